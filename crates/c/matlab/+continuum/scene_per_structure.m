function found = scene_per_structure(varargin)
%CONTINUUM.SCENE_PER_STRUCTURE  Finds where robots are closest to each structure of a scene.
%   found = continuum.scene_per_structure(scene, robots, ...)
%
%   robots: as for continuum.scene_clears.
%
%   The fields have a row for each structure: found.structure, found.robot, found.slack (NaN
%   without a margin), and those of continuum.minimum.
%
%   See also continuum.scene_tightest
    found = continuum_mex('scene_per_structure', varargin{:});
end
