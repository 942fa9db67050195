//! Modified cylinder against modified cylinder: every pair of links, whatever their caps.
//!
//! Let p and q be the closest points of the two axes and F their distance. The head of
//! [`triangle_modified_cylinder`](super::triangle_modified_cylinder) proves two things of a link Z
//! and any convex body T, with s the place on the axis that is closest to T, p* the point of T, and
//! f their distance:
//!
//! - **S.** s is not at a flat end: the distance is max(0, f - r).
//! - **D.** s is at a flat end: the distance is that of the end's disc from T.
//!
//! It uses of the triangle that it is convex, and no more. The second link is convex too, and so
//! are the first link's axis and discs. So the two statements, taken in turn for either link, lead
//! to all cases:
//!
//! 1. *Axis and axis.* q is not at a flat end of the second link. By S its distance from the first
//!    axis is F - r2, at p. If p is not at a flat end either, S says F - r1 - r2.
//! 2. *Axis and disc.* q is at a flat end. By D the second link is as far from the first axis as
//!    that end's disc is: segment-disc. If the place on the axis is not at a flat end, S takes r1
//!    off.
//! 3. *Disc and axis.* In 1 or in 2 the place on the first axis is at a flat end. By D the first
//!    link is its disc to the second link. The disc's place on the second axis tells the rest: if
//!    it is not at a flat end, S takes r2 off.
//! 4. *Disc and disc.* It is: D says disc-disc.
//!
//! S and D hold where the bodies overlap, so the cases do: then the distance is 0 and the points
//! are common.
//!
//! Each case gives a point of one link, and [`Link::closest_to`] the other link's nearest point to
//! it. So every candidate is the distance between a point of each link, and the least of them is
//! right wherever one of them is. Rounding may take a place for a flat end that is none, which adds
//! a candidate and loses none; or the other way round, which is off by what the place is off by.
//! Two capsules are case 1 wherever p and q are: their points are those on the way from p to q, at
//! the radii, or a common one where the radii are as long as the way.

use super::point_modified_cylinder::Link;
use super::segment_segment::{Parameters, parameters};
use super::{Closest, Convex, DiscSolver, Scalar, Vec3, disc_disc, frame::Frame, touching};

/// The distance between two solid modified cylinders, each with the two ends of its axis, its
/// radius, and which of its two caps are flat. Where the two meet, both points are a common one.
///
/// A link of length 0, or of one whose square falls below the range beside the problem's extent,
/// has no direction: its caps count as round.
#[inline(always)]
pub fn modified_cylinder_modified_cylinder<T: Scalar>(
    axis1: [Vec3<T>; 2],
    radius1: T,
    flat1: [T::Mask; 2],
    axis2: [Vec3<T>; 2],
    radius2: T,
    flat2: [T::Mask; 2],
) -> Closest<T> {
    let frame = Frame::around(axis1[0], [axis1[1], axis2[0], axis2[1]], radius1.max(radius2));
    // The second axis is not the difference of two places seen from the first: a short one would
    // lose its direction.
    let pair = TwoLinks {
        first: Link::new(frame.point(axis1[1]), frame.length(radius1), flat1),
        second: Link::new(frame.way(axis2[0], axis2[1]), frame.length(radius2), flat2),
        second_start: frame.point(axis2[0]),
    };
    frame.answer(pair.closest(&pair.axes(), |_| true))
}

/// Two links in coordinates from the start of the first, with numbers near one.
#[derive(Clone, Copy)]
pub(crate) struct TwoLinks<T: Scalar> {
    pub first: Link<T>,
    /// Seen from its own start.
    pub second: Link<T>,
    /// Where the second link starts.
    pub second_start: Vec3<T>,
}

impl<T: Scalar> TwoLinks<T> {
    /// Where the axes are closest. Their distance less both radii is a lower bound on that of the
    /// links.
    #[inline(always)]
    pub(crate) fn axes(&self) -> Parameters<T> {
        parameters(-self.second_start, self.first.end, self.second.end)
    }

    /// The closest points. `may` is asked whether a mask is true in some lane; if it is in none a
    /// case is left out that decides nothing, so `true` is a right answer always.
    #[inline(always)]
    pub(crate) fn closest(
        &self,
        axes: &Parameters<T>,
        may: impl Fn(T::Mask) -> bool,
    ) -> Closest<T> {
        let capsules = self.closest_of_capsules(axes);
        let [start1, end1] = self.first.flat;
        let [start2, end2] = self.second.flat;
        let are_flat = start1 | end1 | start2 | end2;
        if !may(are_flat) {
            return capsules;
        }
        let flat = self.closest_of_flat(
            axes,
            #[inline(always)]
            |mask| may(mask & are_flat),
        );
        Closest::select(are_flat, flat, capsules)
    }

    /// Case 1 of two capsules: both points are on the way between the axes.
    #[inline(always)]
    fn closest_of_capsules(&self, axes: &Parameters<T>) -> Closest<T> {
        let Self { first, second, second_start } = self;
        let apart = axes.gap.norm();
        let distance = (apart - first.radius - second.radius).max(apart.zero());
        let share = apart.one().over(apart);
        // Where they meet the second point is the first, which is in the second link: its axis is
        // no farther than what is left of the way.
        let point1 = (first.end * axes.s).along(axes.gap, -(first.radius.min(apart) * share));
        let outside = second_start.along(second.end, axes.t).along(axes.gap, second.radius * share);
        let point2 = Vec3::select(apart.zero().lt(distance), outside, point1);
        Closest { distance, point1, point2 }
    }

    /// All cases.
    #[inline(always)]
    fn closest_of_flat(&self, axes: &Parameters<T>, may: impl Fn(T::Mask) -> bool) -> Closest<T> {
        let Self { first, second, second_start } = self;
        // Case 1.
        let on_second = second_start.along(second.end, axes.t);
        let on_first = first.end * axes.s;
        let (_, point1) = first.closest_to(on_second);
        let mut closest = self.with_nearest_of_second(point1);
        let mut first_ends = first.flat_ends_facing(on_second);
        let second_ends = second.flat_ends_facing(on_first - *second_start);
        // Case 2.
        let at_flat = second_ends.any();
        if may(at_flat) {
            let centre = *second_start + second_ends.centre(second);
            let axis = [-centre, first.end - centre];
            let on_disc = Convex::segment_disc(axis, second.axis, second.radius).point2 + centre;
            let (distance, point1) = first.closest_to(on_disc);
            closest = nearer_where(at_flat, closest, Closest { distance, point1, point2: on_disc });
            first_ends = first_ends.unless(at_flat, first.flat_ends_facing(on_disc));
        }
        // Cases 3 and 4.
        let closest =
            self.nearer_from_disc(first_ends.any(), first_ends.centre(first), closest, &may);
        // Of a point in the plane of a cap rounding may say that it is beyond it; the other link's
        // point may be within.
        let (distance, point1) = first.closest_to(closest.point2);
        let back = Closest { distance, point1, point2: closest.point2 };
        let forth = closest;
        let closest = forth.nearer(back);
        let doubtful = touching::is_doubtful(closest.distance);
        if !may(doubtful) {
            return closest;
        }
        // Rounding alone may have put a point beyond a flat cap that none of the cases names.
        let measured_at_cap = first.flat_ends_facing(closest.point2).any()
            | second.flat_ends_facing(forth.point1 - *second_start).any()
            | second.flat_ends_facing(closest.point1 - *second_start).any();
        self.touching(at_flat | first_ends.any() | measured_at_cap, closest)
    }

    /// The same, with distances at flat caps that rounding cannot tell from 0 as 0.
    #[inline(always)]
    fn touching(&self, at_cap: T::Mask, closest: Closest<T>) -> Closest<T> {
        let Self { first, second, second_start } = self;
        let points = [first.end, *second_start, *second_start + second.end];
        touching::settle(closest, at_cap, touching::extent(points, first.radius.max(second.radius)))
    }

    /// The closest points of the flat cap around one end of the first link, which has a length, and
    /// the second link. `may` is as in [`closest`](Self::closest).
    #[inline(always)]
    pub(crate) fn closest_to_cap(
        &self,
        centre: Vec3<T>,
        may: impl Fn(T::Mask) -> bool,
    ) -> Closest<T> {
        let everywhere = self.first.radius.le(self.first.radius);
        let closest =
            self.nearer_from_disc(everywhere, centre, self.with_nearest_of_second(centre), may);
        self.touching(everywhere, closest)
    }

    /// The closest points of two flat caps, each around one end of its link. Both are seen from the
    /// first link's start.
    #[inline(always)]
    fn between_caps(&self, centres: [Vec3<T>; 2]) -> Closest<T> {
        let [centre1, centre2] = centres;
        let radii = [self.first.radius, self.second.radius];
        let discs =
            disc_disc::from_centre(radii, [self.first.axis, self.second.axis], centre2 - centre1);
        Closest { point1: discs.point1 + centre1, point2: discs.point2 + centre1, ..discs }
    }

    /// The closest points of two flat caps, as [`closest_to_cap`](Self::closest_to_cap) has them.
    #[inline(always)]
    pub(crate) fn closest_caps(&self, centres: [Vec3<T>; 2]) -> Closest<T> {
        let everywhere = self.first.radius.le(self.first.radius);
        self.touching(everywhere, self.between_caps(centres))
    }

    /// Cases 3 and 4 where the mask is true, with the disc of the first link around `centre`, if
    /// they are nearer than what is known.
    #[inline(always)]
    fn nearer_from_disc(
        &self,
        at_flat: T::Mask,
        centre: Vec3<T>,
        closest: Closest<T>,
        may: impl Fn(T::Mask) -> bool,
    ) -> Closest<T> {
        let Self { first, second, second_start } = self;
        if !may(at_flat) {
            return closest;
        }
        let axis = [*second_start - centre, *second_start + second.end - centre];
        let on_disc = Convex::segment_disc(axis, first.axis, first.radius).point2 + centre;
        let closest = nearer_where(at_flat, closest, self.with_nearest_of_second(on_disc));
        let second_ends = second.flat_ends_facing(on_disc - *second_start);
        let both = at_flat & second_ends.any();
        if !may(both) {
            return closest;
        }
        let discs = self.between_caps([centre, *second_start + second_ends.centre(second)]);
        nearer_where(both, closest, discs)
    }

    /// A point of the first link, and the second link's nearest to it.
    #[inline(always)]
    fn with_nearest_of_second(&self, point1: Vec3<T>) -> Closest<T> {
        let (distance, on_second) = self.second.closest_to(point1 - self.second_start);
        Closest { distance, point1, point2: self.second_start + on_second }
    }
}

/// The nearer of two answers; the first where the mask is false.
#[inline(always)]
fn nearer_where<T: Scalar>(mask: T::Mask, closest: Closest<T>, other: Closest<T>) -> Closest<T> {
    Closest::select(mask & other.distance.lt(closest.distance), other, closest)
}

/// Which flat end of a link is the place on its axis that is closest to a point, if that is at a
/// flat end.
#[derive(Clone, Copy)]
struct FlatEnds<T: Scalar> {
    at_start: T::Mask,
    at_end: T::Mask,
}

impl<T: Scalar> FlatEnds<T> {
    #[inline(always)]
    fn any(self) -> T::Mask {
        self.at_start | self.at_end
    }

    /// The end's place on the link, seen from its start.
    #[inline(always)]
    fn centre(self, link: &Link<T>) -> Vec3<T> {
        Vec3::select(self.at_end, link.end, Vec3::zero(link.radius))
    }

    /// The other ends where the mask is true.
    #[inline(always)]
    fn unless(self, mask: T::Mask, other: Self) -> Self {
        Self {
            at_start: (mask & other.at_start) | (!mask & self.at_start),
            at_end: (mask & other.at_end) | (!mask & self.at_end),
        }
    }
}

impl<T: Scalar> Link<T> {
    #[inline(always)]
    fn flat_ends_facing(&self, point: Vec3<T>) -> FlatEnds<T> {
        let zero = self.radius.zero();
        let has_axis = zero.lt(self.axis.norm_squared());
        let at_end = has_axis & self.flat[1] & zero.le((point - self.end).dot(self.axis));
        let at_start = has_axis & self.flat[0] & point.dot(self.axis).le(zero) & !at_end;
        FlatEnds { at_start, at_end }
    }
}
