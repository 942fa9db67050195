//! The picture of a way: the shapes at its start and at its goal, and thin ones between them, cut open in front of them.

use super::edges::{Edges, Place, text};
use continuum_demo::canvas::{Align, Canvas, Colour, hex, mix};
use continuum_demo::figure::ruler;
use continuum_demo::picture::{Camera, Picture, SKY, Skin, Solid};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::parry::shape::{SharedShape, TriMesh};

const INK: Colour = hex(0x22303c);
const PALE: Colour = hex(0x66757f);
/// Of the shapes, from the first to the last: they differ in lightness, so that they do in grey, too.
const FIRST: Colour = hex(0xffe08a);
const LAST: Colour = hex(0x16324f);
const SIZE: [usize; 2] = [1200, 900];
/// How high the head and the foot of the picture are.
const HEAD: f32 = 96.0;
const FOOT: f32 = 72.0;

/// How far the tip moves from one shape to the next, mm, and how long their links are about.
const APART: Real = 8.0;
const LINK: Real = 1.0;

/// How thick the shapes between start and goal are drawn, so that they stay apart.
const THIN: Real = 0.3;

/// Draws the way through what is called `name`.
pub fn draw(mesh: &TriMesh, name: &str, edges: &Edges, path: &[Place]) -> Result<Canvas, String> {
    let (mut chains, mut moved) = (Vec::new(), APART);
    for (number, ends) in path.windows(2).enumerate() {
        let motion = edges.motion(&ends[0], &ends[1])?;
        let is_last = number + 2 == path.len();
        let mut tip = motion.tip(0.0);
        for k in 0..=100 {
            let t = Real::from(k) / 100.0;
            moved += (motion.tip(t) - tip).length();
            tip = motion.tip(t);
            if moved >= APART || is_last && k == 100 {
                moved = 0.0;
                let joints = motion.joints(t);
                let links = (edges.robot.length(&joints) / LINK).ceil() as usize;
                let mut line = edges.robot.centreline(&joints, links);
                if !(chains.is_empty() || is_last && k == 100) {
                    line.radii.iter_mut().for_each(|radius| *radius *= THIN);
                }
                chains.push(Chain::from_centreline(&line.points, &line.radii).map_err(text)?);
            }
        }
    }
    let last = chains.len() - 1;
    let ends = |chain: &Chain| -> Vec<Vector> {
        chain.links().iter().flat_map(|link| [edges.base * link.start(), edges.base * link.end()]).collect()
    };
    let places: Vec<_> = chains.iter().flat_map(ends).collect();
    let shade = |share: Real| mix(FIRST, LAST, share as f32);
    let solids = chains.iter().enumerate().rev().flat_map(|(k, chain)| {
        let (base, colour) = (edges.base, shade(k as Real / last.max(1) as Real));
        // The last shape alone darkens the wall near it.
        let solid = move |link| Solid::new(SharedShape::new(link), base, colour, k == last);
        chain.links().iter().copied().map(solid)
    });
    let mut picture = Picture::new(Some(mesh), solids.collect());
    // Folds of the wall between the eye and the robot let it show through.
    picture.skin = Skin { near: 0.0, rim: 0.4, glint: 0.05, far: 0.85, edges: [0.03, 0.22], veil: 0.25 };

    let side = if edges.base.translation.x < mesh.local_aabb().center().x { 1.0 } else { -1.0 };
    let towards = Vector::new(side, -0.55, -0.32);
    let aspect = SIZE[0] as Real / SIZE[1] as Real;
    let mut camera = Camera::framing(&places, towards, Vector::Z, aspect, 0.16);
    let depths = places.iter().map(|&p| (p - camera.eye).dot(camera.forward) - 2.0);
    camera.cut = depths.fold(Real::INFINITY, Real::min).max(0.0);
    let mut canvas = picture.render(&camera, SIZE[0], SIZE[1]);

    for (chain, label) in [(&chains[0], "start"), (&chains[last], "goal")] {
        if let Some(link) = chain.links().last() {
            let [x, y] = camera.place(edges.base * link.end(), SIZE);
            canvas.frame([x - 16.0, y - 16.0, x + 16.0, y + 16.0], 16.0, 3.0, INK);
            let width = 15.0 * label.len() as f32;
            canvas.panel([x + 22.0, y - 17.0, x + 34.0 + width, y + 15.0], 6.0, SKY[0], 0.85);
            canvas.text(label, [x + 28.0, y + 6.0], Align::Left, 17.0, INK);
        }
    }
    let [right, bottom] = SIZE.map(|size| size as f32);
    canvas.panel([0.0, 0.0, right, HEAD], 0.0, SKY[0], 0.8);
    let title = format!("A way into {name}, proven at every moment");
    canvas.text(&title, [40.0, 48.0], Align::Left, 23.0, INK);
    let note = format!(
        "{} edges, each proven to keep {} mm from the wall; a shape whenever the tip has moved {APART} mm",
        path.len() - 1,
        edges.margin
    );
    canvas.text(&note, [40.0, 80.0], Align::Left, 14.0, PALE);
    canvas.panel([0.0, bottom - FOOT, right, bottom], 0.0, SKY[0], 0.8);
    let middle = places.iter().sum::<Vector>() / places.len() as Real;
    ruler(&mut canvas, &camera, middle, SIZE, [40.0, bottom - 32.0]);
    legend(&mut canvas, [0.36 * right, bottom - 46.0], shade);
    Ok(canvas)
}

/// What the colours and the thickness of shapes mean.
fn legend(canvas: &mut Canvas, [x, y]: [f32; 2], shade: impl Fn(Real) -> Colour) {
    canvas.text("start", [x - 12.0, y + 21.0], Align::Right, 15.0, INK);
    for column in 0..200_u8 {
        let left = x + f32::from(column);
        canvas.panel([left, y, left + 1.0, y + 26.0], 0.0, shade(Real::from(column) / 199.0), 1.0);
    }
    canvas.frame([x, y, x + 200.0, y + 26.0], 0.0, 1.5, INK);
    canvas.text("goal", [x + 212.0, y + 21.0], Align::Left, 15.0, INK);
    let note = "thin: on the way";
    canvas.text(note, [x + 300.0, y + 21.0], Align::Left, 15.0, PALE);
}
