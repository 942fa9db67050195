//! The robots and the meshes that all chapters ask: 30 links in the ventricle.

use crate::text;
use continuum_scene::subdivide::{in_four, shuffled};
use continuum_scene::{ctr, ventricle};
use parry_continuum::Chain;
use parry_continuum::parry::shape::TriMesh;

pub const LINKS: usize = 30;

/// As capsules, with caps that fit (Algorithm 1, the paper's Z*), and as cylinders (K and Z).
pub fn models() -> Result<[Chain; 3], String> {
    let line = ctr::three_tubes().centreline(&ventricle::goal(), LINKS);
    let (points, radii) = (&line.points, &line.radii);
    Ok([
        Chain::capsules(points, radii).map_err(text)?,
        Chain::from_centreline(points, radii).map_err(text)?,
        Chain::cylinders(points, radii).map_err(text)?,
    ])
}

/// The meshes, 1e4 triangles and more, and the largest: the ventricle divided in four until it has enough, shuffled,
/// and of that the first so many.
pub fn meshes(largest: u32) -> Result<Vec<TriMesh>, String> {
    let mut sizes: Vec<_> =
        [10_000, 100_000, 1_000_000, 10_000_000].into_iter().filter(|&size| size < largest).collect();
    sizes.push(largest);
    sizes.into_iter().map(mesh).collect()
}

fn mesh(triangles: u32) -> Result<TriMesh, String> {
    let mut divided = ventricle::mesh(ventricle::DEFAULT_TRIANGLES);
    while divided.1.len() < triangles as usize {
        divided = in_four(divided);
    }
    let (vertices, mut indices) = shuffled(divided, 1);
    indices.truncate(triangles as usize);
    TriMesh::new(vertices, indices).map_err(text)
}
