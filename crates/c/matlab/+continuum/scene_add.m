function structure = scene_add(varargin)
%CONTINUUM.SCENE_ADD  Adds a mesh to a scene. Its number counts from 1.
%   structure = continuum.scene_add(scene, name, mesh, 'margin', margin, ...)
%
%   Without a margin it is never tested.
%   'pose': 4 x 4, from the mesh's frame to the scene's.
%
%   See also continuum.scene
    structure = continuum_mex('scene_add', varargin{:});
end
