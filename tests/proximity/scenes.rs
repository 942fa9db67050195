//! Meshes and robots for the engines.

use continuum_testing::Random;
use parry_continuum::Chain;
use parry_continuum::parry::math::Vector;
use parry_continuum::parry::shape::TriMesh;

pub fn extent(mesh: &TriMesh, robot: &Chain) -> f64 {
    let (mesh, robot) = (mesh.local_aabb(), robot.local_aabb());
    (mesh.maxs.max(robot.maxs) - mesh.mins.min(robot.mins)).max_element()
}

pub fn mesh_of(triangles: &[[[f64; 3]; 3]]) -> TriMesh {
    let vertices = triangles.iter().flatten().map(|&vertex| Vector::from(vertex)).collect();
    let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriMesh::new(vertices, indices).unwrap()
}

/// A bumpy sphere with slivers, points, folded and duplicate triangles strewn in.
pub fn nasty_mesh(random: &mut Random, size: f64, offset: Vector) -> TriMesh {
    let mut triangles = Vec::new();
    for _ in 0..400 {
        let centre = random.direction() * size * random.between(0.5, 1.5);
        let mut corner = || centre + random.direction() * size * 0.2;
        let (a, b, c) = (corner(), corner(), corner());
        let kind = random.below(8);
        triangles.push(match kind {
            0 => [a, a, a],
            1 => [a, b, b],
            2 => [a, a.lerp(b, 0.3), b],
            3 => [a, a.lerp(b, 0.3) + (c - a) * 1e-9, b],
            4 => [a, b, a + (c - a) * 1e-12],
            _ => [a, b, c],
        });
        if kind == 5 {
            triangles.push([b, c, a]);
        }
    }
    mesh_of(&triangles.iter().map(|t| t.map(|v| (v + offset).to_array())).collect::<Vec<_>>())
}

pub fn random_robot(random: &mut Random, size: f64, offset: Vector, model: u32) -> Chain {
    let mut points = vec![offset + random.direction() * size * 0.2];
    let mut heading = random.direction();
    let mut radii = Vec::new();
    for segment in 0..12 {
        heading = (heading + random.direction() * 0.4).normalize();
        points.push(points[segment] + heading * size * random.between(0.01, 0.1));
        radii.push(size * [0.05, 0.03, 0.01][segment / 4]);
    }
    match model {
        0 => Chain::from_centreline(&points, &radii),
        1 => Chain::capsules(&points, &radii),
        _ => Chain::cylinders(&points, &radii),
    }
    .unwrap()
}

/// A robot whose middle is nearest to the mesh and whose ends are far away.
pub fn bent_towards(mesh: &TriMesh) -> Chain {
    let bounds = mesh.local_aabb();
    let size = bounds.extents().max_element();
    let near = Vector::new(bounds.center().x, bounds.maxs.y + 0.1 * size, bounds.center().z);
    let aside = |x| near + Vector::new(x, 5.0, 0.0) * size;
    Chain::capsules(&[aside(-5.0), near, aside(5.0)], &[0.01 * size; 2]).unwrap()
}
