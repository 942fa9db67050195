//! parry's queries about links side by side with level ends, which overlap deeply.

use continuum_testing::{Random, found_level_links};
use parry_continuum::ContinuumDispatcher;
use parry_continuum::parry::math::Pose;
use parry_continuum::parry::query::{
    ClosestPoints, ContactManifold, PersistentQueryDispatcher, QueryDispatcher, ShapeCastOptions,
};

/// How many pairs are drawn.
const ROUNDS: u32 = 600;

#[test]
fn every_query_says_how_deep_they_overlap() {
    let (mut random, dispatcher, here) =
        (Random::new(3), ContinuumDispatcher::default(), Pose::IDENTITY);
    let mut flat = 0;
    for pair in found_level_links().chain((0..ROUNDS).map(|_| random.level_links())) {
        let [a, b] = pair.links;
        let extent = [a.start(), a.end(), b.start(), b.end()]
            .iter()
            .fold(a.radius().max(b.radius()), |most, end| most.max(end.abs().max_element()));
        for [a, b] in [[&a, &b], [&b, &a]] {
            assert_eq!(dispatcher.distance(&here, a, b).unwrap().distance, 0.0, "{pair:?}");
            assert!(dispatcher.intersection_test(&here, a, b).unwrap().intersecting, "{pair:?}");
            let closest = dispatcher.closest_points(&here, a, b, 0.1 * extent).unwrap();
            assert_eq!(closest, ClosestPoints::Intersecting, "{pair:?}");
            let prediction = 0.1 * a.radius();
            let contact =
                dispatcher.contact(&here, a, b, prediction).unwrap().expect("they overlap");
            // A round cap makes the way out longer.
            let off = contact.dist + pair.depth;
            let slack = 64.0 * f64::EPSILON * extent;
            assert!(
                off <= slack && (!pair.is_flat() || off >= -slack),
                "{} of {pair:?}",
                contact.dist
            );
            flat += u32::from(pair.is_flat());
            let (mut manifolds, mut workspace) = (Vec::<ContactManifold<(), ()>>::new(), None);
            dispatcher
                .contact_manifolds(&here, a, b, prediction, &mut manifolds, &mut workspace)
                .unwrap();
            let points = manifolds.iter().flat_map(|manifold| &manifold.points);
            let deepest = points.fold(f64::INFINITY, |least, point| least.min(point.dist));
            assert!((deepest - contact.dist).abs() <= slack, "{deepest} of {pair:?}");
            // Towards one another they touch at once.
            let way = -contact.normal1;
            let options = ShapeCastOptions::with_max_time_of_impact(10.0 * extent);
            let hit =
                dispatcher.cast_shapes(&here, way, a, b, options).unwrap().expect("they overlap");
            assert_eq!(hit.time_of_impact, 0.0, "{pair:?}");
        }
    }
    assert!(flat > ROUNDS, "{flat}");
}
