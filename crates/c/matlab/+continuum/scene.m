function scene = scene(varargin)
%CONTINUUM.SCENE  Makes a scene of several meshes with margins.
%   scene = continuum.scene(...)
%
%   'robot_margin': the margin between two robots.
%   'self_margin': the margin of a moving robot and itself.
%
%   See also continuum.scene_add, continuum.scene_tightest
    scene = continuum_mex('scene', varargin{:});
end
