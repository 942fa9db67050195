function scene_set_solid(varargin)
%CONTINUUM.SCENE_SET_SOLID  Makes a structure of a scene solid, or a surface again.
%   continuum.scene_set_solid(scene, structure)
%   continuum.scene_set_solid(scene, structure, false)
%
%   A robot inside of a solid structure is in contact with it. Its mesh must be closed.
%
%   See also continuum.scene_is_solid, continuum.surface
    continuum_mex('scene_set_solid', varargin{:});
end
