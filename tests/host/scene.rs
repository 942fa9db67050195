//! Robots and surroundings for the dispatcher's tests, and the parts that composites fall into.

use crate::draw::Draw;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{
    Ball, Compound, Cuboid, HeightField, Polyline, Segment, Shape, SharedShape, TriMesh, Triangle,
};
use parry_continuum::parry::utils::Array2;
use parry_continuum::{Chain, ModifiedCylinder};

/// A tube of five links with a step in its radius.
pub fn tube(random: &mut Random) -> Chain {
    let mut points = vec![random.vector(0.3)];
    let mut heading = random.direction();
    for _ in 0..5 {
        heading = (heading + random.vector(0.4)).normalize();
        points.push(points[points.len() - 1] + heading * random.between(0.1, 0.4));
    }
    let radius = random.between(0.02, 0.1);
    Chain::from_centreline(&points, &[radius, radius, radius, 0.6 * radius, 0.6 * radius]).unwrap()
}

/// A height of a bumpy floor.
fn bump(x: Real, z: Real) -> Real {
    0.2 * (3.0 * x).sin() * (2.5 * z).cos()
}

/// A bumpy floor as a mesh of 2 x 12 x 12 triangles over the square from -1 to 1.
pub fn floor_mesh() -> TriMesh {
    let place = |i: usize| i as Real / 6.0 - 1.0;
    let vertex = |i: usize, j: usize| Vector::new(place(i), bump(place(i), place(j)), place(j));
    let vertices = (0..13 * 13).map(|k| vertex(k / 13, k % 13)).collect();
    let cell = |k: u32| {
        let a = 13 * (k / 12) + k % 12;
        [[a, a + 1, a + 13], [a + 1, a + 14, a + 13]]
    };
    TriMesh::new(vertices, (0..144).flat_map(cell).collect()).unwrap()
}

/// A bumpy floor as a height field over the same square.
pub fn floor_field() -> HeightField {
    let place = |i: usize| i as Real / 4.0 - 1.0;
    let heights = (0..81).map(|k| bump(place(k / 9), place(k % 9))).collect();
    HeightField::new(Array2::new(9, 9, heights), Vector::new(2.0, 1.0, 2.0))
}

/// Shapes of several kinds, a link among them.
pub fn heap(random: &mut Random) -> Compound {
    let shapes: Vec<SharedShape> = vec![
        SharedShape::new(Triangle::new(random.vector(0.5), random.vector(0.5), random.vector(0.5))),
        SharedShape::new(Cuboid::new(Vector::new(0.1, 0.2, 0.3))),
        SharedShape::new(Ball::new(0.2)),
        SharedShape::new(ModifiedCylinder::cylinder(Vector::ZERO, 0.4 * Vector::X, 0.1).unwrap()),
    ];
    Compound::new(shapes.into_iter().map(|shape| (random.pose(0.7), shape)).collect())
}

pub fn zigzag(random: &mut Random) -> Polyline {
    Polyline::new((0..6).map(|_| random.vector(0.8)).collect(), None)
}

/// What a shape consists of: ids, places and shapes. A shape that consists of nothing else is its
/// own part 0.
pub fn parts(shape: &dyn Shape) -> Vec<(u32, Pose, SharedShape)> {
    if let Some(chain) = shape.as_shape::<Chain>() {
        numbered(chain.links().iter().map(|link| SharedShape::new(*link)))
    } else if let Some(mesh) = shape.as_trimesh() {
        numbered(mesh.triangles().map(SharedShape::new))
    } else if let Some(line) = shape.as_polyline() {
        numbered(line.segments().map(|s| SharedShape::new(Segment::new(s.a, s.b))))
    } else if let Some(compound) = shape.as_compound() {
        (0..).zip(compound.shapes()).map(|(id, (pose, shape))| (id, *pose, shape.clone())).collect()
    } else if let Some(field) = shape.as_heightfield() {
        let (rows, columns) = field.num_cells_ij();
        let ids = 0..2 * (rows * columns) as u32;
        let element = |id| Some((id, Pose::IDENTITY, SharedShape::new(field.triangle_at_id(id)?)));
        ids.filter_map(element).collect()
    } else {
        vec![(0, Pose::IDENTITY, SharedShape(shape.clone_dyn().into()))]
    }
}

fn numbered(shapes: impl Iterator<Item = SharedShape>) -> Vec<(u32, Pose, SharedShape)> {
    (0..).zip(shapes).map(|(id, shape)| (id, Pose::IDENTITY, shape)).collect()
}
