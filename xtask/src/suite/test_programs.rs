//! Rust tests in files of their own, each a program: run without cargo, some beside each other. Cargo would run one after the other, and wait for its lock before.

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result};
use serde::Deserialize;

use super::at_once;
use super::checked_profile;
use super::counts;
use super::report::Said;
use crate::output::say;
use crate::setup::failed::Failed;
use crate::setup::{command, telling};
use crate::workspace;

/// The longest, which begin first.
const LONG: [&str; 5] = ["all", "decode", "batch", "order", "film"];
/// A program has as many threads as the machine, but many have one long test.
const AT_ONCE: usize = 2;

/// A program of tests.
pub(super) struct Program {
    name: String,
    file: PathBuf,
    /// Where cargo starts it: in its package.
    folder: PathBuf,
}

/// A line in which cargo tells of something that it compiled.
#[derive(Deserialize)]
struct Line {
    manifest_path: Option<PathBuf>,
    target: Option<Target>,
    executable: Option<PathBuf>,
}

#[derive(Deserialize)]
struct Target {
    name: String,
    kind: Vec<String>,
}

/// All programs of tests in files of their own, compiled where they are not.
///
/// # Errors
/// Where they do not compile.
pub(super) fn built() -> Result<Vec<Program>> {
    let which = ["--no-run", "--message-format=json", "--test", "*"];
    let said = command::output(&mut checked_profile::cargo("test", &which)?)?;
    told_of(&said)
}

/// The programs among the lines of cargo.
fn told_of(lines: &str) -> Result<Vec<Program>> {
    let mut programs = Vec::new();
    for line in lines.lines() {
        let line: Line =
            serde_json::from_str(line).context("a line of cargo's cannot be read as JSON")?;
        let (Some(file), Some(target), Some(manifest)) =
            (line.executable, line.target, line.manifest_path)
        else {
            continue;
        };
        // Programs that tests start are told of as well.
        if target.kind != ["test"] {
            continue;
        }
        programs.push(Program {
            name: target.name,
            file,
            folder: manifest.parent().map(PathBuf::from).unwrap_or_default(),
        });
    }
    Ok(programs)
}

/// Runs them.
///
/// # Errors
/// Where a test fails, or none passes.
pub(super) fn run(programs: &[Program]) -> Result<Said> {
    run_by(programs, &|program| command::of_lane(&program.file))
}

fn run_by(programs: &[Program], start: &(dyn Fn(&Program) -> Command + Sync)) -> Result<Said> {
    let longest_first =
        at_once::long_first(programs.iter().collect(), &LONG, |program| &program.name);
    let ended = at_once::each(longest_first, AT_ONCE, |program| {
        program.run(start(program))
    })?;
    let failed = ended.iter().filter(|ended| !ended.success);
    let lines: Vec<String> = failed
        .flat_map(|ended| telling::of_cargo(&ended.output))
        .collect();
    if ended.iter().any(|ended| !ended.success) {
        let what = "a test in a file of its own failed".to_owned();
        return Err(Failed { what, lines }.into());
    }
    let outputs: String = ended.iter().map(|ended| ended.output.as_str()).collect();
    let notes: String = ended.iter().map(|ended| ended.notes.as_str()).collect();
    Ok(counts::of_cargo(&outputs)?.with_notes(&notes).into())
}

/// What became of a program's tests.
struct Ended {
    success: bool,
    output: String,
    /// Tests that found nothing to check.
    notes: String,
}

impl Program {
    /// Runs it as it is started, and shows what it said when it is done.
    fn run(&self, mut started: Command) -> Result<Ended> {
        let notes = workspace::target_dir().join(format!("skipped-tests-{}", self.name));
        // None is left from a run before.
        let _ = fs::remove_file(&notes);
        started
            .current_dir(&self.folder)
            // As cargo does: ours is xtask's.
            .env("CARGO_MANIFEST_DIR", &self.folder)
            .env("FLUOROPOSE_SKIPPED", &notes)
            .envs(checked_profile::surroundings());
        let told = command::quietly(&mut started, None)
            .with_context(|| format!("cannot run the tests of {}", self.name))?;
        let ended = Ended {
            success: told.success,
            output: told.text(),
            notes: fs::read_to_string(&notes).unwrap_or_default(),
        };
        // One program after the other.
        static SHOWING: Mutex<()> = Mutex::new(());
        let _turn = SHOWING.lock().unwrap_or_else(PoisonError::into_inner);
        let how = if ended.success { "passed" } else { "FAILED" };
        say(&format!("{}: {how}", self.name));
        ended.output.lines().for_each(say);
        ended.notes.lines().for_each(say);
        Ok(ended)
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use crate::suite::counts::Counts;

    #[test]
    fn programs_are_found_among_what_cargo_tells() {
        let said = r#"{"reason":"compiler-artifact","manifest_path":"/a/Cargo.toml","target":{"name":"a","kind":["lib"]},"executable":null}
{"reason":"compiler-artifact","manifest_path":"/a/Cargo.toml","target":{"name":"a","kind":["bin"]},"executable":"/target/a"}
{"reason":"compiler-artifact","manifest_path":"/a/Cargo.toml","target":{"name":"all","kind":["test"]},"executable":"/target/all-1"}
{"reason":"build-finished","success":true}"#;
        let [program] = told_of(said).unwrap().try_into().ok().unwrap();
        let found = (program.name, program.file, program.folder);
        assert_eq!(found, ("all".into(), "/target/all-1".into(), "/a".into()));
    }

    /// In place of a program: what a shell is to do.
    fn program(name: &str, text: &str) -> Program {
        Program {
            name: format!("{name}-{}", std::process::id()),
            file: text.into(),
            folder: std::env::temp_dir(),
        }
    }

    fn run(programs: &[Program]) -> Result<Said> {
        run_by(programs, &|program| {
            let mut shell = Command::new("sh");
            shell.arg("-c").arg(&program.file);
            shell
        })
    }

    #[test]
    fn tests_of_all_programs_are_counted_and_failures_told() {
        let passing = || {
            program(
                "passing",
                "echo 'test result: ok. 3 passed; 0 failed; 1 ignored'",
            )
        };
        let noting = program(
            "noting",
            "echo 'SKIPPED: b: not here' > $FLUOROPOSE_SKIPPED; echo 'test result: ok. 2 passed; 0 failed; 0 ignored'",
        );
        let wanted = Counts {
            passed: 4,
            skipped: 2,
        };
        let both = [passing(), noting];
        assert_eq!(run(&both).unwrap(), wanted.into());
        let failing = program(
            "failing",
            "printf -- '---- a ----\\nnot so\\n\\nfailures:\\n'; exit 1",
        );
        let error = run(&[passing(), failing]).unwrap_err();
        let failed = error.downcast_ref::<Failed>().unwrap();
        assert!(
            failed.lines.iter().any(|line| line.contains("not so")),
            "{:?}",
            failed.lines
        );
        assert!(run(&[]).is_err(), "none is no success");
    }
}
