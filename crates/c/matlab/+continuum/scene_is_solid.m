function is_solid = scene_is_solid(varargin)
%CONTINUUM.SCENE_IS_SOLID  Says whether a structure of a scene is solid.
%   is_solid = continuum.scene_is_solid(scene, structure)
%
%   See also continuum.scene_set_solid
    is_solid = continuum_mex('scene_is_solid', varargin{:});
end
