//! What became of each step, summed up at the end.

use std::fmt;
use std::time::{Duration, Instant};

use anyhow::Result;

use crate::setup::{Missing, announce};

/// What became of a step, with a few words about it.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Outcome {
    Passed(String),
    Failed(String),
    Skipped(String),
}

struct Line {
    step: String,
    outcome: Outcome,
    time: Duration,
}

/// The steps so far.
pub(crate) struct Report {
    lines: Vec<Line>,
    under_ci: bool,
}

impl Report {
    /// An empty report; the environment variable `CI` makes it strict about what is missing.
    pub(crate) fn new() -> Self {
        let under_ci = std::env::var("CI").is_ok_and(|value| value == "true" || value == "1");
        Self {
            lines: Vec::new(),
            under_ci,
        }
    }

    /// Runs a step, says so as it starts, and records what became of it. Returns whether it passed.
    ///
    /// The work returns what to say of it ("12 tests"). An error fails the step, except for a [`Missing`] thing,
    /// which skips it.
    pub(crate) fn step(&mut self, name: &str, work: impl FnOnce() -> Result<String>) -> bool {
        announce(name);
        let start = Instant::now();
        let outcome = match work() {
            Ok(said) => Outcome::Passed(said),
            Err(error) => self.outcome_of(&error),
        };
        if let Outcome::Failed(said) | Outcome::Skipped(said) = &outcome {
            eprintln!("{said}");
        }
        let passed = matches!(outcome, Outcome::Passed(_));
        self.lines.push(Line {
            step: name.to_string(),
            outcome,
            time: start.elapsed(),
        });
        passed
    }

    /// Records a step that cannot run because an earlier one did not pass.
    pub(crate) fn skip(&mut self, name: &str, why: &str) {
        let outcome = Outcome::Skipped(why.to_string());
        self.lines.push(Line {
            step: name.to_string(),
            outcome,
            time: Duration::ZERO,
        });
    }

    fn outcome_of(&self, error: &anyhow::Error) -> Outcome {
        let said = format!("{error:#}");
        match error.downcast_ref::<Missing>() {
            // Whoever runs CI can give the machine what it needs, but cannot make a source offer what it has not.
            Some(missing) if missing.tried || !self.under_ci => Outcome::Skipped(said),
            _ => Outcome::Failed(said),
        }
    }

    /// Whether a step failed.
    pub(crate) fn has_failed(&self) -> bool {
        self.count(|outcome| matches!(outcome, Outcome::Failed(_))) > 0
    }

    fn count(&self, which: impl Fn(&Outcome) -> bool) -> usize {
        self.lines
            .iter()
            .filter(|line| which(&line.outcome))
            .count()
    }
}

impl Default for Report {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f)?;
        for line in &self.lines {
            let (word, said) = match &line.outcome {
                Outcome::Passed(said) => ("passed ", said),
                Outcome::Failed(said) => ("FAILED ", said),
                Outcome::Skipped(said) => ("skipped", said),
            };
            let seconds = line.time.as_secs_f64();
            writeln!(
                f,
                "{word} {:<50} {seconds:6.1} s  {}",
                line.step,
                said.trim()
            )?;
        }
        let passed = self.count(|outcome| matches!(outcome, Outcome::Passed(_)));
        let failed = self.count(|outcome| matches!(outcome, Outcome::Failed(_)));
        write!(f, "{passed} passed, {failed} failed")?;
        match self.lines.len() - passed - failed {
            0 => writeln!(f),
            skipped => writeln!(f, ", {skipped} skipped"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::anyhow;

    fn missing(tried: bool) -> anyhow::Error {
        let text = String::from;
        Missing {
            what: text("QEMU"),
            why: text("not here"),
            remedy: text("get it"),
            tried,
        }
        .into()
    }

    fn report(under_ci: bool) -> Report {
        Report {
            lines: Vec::new(),
            under_ci,
        }
    }

    #[test]
    fn the_last_line_counts_steps() {
        let mut report = report(false);
        assert!(report.step("one", || Ok("3 tests".into())));
        assert!(
            report.to_string().ends_with("\n1 passed, 0 failed\n"),
            "{report}"
        );
        assert!(!report.step("two", || Err(anyhow!("broken"))));
        report.skip("three", "two did not pass");
        assert!(
            report
                .to_string()
                .ends_with("\n1 passed, 1 failed, 1 skipped\n"),
            "{report}"
        );
        assert!(report.has_failed());
    }

    #[test]
    fn what_is_missing_skips_here_and_fails_under_ci_unless_it_cannot_be_had() {
        for (under_ci, tried, fails) in [
            (false, false, false),
            (false, true, false),
            (true, false, true),
            (true, true, false),
        ] {
            let mut report = report(under_ci);
            assert!(!report.step("firmware", || Err(missing(tried))));
            assert_eq!(report.has_failed(), fails, "CI {under_ci}, tried {tried}");
        }
    }

    #[test]
    fn a_missing_thing_is_seen_through_context() {
        let mut report = report(false);
        report.step("page", || {
            Err(missing(false).context("cannot build the page"))
        });
        assert!(!report.has_failed());
    }
}
