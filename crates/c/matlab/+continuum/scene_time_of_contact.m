function found = scene_time_of_contact(varargin)
%CONTINUUM.SCENE_TIME_OF_CONTACT  Finds when robots that move first violate a margin.
%   found = continuum.scene_time_of_contact(scene, motions, 'resolution', resolution)
%
%   motions: a row with one motion for each robot.
%
%   The fields are those of continuum.scene_clears_motion. found.interval: all margins are kept
%   until the first time, and not at the second.
%
%   See also continuum.scene_clears_motion, continuum.time_of_contact
    found = continuum_mex('scene_time_of_contact', varargin{:});
end
