function answers(cases, found)
% The answers of Octave to the cases of answers.rs: the same questions in the same order.
    file = fopen(cases, 'rb');
    numbers = fread(file, Inf, 'double', 0, 'ieee-le');
    fclose(file);
    at = 0;
    out = cell(1, 20000);
    used = 0;
    fine = 0.05;

    function values = take(count)
        values = numbers(at + 1:at + count);
        at = at + count;
    end
    function points = rows(count)
        points = reshape(take(3 * count), 3, count)';
    end
    function put(values)
        used = used + 1;
        out{used} = double(values(:));
    end
    % Writes an answer, or NaN if it is refused.
    function answer(ask)
        try
            values = ask();
        catch error
            assert(strncmp(error.identifier, 'continuum:', 10));
            values = NaN;
        end
        put(values);
    end

    meshes = zeros(1, take(1), 'uint64');
    vertices = cell(1, numel(meshes));
    for k = 1:numel(meshes)
        vertices{k} = rows(take(1));
        meshes(k) = continuum.mesh(vertices{k}, rows(take(1)) + 1);
    end
    last = cell(0, 2);
    for k = 1:take(1)
        place = take(1) + 1;
        caps = {'fitted', 'capsules', 'cylinders'}{take(1) + 1};
        margin = take(1);
        everything = take(1) ~= 0;
        pose = reshape(take(16), 4, 4)';
        count = take(1);
        from = rows(count);
        to = rows(count);
        radii = take(count - 1);
        mesh = meshes(place);
        robot = {from, radii, 'pose', pose, 'caps', caps};
        try
            found_minimum = minimum_row(continuum.minimum(mesh, robot{:}));
        catch
            put(NaN);
            continue
        end
        put(found_minimum);
        answer(@() continuum.clears(mesh, robot{:}, 'margin', margin));
        if place == numel(meshes)
            last(end + 1, :) = {found_minimum, robot};
        end
        if ~everything
            continue
        end
        answer(@() rows_in(continuum.per_link(mesh, robot{:}), @minimum_row));
        answer(@() rows_in(continuum.contacts_within(mesh, robot{:}, 'margin', margin), ...
                           @contact_row));
        answer(@() continuum.side(mesh, from(1, :)));
        answer(@() inside_row(continuum.clears_inside(mesh, robot{:}, 'margin', margin)));
        pose_of = {'pose', pose};
        answer(@() clearance_row(continuum.clearance(mesh, from, radii, 'tolerance', fine, ...
                                                     pose_of{:})));
        answer(@() continuum.clears_tube(mesh, from, radii, 'margin', margin, ...
                                         'resolution', fine, pose_of{:}));
        motion = continuum.linear_motion(from, to, radii);
        asked = {mesh, motion, 'margin', margin, 'resolution', fine};
        answer(@() motion_answer_row(continuum.clears_motion(asked{:})));
        answer(@() motion_answer_row(continuum.time_of_contact(asked{:})));
        answer(@() clearance_row(continuum.clearance_of_motion(mesh, motion, 'tolerance', fine)));
        continuum.free(motion);
        answer(@() proximity_row(continuum.pair_minimum(from, radii, to, radii, 'pose_a', pose, ...
                                                    'caps', caps)));
        answer(@() distance_row(continuum.self_minimum(from, radii, 'caps', caps)));
        scene = continuum.scene('robot_margin', 0.1);
        continuum.scene_add(scene, 'wall', mesh, 'margin', margin);
        both = {from, radii, pose; to, radii, []};
        answer(@() tightest_row(continuum.scene_tightest(scene, both, 'caps', caps)));
        continuum.scene_set_margin_between(scene, 1, 2, 0.5);
        put([continuum.scene_margin_between(scene, 1, 1), ...
             continuum.scene_margin_between(scene, 1, 2)]);
        answer(@() made_solid(scene));
        put(continuum.scene_is_solid(scene, 1));
        sets = {cat(3, from, to), radii, cat(3, pose, eye(4))
                cat(3, to, from), radii, cat(3, eye(4), pose)};
        answer(@() continuum.scene_clears(scene, sets, 'caps', caps));
        answer(@() slack_rows(continuum.scene_tightest(scene, sets, 'caps', caps)));
        continuum.scene_set_margin_between(scene, 1, 2, []);
        answer(@() continuum.scene_clears(scene, both, 'caps', caps));
        continuum.free(scene);
        scene = continuum.scene();
        continuum.scene_add(scene, 'wall', mesh, 'margin', margin);
        continuum.scene_set_margin_between(scene, 1, 2, []);
        try
            continuum.scene_set_solid(scene, 1);
        catch
        end
        motion = continuum.linear_motion(from, to, radii);
        moved = {1, pose};
        answer(@() scene_motion_rows(continuum.scene_clears_motion_while(scene, moved, motion, ...
                                                                         'resolution', fine)));
        moved = {1, vertices{place} * 1.25};
        answer(@() scene_motion_rows(continuum.scene_clears_motion_while(scene, moved, motion, ...
                                                                         'resolution', fine)));
        answer(@() scene_motion_rows(continuum.scene_clears_motion(scene, [motion; motion], ...
                                                                   'resolution', fine)));
        continuum.free(motion);
        continuum.free(scene);
    end
    for k = 1:rows_of(last)
        put(last{k, 1});
    end
    links = cellfun(@(robot) continuum.per_link(meshes(end), robot{:}), last(:, 2), ...
                    'UniformOutput', false);
    for k = 1:numel(links)
        each = minimum_row(links{k})';
        put(each);
    end
    for k = 1:rows_of(last) - 1
        [one, next] = last{k:k + 1, 2}; % points, radii, 'pose', pose, 'caps', caps
        put(continuum.pair_clears(one{1:2}, one{1:2}, 'pose_a', one{4}, 'pose_b', next{4}, ...
                                  one{5:6}, 'margin', 0.5));
    end
    sections = zeros(2, 3, 1000);
    for k = 0:999
        sections(:, :, k + 1) = [2 + 0.5 * mod(k, 10), 0.0625 * mod(k, 7), -0.03125 * mod(k, 5)
                                 2, 0.5 - 0.125 * mod(k, 11), 0.25 * mod(k, 3)];
    end
    keeps = mod(0:999, 97)' ~= 96;
    clear_ones = NaN(1000, 1);
    clear_ones(keeps) = continuum.clears_sections(meshes(end), sections(:, :, keeps), ...
                                                  [0.3 0.2], 'segments', 5, 'margin', 0.1);
    put(clear_ones);
    file = fopen(found, 'wb');
    fwrite(file, vertcat(out{1:used}), 'double', 0, 'ieee-le');
    fclose(file);
end

function count = rows_of(array)
    count = size(array, 1);
end

% A row of numbers for each row of an answer, in the order of answers.rs.
function values = minimum_row(found)
    values = [found.distance, place_row(found)];
end

function values = place_row(found)
    values = [found.on_robot, found.on_mesh, found.arc_length, found.segment - 1, ...
              found.triangle - 1];
end

function values = contact_row(found)
    values = [found.distance, found.depth, found.fraction, found.normal, place_row(found)];
end

function values = rows_in(found, numbers)
    each = numbers(found)';
    values = [rows_of(found.distance); each(:)];
end

function values = inside_row(found)
    values = [found.base, found.tip, found.clears, found.crosses_opening, found.holds];
end

function values = clearance_row(found)
    values = [found.lower, found.upper, found.uncertainty, found.t, place_row(found), ...
              found.resolved];
end

function values = motion_answer_row(found)
    values = [found.decision, found.reason, found.interval, found.t, found.upper, place_row(found)];
end

function value = distance_row(found)
    value = found.distance;
end

function values = proximity_row(found)
    values = [found.distance, found.on_first, found.on_second, found.arc_lengths];
end

function value = made_solid(scene)
    continuum.scene_set_solid(scene, 1);
    value = 1;
end

function values = slack_rows(found)
    values = found.slack;
end

function values = scene_motion_rows(found)
    values = [double(found.decision), found.reason, found.interval, found.t, found.upper]';
end

function values = tightest_row(found)
    values = [found.slack, found.structure - 1];
end
