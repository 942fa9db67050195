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

/// How many bytes a line takes at most while lines are joined, beside its points.
pub const JOINING: u64 = 400;

impl PolyData {
    /// Adds what another piece of the file has.
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

    /// The lines by their points, joined where they meet.
    ///
    /// # Errors
    /// A line names a point that is not there.
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

    /// The polygons and strips as triangles.
    ///
    /// # Errors
    /// A polygon has too many corners, or names a point beyond 32 bits.
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

/// The end of a line: its number, and whether it is the last point.
type End = (usize, bool);

/// Joins lines whose ends meet, in any order, as where each cell of a file is one segment. A joint
/// is where two ends meet, and nothing else does. A line that begins where another one ends goes on
/// there. Segments that share a point are joined either way around; longer lines are not, so that
/// two branches that begin at one place stay two. Joined lines are in the order and the direction
/// of their first ones in the file.
fn join(lines: &[Vec<usize>], points: &[Point]) -> Vec<Vec<Point>> {
    // Adding 0 makes -0 and 0 the same.
    let key = |index: usize| points[index].map(|x| (x + 0.0).to_bits());
    let index = |(line, is_last): End| {
        let own: &[usize] = &lines[line];
        if is_last { own.last() } else { own.first() }.copied()
    };
    // The first two ends at each place, and how many more things are there.
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
        // Back to where the joined line begins, or once around.
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
            // The first point is the last one of the line before.
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
