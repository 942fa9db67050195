//! Draws the seven ways to cap a chain (Fig. 7 of the paper): `cargo run --release --example
//! figure7`.
//!
//! Cylinders leave a gap at every joint, capsules have round ends. Round caps inside and flat ones
//! at both ends are right only while segments are longer than the radius and the radius does not
//! change; otherwise caps stick out. Algorithm 1 (`Chain::from_centreline`) places round caps only
//! where they stay inside.

use clap::Parser;
use continuum_demo::canvas::{Align, Canvas, Colour, hex, mix};
use continuum_demo::command;
use continuum_demo::picture::{Camera, Picture, Solid};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::SharedShape;
use parry_continuum::{Cap, Chain, ModifiedCylinder, RobotError};
use rayon::prelude::*;
use std::path::PathBuf;
use std::process::ExitCode;

/// Draw the seven ways to cap a chain.
#[derive(Parser)]
struct Options {
    /// Where to save the picture: a directory, or a file that ends in .png
    #[arg(long, value_name = "PATH", default_value = "target/figure7.png")]
    out: PathBuf,
}

const INK: Colour = hex(0x22303c);
const PALE: Colour = hex(0x5d6b75);
const PAPER: Colour = hex(0xf3f5f6);
/// Vermilion and bluish green, which colour-blind readers tell apart (Okabe and Ito).
const INADEQUATE: Colour = hex(0xd55e00);
const ADEQUATE: Colour = hex(0x009e73);
/// Links alternate in colour, so that neighbours differ.
const LINKS: [Colour; 2] = [hex(0x3f7fa8), hex(0x9cc4da)];

/// One way to cap a chain.
struct Panel {
    letter: char,
    title: &'static str,
    remark: &'static str,
    adequate: bool,
    links: Vec<ModifiedCylinder>,
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

    fn algorithm_1(&self) -> Result<Vec<ModifiedCylinder>, RobotError> {
        Ok(Chain::from_centreline(&self.points, &self.radii)?.links().to_vec())
    }
}

fn panels() -> Result<Vec<Panel>, RobotError> {
    let long = Curve::new(3.6, 1.5, &[1.0; 4]);
    let short = Curve::new(2.6, 0.4, &[1.0; 9]);
    let tubes = Curve::new(6.0, 1.0, &[1.5, 1.5, 1.5, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5]);
    let panel =
        |letter, title, remark, adequate, links| Panel { letter, title, remark, adequate, links };
    Ok(vec![
        panel('a', "cylinders", "a gap at every joint", false, long.cylinders()?),
        panel('b', "capsules", "longer by a radius at both ends", false, long.capsules()?),
        panel('c', "flat ends, short links", "inner round caps stick out", false, short.naive()?),
        panel(
            'd',
            "flat ends, three tubes",
            "round caps stick out at steps",
            false,
            tubes.naive()?,
        ),
        panel('e', "flat ends, long links", "closed, and flat where it ends", true, long.naive()?),
        panel(
            'f',
            "fitted caps, short links",
            "round only where it stays inside",
            true,
            short.algorithm_1()?,
        ),
        panel('g', "fitted caps, three tubes", "flat at each step", true, tubes.algorithm_1()?),
    ])
}

const CARD: [usize; 2] = [460, 470];
const VIEW: [usize; 2] = [440, 330];
const GAP: usize = 24;
const HEAD: usize = 120;

fn main() -> ExitCode {
    command::run(|options: &Options| {
        let out = command::picture_path(&options.out, "figure7.png")?;
        let panels = panels().map_err(|error| error.to_string())?;
        draw(&panels).save(&out).map_err(|error| command::unwritable(&out, error))?;
        println!("picture: {}", out.display());
        Ok(())
    })
}

fn draw(panels: &[Panel]) -> Canvas {
    let width = 4 * CARD[0] + 5 * GAP;
    let height = HEAD + 2 * CARD[1] + 2 * GAP;
    let mut canvas = Canvas::new(width, height, |_, _| PAPER);
    canvas.text("Seven ways to cap a chain", [GAP as f32 + 6.0, 64.0], Align::Left, 30.0, INK);
    let pictures: Vec<Canvas> = panels.par_iter().map(render).collect();
    for (index, (panel, picture)) in panels.iter().zip(&pictures).enumerate() {
        // Four that are not adequate above, three that are below.
        let (row, column) = (index / 4, index % 4);
        let left = GAP + column * (CARD[0] + GAP);
        let top = HEAD + row * (CARD[1] + GAP);
        let [x, y] = [left as f32, top as f32];
        let card = [x, y, x + CARD[0] as f32, y + CARD[1] as f32];
        canvas.panel(card, 16.0, [1.0; 3], 1.0);
        canvas.paste(picture, [left + 10, top + 12], 0.0);
        let verdict = if panel.adequate { ADEQUATE } else { INADEQUATE };
        canvas.frame(card, 16.0, 3.0, mix(verdict, [1.0; 3], 0.45));
        let foot = y + CARD[1] as f32;
        canvas.panel([x + 24.0, foot - 96.0, x + 74.0, foot - 46.0], 25.0, verdict, 1.0);
        canvas.text(
            &panel.letter.to_string(),
            [x + 49.0, foot - 63.0],
            Align::Centre,
            22.0,
            [1.0; 3],
        );
        canvas.text(panel.title, [x + 92.0, foot - 74.0], Align::Left, 19.0, INK);
        canvas.text(panel.remark, [x + 92.0, foot - 36.0], Align::Left, 16.5, PALE);
    }
    let [x, y] = [(GAP + 3 * (CARD[0] + GAP) + 30) as f32, (HEAD + CARD[1] + GAP + 150) as f32];
    let legend = [
        (INADEQUATE, ["a to d: not the robot's shape,", "for the reason that is named"]),
        (ADEQUATE, ["e to g: the robot's shape,", "as fitted caps make it"]),
    ];
    for (row, (verdict, lines)) in legend.into_iter().enumerate() {
        let y = y - 60.0 + 92.0 * row as f32;
        canvas.panel([x, y, x + 22.0, y + 22.0], 11.0, verdict, 1.0);
        for (line, text) in lines.into_iter().enumerate() {
            canvas.text(text, [x + 38.0, y + 18.0 + 32.0 * line as f32], Align::Left, 17.0, INK);
        }
    }
    canvas.text("radius 1; of three tubes 1.5, 1 and 0.5", [x, y + 150.0], Align::Left, 16.5, PALE);
    canvas.text("links 1.5 long, short ones 0.4,", [x, y + 182.0], Align::Left, 16.5, PALE);
    canvas.text("of three tubes 1", [x, y + 214.0], Align::Left, 16.5, PALE);
    canvas
}

fn render(panel: &Panel) -> Canvas {
    // Its chord lies flat, and its proximal end face is visible.
    let (first, last) = (panel.links[0], panel.links[panel.links.len() - 1]);
    let chord = (last.end() - first.start()).normalize();
    let pose = Pose::from_rotation(Rot3::from_rotation_arc(chord, Vector::X));
    let solid = |(index, link): (usize, &ModifiedCylinder)| {
        Solid::new(SharedShape::new(*link), pose, LINKS[index % 2], false)
    };
    let mut picture = Picture::new(None, panel.links.iter().enumerate().map(solid).collect());
    picture.sky = [[1.0; 3], [1.0; 3]];
    let outline = panel.links.iter().flat_map(|link| link.transformed(&pose).to_trimesh(24).0);
    let towards = Vector::new(0.75, 0.12, -1.0);
    let aspect = VIEW[0] as Real / VIEW[1] as Real;
    let camera = Camera::framing(&outline.collect::<Vec<_>>(), towards, Vector::Y, aspect, 0.07);
    picture.render(&camera, VIEW[0], VIEW[1])
}
