function motion = linear_motion(varargin)
%CONTINUUM.LINEAR_MOTION  Makes a motion whose points move straight and evenly.
%   motion = continuum.linear_motion(start_points, end_points, radii, ...)
%
%   start_points, end_points: N x 3.
%   'caps': 'fitted' or 'capsules'.
%
%   See also continuum.clears_motion, continuum.motion_path
    motion = continuum_mex('linear_motion', varargin{:});
end
