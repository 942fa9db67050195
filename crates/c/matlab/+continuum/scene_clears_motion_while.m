function found = scene_clears_motion_while(varargin)
%CONTINUUM.SCENE_CLEARS_MOTION_WHILE  The same while structures move, too.
%   found = continuum.scene_clears_motion_while(scene, ends, motions, 'resolution', resolution)
%
%   ends: a cell array with a structure in each row, and the pose, 4 x 4, or the vertices, N x 3,
%   to which it moves. Others rest.
%   motions: a row with one motion for each robot.
%
%   The fields are those of continuum.scene_clears_motion.
%
%   See also continuum.scene_clears_motion, continuum.clears_motion_while
    found = continuum_mex('scene_clears_motion_while', varargin{:});
end
