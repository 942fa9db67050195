//! Links and chains for parry and rapier: shapes with exact point and ray queries, and the
//! dispatcher that answers for pairs of shapes.

mod axial;
mod chain;
mod composite;
mod convex;
mod crest;
mod decomposition;
mod dispatcher;
mod feature;
mod forward;
mod height_field;
mod iterated;
mod lens;
mod link_cast;
mod link_convex_manifold;
mod link_halfspace_manifold;
mod link_link;
mod link_link_manifold;
mod link_pair;
mod link_triangle;
mod link_triangle_manifold;
mod link_triangle_points;
mod manifold;
mod mass;
mod nonlinear_cast;
mod plane_gap;
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
mod strict_dispatcher;
mod support_map;
mod support_points;
mod thin_shape;
#[cfg(feature = "rapier")]
mod world_dispatcher;

pub use dispatcher::ContinuumDispatcher;
