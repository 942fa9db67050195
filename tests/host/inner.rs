//! The queries that reach the inner dispatcher, and its errors.

use crate::composites::composites;
use crate::scene::{floor_field, floor_mesh, tube};
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{
    ClosestPoints, Contact, DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher,
    ShapeCastHit, ShapeCastOptions, ShapeDistance, ShapeIntersection, Unsupported,
};
use parry_continuum::parry::shape::{Compound, Cuboid, Shape, SharedShape, Triangle};
use parry_continuum::{ContinuumDispatcher, ModifiedCylinder};
use std::sync::Mutex;

/// Passes on to parry and keeps a record of the pairs.
#[derive(Default)]
struct Recorder(Mutex<Vec<String>>);

impl Recorder {
    fn note(&self, query: &str, g1: &dyn Shape, g2: &dyn Shape) {
        let name = |shape: &dyn Shape| {
            let composite =
                shape.as_composite_shape().is_some() || shape.as_heightfield().is_some();
            let link = if shape.as_shape::<ModifiedCylinder>().is_some() { "Link" } else { "" };
            format!("{link}{:?}{}", shape.shape_type(), if composite { " composite" } else { "" })
        };
        self.0.lock().unwrap().push(format!("{query}: {} and {}", name(g1), name(g2)));
    }
}

macro_rules! recorded {
    ($name:ident($($arg:ident: $type:ty),*) -> $answer:ty, $g1:ident, $g2:ident) => {
        fn $name(&self, $($arg: $type),*) -> Result<$answer, Unsupported> {
            self.note(stringify!($name), $g1, $g2);
            DefaultQueryDispatcher.$name($($arg),*)
        }
    };
}

impl QueryDispatcher for Recorder {
    recorded!(intersection_test(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> ShapeIntersection, g1, g2);
    recorded!(distance(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> ShapeDistance, g1, g2);
    recorded!(contact(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, prediction: Real) -> Option<Contact>, g1, g2);
    recorded!(closest_points(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, max: Real) -> ClosestPoints, g1, g2);
    recorded!(cast_shapes(pos12: &Pose, vel12: Vector, g1: &dyn Shape, g2: &dyn Shape, options: ShapeCastOptions)
        -> Option<ShapeCastHit>, g1, g2);
    recorded!(cast_shapes_nonlinear(motion1: &NonlinearRigidMotion, g1: &dyn Shape, motion2: &NonlinearRigidMotion,
        g2: &dyn Shape, start: Real, end: Real, stop: bool) -> Option<ShapeCastHit>, g1, g2);
}

/// Asks everything of a pair; true for each query that is answered.
pub fn ask_everything(
    dispatcher: &impl QueryDispatcher,
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
) -> [bool; 6] {
    let options = ShapeCastOptions::with_max_time_of_impact(1.0);
    let motion1 = NonlinearRigidMotion::constant_position(Pose::IDENTITY);
    let motion2 = NonlinearRigidMotion::new(*pos12, Vector::ZERO, Vector::X, Vector::ZERO);
    [
        dispatcher.intersection_test(pos12, g1, g2).is_ok(),
        dispatcher.distance(pos12, g1, g2).is_ok(),
        dispatcher.contact(pos12, g1, g2, 9.0).is_ok(),
        dispatcher.closest_points(pos12, g1, g2, 9.0).is_ok(),
        dispatcher.cast_shapes(pos12, -Vector::X, g1, g2, options).is_ok(),
        dispatcher.cast_shapes_nonlinear(&motion1, g1, &motion2, g2, 0.0, 1.0, true).is_ok(),
    ]
}

#[test]
fn the_inner_dispatcher_is_asked_only_for_simple_pairs_of_others() {
    let dispatcher = ContinuumDispatcher(Recorder::default());
    let mut random = Random::new(45);
    for (name, robot, other, pos12) in composites(&mut random) {
        assert_eq!(ask_everything(&dispatcher, &pos12, &*robot, &*other), [true; 6], "{name}");
        assert_eq!(
            ask_everything(&dispatcher, &pos12.inverse(), &*other, &*robot),
            [true; 6],
            "{name}"
        );
    }
    let record = dispatcher.0.0.into_inner().unwrap();
    let asked = |what: &str| record.iter().any(|line| line.contains(what));
    assert!(!asked("composite"), "{record:?}");
    assert!(!asked("LinkCustom and Triangle") && !asked("Triangle and LinkCustom"), "{record:?}");
    assert!(
        asked("Cuboid")
            && !asked("Ball")
            && !asked("Segment")
            && !asked("distance: LinkCustom and LinkCustom"),
        "{record:?}"
    );
}

/// Knows nothing.
struct Ignorant;

macro_rules! refused {
    ($($name:ident($($type:ty),*) -> $answer:ty;)*) => {
        $(fn $name(&self, $(_: $type),*) -> Result<$answer, Unsupported> {
            Err(Unsupported)
        })*
    };
}

impl QueryDispatcher for Ignorant {
    refused! {
        intersection_test(&Pose, &dyn Shape, &dyn Shape) -> ShapeIntersection;
        distance(&Pose, &dyn Shape, &dyn Shape) -> ShapeDistance;
        contact(&Pose, &dyn Shape, &dyn Shape, Real) -> Option<Contact>;
        closest_points(&Pose, &dyn Shape, &dyn Shape, Real) -> ClosestPoints;
        cast_shapes(&Pose, Vector, &dyn Shape, &dyn Shape, ShapeCastOptions) -> Option<ShapeCastHit>;
        cast_shapes_nonlinear(&NonlinearRigidMotion, &dyn Shape, &NonlinearRigidMotion, &dyn Shape, Real, Real, bool)
            -> Option<ShapeCastHit>;
    }
}

/// parry would say that these pairs are infinitely far apart.
#[test]
fn a_pair_that_is_refused_makes_the_whole_query_refused() {
    let mut random = Random::new(46);
    let dispatcher = ContinuumDispatcher(Ignorant);
    // An untouched box of an unsupported kind, among supported triangles.
    let cuboid = SharedShape::new(Cuboid::new(Vector::splat(0.5)));
    let triangle = SharedShape::new(Triangle::new(Vector::X, Vector::Y, Vector::Z));
    let mixed = Compound::new(vec![(Pose::IDENTITY, triangle), (Pose::IDENTITY, cuboid)]);
    for robot in
        [SharedShape::new(tube(&mut random)), SharedShape::new(tube(&mut random).links()[0])]
    {
        // Inside the box from the start.
        let place = Pose::from_translation(Vector::new(0.0, 0.1, 0.0));
        assert_eq!(ask_everything(&dispatcher, &place, &mixed, &*robot)[1..], [false; 5]);
        assert_eq!(ask_everything(&dispatcher, &place, &*robot, &mixed)[1..], [false; 5]);
        // With nothing but triangles all is well. (To leave out parts of a mesh in a nonlinear
        // cast, parry asks about balls.)
        assert_eq!(ask_everything(&dispatcher, &place, &floor_mesh(), &*robot)[..5], [true; 5]);
        assert_eq!(ask_everything(&dispatcher, &place, &floor_field(), &*robot)[..5], [true; 5]);
    }
    // Found before anything was refused: they do meet.
    let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::X, 0.5).unwrap();
    assert!(
        dispatcher.intersection_test(&Pose::IDENTITY, &floor_mesh(), &link).unwrap().intersecting
    );
}
