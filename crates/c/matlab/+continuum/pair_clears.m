function is_clear = pair_clears(varargin)
%CONTINUUM.PAIR_CLEARS  Says whether two robots keep more than the margin apart.
%   is_clear = continuum.pair_clears(points_a, radii_a, points_b, radii_b, 'margin', margin, ...)
%
%   The other arguments are those of continuum.pair_minimum.
%
%   See also continuum.pair_minimum
    is_clear = continuum_mex('pair_clears', varargin{:});
end
