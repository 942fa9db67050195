//! Draws four rules for the caps of a chain on three robots (Fig. 7 of the paper):
//! `cargo run --example figure7`.
//!
//! Cylinders leave a gap at every joint, capsules have round ends. Naive caps, round inside and
//! flat at both ends, are right only while links are longer than the radius and the radius does not
//! change; otherwise caps stick out. Algorithm 1 (`Chain::from_centreline`) fits the caps: round
//! only where they stay inside.

use clap::Parser;
use continuum_demo::canvas::{Align, Canvas, Colour, hex};
use continuum_demo::command;
use continuum_demo::picture::{Camera, Picture, Solid};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::SharedShape;
use parry_continuum::{Cap, Chain, ModifiedCylinder, RobotError};
use rayon::prelude::*;
use std::path::PathBuf;
use std::process::ExitCode;

/// Draw four rules for the caps of a chain.
#[derive(Parser)]
struct Options {
    /// Where to save the picture: a directory, or a file that ends in .png
    #[arg(long, value_name = "PATH", default_value = "target/figure7.png")]
    out: PathBuf,
}

const INK: Colour = hex(0x22303c);
const PALE: Colour = hex(0x5d6b75);
const PAPER: Colour = hex(0xf3f5f6);
/// A dark vermilion and bluish green, which colour-blind readers tell apart (Okabe and Ito).
const WRONG: Colour = hex(0xa63200);
const RIGHT: Colour = hex(0x009e73);
/// Links alternate in colour, so that neighbours differ. In grey, both are lighter than [`WRONG`].
const LINKS: [Colour; 2] = [hex(0x7db0d0), hex(0xcbe0ec)];

/// A rule: how it caps a chain.
struct Rule {
    name: &'static str,
    remark: &'static str,
    links: fn(&Curve) -> Result<Vec<ModifiedCylinder>, RobotError>,
}

const RULES: [Rule; 4] = [
    Rule { name: "cylinders", remark: "flat everywhere", links: Curve::cylinders },
    Rule { name: "capsules", remark: "round everywhere", links: Curve::capsules },
    Rule { name: "naive caps", remark: "flat at both ends, round inside", links: Curve::naive },
    Rule { name: "fitted caps", remark: "round where it stays inside", links: Curve::fitted },
];

/// One rule on one robot.
struct Panel {
    links: Vec<ModifiedCylinder>,
    fitted: Vec<ModifiedCylinder>,
}

impl Panel {
    fn is_right(&self) -> bool {
        self.links.iter().zip(&self.fitted).all(|(link, fitted)| link.caps() == fitted.caps())
    }

    /// The links, and in the colour of mistakes each cap that sticks out or is missing.
    fn solids(&self, pose: &Pose) -> Result<Vec<Solid>, RobotError> {
        let (mut solids, mut mistakes) = (Vec::new(), Vec::new());
        for (index, (link, fitted)) in self.links.iter().zip(&self.fitted).enumerate() {
            let capped = |caps| -> Result<SharedShape, RobotError> {
                let ends = [link.start(), link.end()];
                let link = ModifiedCylinder::new(ends[0], ends[1], link.radius(), caps)?;
                Ok(SharedShape::new(link))
            };
            let (own, fitted) = (link.caps(), fitted.caps());
            // Flat where the two differ, and round there.
            let flat = [0, 1].map(|end| if own[end] == fitted[end] { own[end] } else { Cap::Flat });
            let round =
                [0, 1].map(|end| if own[end] == fitted[end] { own[end] } else { Cap::Round });
            solids.push(Solid::new(capped(flat)?, *pose, LINKS[index % 2], false));
            if own != fitted {
                mistakes.push(Solid::new(capped(round)?, *pose, WRONG, false));
            }
        }
        // Where two surfaces coincide the first one shows.
        solids.extend(mistakes);
        Ok(solids)
    }
}

/// A centreline on a circle of the given radius, one segment per tube radius.
struct Curve {
    points: Vec<Vector>,
    radii: Vec<Real>,
}

impl Curve {
    fn new(bend: Real, spacing: Real, radii: &[Real]) -> Self {
        let point = |k: usize| {
            let angle = k as Real * spacing / bend;
            Vector::new(bend * angle.sin(), bend * (angle.cos() - 1.0), 0.0)
        };
        Self { points: (0..=radii.len()).map(point).collect(), radii: radii.to_vec() }
    }

    /// Round caps inside and flat caps at both ends, for all lengths and radii.
    fn naive(&self) -> Result<Vec<ModifiedCylinder>, RobotError> {
        let last = self.radii.len() - 1;
        let cap = |is_end| if is_end { Cap::Flat } else { Cap::Round };
        let link = |k: usize| {
            let caps = [cap(k == 0), cap(k == last)];
            ModifiedCylinder::new(self.points[k], self.points[k + 1], self.radii[k], caps)
        };
        (0..=last).map(link).collect()
    }

    fn cylinders(&self) -> Result<Vec<ModifiedCylinder>, RobotError> {
        Ok(Chain::cylinders(&self.points, &self.radii)?.links().to_vec())
    }

    fn capsules(&self) -> Result<Vec<ModifiedCylinder>, RobotError> {
        Ok(Chain::capsules(&self.points, &self.radii)?.links().to_vec())
    }

    fn fitted(&self) -> Result<Vec<ModifiedCylinder>, RobotError> {
        Ok(Chain::from_centreline(&self.points, &self.radii)?.links().to_vec())
    }
}

/// A robot, and what is said about it.
struct Row {
    name: &'static str,
    remark: &'static str,
    panels: [Panel; 4],
}

fn rows() -> Result<[Row; 3], RobotError> {
    let row = |name, remark, curve: Curve| -> Result<Row, RobotError> {
        let panel = |rule: &Rule| -> Result<Panel, RobotError> {
            Ok(Panel { links: (rule.links)(&curve)?, fitted: curve.fitted()? })
        };
        let [a, b, c, d] = RULES.each_ref().map(panel);
        Ok(Row { name, remark, panels: [a?, b?, c?, d?] })
    };
    let tubes = [1.5, 1.5, 1.5, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5];
    Ok([
        row("long links", "1.5 radii each", Curve::new(3.6, 1.5, &[1.0; 4]))?,
        row("short links", "0.4 radii each", Curve::new(2.6, 0.4, &[1.0; 9]))?,
        row("three tubes", "three links each", Curve::new(6.0, 1.0, &tubes))?,
    ])
}

const CARD: [usize; 2] = [400, 300];
const GAP: usize = 24;
/// Left of the cards, for the names of the robots.
const SIDE: usize = 210;
/// Above the cards, for the title and the names of the rules.
const HEAD: usize = 256;

fn main() -> ExitCode {
    command::run(|options: &Options| {
        let out = command::picture_path(&options.out, "figure7.png")?;
        let canvas = rows().and_then(|rows| draw(&rows)).map_err(|error| error.to_string())?;
        canvas.save(&out).map_err(|error| command::unwritable(&out, error))?;
        println!("picture: {}", out.display());
        Ok(())
    })
}

fn draw(rows: &[Row]) -> Result<Canvas, RobotError> {
    let (width, height) = (SIDE + 4 * (CARD[0] + GAP), HEAD + rows.len() * (CARD[1] + GAP));
    let mut canvas = Canvas::new(width, height, |_, _| PAPER);
    let left = 30.0;
    canvas.text(
        "Only fitted caps give the shape of every robot",
        [left, 62.0],
        Align::Left,
        32.0,
        INK,
    );
    canvas.panel([left, 93.0, left + 22.0, 115.0], 4.0, WRONG, 1.0);
    canvas.text("wrong: sticks out, or is missing", [left + 38.0, 112.0], Align::Left, 19.0, INK);
    let at =
        |column: usize, row: usize| [SIDE + column * (CARD[0] + GAP), HEAD + row * (CARD[1] + GAP)];
    for (column, rule) in RULES.iter().enumerate() {
        let x = at(column, 0)[0] as f32;
        canvas.text(rule.name, [x, HEAD as f32 - 58.0], Align::Left, 24.0, INK);
        canvas.text(rule.remark, [x, HEAD as f32 - 22.0], Align::Left, 17.0, PALE);
    }
    let pictures: Vec<_> = rows.par_iter().map(render).collect::<Result<_, _>>()?;
    for (index, (row, pictures)) in rows.iter().zip(&pictures).enumerate() {
        let middle = (HEAD + index * (CARD[1] + GAP) + CARD[1] / 2) as f32;
        canvas.text(row.name, [left, middle], Align::Left, 20.0, INK);
        canvas.text(row.remark, [left, middle + 34.0], Align::Left, 16.0, PALE);
        for (column, (panel, picture)) in row.panels.iter().zip(pictures).enumerate() {
            let corner = at(column, index);
            canvas.paste(picture, corner, 16.0);
            verdict(&mut canvas, panel.is_right(), corner.map(|x| x as f32));
        }
    }
    Ok(canvas)
}

/// A tick or a cross in the corner of a card.
fn verdict(canvas: &mut Canvas, is_right: bool, [x, y]: [f32; 2]) {
    let (x, y) = (x + 22.0, y + 22.0);
    let (lines, colour) = if is_right {
        (vec![vec![[x, y + 16.0], [x + 11.0, y + 28.0], [x + 32.0, y]]], RIGHT)
    } else {
        let cross = vec![vec![[x, y], [x + 26.0, y + 26.0]], vec![[x, y + 26.0], [x + 26.0, y]]];
        (cross, WRONG)
    };
    canvas.stroke(&lines, 7.0, colour, 1.0);
}

/// Draws the robot by each rule, all from the same place.
fn render(row: &Row) -> Result<Vec<Canvas>, RobotError> {
    // The chord lies flat, and the proximal end face is visible.
    let all = || row.panels.iter().flat_map(|panel| &panel.links);
    let links = &row.panels[0].links;
    let chord = (links[links.len() - 1].end() - links[0].start()).normalize();
    let pose = Pose::from_rotation(Rot3::from_rotation_arc(chord, Vector::X));
    let outline: Vec<_> = all().flat_map(|link| link.transformed(&pose).to_trimesh(24).0).collect();
    let towards = Vector::new(0.75, 0.12, -1.0);
    let aspect = CARD[0] as Real / CARD[1] as Real;
    let camera = Camera::framing(&outline, towards, Vector::Y, aspect, 0.07);
    let draw = |panel: &Panel| {
        let mut picture = Picture::new(None, panel.solids(&pose)?);
        picture.sky = [[1.0; 3], [1.0; 3]];
        Ok(picture.render(&camera, CARD[0], CARD[1]))
    };
    row.panels.iter().map(draw).collect()
}
