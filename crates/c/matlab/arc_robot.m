function [best, clearance] = arc_robot(show)
%ARC_ROBOT  A robot of two sections of constant curvature that reaches sideways in a vessel.
%   [best, clearance] = arc_robot(show)
%
%   best: length and curvature of each section, for the largest x of the tip with a clearance of 1.
%   clearance: the clearance of that shape. show: whether to plot the clearance along the robot.
    if nargin < 1
        show = true;
    end
    radius = 0.5;
    least = 1.0;
    mesh = vessel(8, 60);
    start = [20; 0.01; 20; 0.01];
    lower = [10; -0.1; 10; -0.1];
    upper = [25; 0.1; 25; 0.1];

    % What sqp and fmincon ask for: the tip to maximise, and a constraint that must not be negative.
    function [value, slope] = tip(q)
        [points, rates] = shape(q);
        value = -points(end, 1);
        slope = -squeeze(rates(end, 1, :));
    end
    function [value, slope] = room(q)
        [points, rates] = shape(q);
        found = continuum.distance_and_gradient(mesh, points, radius);
        value = found.value - least;
        slope = zeros(4, 1);
        for k = 1:4
            slope(k) = sum(sum(found.points .* rates(:, :, k)));
        end
    end
    function slope = second(f, q)
        [~, slope] = f(q);
    end

    if exist('OCTAVE_VERSION', 'builtin')
        best = sqp(start, {@tip, @(q) second(@tip, q)}, [], {@room, @(q) second(@room, q)'}, ...
                   lower, upper);
    else
        options = optimoptions('fmincon', 'SpecifyObjectiveGradient', true, ...
                               'SpecifyConstraintGradient', true, 'Algorithm', 'sqp');
        best = fmincon(@tip, start, [], [], [], [], lower, upper, @nonlinear, options);
    end
    function [c, ceq, slope, none] = nonlinear(q)
        [value, gradient] = room(q);
        c = -value;
        slope = -gradient;
        ceq = [];
        none = [];
    end

    points = shape(best);
    links = continuum.per_link(mesh, points, radius);
    clearance = min(links.distance);
    if show
        plot(links.arc_length, links.distance);
        xlabel('arc length from the base');
        ylabel('distance');
    end
    continuum.free(mesh);
end

function [points, rates] = shape(q)
% The centreline in the plane y = 0, and its derivative by each of the four numbers.
    points = centreline(q);
    rates = zeros([size(points), 4]);
    for k = 1:4
        step = zeros(4, 1);
        step(k) = 1e-6;
        rates(:, :, k) = (centreline(q + step) - centreline(q - step)) / 2e-6;
    end
end

function points = centreline(q)
    each = 15;
    points = zeros(2 * each + 1, 3);
    angle = 0;
    for section = 1:2
        s = q(2 * section - 1) * (1:each)' / each;
        curvature = q(2 * section);
        turn = angle + curvature * s / 2; % the direction of the chord
        half = curvature * s / 2;
        chord = s .* (1 - half .^ 2 / 6 + half .^ 4 / 120 - half .^ 6 / 5040);
        first = (section - 1) * each + 1;
        points(first + (1:each), :) = points(first, :) + chord .* [sin(turn), 0 * turn, cos(turn)];
        angle = angle + curvature * q(2 * section - 1);
    end
end

function mesh = vessel(radius, length)
% An uneven tube of triangles around the z axis.
    around = 40;
    along = 40;
    [k, ring] = ndgrid(0:around - 1, 0:along);
    angle = 2 * pi * k / around;
    here = radius * (1 + 0.15 * sin(9 * ring / along) + 0.05 * cos(5 * angle));
    vertices = [here(:) .* cos(angle(:)), here(:) .* sin(angle(:)), ...
                length * (ring(:) / along - 0.1)];
    [k, ring] = ndgrid(0:around - 1, 0:along - 1);
    a = ring(:) * around + k(:) + 1;
    b = ring(:) * around + mod(k(:) + 1, around) + 1;
    mesh = continuum.mesh(vertices, [a, b, a + around; b, b + around, a + around]);
end
