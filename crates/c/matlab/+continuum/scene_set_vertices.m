function scene_set_vertices(varargin)
%CONTINUUM.SCENE_SET_VERTICES  Moves the vertices of a structure of a scene.
%   continuum.scene_set_vertices(scene, structure, vertices)
%
%   vertices: as many rows as the mesh has, in the mesh's frame.
%
%   See also continuum.scene_set_pose
    continuum_mex('scene_set_vertices', varargin{:});
end
