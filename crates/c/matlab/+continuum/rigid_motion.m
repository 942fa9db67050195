function motion = rigid_motion(varargin)
%CONTINUUM.RIGID_MOTION  Makes the motion of a robot that keeps its shape and turns the lesser way.
%   motion = continuum.rigid_motion(points, radii, 'start_pose', A, 'end_pose', B, ...)
%
%   points: N x 3, the centreline from the base to the tip.
%   radii: one number, or N - 1, one for each segment.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   See also continuum.clears_motion, continuum.moving_base
    motion = continuum_mex('rigid_motion', varargin{:});
end
