//! What parry sees of links and chains: shapes, points, rays, masses, the dispatcher and contact manifolds.

mod casts;
mod chain;
mod composites;
mod contact;
mod dispatcher;
mod draw;
mod halfspace;
mod inner;
mod joints;
mod link_links;
mod link_manifold;
mod manifolds;
mod mass;
mod nonlinear;
mod overlap;
mod pairs;
mod placements;
mod point_ray;
mod points;
mod rays;
mod scene;
mod serialised;
mod shape;
mod straight_casts;
mod touching;
