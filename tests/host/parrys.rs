//! The pairs that stay parry's, and by how much their distance is off in millimetres and in metres:
//! the table of docs/RAPIER.md, as `cargo test --test host parrys -- --ignored --nocapture` prints
//! it.
//!
//! What is right is known without parry's iterations: by this crate's narrow phase for links and
//! for triangles of a hull, less the border of what is rounded, and by projections to and fro for a
//! cone and a disc, whose point queries are closed forms.

use crate::draw::Draw;
use crate::pairs::projected;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::query::{DefaultQueryDispatcher, QueryDispatcher};
use parry_continuum::parry::shape::{
    ConvexPolyhedron, Cuboid, Cylinder, Shape, SharedShape, TriMesh,
};
use parry_continuum::{ContinuumDispatcher, ModifiedCylinder};

const KINDS: [&str; 7] = [
    "`Cuboid`",
    "`ConvexPolyhedron`",
    "`RoundCuboid`",
    "`RoundCylinder`",
    "`Cone`",
    "`Cylinder` without height",
    "parry's `Cylinder` beside parry's `Cylinder`",
];

/// A shape of a robot's sizes, in a unit that fits this many times into a millimetre.
fn shape(kind: usize, [a, b, c]: [Real; 3], hull: &[Vector], unit: Real) -> SharedShape {
    let [a, b, c] = [a * unit, b * unit, c * unit];
    match kind {
        0 => SharedShape::cuboid(a, b, c),
        1 => SharedShape::convex_hull(&hull.iter().map(|&point| point * a).collect::<Vec<_>>())
            .unwrap(),
        2 => SharedShape::round_cuboid(a, b, c, 0.25 * a),
        3 => SharedShape::round_cylinder(a, b, 0.25 * a),
        4 => SharedShape::cone(a, b),
        5 => SharedShape::cylinder(0.0, b),
        _ => SharedShape::cylinder(a, b),
    }
}

/// How far a link and a shape are apart.
fn reference(link: &ModifiedCylinder, shape: &dyn Shape, pose: &Pose) -> Real {
    let exact = |wall: &dyn Shape| {
        ContinuumDispatcher::default().distance(pose, link, wall).unwrap().distance
    };
    let of_triangles = |(vertices, triangles): (Vec<Vector>, Vec<[u32; 3]>)| {
        exact(&TriMesh::new(vertices, triangles).unwrap())
    };
    if let Some(cuboid) = shape.as_shape::<Cuboid>() {
        return of_triangles(cuboid.to_trimesh());
    }
    if let Some(hull) = shape.as_shape::<ConvexPolyhedron>() {
        return of_triangles(hull.to_trimesh());
    }
    if let Some(round) = shape.as_round_cuboid() {
        return (of_triangles(round.inner_shape.to_trimesh()) - round.border_radius).max(0.0);
    }
    if let Some(round) = shape.as_round_cylinder() {
        return (exact(&round.inner_shape) - round.border_radius).max(0.0);
    }
    if shape.as_shape::<Cylinder>().is_some_and(|cylinder| cylinder.half_height > 0.0) {
        return exact(shape);
    }
    projected(link, shape, pose)
}

/// How much too far apart the two are said to be, as shares of the link's radius: one in a hundred
/// is worse than the first, none worse than the second. Negative ones count by their size.
fn off(kind: usize, unit: Real) -> [Real; 2] {
    let mut random = Random::new(471);
    let mut off = vec![];
    while off.len() < 1500 {
        let radius = random.between(0.5, 2.0) * unit;
        let half = random.between(2.5, 10.0) * unit;
        let [a, b, c] = [0; 3].map(|_| random.between(1.0, 10.0));
        let hull: Vec<_> = (0..12).map(|_| random.direction()).collect();
        let caps = random.caps();
        // Every third time aligned, as scenes are.
        let pose = match off.len() % 3 {
            0 => {
                let turn = [Vector::ZERO, Vector::X, Vector::Z][random.index(3)]
                    * std::f64::consts::FRAC_PI_2;
                let place = Vector::AXES[random.index(3)] * random.between(10.0, 25.0);
                Pose::from_parts(place * unit, Rot3::from_scaled_axis(turn))
            }
            _ => {
                Pose::new(random.vector(25.0) * unit, random.direction() * random.between(0.0, 3.0))
            }
        };
        let wall = shape(kind, [a, b, c], &hull, unit);
        let along = Vector::Y * half;
        let is_parrys = kind == 6;
        let link = if is_parrys {
            ModifiedCylinder::cylinder(-along, along, radius).unwrap()
        } else {
            ModifiedCylinder::new(-along, along, radius, caps).unwrap()
        };
        let right = reference(&link, &*wall, &pose);
        // Triangles have no inside.
        if right <= 1e-3 * radius || wall.contains_point(&pose, link.start()) {
            continue;
        }
        let said = if is_parrys {
            DefaultQueryDispatcher.distance(&pose, &Cylinder::new(half, radius), &*wall)
        } else {
            ContinuumDispatcher::default().distance(&pose, &link, &*wall)
        };
        off.push((said.unwrap().distance - right).abs() / radius);
    }
    off.sort_by(Real::total_cmp);
    [off[1484], off[1499]]
}

#[test]
#[ignore = "prints a table of the documentation"]
fn what_stays_parrys_is_off_by() {
    println!("| a link and | mm, 99 % | mm, worst | m, 99 % | m, worst |\n|---|---|---|---|---|");
    for (kind, name) in KINDS.into_iter().enumerate() {
        let [[usual, worst], [usual_in_metres, worst_in_metres]] =
            [1.0, 1e-3].map(|unit| off(kind, unit));
        println!(
            "| {name} | {usual:.0e} | {worst:.0e} | {usual_in_metres:.0e} | {worst_in_metres:.0e} |"
        );
    }
}
