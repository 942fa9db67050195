function is_clear = clears_sections(varargin)
%CONTINUUM.CLEARS_SECTIONS  Says whether robots of constant curvature keep the margin.
%   is_clear = continuum.clears_sections(mesh, sections, radii, 'margin', margin, ...)
%
%   sections: S x 3 x B, the length and the curvatures towards x and y of each of S sections of B
%   robots, which run on all cores.
%   radii: one number, or S, one for each section.
%   'segments': how many straight links a section becomes; 1 without it.
%   'pose': 4 x 4, of all bases.
%
%   See also continuum.clears, continuum.bending_motion
    is_clear = continuum_mex('clears_sections', varargin{:});
end
