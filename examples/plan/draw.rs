//! The picture of a way: the shapes that the robot takes, from pale to dark, cut open in front of them.

use super::edges::{Edges, Place, text};
use continuum_demo::canvas::{Align, Canvas, Colour, hex, mix};
use continuum_demo::picture::{Camera, Picture, SKY, Skin, Solid};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::parry::shape::{SharedShape, TriMesh};

const INK: Colour = hex(0x22303c);
const PALE: Colour = hex(0x66757f);
const FIRST: Colour = hex(0xf4d58d);
const LAST: Colour = hex(0x1f4e79);
const SIZE: [usize; 2] = [1200, 900];

/// How far the tip moves from one shape to the next, mm, and how long their links are about.
const APART: Real = 5.0;
const LINK: Real = 2.0;

/// Draws the way.
pub fn draw(mesh: &TriMesh, edges: &Edges, path: &[Place]) -> Result<Canvas, String> {
    let (mut chains, mut moved) = (Vec::new(), APART);
    for ends in path.windows(2) {
        let motion = edges.motion(&ends[0], &ends[1])?;
        let mut tip = motion.tip(0.0);
        for k in 0..=100 {
            let t = Real::from(k) / 100.0;
            moved += (motion.tip(t) - tip).length();
            tip = motion.tip(t);
            if moved >= APART {
                moved = 0.0;
                let joints = motion.joints(t);
                let links = (edges.robot.length(&joints) / LINK).ceil() as usize;
                let line = edges.robot.centreline(&joints, links);
                chains.push(Chain::from_centreline(&line.points, &line.radii).map_err(text)?);
            }
        }
    }
    let ends = |chain: &Chain| -> Vec<Vector> {
        chain.links().iter().flat_map(|link| [edges.base * link.start(), edges.base * link.end()]).collect()
    };
    let places: Vec<_> = chains.iter().flat_map(ends).collect();
    let shade = |k: usize| mix(FIRST, LAST, k as f32 / (chains.len().max(2) - 1) as f32);
    // The last shape alone darkens the wall near it.
    let last = chains.len() - 1;
    let solids = chains.iter().enumerate().rev().flat_map(|(k, chain)| {
        let (base, colour) = (edges.base, shade(k));
        let solid = move |link| Solid::new(SharedShape::new(link), base, colour, k == last);
        chain.links().iter().copied().map(solid)
    });
    let mut picture = Picture::new(Some(mesh), solids.collect());
    picture.skin = Skin { near: 0.0, rim: 0.45, glint: 0.06, far: 0.88, edges: [0.04, 0.25], veil: 1.0 };

    let side = if edges.base.translation.x < mesh.local_aabb().center().x { 1.0 } else { -1.0 };
    let towards = Vector::new(side, -0.55, -0.32);
    let aspect = SIZE[0] as Real / SIZE[1] as Real;
    let mut camera = Camera::framing(&places, towards, Vector::Z, aspect, 0.16);
    let depths = places.iter().map(|&p| (p - camera.eye).dot(camera.forward) - 2.0);
    camera.cut = depths.fold(Real::INFINITY, Real::min).max(0.0);
    let mut canvas = picture.render(&camera, SIZE[0], SIZE[1]);
    canvas.panel([0.0, 0.0, SIZE[0] as f32, 96.0], 0.0, SKY[0], 0.8);
    canvas.text("A way into a brain ventricle, proven at every moment", [40.0, 48.0], Align::Left, 23.0, INK);
    let note = format!(
        "It keeps {1} mm. {0} edges, and shapes of the robot whenever its tip has moved {APART} mm, the last ones dark.",
        path.len() - 1,
        edges.margin
    );
    canvas.text(&note, [40.0, 80.0], Align::Left, 14.0, PALE);
    Ok(canvas)
}
