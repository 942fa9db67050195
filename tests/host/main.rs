//! parry's interface to links and chains: shapes, points, rays, masses, the dispatcher and contact
//! manifolds.

mod casts;
mod chain;
mod composites;
mod contact;
mod depths;
mod dispatcher;
mod draw;
mod finite;
mod flat_caps;
mod free_edges;
mod halfspace;
mod inner;
mod joints;
mod level_links;
mod link_links;
mod link_manifold;
mod link_pairs;
mod manifolds;
mod mass;
mod nonlinear;
mod overlap;
mod pairs;
mod parrys;
mod placements;
mod point_ray;
mod points;
mod rays;
mod scene;
#[cfg(feature = "serde-serialize")]
mod serialised;
mod shape;
mod small_gaps;
mod straight_casts;
mod touching;
