//! The local minima of the distance over pairs of links: one place per pair of approaching parts.
//!
//! # Definitions
//! - **Cell**: a pair of links within the margin. The cells form a grid: one row per link of the
//!   first robot, one column per link of the second.
//! - **Neighbours** of a cell: one link further along either robot, or along both.
//! - **Group**: connected cells of equal distance, such as cells that overlap.
//!
//! # Rule
//! A group is one place, at its lowest links, if no neighbour of any of its cells is nearer.
//!
//! # Algorithm
//! 1. The rows come in order, some at a time ([`end_rows`](PairMinima::end_rows)).
//! 2. A cell is compared with the cell before it in its row and with its three neighbours in the
//!    row before. So each pair of neighbours is compared once.
//! 3. Only the last row and the groups with a cell in it are kept: no other group can change.

use parry3d_f64::math::Real;

/// A pair of links within the margin.
#[derive(Clone, Copy, Debug)]
struct Cell {
    links: [usize; 2],
    distance: Real,
    /// The number of its group, which may have been joined to another since.
    group: usize,
}

/// Connected cells of equal distance.
#[derive(Clone, Copy, Debug)]
struct Group {
    /// The group that it was joined to, or itself.
    leader: usize,
    /// Its lowest links.
    links: [usize; 2],
    /// Whether some neighbour is nearer.
    descends: bool,
    /// Its number among the kept groups, if it is kept.
    kept: Option<usize>,
}

/// The state of a search for local minima; a later search reuses the memory.
#[derive(Clone, Debug, Default)]
pub(super) struct PairMinima {
    /// The cells of the rows since the last [`end_rows`](Self::end_rows), in any order.
    cells: Vec<Cell>,
    /// The last row and the row before it, in order.
    row: Vec<Cell>,
    row_before: Vec<Cell>,
    groups: Vec<Group>,
    kept: Vec<Group>,
    places: Vec<[usize; 2]>,
}

impl PairMinima {
    pub fn start(&mut self) {
        self.cells.clear();
        self.row.clear();
        self.groups.clear();
        self.places.clear();
    }

    pub fn push(&mut self, links: [usize; 2], distance: Real) {
        self.cells.push(Cell { links, distance, group: 0 });
    }

    /// Processes the complete rows. All later cells belong to higher rows.
    pub fn end_rows(&mut self) {
        let mut cells = std::mem::take(&mut self.cells);
        cells.sort_unstable_by_key(|cell| cell.links);
        for row in cells.chunk_by(|one, other| one.links[0] == other.links[0]) {
            self.add_row(row);
        }
        cells.clear();
        self.cells = cells;
        self.close_groups();
    }

    /// Returns the links of all places, in order.
    pub fn finish(&mut self) -> &[[usize; 2]] {
        self.end_rows();
        self.row.clear();
        self.close_groups();
        self.places.sort_unstable();
        &self.places
    }

    fn add_row(&mut self, cells: &[Cell]) {
        std::mem::swap(&mut self.row, &mut self.row_before);
        self.row.clear();
        // A row without cells in between separates both rows.
        let follows =
            self.row_before.first().is_some_and(|cell| cell.links[0] + 1 == cells[0].links[0]);
        if !follows {
            self.row_before.clear();
        }
        let mut from = 0;
        for &Cell { links, distance, .. } in cells {
            let group = self.groups.len();
            self.groups.push(Group { leader: group, links, descends: false, kept: None });
            let cell = Cell { links, distance, group };
            let column = links[1];
            while self.row_before.get(from).is_some_and(|cell| cell.links[1] + 1 < column) {
                from += 1;
            }
            let above =
                self.row_before[from..].iter().take_while(|cell| cell.links[1] <= column + 1);
            let left = self.row.last().filter(|cell| cell.links[1] + 1 == column);
            for other in above.chain(left) {
                compare(&mut self.groups, &cell, other);
            }
            self.row.push(cell);
        }
    }

    /// Decides the groups that have no cell in the last row.
    fn close_groups(&mut self) {
        let Self { row, groups, kept, places, .. } = self;
        kept.clear();
        for cell in row {
            let leader = root(groups, cell.group);
            let Group { links, descends, .. } = groups[leader];
            cell.group = *groups[leader].kept.get_or_insert_with(|| {
                kept.push(Group { leader: kept.len(), links, descends, kept: None });
                kept.len() - 1
            });
        }
        let closed = groups.iter().enumerate().filter(|(number, group)| group.leader == *number);
        let closed = closed.filter(|(_, group)| group.kept.is_none() && !group.descends);
        places.extend(closed.map(|(_, group)| group.links));
        std::mem::swap(groups, kept);
    }
}

/// Records which of two neighbours is nearer, or joins their groups.
fn compare(groups: &mut [Group], cell: &Cell, other: &Cell) {
    let [one, two] = [cell, other].map(|cell| root(groups, cell.group));
    if cell.distance < other.distance {
        groups[two].descends = true;
    } else if other.distance < cell.distance {
        groups[one].descends = true;
    } else if one != two {
        let Group { links, descends, .. } = groups[one];
        groups[one].leader = two;
        groups[two].links = groups[two].links.min(links);
        groups[two].descends |= descends;
    }
}

fn root(groups: &mut [Group], mut group: usize) -> usize {
    while groups[group].leader != group {
        groups[group].leader = groups[groups[group].leader].leader;
        group = groups[group].leader;
    }
    group
}

#[cfg(test)]
mod tests {
    use super::*;
    use continuum_testing::Random;

    /// Returns the places of a grid by the rule: flood fill, one group at a time.
    fn flooded(grid: &[Vec<Option<u32>>]) -> Vec<[usize; 2]> {
        let (rows, columns) = (grid.len(), grid[0].len());
        let mut seen = vec![vec![false; columns]; rows];
        let mut places = Vec::new();
        for i in 0..rows {
            for j in 0..columns {
                let Some(distance) = grid[i][j].filter(|_| !seen[i][j]) else { continue };
                let (mut waiting, mut is_least) = (vec![[i, j]], true);
                seen[i][j] = true;
                while let Some([k, l]) = waiting.pop() {
                    for row in k.saturating_sub(1)..(k + 2).min(rows) {
                        for column in l.saturating_sub(1)..(l + 2).min(columns) {
                            let Some(other) = grid[row][column] else { continue };
                            is_least &= other >= distance;
                            if other == distance && !seen[row][column] {
                                seen[row][column] = true;
                                waiting.push([row, column]);
                            }
                        }
                    }
                }
                places.extend(is_least.then_some([i, j]));
            }
        }
        places
    }

    #[test]
    fn places_are_those_of_the_rule_however_rows_are_grouped() {
        let mut random = Random::new(1);
        let (mut minima, mut places, mut wide) = (PairMinima::default(), 0, 0);
        for _ in 0..2000 {
            let [rows, columns] = [0; 2].map(|_| 1 + random.below(9) as usize);
            // Few distinct distances make groups large. Cells, and sometimes whole rows, are
            // missing.
            let (kinds, gaps) = (1 + random.below(5), random.below(4));
            let mut cell = || (random.below(4) >= gaps).then(|| random.below(kinds));
            let grid: Vec<Vec<_>> =
                (0..rows).map(|_| (0..columns).map(|_| cell()).collect()).collect();
            minima.start();
            let most = 1 + random.below(3);
            for (i, row) in grid.iter().enumerate() {
                // Cells of a row come in reverse order.
                for j in (0..columns).rev() {
                    if let Some(distance) = row[j] {
                        minima.push([i, j], f64::from(distance));
                    }
                }
                if random.below(most) == 0 {
                    minima.end_rows();
                    // At most one group per cell of the last row is kept.
                    assert!(minima.groups.len() <= columns && minima.cells.is_empty());
                }
            }
            let expected = flooded(&grid);
            assert_eq!(minima.finish(), expected, "{grid:?}");
            places += expected.len();
            wide += usize::from(expected.len() == 1 && rows * columns > 20);
        }
        assert!(places > 3000 && wide > 50, "{places} {wide}");
    }
}
