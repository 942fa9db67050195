function path = motion_path(varargin)
%CONTINUUM.MOTION_PATH  Puts motions one after another, with equal shares of the time.
%   path = continuum.motion_path(motions)
%
%   motions: an array of motions, as in [first, second]. Each begins where the one before ends.
%
%   See also continuum.clears_motion
    path = continuum_mex('motion_path', varargin{:});
end
