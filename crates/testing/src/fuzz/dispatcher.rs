//! The dispatcher between a robot and every kind of parry's shapes: an answer or an error, never a
//! panic and never a NaN, for every pose, margin and option. Aligned pairs that touch are tested
//! further.

use super::source::Source;
use crate::Random;
use crate::placements::{Placement, Wall};
use parry_continuum::parry::math::{IVector, Pose, Rot3, Vector};
use parry_continuum::parry::query::{
    ContactManifold, NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher,
    ShapeCastOptions,
};
use parry_continuum::parry::shape::{
    Ball, Capsule, Compound, Cone, ConvexPolyhedron, Cuboid, Cylinder, HalfSpace, HeightField,
    Polyline, RoundCone, RoundCuboid, RoundCylinder, RoundTriangle, Segment, Shape, SharedShape,
    TriMesh, Triangle, Voxels,
};
use parry_continuum::parry::utils::Array2;
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};

/// The largest coordinate for which parry builds hierarchies over parts, and hulls.
const LARGEST: f64 = 1e150;
/// The kinds of [`other`].
const KINDS: u8 = 21;

pub fn dispatcher(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let source = &mut source;
    let _ = any_pair(source);
    if source.flag() {
        aligned_pair(source);
    }
}

/// Runs numbers of any kind, unless they make no robot or no other shape.
fn any_pair(source: &mut Source) -> Option<()> {
    let robot = robot(source)?;
    let kind = source.below(KINDS);
    let other = other(source, kind)?;
    let pose = pose(source);
    let margin = source.number();
    for (pos12, g1, g2) in [(pose, &*robot, &*other), (pose.inverse(), &*other, &*robot)] {
        ask(source, &pos12, g1, g2, margin);
    }
    Some(())
}

/// Runs a robot that is aligned with a wall and touches it: there the queries must agree.
fn aligned_pair(source: &mut Source) {
    let wall = Wall::ALL[source.below(Wall::ALL.len() as u8)];
    let seed = (0..8).fold(0, |seed, _| seed << 8 | u64::from(source.byte()));
    let Placement { robot, wall, pose, .. } = Random::new(seed).placement(wall);
    let margin = source.number();
    let dispatcher = ContinuumDispatcher::default();
    for (pos12, g1, g2) in [(pose, &*robot, &*wall), (pose.inverse(), &*wall, &*robot)] {
        let problem =
            || format!("{:?} {:?} {pos12:?} {margin}", g1.as_typed_shape(), g2.as_typed_shape());
        ask(source, &pos12, g1, g2, margin);
        let Ok(all) = dispatcher.contact(&pos12, g1, g2, f64::MAX) else { continue };
        assert!(all.is_some(), "no contact: {}", problem());
        if let Ok(Some(contact)) = dispatcher.contact(&pos12, g1, g2, margin) {
            assert!(contact.dist <= margin, "beyond: {}", problem());
        }
    }
}

fn robot(source: &mut Source) -> Option<SharedShape> {
    let points: Vec<_> = (0..2 + source.below(3)).map(|_| source.point()).collect();
    let radius = source.number().abs();
    let caps = [source.flag(), source.flag()].map(|flat| if flat { Cap::Flat } else { Cap::Round });
    if points.len() == 2 {
        return ModifiedCylinder::new(points[0], points[1], radius, caps)
            .ok()
            .map(SharedShape::new);
    }
    Chain::from_centreline(&points, &vec![radius; points.len() - 1]).ok().map(SharedShape::new)
}

/// Returns a pose that may be invalid: the parts of its rotation are arbitrary.
fn pose(source: &mut Source) -> Pose {
    match source.below(8) {
        0..4 => Pose::from_translation(source.point()),
        4..7 => source.pose(),
        _ => {
            let [x, y, z, w] = [source.number(), source.number(), source.number(), source.number()];
            Pose::from_parts(source.point(), Rot3::from_xyzw(x, y, z, w))
        }
    }
}

/// Returns a shape of this kind, if parry can build it from such numbers.
fn other(source: &mut Source, kind: usize) -> Option<SharedShape> {
    // parry cannot compute a box around a shape whose size is NaN.
    let size = |source: &mut Source| source.number().abs().max(0.0);
    let finite = |points: &[Vector]| {
        points
            .iter()
            .all(|point| point.is_finite() && point.abs().max_element() <= LARGEST)
            .then_some(())
    };
    let triangle =
        |source: &mut Source| Triangle::new(source.point(), source.point(), source.point());
    Some(match kind {
        0 => SharedShape::new(Ball::new(size(source))),
        1 => SharedShape::new(Cuboid::new(source.point().abs())),
        2 => SharedShape::new(Capsule::new(source.point(), source.point(), size(source))),
        3 => SharedShape::new(Cylinder::new(size(source), size(source))),
        4 => SharedShape::new(Cone::new(size(source), size(source))),
        5 => SharedShape::new(Segment::new(source.point(), source.point())),
        6 => SharedShape::new(triangle(source)),
        7 => SharedShape::new(HalfSpace { normal: source.point() }),
        8 => SharedShape::new(RoundCuboid {
            inner_shape: Cuboid::new(source.point().abs()),
            border_radius: size(source),
        }),
        9 => SharedShape::new(RoundCylinder {
            inner_shape: Cylinder::new(size(source), size(source)),
            border_radius: size(source),
        }),
        10 => SharedShape::new(RoundCone {
            inner_shape: Cone::new(size(source), size(source)),
            border_radius: size(source),
        }),
        11 => SharedShape::new(RoundTriangle {
            inner_shape: triangle(source),
            border_radius: size(source),
        }),
        12 => {
            // The vertices of a box, moved: parry's hulls panic on points that span no volume.
            let half = source.point().abs().max(Vector::splat(1e-3)).min(Vector::splat(1e3));
            finite(&[half])?;
            let corner = |k: u32| half * Vector::new(sign(k), sign(k >> 1), sign(k >> 2));
            let corners: Vec<_> = (0..8).map(corner).collect();
            SharedShape::new(ConvexPolyhedron::from_convex_hull(&corners)?)
        }
        13 => {
            let vertices: Vec<_> = (0..3 + source.below(5)).map(|_| source.point()).collect();
            finite(&vertices)?;
            let count = vertices.len() as u8;
            let mut corner = || source.below(count) as u32;
            let triangles = (0..4).map(|_| [corner(), corner(), corner()]).collect();
            SharedShape::new(TriMesh::new(vertices, triangles).ok()?)
        }
        14 => {
            let vertices: Vec<_> = (0..2 + source.below(5)).map(|_| source.point()).collect();
            finite(&vertices)?;
            SharedShape::new(Polyline::new(vertices, None))
        }
        15 => {
            let heights: Vec<_> = (0..9).map(|_| source.number()).collect();
            let scale = source.point().abs();
            finite(&[scale])?;
            finite(&heights.iter().map(|&height| Vector::splat(height)).collect::<Vec<_>>())?;
            SharedShape::new(HeightField::new(Array2::new(3, 3, heights), scale))
        }
        16 => {
            let size = source.point().abs().max(Vector::splat(1e-3)).min(Vector::splat(1e3));
            finite(&[size])?;
            let cells: Vec<_> = (0..1 + source.below(4))
                .map(|_| {
                    IVector::new(
                        source.below(4) as i64,
                        source.below(4) as i64,
                        source.below(4) as i64,
                    )
                })
                .collect();
            SharedShape::new(Voxels::new(size, &cells))
        }
        17 | 18 => {
            let inner = source.below(13);
            let parts: Vec<_> = (0..1 + source.below(3))
                .filter_map(|_| {
                    let place = source.point();
                    finite(&[place])?;
                    Some((
                        Pose::from_translation(place),
                        other(source, inner).filter(|part| part.as_halfspace().is_none())?,
                    ))
                })
                .collect();
            let boxes: Vec<_> = parts
                .iter()
                .map(|(place, part)| part.compute_aabb(place))
                .flat_map(|b| [b.mins, b.maxs])
                .collect();
            finite(&boxes)?;
            if parts.is_empty() {
                return None;
            }
            SharedShape::new(Compound::new(parts))
        }
        _ => robot(source)?,
    })
}

fn sign(bit: u32) -> f64 {
    if bit & 1 == 0 { -1.0 } else { 1.0 }
}

/// Runs every query, and asserts that no answer is NaN.
fn ask(source: &mut Source, pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, margin: f64) {
    let dispatcher = ContinuumDispatcher::default();
    let problem =
        || format!("{:?} {:?} {pos12:?} {margin}", g1.as_typed_shape(), g2.as_typed_shape());
    let apart = dispatcher.distance(pos12, g1, g2);
    if let Ok(apart) = &apart {
        assert!(apart.distance >= 0.0, "{apart:?}");
    }
    let _ = dispatcher.intersection_test(pos12, g1, g2);
    if let Ok(Some(contact)) = dispatcher.contact(pos12, g1, g2, margin) {
        assert!(!contact.dist.is_nan(), "{}", problem());
    }
    let _ = dispatcher.closest_points(pos12, g1, g2, margin);
    let options = ShapeCastOptions {
        max_time_of_impact: source.number(),
        target_distance: source.number(),
        stop_at_penetration: source.flag(),
        compute_impact_geometry_on_penetration: source.flag(),
    };
    if let Ok(Some(hit)) = dispatcher.cast_shapes(pos12, source.point(), g1, g2, options) {
        assert!(!hit.time_of_impact.is_nan(), "{}", problem());
    }
    let still = NonlinearRigidMotion::constant_position(Pose::IDENTITY);
    let moving = NonlinearRigidMotion::new(*pos12, source.point(), source.point(), source.point());
    let times = (source.number(), source.number());
    let stop = source.flag();
    if let Ok(Some(hit)) =
        dispatcher.cast_shapes_nonlinear(&still, g1, &moving, g2, times.0, times.1, stop)
    {
        assert!(!hit.time_of_impact.is_nan(), "{}", problem());
    }
    let (mut manifolds, mut workspace): (Vec<ContactManifold<(), ()>>, _) = (vec![], None);
    // The second time parry continues from its earlier result.
    for _ in 0..2 {
        let _ = dispatcher.contact_manifolds(pos12, g1, g2, margin, &mut manifolds, &mut workspace);
    }
}
