//! Parallel links side by side whose ends are level, in deep overlap.
//!
//! The closest places of their axes lie in the planes of flat caps. Rounding puts them before or
//! behind these planes.

use crate::Random;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::{Cap, ModifiedCylinder};

/// Two parallel links that overlap.
#[derive(Clone, Copy, Debug)]
pub struct LevelLinks {
    pub links: [ModifiedCylinder; 2],
    /// The length of the least translation that separates them, if all caps are flat. With round
    /// caps it is at least as long.
    pub depth: f64,
}

/// The axes of two cylinders of radius 0.5, and the depth of their overlap.
type FoundPair = ([[[f64; 3]; 2]; 2], f64);

/// Pairs that an earlier version reported as apart.
const FOUND: [FoundPair; 6] = [
    (
        [
            [[0.0, 0.0, 0.0], [4.858605909122425, 0.18257483771516916, -10.782870634070369]],
            [
                [-0.4845586463096552, 0.698416405152407, -0.20650959433866187],
                [4.37404726281277, 0.8809912428675761, -10.989380228409031],
            ],
        ],
        0.12522644687132012,
    ),
    (
        [
            [[0.0, 0.0, 0.0], [-1.3604851197136347, -5.4997179435739065, 12.504985224037153]],
            [
                [-0.0058518993614082365, -0.59556782092403, -0.2625685992049758],
                [-1.366337019075043, -6.095285764497937, 12.242416624832178],
            ],
        ],
        0.3490948276939283,
    ),
    (
        [
            [[0.0, 0.0, 0.0], [1.9840018468779397, -1.0296179917086778, 0.34160645214235474]],
            [
                [0.1359046159307829, 0.1803720212323859, -0.24566494636703937],
                [2.1199064628087227, -0.8492459704762919, 0.09594150577531538],
            ],
        ],
        0.666300439694221,
    ),
    (
        [
            [[0.0, 0.0, 0.0], [-0.03129045455700443, 2.264151245424668, -0.7557656936617547]],
            [
                [-0.428504506434368, 0.19672154213507986, 0.6070868647001632],
                [-0.4597949609913724, 2.4608727875597483, -0.14867882896159157],
            ],
        ],
        0.23131935209344612,
    ),
    (
        [
            [[0.0, 0.0, 0.0], [2.6360325862784406, 3.002550721493994, 0.9875948112828031]],
            [
                [-0.5041795374902198, 0.5698106233448118, -0.38664805010862885],
                [2.131853048788221, 3.572361344838806, 0.6009467611741743],
            ],
        ],
        0.1465494348509342,
    ),
    (
        [
            [[0.0, 0.0, 0.0], [-7.849290214809553, 0.7957697376741594, 5.27653307031662]],
            [
                [-0.23650067180059509, 0.6957830679969781, -0.4567479226115715],
                [-8.085790886610148, 1.4915528056711373, 4.819785147705049],
            ],
        ],
        0.13474552281805197,
    ),
];

/// Returns the pairs that an earlier version reported as apart.
pub fn found_level_links() -> impl Iterator<Item = LevelLinks> {
    FOUND.into_iter().map(|(axes, depth)| {
        let links = axes.map(|ends| {
            let [start, end] = ends.map(Vector::from);
            ModifiedCylinder::cylinder(start, end, 0.5).expect("finite")
        });
        LevelLinks { links, depth }
    })
}

impl Random {
    /// Returns two links that are level at the start, at the end or at both, at any pose and in any
    /// unit between micrometres and kilometres. One pair in four also has round caps.
    ///
    /// **Depth.** The Minkowski difference of two parallel cylinders is a cylinder whose radius is
    /// the sum of both radii. From inside, the least translation is across the axes or along them;
    /// the depth is the smaller of the two.
    pub fn level_links(&mut self) -> LevelLinks {
        let size = if self.below(2) == 0 { 1.0 } else { self.magnitude(-6.0, 3.0) };
        let radius = self.between(0.2, 1.0);
        let radii = [radius, if self.below(2) == 0 { radius } else { self.between(0.2, 1.0) }];
        let across = 2.0 * radii[0].min(radii[1]) * self.between(0.1, 1.0);
        let lengths = [self.between(0.3, 12.0), self.between(0.3, 12.0)];
        let level = self.below(3);
        let lengths = if level == 0 { [lengths[0]; 2] } else { lengths };
        let low = if level == 2 { lengths[0] - lengths[1] } else { 0.0 };
        let aside = Vector::X * (radii[0] + radii[1] - across);
        let axes = [[0.0, lengths[0]], [low, low + lengths[1]]]
            .map(|ends: [f64; 2]| ends.map(|z| Vector::Z * z));
        let axes = [axes[0], axes[1].map(|end| end + aside)];
        let pose = match self.below(4) {
            0 => Pose::IDENTITY,
            1 => self.pose(5.0),
            _ => self.pose(0.0),
        };
        let is_flat = self.below(4) > 0;
        let links = [0, 1].map(|k: usize| {
            let [mut start, mut end] = axes[k].map(|end| (pose * end) * size);
            if self.below(2) == 0 {
                (start, end) = (end, start);
            }
            let some = [[Cap::Flat, Cap::Round], [Cap::Round, Cap::Flat], [Cap::Flat; 2]];
            let caps = if is_flat { [Cap::Flat; 2] } else { some[self.below(3) as usize] };
            ModifiedCylinder::new(start, end, radii[k] * size, caps).expect("finite")
        });
        LevelLinks { links, depth: across.min(lengths[0].min(lengths[1])) * size }
    }
}

impl LevelLinks {
    /// Returns whether all caps are flat.
    pub fn is_flat(&self) -> bool {
        self.links.iter().all(|link| link.caps() == [Cap::Flat; 2])
    }
}
