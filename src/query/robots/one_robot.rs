//! A robot and itself: which of its parts can come to be near one another, and how near they are.
//!
//! Neighbouring links touch, and those around a bend are near for no other reason. So the question is about pairs of places
//! that are a local minimum of the distance: two places that come no nearer when either moves along the robot. Three kinds
//! of pairs are asked for, and no margin decides which.
//!
//! **Two links with a turn of at least pi between them.** Let x and y be places on the axes of two links, at which the
//! distance of the axes is a local minimum, and v the unit vector from x to y. The part of the centreline from x to y and
//! the way back along the chord are a closed polygon. Its exterior angles sum up to at least 2 pi (Fenchel; equality for
//! plane convex polygons). At x the polygon turns from -v to the direction t of the centreline. Moving x on by t changes
//! the distance at the rate -v . t, which is not below 0 at a minimum; so the angle between -v and t is at most pi / 2. The
//! same holds at y, at a joint, where it holds of the direction on the way to y, and at the robot's ends. So the joints
//! between x and y turn by at least 2 pi - pi / 2 - pi / 2 = pi. Where the axes meet there is one corner, of at most pi,
//! and the same is left. The distance of two barrels is that of their axes less both radii.
//!
//! **A flat face and a link, with a turn of at least pi / 2.** A face is the robot's base, its tip, or the wider side of a
//! step in radius; c is its centre, n its normal, out of the robot. The shortest way leaves it at a point c + a e along v,
//! where e is perpendicular to n, a >= 0, and v lies between n and e: at the angle alpha from n. It ends, prolonged by the
//! other link's radius, at a place y of an axis, which it meets at a right angle as above. Close the polygon by the chord
//! from c to y instead. That is a e plus a multiple of v, so at an angle beta from n with alpha <= beta <= pi / 2. At y it
//! has turned by beta - alpha, which adds so much to pi / 2. At c the centreline goes on along n, or comes from where n
//! points away from: the polygon turns by pi - beta at most in the first case, by beta in the second. Together that is no
//! more than 3/2 pi, which leaves pi / 2 for the joints.
//!
//! **A round cap at the wider side of a step** is a ball around c, and asked for like a face. Of a link alone the place
//! nearest to y may be its end for no other reason than that the robot is thinner beyond: going on along the centreline is
//! no descent then, so that the corner at c is bounded by pi instead of pi / 2. The rest is as above: pi / 2 is left for
//! the joints. At a round base or tip the centreline does not go on, and the first rule has it.
//!
//! **Two such ends** at any turn: two steps of a straight robot may face one another. What such a pair has found counts if
//! the way between the two leaves both on their outer sides, or if they meet.
//!
//! Links that share a joint are never asked for. The rule is one for thin tubes: where a joint is so sharp that its two
//! links overlap over more than half of the shorter one, r tan(angle / 2) > length / 2, there is no saying what is near
//! whom, and the robot is refused.
//!
//! **Rounding of the way.** The two points that are found belong to the two parts and are at most e farther apart than the
//! nearest two, at the distance d. So the way w between them lies in the parts' difference, a convex set, whose point
//! nearest to 0 is the shortest way w*. There w . w* >= |w*|^2, and |w - w*|^2 <= |w|^2 - |w*|^2 <= (d + e)^2 - d^2 = e (2
//! d + e): of a pair that touches the way is noise, and of one that is nearly parallel it errs by far more than e. Let S be
//! the largest coordinate of both links and their radius. The narrow phase errs by 16 u of the pair's extent of at most 2
//! S; the links' coordinates in their pair's frame by sqrt(3) 4 u S, the points in the robot's frame and their difference
//! by sqrt(3) 3 u S: e = 64 u S is enough. A way that leaves a face by no more than sqrt(e (2 d + e)) on its inner side
//! counts as one that leaves it outside. And what is measured to be within a bound is in truth within e of it, which is
//! what the ball around a face is asked for first: it is smaller than the face's link, and so known better than what is
//! measured.
//!
//! **Turns without angles.** The cosine of half a turn falls from 1 to -1 as the turn grows from 0 to 2 pi, so it is
//! compared instead of the turn. With the unit axes a and b of two links, half of their angle has the cosine |a + b| / 2
//! and the sine |a - b| / 2; half of the turn up to a link is the product of as many complex numbers, and half of that
//! between two links the quotient of two products. The axes are unit vectors to 4 u, so both numbers err by 8 u, and their
//! products over n joints by less than 20 n u of length, with the roundings of the products; a cosine of a quotient errs by
//! twice that and 3 u. [`Turns`] asks for cosines up to 128 n u above the one that counts.

use super::descent::{Descent, Limit, measure_pair};
use crate::answer::{ProximityError, RobotProximity};
use crate::distance::Scalar;
use crate::pair::{NearestOfLinks, PlacedLink, PlacedRobot};
use crate::robot::{Chain, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};
use std::f64::consts::FRAC_1_SQRT_2;

/// What one query leaves for the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct OwnMemory {
    descent: Descent,
    turns: Turns,
    faces: Vec<Face>,
    /// The links that were nearest.
    nearest: Option<[usize; 2]>,
}

impl OwnMemory {
    pub fn forget(&mut self) {
        self.nearest = None;
    }
}

/// How far a chain's centreline turns.
#[derive(Clone, Debug, Default)]
struct Turns {
    /// Half of what the joints up to each link turn by, together: its cosine and its sine.
    before: Vec<[Real; 2]>,
    slack: Real,
    /// Of each link the first one behind a turn of at least pi that shares no joint with it; beyond the last if none is.
    asked_from: Vec<usize>,
}

impl Turns {
    /// # Errors
    /// A joint is too sharp.
    fn measure(&mut self, links: &[ModifiedCylinder]) -> Result<(), ProximityError> {
        self.before.clear();
        let of_link = |link: &ModifiedCylinder| {
            let (length, axis) = link.length_and_axis();
            (axis, length, link.radius())
        };
        let (mut last, mut turned) = (of_link(&links[0]), [1.0, 0.0]);
        self.before.push(turned);
        for (joint, link) in links[1..].iter().enumerate() {
            let next = of_link(link);
            // Of half of the joint's angle.
            let (cosine, sine) = (0.5 * (next.0 + last.0).length(), 0.5 * (next.0 - last.0).length());
            let (length, radius) = (next.1.min(last.1), next.2.max(last.2));
            // Of a link that comes back along the one before, rounding leaves no cosine.
            let is_folded = cosine * cosine <= 8.0 * Real::UNIT_ROUNDOFF;
            if 2.0 * radius * sine > length * cosine || is_folded {
                let angle = 2.0 * libm::atan2(sine, cosine);
                return Err(ProximityError::JointTooSharp { joint: joint + 1, angle, radius, length });
            }
            let [real, imaginary] = turned;
            turned = [real * cosine - imaginary * sine, real * sine + imaginary * cosine];
            self.before.push(turned);
            last = next;
        }
        self.slack = 128.0 * links.len() as Real * Real::UNIT_ROUNDOFF;
        self.find_asked();
        Ok(())
    }

    /// Finds from which link on each is asked for: no earlier than for the link before.
    ///
    /// No turn that is looked at is as large as 2 pi. It is one to a link that is reached by less than pi, from here or from
    /// the link before, and one joint more; or that of two joints. A joint turns by less than pi.
    fn find_asked(&mut self) {
        self.asked_from.clear();
        let mut from = 0;
        for link in 0..self.before.len() {
            from = from.max(link + 2);
            while from < self.before.len() && !self.reach(0.0, link, from) {
                from += 1;
            }
            self.asked_from.push(from);
        }
    }

    /// Whether two links, the second after the first, have a turn of at least an angle between them, as far as rounding tells:
    /// one whose half has this cosine. They have no more than 2 pi between them.
    fn reach(&self, half_cosine: Real, first: usize, second: usize) -> bool {
        let ([c1, s1], [c2, s2]) = (self.before[first], self.before[second]);
        c1 * c2 + s1 * s2 <= half_cosine + self.slack
    }

    /// The links with a turn of at least pi / 2 to or from a link, and less than pi, that share no joint with it.
    fn quarter_turned(&self, link: usize) -> impl Iterator<Item = usize> {
        let is_quarter = |first, second| self.reach(FRAC_1_SQRT_2, first, second);
        let before =
            (0..link.saturating_sub(1)).rev().take_while(move |&first| self.asked_from[first] > link);
        let after = link + 2..self.asked_from[link].max(link + 2);
        before
            .filter(move |&first| is_quarter(first, link))
            .chain(after.filter(move |&second| is_quarter(link, second)))
    }
}

/// A flat face of a robot, or the round cap at the wider side of a step: one end of a link.
#[derive(Clone, Copy, Debug)]
struct Face {
    link: usize,
    end: usize,
    is_flat: bool,
}

impl Face {
    /// All faces of a chain: its ends, where they are flat, and the wider sides of its steps.
    fn all(links: &[ModifiedCylinder], faces: &mut Vec<Self>) {
        faces.clear();
        for (number, link) in links.iter().enumerate() {
            let before = number.checked_sub(1).and_then(|before| links.get(before));
            for (end, neighbour) in [(0, before), (1, links.get(number + 1))] {
                let is_flat = link.flat()[end];
                if neighbour.map_or(is_flat, |neighbour| neighbour.radius() < link.radius()) {
                    faces.push(Self { link: number, end, is_flat });
                }
            }
        }
    }

    /// The normal, out of the robot.
    fn outward(&self, robot: &PlacedRobot) -> Vector {
        let axis = robot.links()[self.link].axis();
        if self.end == 0 { -axis } else { axis }
    }

    /// Whether a way to a point leaves it on its outer side, up to rounding.
    fn sees(&self, robot: &PlacedRobot, way: Vector, slack: Real) -> bool {
        way.dot(self.outward(robot)) >= -slack
    }

    /// The ball around its centre, which is all of it that is asked for if it is round.
    fn ball(&self, robot: &PlacedRobot) -> PlacedLink {
        let link = robot.link(self.link);
        let centre = [link.start(), link.end()][self.end];
        PlacedLink::between(centre, centre, link.radius(), [false; 2])
    }

    fn nearest_to_link(&self, robot: &PlacedRobot, other: &PlacedLink) -> NearestOfLinks {
        if self.is_flat {
            robot.link(self.link).face_to_link(self.end, other)
        } else {
            self.ball(robot).measure_link(other)
        }
    }

    fn nearest_to_face(&self, robot: &PlacedRobot, other: &Self) -> NearestOfLinks {
        if !other.is_flat {
            return self.nearest_to_link(robot, &other.ball(robot));
        }
        let (link, facing) = (robot.link(self.link), robot.link(other.link));
        if self.is_flat {
            link.face_to_face([self.end, other.end], &facing)
        } else {
            facing.face_to_link(other.end, &self.ball(robot)).swapped()
        }
    }
}

/// A robot in its own frame, and what can come to be near within it.
pub(crate) struct OneRobot<'a> {
    robot: PlacedRobot<'a>,
}

impl<'a> OneRobot<'a> {
    /// # Errors
    /// A joint is too sharp.
    pub fn new(robot: &'a Chain, memory: &mut OwnMemory) -> Result<Self, ProximityError> {
        let robot = PlacedRobot::new(robot, &Pose::IDENTITY)?;
        memory.turns.measure(robot.links())?;
        Face::all(robot.links(), &mut memory.faces);
        Ok(Self { robot })
    }

    /// The nearest of all pairs that are asked for.
    pub fn minimum(&self, memory: &mut OwnMemory) -> Option<RobotProximity> {
        let OwnMemory { descent, turns, faces, nearest } = memory;
        let remembered = nearest.filter(|links| links[1] < self.robot.links().len());
        let remembered = remembered.filter(|links| turns.asked_from[links[0]] <= links[1]);
        let mut best = remembered.map(|links| measure_pair([&self.robot; 2], links));
        descent.run([&self.robot; 2], Limit::at_best(&best), asked_from(turns), |found| {
            Limit::at(best.insert(found))
        });
        // Last, since faces cost most: what is near already spares most of them.
        let bound = best.map_or(Real::INFINITY, |best| best.distance);
        self.between_faces(descent, turns, faces, bound, |found| {
            let links = found.links.map(|link| link as usize);
            if Limit::at_best(&best).admits(found.distance, links) {
                best = Some(found);
            }
            best.map(|best| best.distance)
        });
        *nearest = best.map(|best| best.links.map(|link| link as usize));
        best
    }

    /// Whether all pairs that are asked for are farther apart than `margin`.
    pub fn clears(&self, margin: Real, memory: &mut OwnMemory) -> bool {
        let OwnMemory { descent, turns, faces, .. } = memory;
        let mut is_clear = true;
        descent.run([&self.robot; 2], Limit::of(margin), asked_from(turns), |_| {
            is_clear = false;
            Limit::NOTHING
        });
        let keep = |found: RobotProximity| (found.distance > margin).then_some(margin);
        is_clear && self.between_faces(descent, turns, faces, margin, keep)
    }

    /// Shows `keep` what every face is near, at most `bound` away, as long as it returns what is the bound from then on.
    /// Returns whether it always did.
    fn between_faces(
        &self,
        descent: &mut Descent,
        turns: &Turns,
        faces: &[Face],
        mut bound: Real,
        mut keep: impl FnMut(RobotProximity) -> Option<Real>,
    ) -> bool {
        for (number, face) in faces.iter().enumerate() {
            // Those of the links that are asked for at a turn of pi anyway are left to that.
            let of_links = turns.quarter_turned(face.link).map(|link| (link, None));
            let of_faces = faces[number + 1..].iter().map(|facing| (facing.link, Some(facing)));
            for (link, facing) in of_links.chain(of_faces.filter(|(link, _)| link.abs_diff(face.link) >= 2)) {
                if !descent.may_be_within(&self.robot, [face.link, link], bound) {
                    continue;
                }
                let (on_face, other) = (self.robot.link(face.link), self.robot.link(link));
                let error = error([&on_face, &other]);
                // The ball around a face holds it, and spares most others.
                if !face.ball(&self.robot).may_be_within(bound + error, &other) {
                    continue;
                }
                let nearest = match facing {
                    Some(facing) => face.nearest_to_face(&self.robot, facing),
                    None => face.nearest_to_link(&self.robot, &other),
                };
                let (way, slack) = way(&nearest, error);
                let meets = facing.is_none_or(|facing| facing.sees(&self.robot, -way, slack));
                if meets && face.sees(&self.robot, way, slack) {
                    let found = in_order([face.link, link], [&on_face, &other], &nearest);
                    let Some(next) = keep(found) else { return false };
                    bound = next;
                }
            }
        }
        true
    }
}

/// By how much the distance of two links may be measured wrong, and the way between them be longer than the shortest.
fn error(links: [&PlacedLink; 2]) -> Real {
    let reach = |link: &PlacedLink| link.start().abs().max(link.end().abs()).max_element() + link.radius();
    64.0 * Real::UNIT_ROUNDOFF * reach(links[0]).max(reach(links[1]))
}

/// The way from the first of two links to the second, and by how much it may err in any direction.
fn way(nearest: &NearestOfLinks, error: Real) -> (Vector, Real) {
    // Two roots, so that no product leaves the range of numbers.
    let slack = error.sqrt() * (2.0 * nearest.distance + error).sqrt();
    (nearest.on_second - nearest.on_first, slack)
}

/// From which link on each is asked for.
fn asked_from(turns: &Turns) -> impl Fn(usize) -> usize {
    |link| turns.asked_from[link]
}

/// The answer with the lower link first.
fn in_order(links: [usize; 2], placed: [&PlacedLink; 2], nearest: &NearestOfLinks) -> RobotProximity {
    if links[0] < links[1] {
        return nearest.answer(links, placed);
    }
    nearest.swapped().answer([links[1], links[0]], [placed[1], placed[0]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use continuum_testing::Random;
    use std::f64::consts::PI;

    fn turns(points: &[Vector]) -> Turns {
        let robot = Chain::with_constant_radius(points, 0.0).expect("points that differ");
        let mut turns = Turns::default();
        turns.measure(robot.links()).expect("no joint of a thin robot is too sharp");
        turns
    }

    /// What an even polygon reaches at half a turn, rounded to either side, is asked for; and what it does not reach is not.
    #[test]
    fn half_a_turn_of_a_polygon_is_asked_for() {
        for (corners, scale) in [(4, 1.0), (6, 1e-150), (20, 3.0), (360, 1e150), (2000, 0.1)] {
            let corner = |k: i32| {
                let (sin, cos) = (2.0 * PI * f64::from(k) / f64::from(corners)).sin_cos();
                Vector::new(cos, sin * 0.6, sin * 0.8) * scale
            };
            let points: Vec<_> = (0..3 * corners).map(corner).collect();
            let turns = turns(&points);
            let half = corners as usize / 2;
            for link in 0..points.len() - 1 {
                assert_eq!(
                    turns.asked_from[link],
                    (link + half).min(points.len() - 1).max(link + 2),
                    "{corners}"
                );
                let quarter: Vec<_> = turns.quarter_turned(link).filter(|&other| other > link).collect();
                let from = link + (corners as usize).div_ceil(4).max(2);
                assert_eq!(
                    quarter,
                    (from..link + half).filter(|&other| other < points.len() - 1).collect::<Vec<_>>()
                );
            }
        }
    }

    #[test]
    fn turns_are_sums_of_angles() {
        let mut random = Random::new(6);
        let (mut asked, mut sharp) = (0, 0);
        for round in 0..2000 {
            // From nearly straight to nearly folded.
            let bend = [0.05, 0.5, 3.0, 50.0][round % 4];
            let mut way = random.direction();
            let mut points = vec![random.point()];
            for _ in 0..3 + random.below(40) {
                way = (way + random.point() * bend).normalize();
                way = if random.below(8) == 0 { -way } else { way };
                points.push(points[points.len() - 1] + way * random.between(0.1, 1.0));
            }
            let ways: Vec<_> = points.windows(2).map(|pair| (pair[1] - pair[0]).normalize()).collect();
            let angle = |pair: &[Vector]| libm::atan2(pair[0].cross(pair[1]).length(), pair[0].dot(pair[1]));
            let angles: Vec<_> = ways.windows(2).map(angle).collect();
            if angles.iter().any(|&angle| angle > PI - 1e-6) {
                continue;
            }
            sharp += usize::from(angles.iter().any(|&angle| angle > 3.0));
            let turns = turns(&points);
            for link in 0..ways.len() {
                let is_far = |&other: &usize| angles[link..other].iter().sum::<f64>() >= PI;
                let expected = (link + 2..ways.len()).find(is_far).unwrap_or(ways.len().max(link + 2));
                assert_eq!(turns.asked_from[link], expected, "round {round}");
                asked += usize::from(expected < ways.len());
                let mut quarter: Vec<_> = turns.quarter_turned(link).collect();
                quarter.sort_unstable();
                let between = |one: usize, two: usize| angles[one.min(two)..one.max(two)].iter().sum::<f64>();
                let is_quarter = |&other: &usize| {
                    other.abs_diff(link) > 1 && (0.5 * PI..PI).contains(&between(link, other))
                };
                assert_eq!(quarter, (0..ways.len()).filter(is_quarter).collect::<Vec<_>>(), "round {round}");
            }
        }
        assert!(asked > 5000 && sharp > 100, "{asked} {sharp}");
    }
}
