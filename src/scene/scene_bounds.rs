//! The bounds of all structures of a scene: one test for a robot that is far from all of them.

use super::bounding_box::BoundingBox;
use super::structure::Structure;
use crate::distance::Scalar;
use crate::pair::PlacedRobot;
use crate::query::nearest::PlacedOutline;
use crate::robot::COORDINATE_LIMIT;
use parry3d_f64::math::{Real, Vector};

/// The bounds of all structures of a scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct SceneBounds {
    /// The bounding box, in the scene's frame.
    around: BoundingBox,
    /// The largest coordinate of the meshes and poses.
    pub size: Real,
    /// The largest margin, or -infinity.
    pub margin: Real,
}

impl Default for SceneBounds {
    fn default() -> Self {
        Self { around: BoundingBox::default(), size: 0.0, margin: Real::NEG_INFINITY }
    }
}

impl SceneBounds {
    pub fn of(structures: &[Structure]) -> Self {
        structures.iter().fold(Self::default(), |all, structure| Self {
            around: all.around.and(structure.around_in_scene()),
            size: all.size.max(structure.size()),
            margin: all.margin.max(structure.largest_margin()),
        })
    }

    /// Returns whether a robot, placed in the scene's frame, is certainly farther than `bound` from
    /// all structures.
    ///
    /// **Rounding.** M is as in [`DistanceCache`](super::distance_cache::DistanceCache).
    ///
    /// 1. Distances are measured in a mesh's frame. The ends of the robot's capsule there are less
    ///    than 400 u M from their places here.
    /// 2. The corners of a moved box err by less than 80 u M.
    /// 3. The lower bound of the box errs by less than 64 u M.
    ///
    /// The sum is less than the 1024 u M that are subtracted. If coordinates are so large that a
    /// place in a mesh's frame could be out of range, the answer is false.
    pub fn are_beyond(&self, bound: Real, robot: &PlacedRobot) -> bool {
        let translation = robot.placed(Vector::ZERO).abs().max_element();
        let largest = PlacedOutline::around_all(*robot).extent().max(translation) + self.size;
        largest < COORDINATE_LIMIT / 16.0
            && self.around.at_least(robot) - 1024.0 * Real::UNIT_ROUNDOFF * largest > bound
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{BvhSearch, Proximity};
    use crate::robot::Chain;
    use continuum_testing::Random;
    use parry3d_f64::math::Pose;

    /// The distance of a robot in front of a square equals the distance of the boxes. The test
    /// never claims too much, and almost as much as is true.
    #[test]
    fn what_is_beyond_is_beyond() {
        for seed in 0..4000 {
            let random = &mut Random::new(seed);
            let size = [1.0, 2.0_f64.powi(-300), 2.0_f64.powi(300)][random.below(3) as usize];
            let square = [[0.0, -9.0, -9.0], [0.0, 9.0, -9.0], [0.0, 9.0, 9.0], [0.0, -9.0, 9.0]];
            let square = square.map(|corner| Vector::from_array(corner) * size);
            let search = BvhSearch::from_triangles(&square, &[[0, 1, 2], [0, 2, 3]]).unwrap();
            let mut structure = Structure::new(String::new(), search, Some(0.0));
            let far = size * [1.0, 1e6][random.below(2) as usize];
            let pose = Pose::from_translation(random.point() * far);
            structure.set_pose(&pose).unwrap();
            let [x, radius] =
                [random.between(1.0, 9.0), random.between(0.1, 0.9)].map(|length| length * size);
            let robot = Chain::capsules(&[Vector::ZERO, Vector::Y * size], &[radius]).unwrap();
            let at = pose * Pose::translation(x, 0.0, 0.0);
            let distance =
                structure.search.minimum(&robot, &structure.in_mesh(&at)).unwrap().distance;
            let (all, placed) =
                (SceneBounds::of(&[structure]), PlacedRobot::new(&robot, &at).unwrap());
            assert!(!all.are_beyond(distance, &placed), "seed {seed}");
            assert!(all.are_beyond(0.99 * distance, &placed), "seed {seed}");
        }
    }

    /// The same for any pose of structures and robots, and with flat caps.
    #[test]
    fn what_is_beyond_is_beyond_in_any_pose() {
        let mut beyond = 0;
        for seed in 0..4000 {
            let random = &mut Random::new(seed);
            let corners = [0; 3].map(|_| random.point() * 3.0);
            let Ok(search) = BvhSearch::from_triangles(&corners, &[[0, 1, 2]]) else { continue };
            let mut structure = Structure::new(String::new(), search, Some(0.0));
            let far = [1.0, 1e6][random.below(2) as usize];
            structure.set_pose(&random.pose(far)).unwrap();
            let points = [0; 4].map(|_| random.point() * 3.0);
            let make = [Chain::capsules, Chain::cylinders, Chain::from_centreline]
                [random.below(3) as usize];
            let Ok(robot) = make(&points, &[0.9, 0.1, 0.4]) else { continue };
            let at = Pose::from_translation(random.point() * 20.0) * random.pose(far);
            let distance =
                structure.search.minimum(&robot, &structure.in_mesh(&at)).unwrap().distance;
            let (all, placed) =
                (SceneBounds::of(&[structure]), PlacedRobot::new(&robot, &at).unwrap());
            assert!(!all.are_beyond(distance, &placed), "seed {seed}");
            beyond += u32::from(all.are_beyond(0.5 * distance, &placed));
        }
        assert!(beyond > 1000, "{beyond}");
    }
}
