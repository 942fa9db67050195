function side = side(varargin)
%CONTINUUM.SIDE  Says on which side of a mesh points are: -1 inside, 1 outside, 0 undecided.
%   side = continuum.side(mesh, points)
%
%   points: N x 3.
%
%   See also continuum.clears_inside, continuum.surface
    side = continuum_mex('side', varargin{:});
end
