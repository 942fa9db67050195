function found = time_of_contact(varargin)
%CONTINUUM.TIME_OF_CONTACT  Finds the first time at which a motion does not keep the margin.
%   found = continuum.time_of_contact(mesh, motion, 'margin', margin, 'resolution', resolution)
%
%   The fields are those of continuum.clears_motion.
%
%   See also continuum.clears_motion
    found = continuum_mex('time_of_contact', varargin{:});
end
