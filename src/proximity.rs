//! Robot against mesh, and robot against robot: distances, contacts, margins and motions.
//!
//! Build one engine per mesh and reuse it for all queries. [`BvhSearch`] answers every question.
//! [`Exhaustive`] (feature `exhaustive`) and the engines on the GPU answer the questions of the
//! trait [`Proximity`], with the same distances.
//!
//! **A chain of links, exactly**
//!
//! | question | call |
//! |---|---|
//! | which link is closest, how far is it, and where? | [`minimum`] |
//! | how far is every link? | [`per_link`] |
//! | does the robot keep a margin? | [`clears`] |
//! | which link is closest, if any is within a bound? | [`minimum_within`] |
//! | every place where robot and wall are near, with normal and depth | [`contacts_within`] |
//! | normal and depth of one answer, or of all answers of a query | [`contact_of`], [`contacts_of`] |
//! | how fast a distance changes with a joint | [`Contact::rate`], [`Contact::gradient`] |
//! | the derivative by each end, the radius and each vertex | [`derivative`] |
//!
//! **A curve, between bounds** (feature `tubes`)
//!
//! | question | call |
//! |---|---|
//! | the clearance of a [`Tube`], between two bounds | [`clearance`] |
//! | the same, with the pieces of the division | [`clearance_pieces`] |
//! | does a tube keep a margin? | [`clears_tube`] |
//!
//! **A motion, proven at every instant** (feature `tubes`)
//!
//! | question | call |
//! |---|---|
//! | does a [`Motion`] keep a margin at every time? | [`clears_motion`] |
//! | do a planner's own shapes keep a margin, and all shapes between them? | [`clears_path`] |
//! | does it keep a margin to a mesh that moves at the same time? | [`clears_motion_while`] |
//! | when does it first lose the margin? | [`time_of_contact`] |
//! | how near does it come to the mesh, when and where? | [`clearance_of_motion`] |
//!
//! **A proof for others** (feature `tubes`)
//!
//! | question | call |
//! |---|---|
//! | a proof of an answer about links | [`LinkProximity::certify`], [`certify_among_all`] |
//! | a proof of a margin for a short checker | [`prove`], [`prove_tube`], [`prove_motion`] |
//!
//! **Inside or outside**
//!
//! | question | call |
//! |---|---|
//! | on which side of the mesh is a point? | [`side`] |
//! | is the robot inside, and does it keep a margin? | [`clears_inside`] |
//! | on which side is every link? | [`link_sides`] |
//! | is the mesh open, and how wide? do its triangles face the same way? | [`surface`] |
//!
//! **Two robots** (feature `robots`)
//!
//! | question | call |
//! |---|---|
//! | which links of two robots are closest, and where? | [`RobotPair::minimum`] |
//! | do two robots keep a margin? | [`RobotPair::clears`] |
//! | which link of the other robot is closest to each link? | [`RobotPair::per_link`] |
//! | every place where two robots are near | [`RobotPair::contacts_within`] |
//! | the clearance of two tubes, between two bounds | [`RobotPair::clearance`] |
//! | do two tubes keep a margin? | [`RobotPair::clears_tubes`] |
//! | do two robots keep a margin while both move? | [`RobotPair::clears_motions`] |
//! | when do two moving robots first come within a margin? | [`RobotPair::time_of_contact`] |
//! | the least clearance of two moving robots, between two bounds | [`RobotPair::clearance_of_motion`] |
//! | a proof of the distance of two links | [`RobotProximity::certify`] |
//!
//! **One robot and itself** (feature `robots`)
//!
//! | question | call |
//! |---|---|
//! | where does a robot come closest to itself? | [`SelfQuery::minimum`] |
//! | does a robot keep a margin to itself? | [`SelfQuery::clears`] |
//! | does a tube keep a margin to itself? | [`SelfQuery::clears_tube`] |
//! | does a robot keep it while it moves? | [`SelfQuery::clears_motion`] |
//!
//! **Several structures and robots** (feature `robots`)
//!
//! | question | call |
//! |---|---|
//! | do all robots keep all margins? | [`Scene::clears`] |
//! | where is the least slack, and to which structure? | [`Scene::tightest`] |
//! | how near is each structure? | [`Scene::per_structure`] |
//! | every contact, with its structure | [`Scene::contacts_within`] |
//! | do all tubes keep all margins? | [`Scene::clears_tube`] |
//! | the least slack of tubes, between two bounds | [`Scene::clearance`] |
//! | do all robots keep all margins while they move? | [`Scene::clears_motion`] |
//! | ... while structures move too? | [`Scene::clears_motion_while`] |
//! | when is the first margin violated? | [`Scene::time_of_contact`] |
//! | the least slack of moving robots, between two bounds | [`Scene::clearance_of_motion`] |
//!
//! **Many at once, and a mesh that moves**
//!
//! | to do | call |
//! |---|---|
//! | query many robots on all cores | [`per_link_batch`], [`minimum_batch`], [`clears_batch`] |
//! | query tubes or motions | [`clearance_batch`], [`clears_tube_batch`], [`clears_motion_batch`] |
//! | query many robots of sections | [`BvhSearch::clears_sections_batch`] |
//! | query many pairs of robots | [`RobotPair::minimum_batch`], [`RobotPair::clears_batch`], [`RobotPair::clears_motions_batch`] |
//! | query many sets of robots in a scene | [`Scene::clears_batch`], [`Scene::tightest_batch`] |
//! | query many edges of a planner in a scene | [`Scene::clears_motion_batch`] |
//! | build beforehand every structure that a first query would build | [`prepare`] |
//! | move the mesh | [`set_vertices`] |
//! | read the mesh as the engine has it now | [`vertices`], [`triangles`] |
//! | drop the warm start | [`forget`] |
//!
//! An answer that names a place has a [`Witness`] or a [`PairWitness`]: `answer.witness.on_mesh`. A
//! robot keeps a margin if its distance exceeds the margin. A yes or no about links is exact, so it
//! is a `bool`. About tubes and motions it is a [`Decision`], which may be `Undecided`. An error
//! says what to change; its `kind()` is one word for programs.
//!
//! ```
//! use parry_continuum::Chain;
//! use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
//! use parry_continuum::proximity::{BvhSearch, Proximity};
//!
//! let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
//! let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
//! let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 6.0], &[0.5])?;
//! let closest = search.minimum(&robot, &Pose::IDENTITY)?;
//! let at = closest.witness;
//! println!(
//!     "{} mm, {} mm along the robot, triangle {}",
//!     closest.distance, at.arc_length, at.triangle
//! );
//! # assert!(at.arc_length == 6.0 && 3.9 < closest.distance && closest.distance < 4.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The book has more on [the queries](crate::book::queries), [several robots](crate::book::robots),
//! [threads](crate::book::threads) and [controllers](crate::book::control).
//!
//! [`minimum`]: Proximity::minimum
//! [`per_link`]: Proximity::per_link
//! [`clears`]: Proximity::clears
//! [`minimum_within`]: Proximity::minimum_within
//! [`contacts_within`]: Proximity::contacts_within
//! [`contact_of`]: Proximity::contact_of
//! [`contacts_of`]: Proximity::contacts_of
//! [`derivative`]: Proximity::derivative
//! [`certify_among_all`]: LinkProximity::certify_among_all
//! [`Tube`]: crate::Tube
//! [`clearance`]: BvhSearch::clearance
//! [`clearance_pieces`]: BvhSearch::clearance_pieces
//! [`clears_tube`]: BvhSearch::clears_tube
//! [`Motion`]: crate::Motion
//! [`clears_motion`]: BvhSearch::clears_motion
//! [`clears_path`]: BvhSearch::clears_path
//! [`clears_motion_while`]: BvhSearch::clears_motion_while
//! [`time_of_contact`]: BvhSearch::time_of_contact
//! [`clearance_of_motion`]: BvhSearch::clearance_of_motion
//! [`prove`]: BvhSearch::prove
//! [`prove_tube`]: BvhSearch::prove_tube
//! [`prove_motion`]: BvhSearch::prove_motion
//! [`side`]: BvhSearch::side
//! [`clears_inside`]: BvhSearch::clears_inside
//! [`link_sides`]: BvhSearch::link_sides
//! [`surface`]: BvhSearch::surface
//! [`per_link_batch`]: Proximity::per_link_batch
//! [`minimum_batch`]: Proximity::minimum_batch
//! [`clears_batch`]: Proximity::clears_batch
//! [`clearance_batch`]: BvhSearch::clearance_batch
//! [`clears_tube_batch`]: BvhSearch::clears_tube_batch
//! [`clears_motion_batch`]: BvhSearch::clears_motion_batch
//! [`prepare`]: BvhSearch::prepare
//! [`set_vertices`]: Proximity::set_vertices
//! [`vertices`]: Proximity::vertices
//! [`triangles`]: Proximity::triangles
//! [`forget`]: BvhSearch::forget

#[cfg(feature = "gpu")]
pub use crate::answer::DeviceFailure;
#[cfg(feature = "robots")]
pub use crate::answer::{
    Between, PairWitness, RobotClearance, RobotMotionAnswer, RobotMotionClearance, RobotProximity,
    RobotsInContact, SceneClearance, SceneContact, SceneError, SceneMotionAnswer,
    SceneMotionClearance, SceneMotionContact, ScenePlace, StructureProximity, Tightest,
};
pub use crate::answer::{
    Certificate, Contact, ContactFeature, Derivative, InsideAnswer, LinkFeature, LinkProximity,
    MeshError, Opening, PlacementFault, ProximityError, Side, SurfaceReport, TriangleFeature,
    Witness, Work,
};
#[cfg(feature = "tubes")]
pub use crate::answer::{
    Clearance, Decision, MotionAnswer, MotionClearance, Proof, ShapeInContact, TubePiece,
    UndecidedReason,
};
pub use crate::engine::{BvhSearch, Proximity};
#[cfg(feature = "exhaustive")]
pub use crate::engine::{Exhaustive, SearchPrecision};
#[cfg(feature = "robots")]
pub use crate::engine::{RobotPair, SelfQuery};
#[cfg(feature = "robots")]
pub use crate::scene::{Scene, StructureEnd};
