//! VTK's PolyData: points, and the lines, polygons and strips that name them.

use crate::mesh::{Frame, Mesh};
use crate::polygon::Faces;
use std::collections::HashMap;

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
pub const JOINING: u64 = 400;

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
/// 1. A joint is a place where exactly two ends meet, and no other point lies.
/// 2. A line that begins where another one ends continues it.
/// 3. Two lines that share a point are joined in either direction if one of them is a segment.
///    Longer lines are not, so that two branches from one place stay two.
/// 4. A joined line has the order and the direction of its first line in the file.
fn join(lines: &[Vec<usize>], points: &[Point]) -> Vec<Vec<Point>> {
    // Adding 0 makes -0 and 0 the same.
    let key = |index: usize| points[index].map(|x| (x + 0.0).to_bits());
    let index = |(line, is_last): End| {
        let own: &[usize] = &lines[line];
        if is_last { own.last() } else { own.first() }.copied()
    };
    // The first two ends at each place, and the number of further ends or points there.
    let mut places: HashMap<[u64; 3], ([Option<End>; 2], usize)> = HashMap::new();
    for number in 0..lines.len() {
        let [Some(first), Some(last)] = [index((number, false)), index((number, true))] else {
            continue;
        };
        if key(first) == key(last) {
            continue;
        }
        for (point, end) in [(first, (number, false)), (last, (number, true))] {
            let (ends, more) = places.entry(key(point)).or_default();
            match ends.iter_mut().find(|end| end.is_none()) {
                Some(free) => *free = Some(end),
                None => *more += 1,
            }
        }
    }
    for line in lines {
        for &point in line.iter().skip(1).take(line.len().saturating_sub(2)) {
            if let Some((_, more)) = places.get_mut(&key(point)) {
                *more += 1;
            }
        }
    }
    let meeting = |end: End| -> Option<End> {
        let ([Some(a), Some(b)], 0) = *places.get(&key(index(end)?))? else { return None };
        let is_segment = |(line, _): End| lines[line].len() == 2;
        let shares_point = index(a) == index(b) && (is_segment(a) || is_segment(b));
        (a.0 != b.0 && (a.1 != b.1 || shares_point)).then_some(if a == end { b } else { a })
    };
    let mut is_used = vec![false; lines.len()];
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
