function margin = scene_margin_between(varargin)
%CONTINUUM.SCENE_MARGIN_BETWEEN  The margin between a structure and a robot of a scene.
%   margin = continuum.scene_margin_between(scene, structure, robot)
%
%   robot: the row of the robot in the questions. NaN: they may touch.
%
%   See also continuum.scene_set_margin_between
    margin = continuum_mex('scene_margin_between', varargin{:});
end
