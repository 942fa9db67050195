//! Medians, extremes, and how sure a share is.

/// The middle value; of two, the smaller. None of nothing.
pub fn quantile(mut values: Vec<f64>, share: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(((values.len().saturating_sub(1)) as f64 * share) as usize).copied()
}

/// Errors of a clearance: positive where the model claims more room than there is, the unsafe side.
pub struct Errors {
    pub median: f64,
    /// The largest, and at least 0.
    pub over: f64,
    /// The least, and at most 0.
    pub under: f64,
}

impl Errors {
    pub fn of(errors: impl Iterator<Item = f64>) -> Self {
        let all: Vec<f64> = errors.collect();
        let over = all.iter().copied().fold(0.0, f64::max);
        let under = all.iter().copied().fold(0.0, f64::min);
        Self { median: quantile(all, 0.5).unwrap_or(f64::NAN), over, under }
    }

    /// The largest in magnitude.
    pub fn worst(&self) -> f64 {
        self.over.max(-self.under)
    }
}

/// A share of a sample: `count` of `of`.
#[derive(Clone, Copy, Default)]
pub struct Share {
    pub count: usize,
    pub of: usize,
}

impl Share {
    pub fn of<T>(sample: impl Iterator<Item = T>, counts: impl Fn(&T) -> bool) -> Self {
        sample.fold(Self::default(), |share, item| Self {
            count: share.count + usize::from(counts(&item)),
            of: share.of + 1,
        })
    }

    /// Where the true share is with 95 % confidence (Wilson, 1927).
    pub fn interval(&self) -> [f64; 2] {
        const Z: f64 = 1.959_963_984_540_054;
        let (n, p) = (self.of as f64, self.count as f64 / self.of as f64);
        let middle = p + Z * Z / (2.0 * n);
        let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        [middle - half, middle + half].map(|bound| (bound / (1.0 + Z * Z / n)).clamp(0.0, 1.0))
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        if self.of == 0 {
            return write!(f, "none to count");
        }
        let [low, high] = self.interval().map(percent);
        if self.count == 0 {
            return write!(f, "none of {} (below {high} %)", self.of);
        }
        let share = percent(self.count as f64 / self.of as f64);
        write!(f, "{} of {}: {share} % ({low} to {high})", self.count, self.of)
    }
}

/// Per cent with as many digits as a share needs: a bound above 0 never reads as 0.
fn percent(share: f64) -> String {
    match 100.0 * share {
        value if value >= 10.0 => format!("{value:.1}"),
        value if value >= 0.005 => format!("{value:.2}"),
        value if value > 0.0 => format!("{value:.*}", -value.log10().floor() as usize),
        _ => "0".into(),
    }
}

/// A length in mm with two digits; 0 within rounding.
pub fn length(mm: f64) -> String {
    match mm.abs() {
        size if size < 1e-12 => "0".into(),
        size if size < 1e-3 => format!("{mm:.0e}"),
        size if size < 0.1 => format!("{mm:.4}"),
        _ => format!("{mm:.2}"),
    }
}

/// The same with its sign, because a sign tells the safe side from the unsafe.
pub fn signed(mm: f64) -> String {
    let length = length(mm);
    if mm > 0.0 && length != "0" { format!("+{length}") } else { length }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_0_does_not_read_as_0() {
        // Wilson's bounds are 0.0024 % and 0.0757 %.
        assert_eq!(Share { count: 1, of: 7483 }.to_string(), "1 of 7483: 0.01 % (0.002 to 0.08)");
        assert_eq!(Share { count: 0, of: 7483 }.to_string(), "none of 7483 (below 0.05 %)");
        assert_eq!(percent(3e-6), "0.0003");
    }

    #[test]
    fn only_a_length_has_a_sign() {
        assert_eq!([1e-13, 0.0, 0.5, -0.5].map(signed), ["0", "0", "+0.50", "-0.50"]);
    }
}
