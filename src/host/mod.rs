//! What parry and rapier see: links as shapes, with exact point and ray queries.

mod axial;
mod feature;
mod mass;
mod point;
mod ray;
mod shape;
mod support_map;
