//! The order in which candidates are measured.

/// Moves the candidates with the least bounds to the first `count` places.
///
/// The others keep their places, except where they make room. They are in the order of the leaves,
/// so triangles that are near each other are often near in memory too.
pub(crate) fn select_least<E: Copy + PartialOrd>(candidates: &mut [(E, u32)], count: usize) {
    let Some((first, others)) = candidates.split_at_mut_checked(count) else { return };
    let mut farthest = farthest_of(first);
    for other in others {
        if first.get(farthest).is_some_and(|first| other.0 < first.0) {
            std::mem::swap(&mut first[farthest], other);
            farthest = farthest_of(first);
        }
    }
}

fn farthest_of<E: PartialOrd>(candidates: &[(E, u32)]) -> usize {
    (1..candidates.len())
        .fold(0, |far, place| if candidates[far].0 < candidates[place].0 { place } else { far })
}

#[cfg(test)]
mod tests {
    use super::*;
    use continuum_testing::Random;

    #[test]
    fn the_least_come_first_and_the_others_stay() {
        let random = &mut Random::new(5);
        let mut moved = 0;
        for _ in 0..1000 {
            // Many bounds are equal; each triangle occurs once.
            let length = random.below(40);
            let before: Vec<_> = (0..length).map(|triangle| (random.below(12), triangle)).collect();
            let count = random.below(10) as usize;
            let mut after = before.clone();
            select_least(&mut after, count);
            let (mut sorted, mut kept) = (before.clone(), after.clone());
            sorted.sort_unstable();
            kept.sort_unstable();
            assert_eq!(kept, sorted);
            if let Some((first, others)) = after.split_at_checked(count) {
                let largest = first.iter().map(|candidate| candidate.0).max();
                assert!(
                    others
                        .iter()
                        .all(|candidate| largest.is_none_or(|largest| largest <= candidate.0))
                );
                let strays =
                    after.iter().zip(&before).skip(count).filter(|(after, before)| after != before);
                // Each candidate that moved to the front swapped places with another.
                let came = first.iter().filter(|candidate| candidate.1 as usize >= count).count();
                assert!(strays.clone().count() >= came);
                moved += came;
            }
        }
        assert!(moved > 1000, "{moved}");
    }
}
