function found = clearance(varargin)
%CONTINUUM.CLEARANCE  Bounds the clearance of the smooth tube through the points.
%   found = continuum.clearance(mesh, points, radii, 'tolerance', tolerance, ...)
%
%   points: N x 3, the centreline from the base to the tip.
%   radii: one number, or N - 1, one for each segment.
%   'tangents': directions, 2 x 3 for the ends or N x 3 for all points.
%   'deviation': how far a measured point may be from the curve.
%   'turn': by how many rad the true direction may differ at flat ends.
%   'pose': 4 x 4, from the robot's frame to the mesh's; the identity without it.
%
%   found.lower <= clearance <= found.upper, rounding included. found.resolved: the bounds are as
%   close as was asked.
%   on_robot and on_mesh are the closest points, segment and triangle count from 1,
%   arc_length is measured from the base.
%
%   See also continuum.clears_tube
    found = continuum_mex('clearance', varargin{:});
end
