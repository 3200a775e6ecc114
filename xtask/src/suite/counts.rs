//! How many tests a runner says it ran.

use std::collections::BTreeSet;

use anyhow::{Result, ensure};

use crate::setup::telling::without_colours;

/// Tests that ran, and tests that checked nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Counts {
    /// Those that passed.
    pub passed: u32,
    /// Those that were left out, or found nothing to check.
    pub skipped: u32,
}

impl Counts {
    /// Errors when no test ran: a filter or a wrong folder would otherwise pass for success.
    fn of(passed: u32, skipped: u32) -> Result<Self> {
        ensure!(passed > 0, "the runner reports that no test passed");
        Ok(Self { passed, skipped })
    }

    /// Of no test at all.
    pub(crate) const NONE: Self = Self {
        passed: 0,
        skipped: 0,
    };

    /// Of both.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            passed: self.passed + other.passed,
            skipped: self.skipped + other.skipped,
        }
    }

    /// Counts tests as skipped that passed because what they check is not here: each wrote a line that begins with
    /// `SKIPPED: NAME:`.
    pub(crate) fn with_notes(self, notes: &str) -> Self {
        let names: BTreeSet<&str> = notes
            .lines()
            .filter_map(|line| line.strip_prefix("SKIPPED: ")?.split(": ").next())
            .collect();
        let skipped = names.len() as u32;
        Self {
            passed: self.passed.saturating_sub(skipped),
            skipped: self.skipped + skipped,
        }
    }
}

/// Sums the `test result:` lines of `cargo test`.
///
/// Errors when no test passed.
pub(crate) fn of_cargo(output: &str) -> Result<Counts> {
    let results = output
        .lines()
        .filter_map(|line| line.trim().strip_prefix("test result: "));
    let (mut passed, mut ignored) = (0, 0);
    for result in results {
        passed += number_before(result, "passed").unwrap_or(0);
        ignored += number_before(result, "ignored").unwrap_or(0);
    }
    Counts::of(passed, ignored)
}

/// Reads the `Tests  12 passed | 1 skipped (13)` line of vitest.
///
/// Errors when no test passed.
pub(crate) fn of_vitest(output: &str) -> Result<Counts> {
    let plain = without_colours(output);
    let line = plain
        .lines()
        .find(|line| line.trim_start().starts_with("Tests "));
    let count = |word| line.and_then(|line| number_before(line, word)).unwrap_or(0);
    Counts::of(count("passed"), count("skipped"))
}

/// Reads the `pass 12` line of Node's test runner, and how many it skipped.
///
/// Errors when no test passed.
pub(crate) fn of_node(output: &str) -> Result<Counts> {
    let plain = without_colours(output);
    let count = |word: &str| {
        let found = plain.lines().rev().find_map(|line| {
            let mut words = line.split_whitespace().rev();
            let number = words.next()?.parse::<u32>().ok()?;
            (words.next()? == word && words.count() == 1).then_some(number)
        });
        found.unwrap_or(0)
    };
    Counts::of(count("pass"), count("skipped"))
}

/// Reads the `Ran 12 tests` and `OK (skipped=1)` lines of Python's unittest.
///
/// Errors when no test passed.
pub(crate) fn of_unittest(output: &str) -> Result<Counts> {
    let ran = output.lines().find_map(|line| line.strip_prefix("Ran "));
    let ran = ran
        .and_then(|line| line.split_whitespace().next()?.parse().ok())
        .unwrap_or(0);
    let skipped = output
        .lines()
        .find_map(|line| line.strip_prefix("OK (skipped="));
    let skipped = skipped
        .and_then(|rest| rest.trim_end_matches(')').parse().ok())
        .unwrap_or(0);
    Counts::of(u32::saturating_sub(ran, skipped), skipped)
}

/// The number in front of a word, as in `12 passed`.
fn number_before(line: &str, word: &str) -> Option<u32> {
    let words: Vec<&str> = line
        .split([' ', ';', '|'])
        .filter(|word| !word.is_empty())
        .collect();
    let at = words.iter().position(|found| *found == word)?;
    words.get(at.checked_sub(1)?)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(passed: u32, skipped: u32) -> Counts {
        Counts { passed, skipped }
    }

    #[test]
    fn cargo_results_are_summed() {
        let output = "running 2 tests\n\
            test result: ok. 2 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s\n\
            test result: ok. 10 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.10s\n";
        assert_eq!(of_cargo(output).unwrap(), counts(12, 1));
        assert!(of_cargo("test result: ok. 0 passed; 0 failed; 0 ignored;").is_err());
        assert!(of_cargo("").is_err());
    }

    #[test]
    fn vitest_is_read_through_its_colours() {
        let output = " \u{1b}[2m Test Files \u{1b}[22m 3 passed (3)\n\u{1b}[2m      Tests \u{1b}[22m \u{1b}[1m\u{1b}[32m41 passed\u{1b}[39m\u{1b}[22m\u{1b}[90m (41)\u{1b}[39m\n";
        assert_eq!(of_vitest(output).unwrap(), counts(41, 0));
        assert_eq!(
            of_vitest("      Tests  2 failed | 3 passed | 4 skipped (9)").unwrap(),
            counts(3, 4)
        );
        assert!(of_vitest("No test files found").is_err());
    }

    #[test]
    fn unittest_is_read() {
        let ran = "test_a ... ok\n\nRan 12 tests in 3.2s\n\nOK (skipped=2)\n";
        assert_eq!(of_unittest(ran).unwrap(), counts(10, 2));
        assert_eq!(
            of_unittest("Ran 3 tests in 1s\n\nOK\n").unwrap(),
            counts(3, 0)
        );
        assert!(of_unittest("Ran 2 tests in 1s\n\nOK (skipped=2)\n").is_err());
        assert!(of_unittest("").is_err());
    }

    #[test]
    fn a_test_that_found_nothing_to_check_is_skipped_once() {
        let notes = "SKIPPED: sides::a: no study\nSKIPPED: sides::b: no study\nSKIPPED: sides::a: no study\nother\n";
        assert_eq!(counts(10, 1).with_notes(notes), counts(8, 3));
        assert_eq!(counts(10, 1).with_notes(""), counts(10, 1));
    }

    #[test]
    fn both_reporters_of_node_are_read() {
        assert_eq!(
            of_node("ℹ tests 6\nℹ pass 5\nℹ fail 0\nℹ skipped 1\n").unwrap(),
            counts(5, 1)
        );
        assert_eq!(of_node("# pass 5\n# skipped 0\n").unwrap(), counts(5, 0));
        assert!(of_node("ℹ tests 0\nℹ pass 0\n").is_err());
        assert!(of_node("the pedals pass 7\n").is_err());
    }
}
