function decision = scene_clears_motion(varargin)
%CONTINUUM.SCENE_CLEARS_MOTION  Says whether robots that move keep all margins.
%   decision = continuum.scene_clears_motion(scene, motions, 'resolution', resolution)
%
%   1: they do, -1: they do not, 0: undecided.
%   motions: an array of motions, one for each robot.
%
%   See also continuum.clears_motion
    decision = continuum_mex('scene_clears_motion', varargin{:});
end
