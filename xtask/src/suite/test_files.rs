//! Files of tests in a browser, each run by a program of its own, some beside each other.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use anyhow::{Context, Result};

use super::at_once;
use super::counts::{self, Counts};
use super::report::Said;
use crate::output::{announce, say};
use crate::setup::failed::Failed;
use crate::setup::{command, telling};

/// The longest, which begin first.
const LONG: [&str; 8] = [
    "together/films.mjs",
    "together/looks.mjs",
    "together/by_command.mjs",
    "together/work.mjs",
    "together/small.mjs",
    "together/own.mjs",
    "together/tools.mjs",
    "crash",
];
/// What is at fault by chance is at fault in a test or two. More files are not tried again.
const MOST_TRIED_AGAIN: usize = 3;
/// The longest file takes a third of it beside compilers on a slow machine; a browser that hangs is ended after it, and its file tried again.
const PATIENCE: Duration = Duration::from_secs(15 * 60);

/// What became of the tests of a file.
struct Ended {
    file: String,
    success: bool,
    output: String,
}

/// Runs files of `folder`, so many at a time; `prepare` says by which program, and in which surroundings.
///
/// A file that fails is tried once more when all others are done. Where it passes then, that is said with the names of its tests that failed before.
///
/// # Errors
/// Where a test fails twice, or none passes.
pub(super) fn run(
    folder: &Path,
    files: Vec<String>,
    so_many: usize,
    prepare: &(dyn Fn() -> Command + Sync),
) -> Result<Said> {
    let one = |file: &String| run_file(folder, file, prepare());
    let files = at_once::long_first(files, &LONG, |file| name_of(file));
    let (passed, failed): (Vec<_>, Vec<_>) = at_once::each(files, so_many, one)?
        .into_iter()
        .partition(|ended| ended.success);
    let mut counts = sum(&passed)?;
    if failed.len() > MOST_TRIED_AGAIN {
        return Err(of_all(&failed).into());
    }
    let (mut second, mut twice) = (Vec::new(), Vec::new());
    for first in &failed {
        announce(&format!("{}: once more", first.file));
        let again = run_file(folder, &first.file, prepare())?;
        if again.success {
            counts = counts.and(counts::of_node(&again.output)?);
            second.extend(first.names());
        } else {
            twice.push(again);
        }
    }
    if !twice.is_empty() {
        return Err(of_all(&twice).into());
    }
    let said = Said::from(counts);
    if second.is_empty() {
        return Ok(said);
    }
    let words = format!(
        "{} passed at the second attempt: {}",
        second.len(),
        second.join("; ")
    );
    Ok(said.with_words(words, told_of(&failed)))
}

/// The names of all files of tests in a folder; those of several that stand together there in place of each of these.
pub(super) fn all_in(folder: &Path) -> Result<Vec<String>> {
    let mut names = names_in(folder, ".test.mjs")?;
    for several in names_in(&folder.join(TOGETHER), ".mjs")? {
        let several = format!("{TOGETHER}/{several}");
        let text = fs::read_to_string(folder.join(&several))?;
        let own: Vec<&str> = text.lines().filter_map(imported).collect();
        names.retain(|name| !own.contains(&name.as_str()));
        names.push(several);
    }
    names.sort_unstable();
    Ok(names)
}

/// Where files have the tests of several.
const TOGETHER: &str = "together";

/// The file beside the folder whose tests a line imports.
fn imported(line: &str) -> Option<&str> {
    line.strip_prefix("import '../")?.strip_suffix("';")
}

fn names_in(folder: &Path, end: &str) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        names.extend(name.ends_with(end).then_some(name));
    }
    Ok(names)
}

/// The name of a file's tests, as the list of the longest has it.
fn name_of(file: &str) -> &str {
    file.trim_end_matches(".test.mjs")
}

/// Runs the tests of a file, and shows what they said when they are done.
fn run_file(folder: &Path, file: &str, mut node: Command) -> Result<Ended> {
    node.args(["--test-reporter=spec", file]);
    let told = command::quietly(node.current_dir(folder), Some(PATIENCE))
        .with_context(|| format!("cannot run the tests of {file}"))?;
    let ended = Ended {
        file: file.to_owned(),
        success: told.success,
        output: told.text(),
    };
    // One file after the other.
    static SHOWING: Mutex<()> = Mutex::new(());
    let _turn = SHOWING.lock().unwrap_or_else(PoisonError::into_inner);
    say(&format!(
        "{file}: {}",
        if ended.success { "passed" } else { "FAILED" }
    ));
    ended.output.lines().for_each(say);
    Ok(ended)
}

impl Ended {
    /// Its tests that failed, without how long they took.
    fn names(&self) -> Vec<String> {
        let lines = telling::of_node(&self.output);
        let names = lines.iter().filter_map(|line| line.strip_prefix("✖ "));
        let names = names.map(|name| name.rsplit_once(" (").map_or(name, |(name, _)| name));
        let named: Vec<String> = names.map(|name| format!("{}: {name}", self.file)).collect();
        if named.is_empty() {
            return vec![self.file.clone()];
        }
        named
    }
}

/// The failure of some files, with what their tests say.
fn of_all(failed: &[Ended]) -> Failed {
    let count: usize = failed.iter().map(|ended| ended.names().len()).sum();
    Failed {
        what: format!("{count} of the tests in the browser failed"),
        lines: told_of(failed),
    }
}

/// What the tests of some files that failed say, under the name of each.
fn told_of(failed: &[Ended]) -> Vec<String> {
    let of_one = |ended: &Ended| {
        let told = telling::of_node(&ended.output).into_iter();
        let told = told.map(|line| format!("  {line}"));
        std::iter::once(ended.file.clone())
            .chain(told)
            .collect::<Vec<_>>()
    };
    failed.iter().flat_map(of_one).collect()
}

fn sum(passed: &[Ended]) -> Result<Counts> {
    let mut all = Counts::NONE;
    for ended in passed {
        let counts = counts::of_node(&ended.output).with_context(|| ended.file.clone())?;
        all = all.and(counts);
    }
    Ok(all)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::path::PathBuf;

    /// In place of Node: what is called `chance` fails where nothing says that it was tried before, `broken` ever.
    const RUNNER: &str = r#"
        fails() { printf 'ℹ pass 1\n\n✖ failing tests:\n\ntest at a.mjs:1:1\n✖ %s (3.5ms)\n  Error: not so\n' "$1"; exit 1; }
        case "$2" in
            chance*) [ -e tried ] || { touch tried; fails 'by chance'; } ;;
            broken*) fails 'ever' ;;
        esac
        printf 'ℹ pass 2\nℹ skipped 1\n'
    "#;

    fn tried(name: &str, files: &[&str]) -> Result<Said> {
        let folder: PathBuf =
            std::env::temp_dir().join(format!("fluoropose-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder)?;
        let files = files.iter().map(|&file| file.to_owned()).collect();
        let said = run(&folder, files, 2, &|| {
            let mut shell = Command::new("sh");
            shell.args(["-c", RUNNER, "sh"]);
            shell
        });
        fs::remove_dir_all(&folder)?;
        said
    }

    #[test]
    fn each_file_of_the_tests_is_driven_by_itself_or_with_others() {
        let folder = crate::workspace::root().join("tests/browser");
        let mut driven = Vec::new();
        for name in all_in(&folder).unwrap() {
            let text = fs::read_to_string(folder.join(&name)).unwrap();
            if name.starts_with(TOGETHER) {
                let own: Vec<&str> = text.lines().filter_map(imported).collect();
                assert_eq!(own.len(), text.matches("import").count(), "{name}");
                driven.extend(own.into_iter().map(str::to_owned));
            } else {
                driven.push(name);
            }
        }
        driven.sort_unstable();
        let mut all = names_in(&folder, ".test.mjs").unwrap();
        all.sort_unstable();
        assert_eq!(driven, all);
        assert!(
            LONG.iter().all(|long| folder.join(long).exists()
                || folder.join(format!("{long}.test.mjs")).exists())
        );
    }

    #[test]
    fn tests_of_all_files_are_counted() {
        let counts = Counts {
            passed: 4,
            skipped: 2,
        };
        assert_eq!(
            tried("all", &["a.test.mjs", "b.test.mjs"]).unwrap(),
            counts.into()
        );
    }

    #[test]
    fn what_passes_at_the_second_attempt_is_said() {
        let said = tried("chance", &["a.test.mjs", "chance.test.mjs"]).unwrap();
        let counts = Counts {
            passed: 4,
            skipped: 2,
        };
        let words = "1 passed at the second attempt: chance.test.mjs: by chance";
        let lines = [
            "chance.test.mjs",
            "  ✖ by chance (3.5ms)",
            "      Error: not so",
        ];
        let wanted = Said::from(counts).with_words(words.into(), lines.map(str::to_owned).into());
        assert_eq!(said, wanted);
    }

    #[test]
    fn what_fails_twice_fails_and_many_are_not_tried_again() {
        let error = tried("broken", &["a.test.mjs", "broken.test.mjs"]).unwrap_err();
        let failed = error.downcast_ref::<Failed>().unwrap();
        let lines = ["broken.test.mjs", "  ✖ ever (3.5ms)", "      Error: not so"];
        assert_eq!(
            (failed.what.as_str(), &failed.lines[..]),
            (
                "1 of the tests in the browser failed",
                &lines.map(str::to_owned)[..]
            )
        );
        let many = ["broken1", "broken2", "broken3", "chance"];
        let error = tried("many", &many).unwrap_err();
        assert_eq!(error.to_string(), "4 of the tests in the browser failed");
    }
}
