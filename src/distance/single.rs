//! The narrow phase of single numbers, compiled once.
//!
//! The kernels are inlined everywhere, because packs need the instruction set of their caller. A
//! single number does not: these functions give the same bits, and each is compiled once for `f64`
//! and once for [`DoubleDouble`](super::DoubleDouble), not once for each caller.

use super::frame::Frame;
use super::segment_segment::Parameters;
use super::{Axial, Closest, Face, Link, Scalar, TwoLinks, Vec3};

/// [`Axial::new`].
#[inline(never)]
pub(crate) fn axial<T: Scalar<Mask = bool>>(link: &Link<T>, face: &Face<T>) -> Axial<T> {
    Axial::new(link, face)
}

/// [`Axial::with_caps`].
#[inline(never)]
pub(crate) fn with_caps<T: Scalar<Mask = bool>>(
    axial: &Axial<T>,
    link: &Link<T>,
    face: &Face<T>,
) -> Closest<T> {
    axial.with_caps(link, face)
}

/// [`triangle_modified_cylinder`](super::triangle_modified_cylinder).
pub(crate) fn triangle_link<T: Scalar<Mask = bool>>(
    triangle: [Vec3<T>; 3],
    start: Vec3<T>,
    end: Vec3<T>,
    radius: T,
    flat: [bool; 2],
) -> Closest<T> {
    let [a, b, c] = triangle;
    let frame = Frame::around(start, [end, a, b, c], radius);
    let face = Face::new(triangle.map(|vertex| frame.point(vertex)));
    let link = Link::new(frame.point(end), frame.length(radius), flat);
    frame.answer(with_caps(&axial(&link, &face), &link, &face))
}

/// [`TwoLinks::closest`].
#[inline(never)]
pub(crate) fn two_links<T: Scalar<Mask = bool>>(
    pair: &TwoLinks<T>,
    axes: &Parameters<T>,
) -> Closest<T> {
    pair.closest(axes, |mask| mask)
}
