//! Pictures as pixels, for the demo's pictures and the command's plot. Text needs no font file: its
//! letters are strokes.

pub mod canvas;
pub mod lettering;
