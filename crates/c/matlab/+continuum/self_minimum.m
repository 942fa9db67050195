function found = self_minimum(varargin)
%CONTINUUM.SELF_MINIMUM  Finds where two parts of a robot that are not neighbours are closest.
%   found = continuum.self_minimum(points, radii, ...)
%
%   points: N x 3, the centreline from the base to the tip.
%   radii: one number, or N - 1, one for each segment.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   found.distance is Inf if no two parts could meet.
%   The fields are those of continuum.pair_minimum.
%
%   See also continuum.pair_minimum
    found = continuum_mex('self_minimum', varargin{:});
end
