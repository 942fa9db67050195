//! Moving anatomy: a ventricle whose every vertex moves in each frame.

use crate::Effort;
use crate::exhaustive::divided;
use continuum_demo::timing::medians;
use continuum_demo::ventricle;
use continuum_studies::models::models;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity};
use std::fmt::Write;

/// The chapter of the page.
pub fn chapter(effort: Effort) -> Result<String, String> {
    let mut page = String::from(
        "## Moving anatomy\n\n\
         A pulsating ventricle: every vertex moves in every frame, then one per-link query of 30 links with fitted \
         caps, on all cores. Milliseconds per frame; the time of a search that is built anew excludes parry's mesh and \
         its hierarchy.\n\n\
         | triangles | refit and search | exhaustive f32 | exhaustive f64 | build and search |\n|---|---|---|---|---|\n",
    );
    let [_, (_, robot), _] = models().map_err(|error| error.to_string())?;
    let base = ventricle::entry();
    for times in [0, 2, 4].into_iter().filter(|times| *times <= effort.largest) {
        let (rest, indices) = divided(times);
        let beats = ventricle::beat(&rest);
        let mesh = TriMesh::new(rest, indices).map_err(|error| error.to_string())?;
        let text = |error: parry_continuum::proximity::MeshError| error.to_string();
        let mut search = BvhSearch::new(&mesh).map_err(text)?;
        let mut single = Exhaustive::<f32>::new(&mesh).map_err(text)?;
        let mut double = Exhaustive::<f64>::new(&mesh).map_err(text)?;
        let mut out = [Vec::new(), Vec::new(), Vec::new(), Vec::new()];
        let [out1, out2, out3, out4] = &mut out;
        let mut frames = [0; 3];
        let [frame1, frame2, frame3] = &mut frames;
        let step = |engine: &mut dyn Proximity,
                    frame: &mut usize,
                    out: &mut Vec<_>|
         -> Result<(), String> {
            *frame += 1;
            engine.set_vertices(&beats[*frame % 2]).map_err(text)?;
            engine.per_link(&robot, &base, out).map_err(|error| error.to_string())
        };
        let times = medians::<String>(
            &mut [
                &mut || step(&mut search, frame1, out1),
                &mut || step(&mut single, frame2, out2),
                &mut || step(&mut double, frame3, out3),
                &mut || {
                    let mut built = BvhSearch::new(&mesh).map_err(text)?;
                    built.per_link(&robot, &base, out4).map_err(|error| error.to_string())
                },
            ],
            effort.enough / 2,
        )?;
        let _ = write!(page, "| {} |", mesh.num_triangles());
        for time in times {
            let _ = write!(page, " {:.2} |", time.as_secs_f64() * 1e3);
        }
        page.push('\n');
    }
    Ok(page)
}
