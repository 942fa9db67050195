//! The ratios that this project set itself, and whether they were reached.

use std::fmt::Write;

/// What is to be reached.
#[derive(Clone, Copy)]
pub enum Goal {
    AtLeast(f64),
    AtMost(f64),
}

/// Goals, and what was measured for each.
#[derive(Default)]
pub struct Goals(Vec<(String, Goal, Vec<f64>)>);

impl Goals {
    /// Notes a ratio that was measured for a job.
    pub fn note(&mut self, job: &str, goal: Goal, measured: f64) {
        match self.0.iter_mut().find(|(name, ..)| name == job) {
            Some((.., all)) => all.push(measured),
            None => self.0.push((job.into(), goal, vec![measured])),
        }
    }

    /// The page.
    pub fn page(&self, written: &str) -> String {
        let mut page = format!(
            "# Goals of speed\n\n{written}. A goal is a ratio that this project set itself before anything was measured.\n\n\
             | job | goal | measured | met |\n|---|---|---|---|\n",
        );
        for (job, goal, measured) in &self.0 {
            let (low, high) = measured
                .iter()
                .fold((f64::INFINITY, 0.0_f64), |(low, high), &x| (low.min(x), high.max(x)));
            let met = |x: &&f64| match *goal {
                Goal::AtLeast(least) => **x >= least,
                Goal::AtMost(most) => **x <= most,
            };
            let met = match measured.iter().filter(met).count() {
                0 => "no".into(),
                count if count == measured.len() => "yes".into(),
                count => format!("in {count} of {}", measured.len()),
            };
            let goal = match goal {
                Goal::AtLeast(least) => format!("at least {least} x"),
                Goal::AtMost(most) => format!("at most {most} x"),
            };
            let measured = if measured.len() == 1 {
                ratio(low)
            } else {
                format!("{} to {}", ratio(low), ratio(high))
            };
            // Writing to a string cannot fail.
            let _ = writeln!(page, "| {job} | {goal} | {measured} | {met} |");
        }
        page
    }
}

fn ratio(x: f64) -> String {
    if x < 10.0 { format!("{x:.2} x") } else { format!("{x:.0} x") }
}
