//! Robot against mesh, and robot against robot: distances, contacts, margins and motions.
//!
//! Build an engine once for each mesh and ask it often. [`BvhSearch`] answers everything;
//! [`Exhaustive`] and the GPU's engine answer what the trait [`Proximity`] has, with the same
//! distances.
//!
//! **A chain of links, exactly**
//!
//! | question | call |
//! |---|---|
//! | which link is closest, how far is it, and where? | [`minimum`](Proximity::minimum) |
//! | how far is every link? | [`per_link`](Proximity::per_link) |
//! | does the robot keep a margin? | [`clears`](Proximity::clears) |
//! | which link is closest, if any is within a bound? | [`minimum_within`](Proximity::minimum_within) |
//! | every place where robot and wall are near, with normal and depth | [`within`](Proximity::within) |
//! | the normal and the depth of an answer, or of all answers of a query | [`contact`](Proximity::contact), [`contacts`](Proximity::contacts) |
//! | how fast a distance changes with a joint | [`Contact::rate`], [`Contact::gradient`] |
//! | the derivative by each end, the radius and each vertex | [`derivative`](Proximity::derivative) |
//! | a proof of an answer | [`LinkProximity::certify`], [`certify_among_all`](LinkProximity::certify_among_all) |
//!
//! **A curve, between bounds**
//!
//! | question | call |
//! |---|---|
//! | the clearance of a [`Tube`](crate::Tube), between two bounds | [`clearance`](BvhSearch::clearance) |
//! | the same, and the pieces that it took | [`clearance_pieces`](BvhSearch::clearance_pieces) |
//! | does a tube keep a margin? | [`tube_clears`](BvhSearch::tube_clears) |
//!
//! **A motion, proven at every instant**
//!
//! | question | call |
//! |---|---|
//! | does a [`Motion`](crate::Motion) keep a margin all the way? | [`clears_motion`](BvhSearch::clears_motion) |
//! | do a planner's own shapes keep it, and all between them? | [`clears_path`](BvhSearch::clears_path) |
//! | does it keep it from a mesh that moves meanwhile? | [`clears_motion_while`](BvhSearch::clears_motion_while) |
//! | when does it first lose it? | [`time_of_contact`](BvhSearch::time_of_contact) |
//! | how near does it come, when and where? | [`clearance_of_motion`](BvhSearch::clearance_of_motion) |
//!
//! **A proof for others**
//!
//! | question | call |
//! |---|---|
//! | a proof that a margin is kept, which a short program checks without this library | [`prove`](BvhSearch::prove), [`prove_tube`](BvhSearch::prove_tube), [`prove_motion`](BvhSearch::prove_motion) |
//!
//! **Inside or outside**
//!
//! | question | call |
//! |---|---|
//! | on which side of the mesh is a point? | [`side`](BvhSearch::side) |
//! | is the robot inside, and does it keep a margin? | [`clears_inside`](BvhSearch::clears_inside) |
//!
//! **Two robots, or one and itself**
//!
//! | question | call |
//! |---|---|
//! | which links of two robots are closest, how far apart, and where? | [`between`], [`RobotPair::minimum`] |
//! | do two robots keep a margin? | [`clears_between`], [`RobotPair::clears`] |
//! | of each link, the closest of the other robot | [`RobotPair::per_link`] |
//! | every place where two robots are near | [`RobotPair::within`] |
//! | the clearance of two tubes, between two bounds | [`RobotPair::clearance`] |
//! | do two tubes keep a margin? | [`RobotPair::tubes_clear`] |
//! | a proof of the distance of its two links | [`RobotProximity::certify`] |
//! | where does a robot come closest to itself? | [`self_minimum`], [`RobotPair::self_minimum`] |
//! | does it keep a margin to itself? | [`self_clears`], [`RobotPair::self_clears`] |
//! | does a robot keep a margin to itself while it moves? | [`motion_self_clears`], [`RobotPair::motion_self_clears`] |
//! | does a tube keep a margin to itself? | [`tube_self_clears`], [`RobotPair::tube_self_clears`] |
//!
//! **Several structures and robots**
//!
//! | question | call |
//! |---|---|
//! | do all robots keep all margins? | [`Scene::clears`] |
//! | where is the least room, and to which structure? | [`Scene::tightest`] |
//! | how near is each structure? | [`Scene::per_structure`] |
//! | every contact, with its structure | [`Scene::contacts`] |
//!
//! **Many at once, and a mesh that moves**
//!
//! | to do | call |
//! |---|---|
//! | ask about many robots on all cores | [`per_link_batch`](Proximity::per_link_batch), [`minimum_batch`](Proximity::minimum_batch), [`clears_batch`](Proximity::clears_batch) |
//! | about many tubes or motions | [`clearance_batch`](BvhSearch::clearance_batch), [`tube_clears_batch`](BvhSearch::tube_clears_batch), [`clears_motion_batch`](BvhSearch::clears_motion_batch) |
//! | about many sets of robots in a scene | [`Scene::clears_batch`], [`Scene::tightest_batch`] |
//! | build beforehand what a first question would build | [`prepare`](BvhSearch::prepare) |
//! | move the mesh | [`set_vertices`](Proximity::set_vertices) |
//! | see the mesh as the engine has it now | [`vertices`](Proximity::vertices), [`triangles`](Proximity::triangles) |
//! | start without what the last queries left | [`forget`](BvhSearch::forget) |
//!
//! Every answer that names a place has a [`Witness`] and reads as one: `answer.on_mesh`,
//! `answer.arc_length`. A margin is kept by what is farther away than it. Yes or no about links is
//! a `bool`, because it is exact; about tubes and motions it is a [`Decision`], which may be
//! `Undecided`. An error says what to change, and its `kind()` is one word for programs.
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
//! println!("{} mm, {} mm along the robot, triangle {}", closest.distance, closest.arc_length, closest.triangle);
//! # assert!(closest.arc_length == 6.0 && 3.9 < closest.distance && closest.distance < 4.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The book has more on [the queries](crate::book::queries), [several robots](crate::book::robots),
//! [threads](crate::book::threads) and [controllers](crate::book::control).

#[cfg(feature = "gpu")]
pub use crate::answer::DeviceFailure;
pub use crate::answer::{
    Between, Certificate, Clearance, Contact, ContactFeature, Decision, Derivative, InsideAnswer,
    LinkFeature, LinkProximity, MeshError, MotionAnswer, MotionClearance, PlacementFault, Proof,
    ProximityError, RobotClearance, RobotMotionAnswer, RobotProximity, RobotsInContact,
    SceneContact, SceneError, ShapeInContact, Side, StructureProximity, Tightest, TriangleFeature,
    TubePiece, UndecidedReason, Witness, Work,
};
pub use crate::engine::{
    BvhSearch, Exhaustive, Proximity, RobotPair, SearchPrecision, between, clears_between,
    motion_self_clears, self_clears, self_minimum, tube_self_clears,
};
pub use crate::scene::Scene;
