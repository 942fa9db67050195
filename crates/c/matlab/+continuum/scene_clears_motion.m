function found = scene_clears_motion(varargin)
%CONTINUUM.SCENE_CLEARS_MOTION  Says whether robots that move keep all margins.
%   found = continuum.scene_clears_motion(scene, motions, 'resolution', resolution)
%
%   motions: a row with one motion for each robot. Several rows are several sets of robots, which
%   run on all cores; the fields then have a row for each.
%
%   found.is_clear: proven. found.decision: 1, -1, or 0: undecided.
%   found.interval: the margins are kept before the first time, and may not be until the second.
%   After a contact: found.t, found.upper, found.structure (NaN between robots), found.robots,
%   found.on_first, found.on_second.
%
%   See also continuum.clears_motion, continuum.scene_clears_motion_while
    found = continuum_mex('scene_clears_motion', varargin{:});
end
