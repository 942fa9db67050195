//! VTK's PolyData: points, and the lines, polygons and strips that name them.

use crate::mesh::{Frame, Mesh};
use crate::polygon::Faces;
use std::collections::{HashMap, HashSet};

pub type Point = [f64; 3];

#[derive(Default)]
pub struct PolyData {
    pub points: Vec<Point>,
    pub lines: Vec<Vec<u64>>,
    pub polygons: Vec<Vec<u64>>,
    pub strips: Vec<Vec<u64>>,
    pub frame: Option<Frame>,
}

/// An upper bound on the bytes for each line while lines are joined, beside its points.
pub const JOINING: u64 = 600;

impl PolyData {
    /// Appends another piece of the file.
    pub fn append(&mut self, other: Self) {
        let first = self.points.len() as u64;
        let moved = |cells: Vec<Vec<u64>>| {
            cells.into_iter().map(move |cell| {
                cell.into_iter().map(|point| point.saturating_add(first)).collect()
            })
        };
        self.lines.extend(moved(other.lines));
        self.polygons.extend(moved(other.polygons));
        self.strips.extend(moved(other.strips));
        self.points.extend(other.points);
    }

    /// Returns the lines as points, joined where they meet.
    ///
    /// # Errors
    /// A line names a point that does not exist.
    pub fn into_lines(self) -> Result<Vec<Vec<Point>>, String> {
        let count = self.points.len();
        let index = |point: u64| {
            usize::try_from(point).ok().filter(|&index| index < count).ok_or_else(|| {
                format!("a line names point {point}, but there are {count}, counted from 0")
            })
        };
        let lines: Result<Vec<Vec<_>>, _> =
            self.lines.into_iter().map(|line| line.into_iter().map(index).collect()).collect();
        Ok(join(&lines?, &self.points))
    }

    /// Returns the polygons and strips as triangles.
    ///
    /// # Errors
    /// A polygon has too many vertices, or names a point beyond 32 bits.
    pub fn into_mesh(self) -> Result<Mesh, String> {
        let mut faces = Faces::default();
        let corners = |cell: Vec<u64>| -> Result<Vec<u32>, String> {
            let corner = |point: u64| {
                u32::try_from(point)
                    .map_err(|_| format!("a polygon names point {point}, which is not there"))
            };
            cell.into_iter().map(corner).collect()
        };
        for polygon in self.polygons {
            faces.push(corners(polygon)?);
        }
        for strip in self.strips {
            faces.push_strip(&corners(strip)?);
        }
        let mut mesh = Mesh { vertices: self.points, frame: self.frame, ..Mesh::default() };
        faces.cut(&mut mesh)?;
        Ok(mesh)
    }
}

/// The end of a line: its index, and whether it is the last point.
type End = (usize, bool);

/// Joins lines whose ends meet, in any order, for files in which each cell is one segment.
///
/// 1. Points closer than the resolution of the file ([`Places`]) are one place.
/// 2. A line without length is left out, unless no line has a length. So is a segment that an
///    earlier one repeats, in either direction.
/// 3. A joint is a place where exactly two ends meet, and no other point lies.
/// 4. A line that begins where another one ends continues it.
/// 5. Two lines are joined in either direction if one of them is a segment. Longer lines are not,
///    so that two branches from one place stay two.
/// 6. A joined line has the order and the direction of its first line in the file.
fn join(lines: &[Vec<usize>], points: &[Point]) -> Vec<Vec<Point>> {
    let mut places = Places::of(lines, points);
    // The places of both ends of each line that is kept.
    let mut ends: Vec<Option<[usize; 2]>> = vec![None; lines.len()];
    let mut segments = HashSet::new();
    for (number, line) in lines.iter().enumerate() {
        let (Some(&first), Some(&last)) = (line.first(), line.last()) else { continue };
        let [a, b] = [places.number(points[first]), places.number(points[last])];
        let has_length = a != b || line.iter().any(|&index| places.find(points[index]) != Some(a));
        if has_length && (line.len() > 2 || segments.insert([a.min(b), a.max(b)])) {
            ends[number] = Some([a, b]);
        }
    }
    let is_without_length = ends.iter().all(Option::is_none);
    // The first two ends at each place, and the number of further ends or points there.
    let mut joints = vec![([None; 2], 0_usize); places.count];
    for (number, &own) in ends.iter().enumerate() {
        let Some([first, last]) = own.filter(|[first, last]| first != last) else { continue };
        for (place, end) in [(first, (number, false)), (last, (number, true))] {
            let (meeting, more) = &mut joints[place];
            match meeting.iter_mut().find(|end| end.is_none()) {
                Some(free) => *free = Some(end),
                None => *more += 1,
            }
        }
        // The points between the ends. Points that repeat an end are left out.
        let line = &lines[number];
        let is_at = |&point: &usize, place| places.find(points[point]) == Some(place);
        let from = line.iter().take_while(|point| is_at(point, first)).count();
        let to = line.len() - line.iter().rev().take_while(|point| is_at(point, last)).count();
        for &point in line.get(from..to).unwrap_or_default() {
            if let Some(place) = places.find(points[point]) {
                joints[place].1 += 1;
            }
        }
    }
    let meeting = |end: End| -> Option<End> {
        let place = ends[end.0]?[usize::from(end.1)];
        let ([Some(a), Some(b)], 0) = joints[place] else { return None };
        let is_segment = |(line, _): End| lines[line].len() == 2;
        let is_joint = a.0 != b.0 && (a.1 != b.1 || is_segment(a) || is_segment(b));
        is_joint.then_some(if a == end { b } else { a })
    };
    let mut is_used: Vec<_> =
        ends.iter().map(|ends| ends.is_none() && !is_without_length).collect();
    let mut joined = Vec::new();
    for first in 0..lines.len() {
        if is_used[first] {
            continue;
        }
        // Go back to the start of the joined line, or once around a closed one.
        let mut start = (first, false);
        while let Some((line, is_last)) = meeting(start) {
            start = (line, !is_last);
            if line == first {
                start = (first, false);
                break;
            }
        }
        let mut along = Vec::new();
        let mut next = Some(start);
        while let Some((line, is_last)) = next
            && !is_used[line]
        {
            is_used[line] = true;
            // The first point repeats the last point of the line before.
            let skip = usize::from(!along.is_empty());
            let own = lines[line].iter().map(|&index| points[index]);
            if is_last {
                along.extend(own.rev().skip(skip));
            } else {
                along.extend(own.skip(skip));
            }
            next = meeting((line, !is_last));
        }
        joined.push(along);
    }
    joined
}

/// Numbers for places, such that points that differ only by rounding are at one place.
///
/// # Definitions
/// - `largest`: the largest absolute coordinate of the lines' points.
/// - `step`: the mean over all segments of the largest coordinate difference of their ends.
/// - `width = min(10^-5 largest, step / 1024)`.
///
/// # Claim
/// Let the points be in groups that are at most `width` wide along each axis, and more than
/// `2 width` apart along some axis. Then the points of a group are at one place, and no two groups
/// are.
///
/// # Proof
/// A cell of the grid is `2 width` wide, so it has points of one group only. The first point of a
/// group is stored. Any other point is in the same cell, or in a neighbouring one, where `find`
/// sees the first point and compares the coordinates.
///
/// # Choice
/// - Programs compute the same place twice with different rounding. VTK prints single precision
///   with 6 digits, so the two may be neighbouring numbers of 6 digits, which differ by at most
///   `10^-5 largest`. Numbers in single precision are 100 times finer.
/// - Coordinates far from the origin can be finer than that. `step / 1024` keeps the points of a
///   line apart.
/// - A `width` below the resolution of double precision, `2^-52 largest`, counts as 0: only equal
///   points are at one place.
struct Places {
    width: f64,
    /// The first point in each cell of a grid of cells `2 width` wide, and its number.
    cells: HashMap<[u64; 3], (Point, usize)>,
    count: usize,
}

impl Places {
    fn of(lines: &[Vec<usize>], points: &[Point]) -> Self {
        let used = lines.iter().flatten().flat_map(|&index| points[index]);
        let largest = used.map(f64::abs).filter(|x| x.is_finite()).fold(0.0, f64::max);
        let (mut length, mut count) = (0.0, 0.0);
        for ends in lines.iter().flat_map(|line| line.windows(2)) {
            let [from, to] = [points[ends[0]], points[ends[1]]];
            let differences = [0, 1, 2].map(|axis| (to[axis] - from[axis]).abs());
            length += differences.into_iter().fold(0.0, f64::max);
            count += 1.0;
        }
        let width = (largest * SIX_DIGITS).min(length / count / 1024.0);
        let is_resolved = width >= largest * f64::EPSILON;
        Self { width: if is_resolved { width } else { 0.0 }, cells: HashMap::new(), count: 0 }
    }

    /// Returns the number of the place of a point.
    fn number(&mut self, point: Point) -> usize {
        self.find(point).unwrap_or_else(|| {
            let number = self.count;
            self.count += 1;
            self.cells.insert(bits(self.cell(point)), (point, number));
            number
        })
    }

    /// Returns the number of the place of a point, if it has one.
    fn find(&self, point: Point) -> Option<usize> {
        let own = self.cell(point);
        let at = |cell: [f64; 3]| self.cells.get(&bits(cell));
        if let Some(&(_, number)) = at(own) {
            return Some(number);
        }
        if self.width == 0.0 {
            return None;
        }
        // The other cells within `width`: along each axis the one on the nearer side.
        let side = [0, 1, 2].map(|axis| {
            let is_low = point[axis] / (2.0 * self.width) - own[axis] < 0.5;
            if is_low { -1.0 } else { 1.0 }
        });
        let is_near =
            |other: &Point| (0..3).all(|axis| (point[axis] - other[axis]).abs() <= self.width);
        (1..8).find_map(|choice: usize| {
            let cell = [0, 1, 2]
                .map(|axis| own[axis] + if choice >> axis & 1 == 1 { side[axis] } else { 0.0 });
            at(cell).filter(|(other, _)| is_near(other)).map(|&(_, number)| number)
        })
    }

    /// Returns the cell of a point: three whole numbers, or the point itself if the width is 0.
    fn cell(&self, point: Point) -> [f64; 3] {
        let whole = |x: f64| (x / (2.0 * self.width)).floor();
        if self.width > 0.0 { point.map(whole) } else { point }
    }
}

/// The largest relative difference of neighbouring numbers of 6 digits.
const SIX_DIGITS: f64 = 1e-5;

/// Returns the bits of three numbers. Adding 0 makes -0 and 0 the same.
fn bits(numbers: [f64; 3]) -> [u64; 3] {
    numbers.map(|x| (x + 0.0).to_bits())
}
