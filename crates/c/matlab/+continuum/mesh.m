function mesh = mesh(varargin)
%CONTINUUM.MESH  Makes a mesh that is asked how near robots are to it.
%   mesh = continuum.mesh(vertices, faces)
%
%   vertices: V x 3. faces: F x 3, rows of vertices, counted from 1, as a triangulation has them.
%   Lengths are in one unit of your choice, the same for meshes and robots.
%   continuum.free(mesh) frees it; 'clear continuum_mex' frees everything.
%
%   See also continuum.load_mesh, continuum.minimum
    mesh = continuum_mex('mesh', varargin{:});
end
