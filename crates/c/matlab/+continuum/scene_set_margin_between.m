function scene_set_margin_between(varargin)
%CONTINUUM.SCENE_SET_MARGIN_BETWEEN  Sets the margin between a structure and one robot.
%   continuum.scene_set_margin_between(scene, structure, robot, margin)
%
%   It replaces the structure's margin for this robot.
%   robot: the row of the robot in the questions.
%   margin: [] if the two may touch.
%
%   See also continuum.scene_set_margin, continuum.scene_margin_between
    continuum_mex('scene_set_margin_between', varargin{:});
end
