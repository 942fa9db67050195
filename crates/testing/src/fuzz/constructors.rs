//! Any numbers as a robot: an error, or a valid robot.

use super::source::Source;
use parry_continuum::parry::math::Vector;
use parry_continuum::{Cap, Chain, ModifiedCylinder, simplify};

/// Asserts that no constructor panics, and that its result is finite and complete.
pub fn constructors(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let points: Vec<_> = (0..source.below(9)).map(|_| source.point()).collect();
    let mut radii: Vec<_> = points.iter().map(|_| source.number()).collect();
    if source.byte() > 4 {
        radii.iter_mut().for_each(|radius| *radius = radius.abs());
    }
    let segments = if source.byte() > 4 { points.len().saturating_sub(1) } else { points.len() };
    let segment_radii = &radii[..segments];
    for chain in [
        Chain::capsules(&points, segment_radii),
        Chain::cylinders(&points, segment_radii),
        Chain::from_centreline(&points, segment_radii),
        Chain::from_vertex_radii(&points, &radii),
    ] {
        match chain {
            Ok(chain) => check(&chain, &points),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
    let tolerance = source.number();
    if let Ok((kept, kept_radii)) = simplify(&points, segment_radii, tolerance) {
        assert_eq!(kept.len(), kept_radii.len() + 1);
        assert_eq!((kept.first(), kept.last()), (points.first(), points.last()));
        let mut rest = points.iter();
        assert!(
            kept.iter().all(|vertex| rest.any(|point| point == vertex)),
            "{kept:?} of {points:?}"
        );
    }
    if let [start, end, ..] = points[..] {
        let cap = |flat| if flat { Cap::Flat } else { Cap::Round };
        let caps = [cap(source.flag()), cap(source.flag())];
        if let Ok(link) = ModifiedCylinder::new(start, end, radii[0], caps) {
            let (vertices, triangles) = link.to_trimesh(3 + source.below(9) as u32);
            assert!(vertices.iter().all(|vertex| vertex.is_finite()), "{link:?}");
            assert!(triangles.iter().flatten().all(|&corner| (corner as usize) < vertices.len()));
        }
    }
}

fn check(chain: &Chain, points: &[Vector]) {
    let mut covered = 0;
    for (place, link) in chain.links().iter().enumerate() {
        assert!(link.start().is_finite() && link.end().is_finite() && link.radius() >= 0.0);
        assert!(link.start() != link.end() || link.caps() == [Cap::Round; 2]);
        let segments = chain.segments_of(place);
        assert!(
            segments.start >= covered
                && segments.end > segments.start
                && segments.end < points.len()
        );
        covered = segments.end;
    }
    assert!(!chain.links().is_empty());
    let bounds = chain.local_aabb();
    assert!(bounds.mins.is_finite() && bounds.maxs.is_finite());
}
