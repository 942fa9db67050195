function found = surface(varargin)
%CONTINUUM.SURFACE  Says what a mesh is as a surface.
%   found = continuum.surface(mesh)
%
%   found.is_sound: closed, and all triangles face the same way. Also the numbers of vertices,
%   triangles, openings, nonmanifold_edges, misoriented_edges, and of skipped_faces of its file.
%
%   See also continuum.side
    found = continuum_mex('surface', varargin{:});
end
