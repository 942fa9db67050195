function mesh = load_mesh(varargin)
%CONTINUUM.LOAD_MESH  Reads a mesh from a file.
%   mesh = continuum.load_mesh(file, ...)
%
%   STL, OBJ, PLY, VTK, or the surface of a label map in NIfTI, NRRD or MetaImage.
%   'label': the label of a label map.
%   'scale': multiplies every coordinate.
%   'frame': 'RAS' or 'LPS'; a file that states the other one is turned.
%
%   See also continuum.mesh, continuum.surface
    mesh = continuum_mex('load_mesh', varargin{:});
end
