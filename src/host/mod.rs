//! What parry and rapier see: links and chains as shapes with exact point and ray queries, and the dispatcher
//! that answers for pairs of shapes.

mod axial;
mod chain;
mod crest;
mod dispatcher;
mod ellipse;
mod feature;
mod field;
mod joint;
mod link_contact;
mod link_manifold;
mod manifold;
mod mass;
mod mesh_manifold;
mod mesh_search;
mod parts;
mod point;
#[cfg(feature = "rapier")]
pub mod rapier;
mod ray;
mod robot_pair;
mod separation;
mod shape;
mod support_map;
mod watched;

pub use dispatcher::ContinuumDispatcher;
