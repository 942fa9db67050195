function gateway(folder)
% What the gateway adds to C: shapes, options, handles, batches, indices from 1, and every function.
    floor_of = [-9 -9 0; 9 -9 0; 0 9 0];
    mesh = continuum.mesh(floor_of, [1 2 3]);
    robot = [0 0 2; 1 0 2; 2 0 3];
    radii = [0.5; 0.5];
    up = eye(4);
    up(3, 4) = 1;

    found = continuum.minimum(mesh, robot, 0.5);
    assert(found.distance == 1.5 && found.segment == 1 && found.triangle == 1);
    assert(continuum.distance(mesh, robot, radii, 'pose', up) == 2.5);
    both = cat(3, robot, robot + [0 0 1]);
    assert(isequal(continuum.distance(mesh, both, 0.5), [1.5; 2.5]));
    assert(isequal(continuum.distance(mesh, both, 0.5, 'pose', up), [2.5; 3.5]));
    assert(isequal(continuum.distance(mesh, both, 0.5, 'pose', cat(3, eye(4), up)), [1.5; 3.5]));
    assert(isequal(continuum.clears(mesh, both, 0.5, 'margin', 2), logical([0; 1])));
    assert(continuum.distance(mesh, robot, radii, 'Pose', up, 'CAPS', 'capsules') == 2.5);
    links = continuum.per_link(mesh, robot, radii);
    assert(isequal(size(links.on_robot), [2 3]) && isequal(links.segment, [1; 2]));
    assert(field(continuum.contacts_within(mesh, robot, radii, 'margin', 2), 'distance')(1) == 1.5);
    assert(isequal(size(continuum.side(mesh, robot)), [3 1]));
    assert(field(continuum.clears_inside(mesh, robot, radii, 'margin', 1), 'clears'));
    surface = continuum.surface(mesh);
    assert(~surface.is_sound && surface.triangles == 1);
    assert(ischar(continuum.version()));

    % The gradient by differences.
    found = continuum.distance_and_gradient(mesh, robot, radii, 'pose', turned());
    step = 1e-6 * [1 2 3; 3 1 2; 2 3 1];
    after = continuum.distance(mesh, robot + step, radii, 'pose', turned());
    before = continuum.distance(mesh, robot - step, radii, 'pose', turned());
    assert(abs((after - before) / 2 - sum(sum(step .* found.points))) < 1e-12);
    assert(abs(sum(found.radii) + 1) < 1e-12 && ~found.kink);

    level = [0 0 2; 1 0 2; 2 0 2];
    found = continuum.clearance(mesh, level, radii, 'tolerance', 0.01, 'tangents', [1 0 0; 2 0 0]);
    assert(found.resolved && found.lower <= 1.5 && 1.5 <= found.upper);
    assert(continuum.clears_tube(mesh, robot, radii, 'margin', 1, 'resolution', 0.01) == 1);
    linear = continuum.linear_motion(robot, robot + [0 0 1], radii, 'caps', 'capsules');
    found = continuum.clears_motion(mesh, linear, 'margin', 1, 'resolution', 0.01);
    assert(found.is_clear && found.decision == 1 && isequal(found.interval, [1 1]));
    rigid = continuum.rigid_motion(robot, radii, 'start_pose', up, 'end_pose', eye(4));
    found = continuum.time_of_contact(mesh, rigid, 'margin', 2, 'resolution', 0.01);
    assert(~found.is_clear && found.decision == -1 && abs(found.t - 0.5) < 0.02);
    straight = continuum.bending_motion([3 0 0], [3 0.1 0], 0.2, 'pose', up);
    back = continuum.bending_motion([3 0.1 0], [3 0 0], 0.2, 'pose', up);
    path = continuum.motion_path([straight back]);
    moved = continuum.moving_base(path, 'start_pose', eye(4), 'end_pose', up);
    found = continuum.clearance_of_motion(mesh, moved, 'tolerance', 0.01);
    assert(found.resolved && found.lower <= 1 && 1 <= found.upper);

    found = continuum.pair_minimum(robot, radii, robot + [0 5 0], radii);
    assert(found.distance == 4);
    high = 5 * up - 4 * eye(4);
    assert(continuum.pair_clears(robot, radii, robot, radii, 'margin', 3, 'pose_b', high));
    assert(field(continuum.self_minimum(robot, radii), 'distance') == Inf);
    scene = continuum.scene('robot_margin', 0.1);
    assert(continuum.scene_add(scene, 'floor', mesh, 'margin', 1) == 1);
    two = {robot, radii; robot + [0 5 0], radii};
    assert(field(continuum.scene_tightest(scene, two), 'slack') == 0.5);
    assert(continuum.scene_clears(scene, {robot, radii, up}));
    both_up = {both, radii, up};
    assert(isequal(field(continuum.scene_tightest(scene, both_up), 'slack'), [1.5; 2.5]));
    poses = cat(3, eye(4), up);
    poses(3, 4, 1) = -1; % the floor is nearer
    assert(isequal(continuum.scene_clears(scene, {robot, radii, poses}), logical([0; 1])));
    found = continuum.scene_per_structure(scene, two);
    assert(found.structure == 1 && found.robot == 1 && found.distance == 1.5);
    found = continuum.scene_clears_motion(scene, linear, 'resolution', 0.01);
    assert(found.is_clear && found.decision == 1 && isnan(found.structure));
    found = continuum.scene_clears_motion(scene, [linear; rigid], 'resolution', 0.01);
    assert(isequal(found.decision, [1; 1]));
    found = continuum.scene_clears_motion(scene, [linear rigid], 'resolution', 0.01);
    assert(found.decision == -1 && isequal(found.robots, [1 2])); % two robots in one place
    found = continuum.scene_time_of_contact(scene, [linear rigid], 'resolution', 0.01);
    assert(found.decision == -1);
    down = eye(4);
    down(3, 4) = 1.9;
    found = continuum.scene_clears_motion_while(scene, {1, down}, rigid, 'resolution', 0.01);
    assert(found.decision == -1 && found.structure == 1 && found.t < 1);
    found = continuum.scene_clears_motion_while(scene, {1, floor_of}, rigid, 'resolution', 0.01);
    assert(found.is_clear);
    found = continuum.clears_motion_while(mesh, floor_of + [0 0 1.9], rigid, 'margin', 1, ...
                                          'resolution', 0.01);
    assert(found.decision == -1 && found.t < 1);
    assert(isnan(field(continuum.clears_motion_while(mesh, floor_of, rigid, 'margin', 1, ...
                                                     'resolution', 0.01), 't')));
    continuum.scene_set_margin_between(scene, 1, 1, 2);
    assert(continuum.scene_margin_between(scene, 1, 1) == 2);
    assert(~continuum.scene_clears(scene, {robot, radii}));
    continuum.scene_set_margin_between(scene, 1, 1, []);
    assert(isnan(continuum.scene_margin_between(scene, 1, 1)));
    continuum.scene_set_margin(scene, 1, 3);
    continuum.scene_set_margin_between(scene, 1, 1, 1);
    continuum.scene_set_pose(scene, 1, down);
    assert(~continuum.scene_clears(scene, {robot, radii}));
    continuum.scene_set_pose(scene, 1, eye(4));
    continuum.scene_set_vertices(scene, 1, floor_of);
    assert(continuum.scene_clears(scene, {robot, radii}));
    assert(~continuum.scene_is_solid(scene, 1));
    continuum.scene_set_solid(scene, 1, false);
    links = continuum.per_link(mesh, both, radii);
    assert(isequal(links.robot, [1; 1; 2; 2]) && links.distance(3) == 2.5);
    bent = cat(3, [3 0 0], [3 2 0]);
    assert(isequal(continuum.clears_sections(mesh, bent, 0.2, 'segments', 9, 'margin', 0.5, ...
                                             'pose', up), logical([1; 0])));
    proof = fullfile(folder, 'octave.txt');
    assert(continuum.prove(mesh, robot, radii, 'margin', 1, 'file', proof));
    assert(~continuum.prove(mesh, robot, radii, 'margin', 2, 'file', proof));
    loaded = continuum.load_mesh(fullfile(folder, 'octave.obj'), 'scale', 2);
    assert(continuum.distance(loaded, robot, radii) == 1.5);

    refuses('bad_shape', @() continuum.minimum(mesh, [robot; robot]', 1));
    refuses('bad_shape', @() continuum.minimum(mesh, zeros(2, 2), 1));
    refuses('bad_shape', @() continuum.contacts_within(mesh, both, 1, 'margin', 1));
    refuses('bad_shape', @() continuum.scene_clears(scene, {both, 1; cat(3, both, robot), 1}));
    refuses('bad_shape', @() continuum.scene_per_structure(scene, {both, 1}));
    refuses('bad_shape', @() continuum.scene_clears_motion_while(scene, {1}, linear, ...
                                                                 'resolution', 1));
    refuses('bad_index', @() continuum.scene_set_margin(scene, 0, 1));
    refuses('bad_index', @() continuum.scene_margin_between(scene, 1, 1.5));
    refuses('no_such_structure', @() continuum.scene_set_margin(scene, 2, 1));
    refuses('not_solid', @() continuum.scene_set_solid(scene, 1));
    refuses('bad_type', @() continuum.scene_set_solid(scene, 1, 2));
    refuses('name_taken', @() continuum.scene_add(scene, 'floor', mesh));
    refuses('vertex_count', @() continuum.scene_set_vertices(scene, 1, robot(1:2, :)));
    refuses('bad_options', @() continuum.clears_sections(mesh, [1 0 0], 1, 'margin', 0, ...
                                                         'segments', 0));
    refuses('missing_option', @() continuum.clears_sections(mesh, [1 0 0], 1));
    try
        continuum.minimum(mesh, cat(3, robot, robot * NaN), 1);
    catch error
        assert(~isempty(strfind(error.message, 'robot 1: point 0 ')), error.message); %#ok
    end
    refuses('bad_shape', @() continuum.minimum(mesh, robot, 1, 'pose', eye(3)));
    refuses('bad_type', @() continuum.minimum(mesh, single(robot), 1));
    refuses('bad_type', @() continuum.minimum(mesh, robot * 1i, 1));
    refuses('bad_type', @() continuum.minimum(mesh, sparse(robot), 1));
    refuses('bad_type', @() continuum.minimum(mesh, robot, 'radius'));
    refuses('bad_options', @() continuum.minimum(mesh, robot, 1, 'pos', up));
    refuses('bad_options', @() continuum.minimum(mesh, robot, 1, 'pose'));
    refuses('bad_options', @() continuum.minimum(mesh, robot, 1, 'caps', 'round'));
    refuses('missing_option', @() continuum.clears(mesh, robot, 1));
    refuses('missing_option', @() continuum.prove(mesh, robot, 1, 'margin', 1));
    refuses('bad_index', @() continuum.mesh(floor_of, [0 1 2]));
    refuses('bad_index', @() continuum.mesh(floor_of, [1 2 2.5]));
    refuses('no_such_vertex', @() continuum.mesh(floor_of, [1 2 4]));
    refuses('lengths_differ', @() continuum.minimum(mesh, robot, [1 1 1]));
    refuses('point_not_finite', @() continuum.minimum(mesh, robot * NaN, 1));
    refuses('negative', @() continuum.clears(mesh, robot, 1, 'margin', -1));
    refuses('file', @() continuum.load_mesh('no such file.stl'));
    refuses('no_such_handle', @() continuum.minimum(1, robot, 1));
    refuses('no_such_handle', @() continuum.minimum(uint64(1e6), robot, 1));
    refuses('wrong_handle', @() continuum.minimum(scene, robot, 1));
    refuses('wrong_handle', @() continuum.motion_path([linear mesh]));
    refuses('bad_call', @() continuum.minimum(mesh, robot));
    refuses('bad_call', @() continuum_mex('no such command'));
    continuum.free(mesh);
    refuses('no_such_handle', @() continuum.minimum(mesh, robot, 1));
    refuses('no_such_handle', @() continuum.free(mesh));
    assert(continuum.scene_clears(scene, {robot, radii, up})); % it has its own

    functions = dir(fullfile(fileparts(which('continuum_mex')), '+continuum', '*.m'));
    assert(numel(functions) > 25);
    for k = 1:numel(functions)
        [~, name] = fileparts(functions(k).name);
        assert(~isempty(strfind(help(['continuum.' name]), upper(['continuum.' name])))); %#ok
    end
end

% Octave takes no field of what a function of a package returns.
function value = field(found, name)
    value = found.(name);
end

function pose = turned()
    pose = [0.8 0 0.6 0.1; 0 1 0 0.2; -0.6 0 0.8 5; 0 0 0 1];
end

function refuses(kind, ask)
    try
        ask();
    catch error
        text = [error.identifier ': ' error.message];
        assert(strcmp(error.identifier, ['continuum:' kind]), text);
        assert(numel(error.message) > 10);
        return
    end
    assert(false, ['nothing is refused as ' kind]);
end
