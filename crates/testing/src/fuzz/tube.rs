//! A tube and a mesh: bounds that hold, and no panic.

use super::source::Source;
use crate::Arcs;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Decision, Proximity};
use parry_continuum::{Chain, Tube, TubeSection};
use std::sync::Arc;

/// Asserts that any points give a tube or an error; that the bounds of a chain's tube contain the
/// chain's distance; and that the bounds of a curve of known curvature contain the distance of a
/// finely divided chain.
pub fn tube(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let vertices: Vec<_> = (0..3 + source.below(6)).map(|_| source.point()).collect();
    let count = vertices.len() as u8;
    let indices =
        (0..1 + usize::from(count)).map(|_| [0; 3].map(|_| source.below(count) as u32)).collect();
    if !vertices.iter().all(|vertex| vertex.abs().max_element() <= 1e150 && vertex.is_finite()) {
        return;
    }
    let Ok(mesh) = TriMesh::new(vertices, indices) else { return };
    let mut search = BvhSearch::new(&mesh).expect("a valid mesh");
    if source.flag() { anything(&mut source, &mut search) } else { arcs(&mut source, &mut search) }
}

/// Runs points, radii and tangents of any kind.
fn anything(source: &mut Source, search: &mut BvhSearch) {
    let pose = source.pose();
    let points: Vec<_> = (0..2 + source.below(8)).map(|_| source.point()).collect();
    let mut radius = source.number().abs();
    let mut next = || {
        if source.below(3) == 0 {
            radius = source.number().abs();
        }
        radius
    };
    let radii: Vec<_> = points[1..].iter().map(|_| next()).collect();
    let tangents = source.flag().then(|| [source.point(), source.point()]);
    let (margin, tolerance) = (source.number().abs(), source.number().abs());
    if let Ok(tube) = Tube::from_samples(&points, &radii, tangents) {
        ask(search, &tube, &pose, margin, tolerance);
    }
    let Ok(chain) = Chain::from_centreline(&points, &radii) else { return };
    let tube = Tube::from(&chain);
    ask(search, &tube, &pose, margin, tolerance);
    // If a pose moves a chain far, rounding turns the axes of its short links. The tube keeps its
    // faces.
    let pose = Pose::IDENTITY;
    let (Ok(truth), Ok(found)) =
        (search.minimum(&chain, &pose), search.clearance(&tube, &pose, tolerance))
    else {
        return;
    };
    assert!(
        found.lower <= truth.distance && truth.distance <= found.upper,
        "{truth:?} {found:?} {chain:?}"
    );
}

/// Asserts that the answers agree with one another.
fn ask(search: &mut BvhSearch, tube: &Tube, pose: &Pose, margin: f64, tolerance: f64) {
    // A tolerance far finer than the scene takes too long.
    let tolerance = tolerance.max(1e-3 * tube.length());
    let Ok(found) = search.clearance(tube, pose, tolerance) else { return };
    assert!(
        0.0 <= found.lower && found.lower <= found.upper && found.upper.is_finite(),
        "{found:?}"
    );
    match search.clears_tube(tube, pose, margin, tolerance) {
        Ok(Decision::Clear) => assert!(found.upper > margin, "{found:?} {margin} {tube:?}"),
        Ok(Decision::Contact) => assert!(found.lower <= margin, "{found:?} {margin} {tube:?}"),
        _ => {}
    }
}

/// Runs arcs whose sizes differ by at most a few thousand, so that a fine chain has few links.
fn arcs(source: &mut Source, search: &mut BvhSearch) {
    let mut size = |largest: f64| (source.number().abs() % largest).max(largest * 1e-3);
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    for _ in 0..1 + (size(300.0) as usize) % 3 {
        let radius = size(1.0);
        let parts: Vec<_> = (0..1 + (size(300.0) as usize) % 2)
            .map(|_| {
                let angle = size(7.0);
                (size(4.0), Vector::new(angle.cos(), angle.sin(), 0.0) * (size(0.95) / radius))
            })
            .collect();
        arcs.push(radius, &parts);
    }
    let sharpest = arcs.stretches.iter().fold(0.1, |most: f64, part| most.max(part.curvature));
    let spacing = (8e-5 / sharpest).sqrt();
    // Outside of a bend the flat ends of two cylinders leave a wedge between them, up to twice this
    // wide. Inside of it their rims protrude by as much, even beyond the face of a section if its
    // end is near.
    let half_wedge =
        arcs.stretches.iter().fold(0.0, |most: f64, part| most.max(part.radius * part.curvature))
            * 0.5
            * spacing;
    let at_ends: Vec<_> = (1..12).map(|k| spacing * 0.5_f64.powi(k)).collect();
    let (points, radii) = arcs.samples(spacing, &at_ends);
    let fine = Chain::cylinders(&points, &radii).expect("a centreline");
    let sections: Vec<_> = arcs
        .stretches
        .iter()
        .map(|part| TubeSection {
            length: part.length,
            radius: part.radius,
            curvature: part.curvature,
        })
        .collect();
    let arcs = Arc::new(arcs);
    let Ok(tube) = Tube::from_function(&sections, move |s| arcs.at(s)) else { return };
    tube.verify(20).expect("a curve of known curvature");
    let truth = search.minimum(&fine, &Pose::IDENTITY).expect("an answer").distance;
    let off = 1e-3;
    let found = search.clearance(&tube, &Pose::IDENTITY, 0.01).expect("bounds");
    assert!(
        found.lower <= truth + off + half_wedge && truth <= found.upper + off + half_wedge,
        "{truth} {found:?} {sections:?}"
    );
    for margin in [truth - 2.0 * off, truth + 2.0 * off].into_iter().filter(|margin| *margin >= 0.0)
    {
        match search.clears_tube(&tube, &Pose::IDENTITY, margin, 1e-4) {
            Ok(Decision::Clear) => {
                assert!(truth + half_wedge > margin, "{truth} {margin} {sections:?}")
            }
            Ok(Decision::Contact) => {
                assert!(truth < margin + half_wedge, "{truth} {margin} {sections:?}")
            }
            _ => {}
        }
    }
}
