function scene_set_pose(varargin)
%CONTINUUM.SCENE_SET_POSE  Moves a structure of a scene.
%   continuum.scene_set_pose(scene, structure, pose)
%
%   pose: 4 x 4, from the mesh's frame to the scene's.
%
%   See also continuum.scene_add, continuum.scene_set_vertices
    continuum_mex('scene_set_pose', varargin{:});
end
