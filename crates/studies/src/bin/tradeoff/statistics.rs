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

/// A share of a sample: so many of so many.
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

/// Per cent with as many digits as a share needs.
fn percent(share: f64) -> String {
    let value = 100.0 * share;
    if (0.005..10.0).contains(&value) { format!("{value:.2}") } else { format!("{value:.1}") }
}

/// A length in mm with two digits, and none where it is no more than rounding.
pub fn length(mm: f64) -> String {
    match mm.abs() {
        size if size < 1e-12 => "0".into(),
        size if size < 1e-3 => format!("{mm:.0e}"),
        size if size < 0.1 => format!("{mm:.4}"),
        _ => format!("{mm:.2}"),
    }
}
