function is_clear = scene_clears(varargin)
%CONTINUUM.SCENE_CLEARS  Says whether robots keep all margins of a scene.
%   is_clear = continuum.scene_clears(scene, robots, ...)
%
%   robots: a cell array with points and radii in each row, and a pose or [] in a third column.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   See also continuum.scene_tightest
    is_clear = continuum_mex('scene_clears', varargin{:});
end
