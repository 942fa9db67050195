//! Tables II and III: the same distance by clamping and by a decision tree.

use crate::timed::{medians, milliseconds};
use crate::{Opened, text};
use continuum_studies::gpu::{Form, GpuForms};
use parry_continuum::distance::Vec3;
use std::fmt::Write;
use std::time::Duration;

/// The chapter of the page.
pub fn chapter(opened: &[Opened], count: usize, enough: Duration) -> Result<String, String> {
    let mut page = format!(
        "## Tables II and III: clamps against branches\n\n\
         {count} random problems in the unit cube, a thread each. Milliseconds by the device's clock, and with the \
         transfers of 12 numbers there and 1 back. The paper's speed-up by clamping is 1.57 for segments on its GPU \
         (with transfers); it found next to none for triangles.\n\n\
         | distance | precision | clamps, device | end to end | tree, device | end to end | tree / clamps, device | end to \
         end |\n|---|---|---|---|---|---|---|---|\n"
    );
    let mut state = 7_u64;
    let mut number = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 * 2.0_f64.powi(-53)
    };
    let points: Vec<_> =
        (0..count).map(|_| [0; 4].map(|_| Vec3::new(number(), number(), number()))).collect();
    for (name, forms) in [
        ("segment to segment", [Form::ClampedSegments, Form::TreeSegments]),
        ("point to triangle", [Form::ClampedTriangle, Form::TreeTriangle]),
    ] {
        for opened in opened {
            let [mut clamps, mut tree] = [
                GpuForms::new(&opened.gpu, forms[0]).map_err(text)?,
                GpuForms::new(&opened.gpu, forms[1]).map_err(text)?,
            ];
            let (mut one, mut other) = (Vec::new(), Vec::new());
            let timed = medians(
                &mut [
                    &mut || {
                        clamps.solve(&points, &mut one).map_err(text).map(|()| clamps.device_time())
                    },
                    &mut || {
                        tree.solve(&points, &mut other).map_err(text).map(|()| tree.device_time())
                    },
                ],
                enough,
            )?;
            let seconds = |time: Option<Duration>| time.map(|time| time.as_secs_f64());
            let ratio = seconds(timed[1].device)
                .zip(seconds(timed[0].device))
                .map_or("-".into(), |(tree, clamps)| format!("{:.2}", tree / clamps));
            writeln!(
                page,
                "| {name} | {} | {} | {} | {} | {} | {ratio} | {:.2} |",
                opened.name,
                milliseconds(timed[0].device),
                milliseconds(Some(timed[0].whole)),
                milliseconds(timed[1].device),
                milliseconds(Some(timed[1].whole)),
                timed[1].whole.as_secs_f64() / timed[0].whole.as_secs_f64()
            )
            .map_err(text)?;
        }
    }
    Ok(page)
}
