//! The distance between two modified cylinders, with any caps.
//!
//! ```text
//!   1. axis, axis      2. axis, disc      3. disc, axis      4. disc, disc
//!    __________         __________         _____              _____
//!   |____p_____|       |____p_____|       |____p             |____p
//!        |                  |                   \                  \
//!    ____|_____           __q__             _____\___              _\_____
//!   |____q_____|         |     |           |______q__|            |q______|
//!                        |     |
//! ```
//!
//! # Definitions
//! - `p`, `q`: the closest points of the first and the second axis. `F`: their distance.
//! - For a link with radius `r` and a convex body `T`: `f` is the distance between the axis and
//!   `T`, and `s` the parameter on the axis that attains it.
//!
//! The head of [`triangle_modified_cylinder`](super::triangle_modified_cylinder) proves two
//! statements about a link and any convex body `T`:
//!
//! - **S.** If `s` is not at a flat end, the distance is `max(0, f - r)`.
//! - **D.** If `s` is at a flat end, the distance is the distance between the disc of that end and
//!   `T`.
//!
//! # Algorithm
//! 1. *Axis and axis.* `q` is not at a flat end of the second link. By S the second link is
//!    `F - r2` from the first axis, attained at `p`. If `p` is not at a flat end either, S gives
//!    `F - r1 - r2`.
//! 2. *Axis and disc.* `q` is at a flat end. By D the distance of the second link from the first
//!    axis is that of this end's disc: segment-disc. If the parameter on the first axis is not at a
//!    flat end, S subtracts `r1`.
//! 3. *Disc and axis.* In case 1 or 2 the parameter on the first axis is at a flat end. By D the
//!    disc of that end replaces the first link. If the parameter on the second axis that is closest
//!    to the disc is not at a flat end, S subtracts `r2`.
//! 4. *Disc and disc.* As case 3, and that parameter is at a flat end. By D the answer is
//!    disc-disc.
//!
//! # Claim
//! The cases cover every pair of links, overlap included.
//!
//! # Proof
//! The second link, the first axis and the first link's discs are convex. So S and D apply to each
//! link in turn. S and D hold in overlap; then the distance is 0 and the points are common.
//!
//! # Rounding
//! - Each case gives a point of one link, and [`Link::closest_to`] gives the other link's nearest
//!   point. So every candidate is a distance between a point of each link. The smallest is right if
//!   any is right.
//! - Rounding may take a parameter to be at a flat end although it is not. This adds a candidate
//!   and drops none. In the opposite case the error is at most the error of the parameter.
//! - Two capsules are always case 1. Their points lie on the segment from `p` to `q`, at the radii.
//!   If `r1 + r2 >= F`, both are one common point.

use super::point_modified_cylinder::Link;
use super::segment_segment::{Parameters, parameters};
use super::{Closest, Convex, DiscSolver, Scalar, Vec3, disc_disc, frame::Frame, touching};

/// Returns the distance between two solid modified cylinders, and the closest points.
///
/// ```text
///       _______________________
///      |                       \
///      o axis1[0] --- axis1[1] o |   radius1, flat1 = [true, false]
///      |___________*___________/
///                  | point1
///                  | distance
///       ___________*___________
///      /         point2        |
///     |  o axis2[0] -- axis2[1] o    radius2, flat2 = [false, true]
///      \_______________________|
/// ```
///
/// - `axis1`, `axis2`: the ends of the axes, in one frame and unit.
/// - `radius1`, `radius2`: in the same unit, at least 0.
/// - `flat1`, `flat2`: whether the cap at each end is flat; a cap that is not flat is round.
///
/// If the links meet, both points are one common point. The caps of a link without a direction
/// count as round: its length is 0, or the square of the length falls below the range beside the
/// problem's extent.
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
    // Transform the axis vector itself: as a difference of two transformed points, a short axis
    // would lose its direction.
    let pair = TwoLinks {
        first: Link::new(frame.point(axis1[1]), frame.length(radius1), flat1),
        second: Link::new(frame.way(axis2[0], axis2[1]), frame.length(radius2), flat2),
        second_start: frame.point(axis2[0]),
    };
    frame.answer(pair.closest(&pair.axes(), |_| true))
}

/// Two links in coordinates relative to the start of the first, scaled near one.
#[derive(Clone, Copy)]
pub(crate) struct TwoLinks<T: Scalar> {
    pub first: Link<T>,
    /// Relative to its own start.
    pub second: Link<T>,
    /// The start of the second link.
    pub second_start: Vec3<T>,
}

impl<T: Scalar> TwoLinks<T> {
    /// Returns the closest parameters of the axes.
    ///
    /// The distance of the axes minus both radii is a lower bound on the distance of the links.
    #[inline(always)]
    pub(crate) fn axes(&self) -> Parameters<T> {
        parameters(-self.second_start, self.first.end, self.second.end)
    }

    /// Returns the closest points of the two links.
    ///
    /// `may(mask)` returns whether `mask` may be true in some lane. A case whose mask is false in
    /// all lanes is skipped, so a constant `true` is always correct.
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

    /// Case 1 for two capsules: both points lie on the segment between the axes.
    #[inline(always)]
    fn closest_of_capsules(&self, axes: &Parameters<T>) -> Closest<T> {
        let Self { first, second, second_start } = self;
        let apart = axes.gap.norm();
        let distance = (apart - first.radius - second.radius).max(apart.zero());
        let share = apart.one().over(apart);
        // In overlap the first point lies in the second link too: its distance from the second axis
        // is F - min(r1, F) <= r2.
        let point1 = (first.end * axes.s).along(axes.gap, -(first.radius.min(apart) * share));
        let outside = second_start.along(second.end, axes.t).along(axes.gap, second.radius * share);
        let point2 = Vec3::select(apart.zero().lt(distance), outside, point1);
        Closest { distance, point1, point2 }
    }

    /// All four cases.
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
        // Rounding may put a point of a cap's plane beyond the cap although the other link's point
        // lies within: measure back from the second point too.
        let (distance, point1) = first.closest_to(closest.point2);
        let back = Closest { distance, point1, point2: closest.point2 };
        let forth = closest;
        let closest = forth.nearer(back);
        let doubtful = touching::is_doubtful(closest.distance);
        if !may(doubtful) {
            return closest;
        }
        // Rounding may also have put a point beyond a flat cap that no case selects.
        let measured_at_cap = first.flat_ends_facing(closest.point2).any()
            | second.flat_ends_facing(forth.point1 - *second_start).any()
            | second.flat_ends_facing(closest.point1 - *second_start).any();
        self.touching(at_flat | first_ends.any() | measured_at_cap, closest)
    }

    /// Sets a distance at a flat cap to 0 if it is within rounding of 0.
    #[inline(always)]
    fn touching(&self, at_cap: T::Mask, closest: Closest<T>) -> Closest<T> {
        let Self { first, second, second_start } = self;
        let points = [first.end, *second_start, *second_start + second.end];
        touching::settle(closest, at_cap, touching::extent(points, first.radius.max(second.radius)))
    }

    /// Returns the closest points of the flat cap around `centre`, an end of the first link, and
    /// the second link.
    ///
    /// The first link must have a length. `may` is as in [`closest`](Self::closest).
    #[cfg(feature = "robots")]
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

    /// Returns the closest points of two flat caps, one of each link. Both centres are relative to
    /// the first link's start.
    #[inline(always)]
    fn between_caps(&self, centres: [Vec3<T>; 2]) -> Closest<T> {
        let [centre1, centre2] = centres;
        let radii = [self.first.radius, self.second.radius];
        let discs =
            disc_disc::from_centre(radii, [self.first.axis, self.second.axis], centre2 - centre1);
        Closest { point1: discs.point1 + centre1, point2: discs.point2 + centre1, ..discs }
    }

    /// Same as [`closest_to_cap`](Self::closest_to_cap), for a flat cap of each link.
    #[cfg(feature = "robots")]
    #[inline(always)]
    pub(crate) fn closest_caps(&self, centres: [Vec3<T>; 2]) -> Closest<T> {
        let everywhere = self.first.radius.le(self.first.radius);
        self.touching(everywhere, self.between_caps(centres))
    }

    /// Cases 3 and 4 with the disc of the first link around `centre`. Replaces `closest` where the
    /// mask is true and the candidate is nearer.
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

    /// Returns a candidate: `point1` of the first link, and the second link's nearest point to it.
    #[inline(always)]
    fn with_nearest_of_second(&self, point1: Vec3<T>) -> Closest<T> {
        let (distance, on_second) = self.second.closest_to(point1 - self.second_start);
        Closest { distance, point1, point2: self.second_start + on_second }
    }
}

/// Returns the nearer of two candidates; `closest` where the mask is false.
#[inline(always)]
fn nearer_where<T: Scalar>(mask: T::Mask, closest: Closest<T>, other: Closest<T>) -> Closest<T> {
    Closest::select(mask & other.distance.lt(closest.distance), other, closest)
}

/// Whether the axis point closest to a given point is at a flat end, and at which one.
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

    /// The centre of that end, relative to the link's start.
    #[inline(always)]
    fn centre(self, link: &Link<T>) -> Vec3<T> {
        Vec3::select(self.at_end, link.end, Vec3::zero(link.radius))
    }

    /// Returns `other` where the mask is true, `self` elsewhere.
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
