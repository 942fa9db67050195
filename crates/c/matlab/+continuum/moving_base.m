function moved = moving_base(varargin)
%CONTINUUM.MOVING_BASE  Moves the base of a motion at the same time.
%   moved = continuum.moving_base(motion, 'start_pose', A, 'end_pose', B)
%
%   The poses are 4 x 4.
%
%   See also continuum.motion_path
    moved = continuum_mex('moving_base', varargin{:});
end
