//! What is asked of each file of code by itself.

use crate::facts::Facts;
use crate::findings::Findings;
use crate::words::Words;

/// A file longer than this holds more than one concept.
const MOST_LINES: usize = 500;
/// A function longer than this does not fit a screen.
const MOST_LINES_OF_FUNCTION: usize = 60;

/// Looks at one file.
pub fn check(file: &str, facts: &Facts, words: &Words, findings: &mut Findings) {
    if facts.lines > MOST_LINES {
        findings.long.push(format!("{file}: {} lines", facts.lines));
    }
    for function in facts
        .functions
        .iter()
        .filter(|function| function.lines > MOST_LINES_OF_FUNCTION)
    {
        let name = if function.name.is_empty() {
            "a function"
        } else {
            &function.name
        };
        findings.long.push(format!(
            "{file}:{} {name}: {} lines",
            function.line, function.lines
        ));
    }
    for (line, what) in &facts.unfinished {
        findings.errors.push(format!("{file}:{line} has {what}"));
    }
    for (name, line) in &facts.names {
        if let Some(fault) = words.fault(name) {
            findings.errors.push(format!("{file}:{line} {fault}"));
        }
    }
    let own_name = file.rsplit('/').next().unwrap_or(file);
    findings
        .errors
        .extend(words.fault(own_name).map(|fault| format!("{file} {fault}")));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_fault_is_told_with_its_place() {
        let mut facts = Facts {
            lines: 501,
            unfinished: vec![(7, "#[ignore]")],
            ..Facts::default()
        };
        facts.note_name("best_tally", 9);
        facts.note_function("fits", 1, 60);
        facts.note_function("runs_on", 100, 160);
        let mut findings = Findings::default();
        let words = Words::parse("tally -> count").unwrap();
        check("core/src/tally.rs", &facts, &words, &mut findings);
        assert_eq!(
            findings.long,
            [
                "core/src/tally.rs: 501 lines",
                "core/src/tally.rs:100 runs_on: 61 lines"
            ]
        );
        assert_eq!(
            findings.errors,
            [
                "core/src/tally.rs:7 has #[ignore]",
                "core/src/tally.rs:9 `best_tally`: `tally` is called count here",
                "core/src/tally.rs `tally.rs`: `tally` is called count here",
            ]
        );
    }
}
