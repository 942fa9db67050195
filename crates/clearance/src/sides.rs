//! The sides of a robot's links, in words.

use parry_continuum::proximity::Side;

/// The sides of a robot: of its base, of its tip, and of each link.
pub struct Sides {
    pub base: Side,
    pub tip: Side,
    pub links: Vec<Side>,
}

impl Sides {
    /// Returns whether every link is inside.
    pub fn is_inside(&self) -> bool {
        self.links.iter().all(|side| *side == Side::Inside)
    }

    /// Returns whether the whole robot is on the side of its base.
    pub fn is_one(&self) -> bool {
        self.tip == self.base && self.links.iter().all(|side| *side == self.base)
    }

    /// Names the side of the base, and the side of the tip if it is another one.
    pub fn ends(&self) -> String {
        let tip = if self.tip == self.base {
            String::new()
        } else {
            format!(", tip {}", place(self.tip))
        };
        format!("base {}{tip}", place(self.base))
    }

    /// Names the side of each link, equal neighbours together.
    pub fn of_links(&self) -> String {
        let mut first = 0;
        let mut runs = Vec::new();
        for run in self.links.chunk_by(|one, other| one == other) {
            let last = first + run.len() - 1;
            let links = if first == last {
                format!("link {first}")
            } else {
                format!("links {first} to {last}")
            };
            let why = match run[0] {
                Side::Undecided => " (on the mesh or in an opening)",
                _ => "",
            };
            runs.push(format!("{links} {}{why}", name(run[0])));
            first = last + 1;
        }
        runs.join(", ")
    }
}

/// Names a side in one word.
pub fn name(side: Side) -> &'static str {
    match side {
        Side::Inside => "inside",
        Side::Outside => "outside",
        Side::Undecided => "undecided",
    }
}

/// Names the side of a point.
pub fn place(side: Side) -> &'static str {
    match side {
        Side::Inside => "inside the mesh",
        Side::Outside => "outside the mesh",
        Side::Undecided => "on the mesh, or the mesh is open there",
    }
}
