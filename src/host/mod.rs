//! What parry and rapier see: links and chains as shapes with exact point and ray queries, and the dispatcher
//! that answers for pairs of shapes.

mod axial;
mod chain;
mod closing;
mod composite;
mod convex;
mod convex_depth;
mod crest;
mod dispatcher;
mod elements;
mod feature;
mod foot;
mod footing;
mod iterated;
mod joint;
mod layers;
mod lens;
mod link_cast;
mod link_convex_manifold;
mod link_halfspace_manifold;
mod link_link;
mod link_link_manifold;
mod link_pair;
mod link_triangle;
mod link_triangle_manifold;
mod manifold;
mod mass;
mod meeting;
mod mesh_search;
mod parts;
mod point;
mod range;
#[cfg(feature = "rapier")]
pub mod rapier;
mod ray;
mod rim;
mod robot_halfspace;
mod robot_surface;
mod robot_surface_manifold;
mod shape;
mod straight_cast;
mod support_map;
mod thin;
mod voxels;
mod watched;

pub use dispatcher::ContinuumDispatcher;
