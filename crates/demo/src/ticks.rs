//! Round numbers along an axis.

/// The steps that an axis may have, times a power of ten.
const STEPS: [f64; 5] = [0.5, 1.0, 2.0, 5.0, 10.0];

/// The ticks from 0 to the first that is at least `high`, at most six of them.
pub fn ticks(high: f64) -> Vec<f64> {
    let high = if high > 0.0 && high.is_finite() { high } else { 1.0 };
    let decade = 10_f64.powf((high / 4.0).log10().floor());
    let steps = STEPS.map(|step| step * decade);
    let step = steps.into_iter().find(|step| high / step <= 5.0).unwrap_or(high);
    (0..=(high / step - 1e-9).ceil() as u32).map(|k| f64::from(k) * step).collect()
}
