function motion = bending_motion(varargin)
%CONTINUUM.BENDING_MOTION  Makes the motion of sections of constant curvature that change evenly.
%   motion = continuum.bending_motion(start_sections, end_sections, radii, ...)
%
%   start_sections, end_sections: S x 3, a row for each section: its length, its
%   curvature towards x and towards y. radii: one number, or S.
%   'pose': 4 x 4, that of the base.
%
%   See also continuum.clears_motion, continuum.moving_base
    motion = continuum_mex('bending_motion', varargin{:});
end
