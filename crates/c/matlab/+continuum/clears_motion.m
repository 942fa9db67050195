function found = clears_motion(varargin)
%CONTINUUM.CLEARS_MOTION  Says whether a motion keeps the margin at every time from 0 to 1.
%   found = continuum.clears_motion(mesh, motion, 'margin', margin, 'resolution', resolution)
%
%   found.is_clear: proven. found.decision: 1, -1, or 0: undecided, within the resolution
%   of the margin.
%   found.interval: the margin is kept before the first time, and may not be until the second.
%   After a contact: the time found.t, found.upper, the places and the triangle.
%
%   See also continuum.time_of_contact, continuum.clearance_of_motion
    found = continuum_mex('clears_motion', varargin{:});
end
