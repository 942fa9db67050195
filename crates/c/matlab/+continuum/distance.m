function found = distance(varargin)
%CONTINUUM.DISTANCE  The distance of a robot from a mesh, 0 where they touch or overlap.
%   found = continuum.distance(mesh, points, radii, ...)
%
%   The arguments are those of continuum.minimum. Of B robots it is B x 1.
%
%   See also continuum.minimum
    found = continuum_mex('minimum', varargin{:});
    found = found.distance;
end
