//! What became of each step, summed up at the end.

use std::fmt;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::Result;

use super::counts::Counts;
use crate::output::{Lane, announce};
use crate::setup::Missing;
use crate::setup::failed::Failed;

/// What became of a step, with a few words about it.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Outcome {
    Passed(Said),
    Failed(Failed),
    Skipped(String),
}

/// What is said of a step that passed.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Said {
    counts: Option<Counts>,
    words: String,
    /// What is told at the end although it passed.
    lines: Vec<String>,
}

impl Said {
    /// With words beside its counts, and lines that tell of them at the end.
    pub(crate) fn with_words(self, words: String, lines: Vec<String>) -> Self {
        Self {
            words,
            lines,
            ..self
        }
    }
}

impl From<()> for Said {
    fn from((): ()) -> Self {
        Self::default()
    }
}

impl From<Counts> for Said {
    fn from(counts: Counts) -> Self {
        Self {
            counts: Some(counts),
            ..Self::default()
        }
    }
}

impl From<String> for Said {
    fn from(words: String) -> Self {
        Self {
            words,
            ..Self::default()
        }
    }
}

struct Line {
    step: String,
    outcome: Outcome,
    time: Duration,
}

/// Steps one after another, and the lane that they run in.
pub(crate) type Steps<'a> = (Lane, &'a (dyn Fn(&mut Report) + Sync));

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
    /// The work returns what to say of it, such as how many tests it ran. An error fails the step, except for a [`Missing`] thing,
    /// which skips it.
    pub(crate) fn step(&mut self, name: &str, work: impl FnOnce() -> Result<Said>) -> bool {
        announce(name);
        let start = Instant::now();
        let outcome = match work() {
            Ok(said) => Outcome::Passed(said),
            Err(error) => self.outcome_of(&error),
        };
        let seconds = start.elapsed().as_secs_f64();
        match &outcome {
            Outcome::Passed(_) => announce(&format!("{name}: passed in {seconds:.1} s")),
            Outcome::Failed(Failed { what, .. }) => {
                announce(&format!("{name}: FAILED after {seconds:.1} s: {what}"))
            }
            Outcome::Skipped(said) => announce(&format!("{name}: skipped: {said}")),
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

    /// Does rows of steps beside each other, each in its lane, and records them in the order of the rows.
    pub(crate) fn side_by_side(&mut self, rows: &[Steps]) {
        let rows = thread::scope(|scope| {
            let begun = rows.iter().map(|&(lane, steps)| {
                scope.spawn(move || {
                    lane.work(|| {
                        let mut report = Self::new();
                        steps(&mut report);
                        report
                    })
                })
            });
            let begun: Vec<_> = begun.collect();
            let rows = begun.into_iter().map(thread::ScopedJoinHandle::join);
            rows.collect::<Vec<_>>()
        });
        for row in rows {
            match row {
                Ok(row) => self.lines.extend(row.lines),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
    }

    fn outcome_of(&self, error: &anyhow::Error) -> Outcome {
        let said = format!("{error:#}");
        match error.downcast_ref::<Missing>() {
            // Whoever runs CI can give the machine what it needs, but cannot make a source offer what it has not.
            Some(missing) if missing.tried || !self.under_ci => Outcome::Skipped(said),
            _ => {
                let failed = error.downcast_ref::<Failed>();
                let lines = failed.map_or_else(Vec::new, |failed| failed.lines.clone());
                Outcome::Failed(Failed { what: said, lines })
            }
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
        writeln!(
            f,
            "\n{:<8}{:<50} {:>8}  {:>6} {:>8}",
            "", "step", "seconds", "tests", "skipped"
        )?;
        for line in &self.lines {
            writeln!(f, "{}", line.to_string().trim_end())?;
        }
        let passed = self.count(|outcome| matches!(outcome, Outcome::Passed(_)));
        let failed = self.count(|outcome| matches!(outcome, Outcome::Failed(_)));
        write!(f, "{passed} passed, {failed} failed")?;
        match self.lines.len() - passed - failed {
            0 => writeln!(f)?,
            skipped => writeln!(f, ", {skipped} skipped")?,
        }
        self.lines.iter().try_for_each(|line| line.tell_why(f))
    }
}

/// So many lines are told once more of a step that failed.
const MOST_TOLD: usize = 40;

impl Line {
    /// At the very end, which is kept where a log is cut.
    fn tell_why(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (word, lines) = match &self.outcome {
            Outcome::Failed(Failed { lines, .. }) => ("FAILED", lines),
            Outcome::Passed(Said { lines, .. }) => ("passed at last", lines),
            Outcome::Skipped(_) => return Ok(()),
        };
        if lines.is_empty() {
            return Ok(());
        }
        writeln!(f, "\n{word}: {}", self.step)?;
        for line in lines.iter().take(MOST_TOLD) {
            writeln!(f, "  {line}")?;
        }
        match lines.len().saturating_sub(MOST_TOLD) {
            0 => Ok(()),
            more => writeln!(f, "  and {more} lines more, where the step failed"),
        }
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (word, counts, words) = match &self.outcome {
            Outcome::Passed(said) => ("passed", said.counts, &said.words),
            Outcome::Failed(failed) => ("FAILED", None, &failed.what),
            Outcome::Skipped(words) => ("skipped", None, words),
        };
        let seconds = self.time.as_secs_f64();
        write!(f, "{word:<7} {:<50} {seconds:>8.1}", self.step)?;
        let number = |of: fn(Counts) -> u32| counts.map_or(String::new(), |c| of(c).to_string());
        let (passed, skipped) = (number(|c| c.passed), number(|c| c.skipped));
        write!(f, "  {passed:>6} {skipped:>8}  {}", words.trim())
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
        assert!(report.step("one", || {
            Ok(Counts {
                passed: 3,
                skipped: 2,
            }
            .into())
        }));
        assert!(
            report.to_string().ends_with("\n1 passed, 0 failed\n"),
            "{report}"
        );
        let line = report.to_string();
        let line = line.lines().find(|line| line.contains(" one ")).unwrap();
        let words: Vec<&str> = line.split_whitespace().collect();
        assert_eq!(words, ["passed", "one", "0.0", "3", "2"]);
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
    fn why_a_step_failed_is_told_at_the_end() {
        let mut report = report(false);
        let failed = |lines| Failed {
            what: "a test failed".into(),
            lines,
        };
        report.step("one", || {
            Err(failed(vec!["a::b".into(), "    not right".into()]).into())
        });
        report.step("two", || {
            Err(anyhow::Error::from(failed(vec!["line".into(); 43])).context("it did not go"))
        });
        let text = report.to_string();
        let (table, end) = text.split_once("0 passed, 2 failed\n").unwrap();
        assert!(table.contains("a test failed"), "{table}");
        assert!(
            end.starts_with("\nFAILED: one\n  a::b\n      not right\n\nFAILED: two\n  line\n"),
            "{end}"
        );
        assert!(
            end.ends_with("  line\n  and 3 lines more, where the step failed\n"),
            "{end}"
        );
        report.step("three", || {
            let words = "one passed at the second attempt".to_owned();
            Ok(Said::default().with_words(words, vec!["a.mjs".into()]))
        });
        let text = report.to_string();
        assert!(
            text.ends_with("\npassed at last: three\n  a.mjs\n"),
            "{text}"
        );
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
