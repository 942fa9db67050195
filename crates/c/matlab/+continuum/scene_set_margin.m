function scene_set_margin(varargin)
%CONTINUUM.SCENE_SET_MARGIN  Changes the margin of a structure of a scene.
%   continuum.scene_set_margin(scene, structure, margin)
%
%   Without a margin, [], the structure is never tested.
%
%   See also continuum.scene_set_margin_between
    continuum_mex('scene_set_margin', varargin{:});
end
