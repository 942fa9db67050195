//! Robot against mesh: the closest triangle of every link, by search or exhaustively.
//!
//! The way of a query, from top to bottom:
//!
//! | file | what it knows |
//! |---|---|
//! | `engine` | what every engine answers: the trait [`Proximity`] |
//! | `wide_bvh/` | the search: `build` makes the hierarchy, `bound` is what a node knows of a child, `fit` puts a box around one, `across` knows the neighbours of a leaf's triangles, `traverse` finds the nearest triangle of a link and `candidates` orders what it leaves in question and `few_each` measures that of several links at once, `gathering` collects all within a margin, `hierarchy` chooses the precision for it, `queries` goes through a robot's links, `minimum` finds the closest of them, `joint` parts robot and mesh together and `rough_sides` guesses where they meet, `kept_distances` knows what still holds after a small motion, `outline` how far it was and `widening` how far to look for the next, `tube_queries` goes through a tube's pieces, `motion_queries` through the shapes of a motion and `moment` through the pieces of one, `winding` sums up how the mesh winds around a point, `engine`, `tube_engine`, `motion_engine` and `side_engine` are [`BvhSearch`] |
//! | `tube/` | a tube in the mesh's frame: its pieces, convex bodies around them, points that are in it |
//! | `exhaustive/` | every triangle: `blocks` holds them, `scan` is the loop, `pass` goes through a query's links, `engine` is [`Exhaustive`] |
//! | `link_lanes` | a link against a pack of triangles, in the precision of the search |
//! | `slopes`, `feet` | which of a pack of triangles lie on a slope towards a neighbour, and where on them the nearest points can lie, in the precision of the search |
//! | `search_frame` | mesh and links near one, in the precision of the search, and what rounding can do there |
//! | `triangle_block` | how triangles stand in memory, to be loaded in packs |
//! | `placed` | the robot in the mesh's frame, and the measurement of a link and a triangle in double precision |
//! | `measure_lanes`, `pair_lanes` | the same measurement, several triangles or pairs together |
//! | `mesh` | the mesh as every engine keeps it |
//! | `parallel`, `lazy` | work for all cores, and what is built by one thread while others may wait for it |
//! | `winding/` | how the mesh winds around a point, and on which side of it that is; `wide_bvh/winding` sums it up |
//! | `certificate` | proofs of an answer |
//! | `contact` | an answer with its normal and its place on the robot, and how it changes with the joints |
//! | `contact_lanes` | contacts of many answers, a pack of pairs at a time |
//! | `local_minima`, `wall_pieces`, `ranked` | the local minima of a link's distance: one contact for each |
//! | `long_rings` | what is known of the triangles around a corner or an edge that very many have |
//! | `near_triangle`, `shared_parts` | what the search tells of a triangle within the margin, and which corners and edges triangles share |
//! | `derivative` | how it changes with the points that link and triangle are made of |
//! | `nearest_features`, `feature` | which parts of link and triangle are nearest, and the normal between them |
//! | `motion` | what an answer about a motion is |
//! | `fit` | whether an answer is about the link and the triangle as they are now |
//! | `checks`, `error`, `report` | what is refused, how, and what an answer is |

mod certificate;
mod checks;
mod contact;
mod contact_lanes;
mod derivative;
mod engine;
mod error;
mod exhaustive;
mod feature;
mod feet;
mod fit;
mod lazy;
mod link_lanes;
mod local_minima;
mod long_rings;
mod measure_lanes;
mod mesh;
mod motion;
#[cfg(feature = "serde-serialize")]
mod motion_serialised;
mod near_triangle;
mod nearest_features;
mod pair_lanes;
mod parallel;
mod placed;
mod ranked;
mod report;
mod search_frame;
#[cfg(feature = "serde-serialize")]
mod serialised;
mod shared_parts;
mod slopes;
mod triangle_block;
mod tube;
mod wall_pieces;
mod wide_bvh;
mod winding;

#[cfg(feature = "gpu")]
pub(crate) use checks::{check_bound, check_margin};
#[cfg(feature = "gpu")]
pub(crate) use engine::{HasMesh, pairs};
#[cfg(feature = "gpu")]
pub(crate) use local_minima::contacts_by_all_triangles;
#[cfg(feature = "gpu")]
pub(crate) use mesh::Mesh;
#[cfg(feature = "gpu")]
pub(crate) use parallel::each;
#[cfg(feature = "gpu")]
pub(crate) use placed::PlacedRobot;
pub(crate) use placed::{Best, Nearest, PlacedLink};
#[cfg(feature = "gpu")]
pub(crate) use search_frame::{SearchFrame, SearchLink};

pub use certificate::Certificate;
pub use contact::Contact;
pub use derivative::Derivative;
pub use engine::Proximity;
#[cfg(feature = "gpu")]
pub use error::DeviceFailure;
pub use error::{MeshError, ProximityError};
pub use exhaustive::{Exhaustive, SearchPrecision};
pub use feature::{ContactFeature, LinkFeature, TriangleFeature};
pub use motion::{FirstContact, MotionAnswer};
pub use report::{LinkProximity, Work};
pub use tube::{Clearance, Decision, TubePiece};
pub use wide_bvh::BvhSearch;
pub use winding::{InsideAnswer, Side};
