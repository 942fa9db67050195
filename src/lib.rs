//! Exact proximity queries between continuum robots and triangle meshes, and between robots, for
//! parry and rapier.
//!
//! How far is each link of a catheter, a concentric tube robot or a snake from the wall around it,
//! and which two points are closest? From centreline to clearance:
//!
//! ```
//! use parry_continuum::Chain;
//! use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
//! use parry_continuum::proximity::{BvhSearch, Proximity};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32); // the wall, in mm
//! let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
//! let centreline = [Vector::ZERO, Vector::new(0.0, 0.0, 3.0), Vector::new(1.0, 0.0, 5.0)];
//! let robot = Chain::from_centreline(&centreline, &[1.25, 0.5])?; // a thick tube and a thin one
//! let mut links = Vec::new();
//! search.per_link(&robot, &Pose::IDENTITY, &mut links)?;
//! for link in &links {
//!     println!(
//!         "link {}: {:.3} mm to triangle {}",
//!         link.link, link.distance, link.witness.triangle
//!     );
//! }
//! assert!(search.clears(&robot, &Pose::IDENTITY, 2.0)?);
//! # assert_eq!(links.len(), 2);
//! # assert!(!search.clears(&robot, &Pose::IDENTITY, 5.0)?);
//! # Ok(())
//! # }
//! ```
//!
//! # The tour
//! - **The robot.** A [`Chain`] is a sequence of [`ModifiedCylinder`]s: links whose two ends are
//!   [`Cap::Flat`] or [`Cap::Round`]. [`Chain::from_centreline`] chooses the caps;
//!   [`Chain::capsules`] and [`Chain::cylinders`] are the simpler models. [`simplify`] finds
//!   few links within a tolerance of a sampled curve.
//! - **The curve** (feature `tubes`). A [`Tube`] is the robot as a curve, without links: samples or
//!   a function. Each query names its tolerance.
//!   [`BvhSearch::clearance`](proximity::BvhSearch::clearance) bounds the clearance from both
//!   sides.
//! - **The kinematics.** [`ConstantCurvature`] computes points from curvatures;
//!   [`book::kinematics`] covers other models.
//! - **Inside or outside.** [`BvhSearch::side`](proximity::BvhSearch::side) decides by the mesh's
//!   winding number, with a bound on its error.
//! - **The queries.** Build one engine of [`proximity`] per mesh and reuse it:
//!   [`BvhSearch`](proximity::BvhSearch) for all questions. The features `exhaustive` and `gpu` add
//!   others with the same answers: [`Exhaustive`](proximity::Exhaustive) and `gpu::GpuSearch`. The
//!   first page of [`proximity`] lists the call for each question.
//! - **The motion** (feature `tubes`).
//!   [`BvhSearch::clears_motion`](proximity::BvhSearch::clears_motion) proves that a [`Motion`]
//!   keeps a margin at every time.
//! - **Several robots** (feature `robots`). [`RobotPair`](proximity::RobotPair) answers about two
//!   robots, or one robot and itself. A [`Scene`](proximity::Scene) has several structures, each
//!   with its margin: see [`book::robots`].
//! - **Threads.** Each thread has a clone of the engine: see [`book::threads`].
//! - **Contacts.** [`contacts_within`](proximity::Proximity::contacts_within) finds every place
//!   where the robot is near the wall, with its normal and its derivative by the joints.
//!   [`book::control`] is about controllers.
//! - **parry and rapier.** Links and chains are parry shapes with exact point and ray queries. Pass
//!   a [`ContinuumDispatcher`] to parry's queries or to rapier's narrow phase. The feature `rapier`
//!   adds a function that does so and sets the parameters that depend on the unit of length.
//! - **The narrow phase.** [`distance`] has one function per pair of simple shapes, in `f64` and
//!   `f32`.
//! - **The registration.** [`pose_from_matrix`] converts the 4x4 matrix from the robot's frame to
//!   the mesh's frame.
//! - **The book.** [`book`] explains the shape, the queries, accuracy against time, certificates
//!   and limits. It leads [from CT to clearance](book::from_ct), and shows what changes for users
//!   who [come from](book::coming_from) capsules, FCL or parry.
//!
//! # Features
//! | feature | for |
//! |---|---|
//! | none | chains of links in a mesh: distances, margins, contacts, sides; parry's shapes and queries |
//! | `tubes` | robots as curves, motions, and what others can check: certificates and proofs |
//! | `robots` | two robots, a robot beside itself, scenes of several meshes; turns on `tubes` |
//! | `rapier` | robots in a rapier world |
//! | `exhaustive` | the engine that visits every triangle |
//! | `gpu` | batches on the GPU; turns on `exhaustive` |
//! | `serde-serialize` | robots and answers as data |
//! | `parallel` (on by default) | batches on all cores |
//!
//! # What an answer means
//! Distances are to the mesh's surface and unsigned: 0 if a link touches or crosses it. A robot
//! that starts inside a closed wall and touches nothing is inside.
//!
//! A distance is within 16 u x extent of the true distance between the placed link and the
//! triangle. Here u = 2^-53, and the extent is the largest difference between two coordinates of
//! the pair, or the radius if that is larger. There are no absolute tolerances: multiplying all
//! lengths by a power of two multiplies every answer by it. Lengths may have magnitudes up to
//! 1e150.
//!
//! # Source
//! *The paper* in these pages is Leibrandt and Yang, "Efficient Proximity Queries for Continuum
//! Robots on Parallel Computing Hardware". This library corrects some of its formulas; each page
//! names the corrections that it uses.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations, missing_docs)]

pub use parry3d_f64 as parry;

mod answer;
pub mod book;
#[cfg(feature = "tubes")]
mod curve;
pub mod distance;
mod engine;
#[cfg(feature = "gpu")]
pub mod gpu;
mod host;
mod mesh;
#[cfg(feature = "tubes")]
mod motion;
mod pair;
pub mod proximity;
mod query;
#[cfg(feature = "tubes")]
mod refine;
mod robot;
#[cfg(feature = "robots")]
mod scene;
mod search;
mod threads;

#[cfg(feature = "tubes")]
pub use curve::{Tube, TubeSection};
pub use host::ContinuumDispatcher;
#[cfg(feature = "rapier")]
pub use host::rapier;
#[cfg(feature = "tubes")]
pub use motion::{
    BendingMotion, BendingRates, CommonFrame, DisplacementBound, LinearMotion, Motion, MotionPath,
    MovingBase, RigidMotion, Speed, bending_displacement, bending_speed, verify_motion,
};
pub use robot::{
    BendingSection, Cap, Chain, ConstantCurvature, MatrixError, ModifiedCylinder, RobotError,
    pose_from_matrix, simplify,
};

/// Runs the code of the README as doc-tests. One example needs rapier.
#[cfg(all(doctest, feature = "rapier"))]
#[doc = include_str!("../README.md")]
struct Readme;
