function found = clearance_of_motion(varargin)
%CONTINUUM.CLEARANCE_OF_MOTION  Bounds the least clearance of a motion.
%   found = continuum.clearance_of_motion(mesh, motion, 'tolerance', tolerance)
%
%   The fields are those of continuum.clearance. found.t: the time of that shape.
%
%   See also continuum.clears_motion
    found = continuum_mex('clearance_of_motion', varargin{:});
end
