function found = contacts_within(varargin)
%CONTINUUM.CONTACTS_WITHIN  Finds every contact within the margin: all local minima of the distance.
%   found = continuum.contacts_within(mesh, points, radii, 'margin', margin, ...)
%
%   points: N x 3, the centreline from the base to the tip.
%   radii: one number, or N - 1, one for each segment.
%   'prominence': leaves out contacts that rise by less before a nearer one.
%   'pose': 4 x 4, from the robot's frame to the mesh's; the identity without it.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   The fields have a row for each contact: distance, depth (negative where they overlap),
%   normal (from the wall to the robot, or NaN), fraction along the segment;
%   on_robot and on_mesh are the closest points, segment and triangle count from 1,
%   arc_length is measured from the base.
%
%   See also continuum.minimum
    found = continuum_mex('contacts_within', varargin{:});
end
