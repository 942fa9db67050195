//! What each query about links means: plain loops over all links and all triangles.
//!
//! The engines are faster ways to the same answers. The tests compare every engine of the CPU with
//! these loops: distances, triangles, links and points bit for bit.
//!
//! # Definitions
//! - `d(k, i)`: the distance of link k from triangle i, measured in `f64`. It is 0 if the two have
//!   a point in common.
//! - `d(k, f)`: the distance of link k from a corner or an edge f.
//! - Tuples are compared by their first entries, ties by the next ones. So the least
//!   `(d(k, i), i, k)` belongs to the lowest of the nearest triangles, then to the lowest link.

use crate::answer::{LinkProximity, Side};
use crate::mesh::Mesh;
use crate::pair::PlacedRobot;
use parry3d_f64::math::{Real, Vector};
use std::cmp::Ordering;
use std::f64::consts::TAU;
use std::ops::Range;

/// A robot in the frame of a mesh, and the mesh.
struct Definition<'a> {
    robot: PlacedRobot<'a>,
    mesh: &'a Mesh,
}

impl Definition<'_> {
    fn links(&self) -> Range<usize> {
        0..self.robot.links().len()
    }

    fn triangles(&self) -> Range<u32> {
        0..self.mesh.len() as u32
    }

    /// `d(k, i)`, with its two points.
    fn pair(&self, link: usize, triangle: u32) -> LinkProximity {
        self.between(link, triangle, self.mesh.corners(triangle))
    }

    fn between(&self, link: usize, triangle: u32, corners: [Vector; 3]) -> LinkProximity {
        let placed = self.robot.link(link);
        placed.answer(link, &placed.measure(triangle, corners))
    }

    /// `per_link`: for each link k the least `(d(k, i), i)`.
    fn per_link(&self) -> Vec<LinkProximity> {
        let nearest = |link| {
            let pairs = self.triangles().map(|triangle| self.pair(link, triangle));
            pairs.min_by(nearer)
        };
        self.links().filter_map(nearest).collect()
    }

    /// `minimum`: the least `(d(k, i), i, k)`.
    fn minimum(&self) -> Option<LinkProximity> {
        // Of equal ones `min_by` returns the first, which has the lowest link.
        self.per_link().into_iter().min_by(nearer)
    }

    /// `minimum_within`: the minimum, if its distance is at most the bound.
    fn minimum_within(&self, bound: Real) -> Option<LinkProximity> {
        self.minimum().filter(|found| found.distance <= bound)
    }

    /// `clears`: whether `d(k, i) > margin` for all k and i.
    fn clears(&self, margin: Real) -> bool {
        let clears = |link, triangle| self.pair(link, triangle).distance > margin;
        self.links().all(|link| self.triangles().all(|triangle| clears(link, triangle)))
    }

    /// `contacts_within` with a prominence of 0: the link and the triangle of each contact, for a
    /// robot that touches nothing.
    ///
    /// For each link k let c grow from 0. Triangle i appears at `c = d(k, i)`, as a piece of wall.
    /// Two triangles with the same corner or edge f are one piece from `c = d(k, f)` on. (Walls
    /// with seams have more such f, which the tests of seams derive.) When two
    /// pieces merge, the one that appeared later ends. A contact is a triangle within the margin
    /// whose piece has not ended at once, up to `rounding`.
    fn contacts_within(&self, margin: Real, rounding: Real) -> Vec<(usize, u32)> {
        let mut contacts = Vec::new();
        for link in self.links() {
            let mut nearest_first: Vec<_> =
                self.triangles().map(|triangle| self.pair(link, triangle)).collect();
            nearest_first.sort_by(nearer);
            let corners = |place: usize| self.mesh.corners(nearest_first[place].witness.triangle);
            let mut merges: Vec<(Real, usize, usize)> = Vec::new();
            for late in 0..nearest_first.len() {
                for early in 0..late {
                    for f in shared_parts(corners(late), corners(early)) {
                        merges.push((self.between(link, 0, f).distance, late, early));
                    }
                }
            }
            merges.sort_by(|a, b| a.0.total_cmp(&b.0));
            // For each triangle the first triangle of its piece; for those, when the piece ends.
            let mut piece: Vec<usize> = (0..nearest_first.len()).collect();
            let mut ends = vec![Real::INFINITY; nearest_first.len()];
            for (c, one, other) in merges {
                let (first, second) = (piece[one].min(piece[other]), piece[one].max(piece[other]));
                if first != second {
                    ends[second] = c;
                    piece.iter_mut().filter(|piece| **piece == second).for_each(|it| *it = first);
                }
            }
            for (found, end) in nearest_first.iter().zip(ends) {
                if found.distance <= margin && end > found.distance + rounding {
                    contacts.push((link, found.witness.triangle));
                }
            }
        }
        contacts
    }
}

/// Compares by `(distance, triangle)`.
fn nearer(a: &LinkProximity, b: &LinkProximity) -> Ordering {
    a.distance.total_cmp(&b.distance).then(a.witness.triangle.cmp(&b.witness.triangle))
}

/// The corners and edges that two triangles have in common, as triangles without area.
fn shared_parts(one: [Vector; 3], other: [Vector; 3]) -> Vec<[Vector; 3]> {
    let common: Vec<_> = one.into_iter().filter(|corner| other.contains(corner)).collect();
    let corners = common.iter().map(|&corner| [corner; 3]);
    let edges = (0..common.len())
        .flat_map(|end| (0..end).map(move |start| (start, end)))
        .map(|(start, end)| [common[start], common[end], common[end]]);
    corners.chain(edges).collect()
}

/// `side`: inside if the winding number w is beyond 3/4, outside if it is below 1/4. `4 pi w` is
/// the sum of the signed solid angles of all triangles (van Oosterom and Strackee, 1983).
fn side(mesh: &Mesh, point: Vector) -> Side {
    let solid_angle = |triangle: u32| {
        let [a, b, c] = mesh.corners(triangle).map(|corner| corner - point);
        let [x, y, z] = [a, b, c].map(Vector::length);
        let along = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
        2.0 * a.dot(b.cross(c)).atan2(along)
    };
    let w = (0..mesh.len() as u32).map(solid_angle).sum::<Real>() / (2.0 * TAU);
    if w.abs() > 0.75 {
        Side::Inside
    } else if w.abs() < 0.25 {
        Side::Outside
    } else {
        Side::Undecided
    }
}

mod tests {
    use super::*;
    use crate::engine::{BvhSearch, Exhaustive, Proximity};
    use crate::robot::Chain;
    use continuum_testing::Random;
    use parry3d_f64::shape::Ball;

    /// A closed wall with bumps, of radius 8 to 10.
    fn wall(random: &mut Random) -> (Vec<Vector>, Vec<[u32; 3]>) {
        let (vertices, triangles) = Ball::new(10.0).to_trimesh(14, 9);
        (vertices.into_iter().map(|vertex| vertex * random.between(0.8, 1.0)).collect(), triangles)
    }

    /// A robot of four links with flat and round ends.
    fn robot(random: &mut Random) -> Chain {
        let mut points = vec![Vector::ZERO];
        for k in 0..4 {
            points.push(points[k] + (Vector::Z + random.point() * 0.7) * 1.5);
        }
        let radii = [0.9, 0.9, 0.6, 0.3];
        if random.below(4) == 0 {
            Chain::capsules(&points, &radii).unwrap()
        } else {
            Chain::from_centreline(&points, &radii).unwrap()
        }
    }

    #[test]
    fn engines_answer_as_defined() {
        let mut random = Random::new(71);
        let (mut touching, mut cleared, mut contacts_of_all) = (0, 0, 0);
        for _ in 0..12 {
            let (vertices, triangles) = wall(&mut random);
            let mesh = Mesh::from_triangles(&vertices, &triangles).unwrap();
            let mut engines: [Box<dyn Proximity>; 3] = [
                Box::new(BvhSearch::from_triangles(&vertices, &triangles).unwrap()),
                Box::new(Exhaustive::<f32>::from_triangles(&vertices, &triangles).unwrap()),
                Box::new(Exhaustive::<f64>::from_triangles(&vertices, &triangles).unwrap()),
            ];
            let (robot, pose) = (robot(&mut random), random.pose(4.0));
            let defined =
                Definition { robot: PlacedRobot::new(&robot, &pose).unwrap(), mesh: &mesh };
            let (per_link, minimum) = (defined.per_link(), defined.minimum().unwrap());
            let margin = [0.5, minimum.distance, 2.0][random.below(3) as usize];
            let is_apart = minimum.distance > 0.0;
            touching += usize::from(!is_apart);
            cleared += usize::from(defined.clears(margin));
            let expected = if is_apart { defined.contacts_within(2.0, 1e-11) } else { Vec::new() };
            contacts_of_all += expected.len();
            for engine in &mut engines {
                let (mut found, mut contacts) = (Vec::new(), Vec::new());
                engine.per_link(&robot, &pose, &mut found).unwrap();
                assert_eq!(found, per_link);
                assert_eq!(engine.minimum(&robot, &pose).unwrap(), minimum);
                for bound in [margin, minimum.distance.next_down().max(0.0)] {
                    let found = engine.minimum_within(&robot, &pose, bound).unwrap();
                    assert_eq!(found, defined.minimum_within(bound));
                    let clears = engine.clears(&robot, &pose, bound).unwrap();
                    assert_eq!(clears, defined.clears(bound));
                }
                engine.contacts_within(&robot, &pose, 2.0, 0.0, &mut contacts).unwrap();
                if is_apart {
                    let mut found: Vec<_> = contacts
                        .iter()
                        .map(|contact| (contact.link as usize, contact.witness.triangle))
                        .collect();
                    found.sort_unstable();
                    let mut expected = expected.clone();
                    expected.sort_unstable();
                    assert_eq!(found, expected);
                }
            }
        }
        assert!(touching > 1 && cleared > 1 && contacts_of_all > 8, "{touching} {cleared}");
    }

    #[test]
    fn sides_are_as_defined() {
        let mut random = Random::new(72);
        let (vertices, triangles) = wall(&mut random);
        let mesh = Mesh::from_triangles(&vertices, &triangles).unwrap();
        let search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
        let mut inside = 0;
        for _ in 0..300 {
            let point = random.point() * 12.0;
            let defined = side(&mesh, point);
            assert_eq!(search.side(point), defined, "{point}");
            inside += usize::from(defined == Side::Inside);
        }
        assert!((50..250).contains(&inside), "{inside}");
    }
}
