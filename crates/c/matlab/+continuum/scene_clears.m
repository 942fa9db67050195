function is_clear = scene_clears(varargin)
%CONTINUUM.SCENE_CLEARS  Says whether robots keep all margins of a scene.
%   is_clear = continuum.scene_clears(scene, robots, ...)
%
%   robots: a cell array with points and radii in each row, and a pose or [] in a third column.
%   Points of N x 3 x B or poses of 4 x 4 x B are B sets of robots, which run on all cores; the
%   answer is then B x 1.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   See also continuum.scene_tightest
    is_clear = continuum_mex('scene_clears', varargin{:});
end
