function found = pair_minimum(varargin)
%CONTINUUM.PAIR_MINIMUM  Finds where two robots are closest to each other.
%   found = continuum.pair_minimum(points_a, radii_a, points_b, radii_b, ...)
%
%   'pose_a', 'pose_b': 4 x 4, into the same frame.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   found.distance, found.on_first, found.on_second, found.links, found.arc_lengths.
%
%   See also continuum.pair_clears, continuum.self_minimum
    found = continuum_mex('pair_minimum', varargin{:});
end
