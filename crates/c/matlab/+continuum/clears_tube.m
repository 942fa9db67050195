function decision = clears_tube(varargin)
%CONTINUUM.CLEARS_TUBE  Says whether a smooth tube keeps the margin.
%   decision = continuum.clears_tube(mesh, points, radii, 'margin', m, 'resolution', r, ...)
%
%   1: it does, -1: it does not, 0: undecided.
%   points: N x 3, the centreline from the base to the tip.
%   radii: one number, or N - 1, one for each segment.
%   'tangents': directions, 2 x 3 for the ends or N x 3 for all points.
%   'deviation': how far a measured point may be from the curve.
%   'turn': by how many rad the true direction may differ at flat ends.
%   'pose': 4 x 4, from the robot's frame to the mesh's; the identity without it.
%
%   It is undecided only within the resolution of the margin.
%
%   See also continuum.clearance
    decision = continuum_mex('clears_tube', varargin{:});
end
