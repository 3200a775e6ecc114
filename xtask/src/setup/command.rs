//! Other programs: found on the PATH, run, and their failures told in words.
//!
//! None of them gets our standard input: cargo hands it on to a `rustc -`, which would take it for source.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use anyhow::{Context, Result, bail};

use super::ended::{self, Told, shown};
use super::telling;
use crate::output;

/// The first of these names that is an executable file on the PATH.
pub(crate) fn find(names: &[&str]) -> Option<PathBuf> {
    find_in(&std::env::var_os("PATH")?, names)
}

/// As [`find`], over a given PATH value.
pub(crate) fn find_in(path: &std::ffi::OsStr, names: &[&str]) -> Option<PathBuf> {
    let folders: Vec<PathBuf> = std::env::split_paths(path).collect();
    names.iter().find_map(|name| {
        let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
        folders
            .iter()
            .map(|folder| folder.join(&file))
            .find(|candidate| is_executable(candidate))
    })
}

#[cfg(unix)]
fn is_executable(file: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    file.metadata()
        .is_ok_and(|meta| meta.is_file() && meta.permissions().mode() & 0o111 != 0)
}

#[cfg(not(unix))]
fn is_executable(file: &Path) -> bool {
    file.is_file()
}

/// A command that gives way to others where its lane does.
pub(crate) fn of_lane(program: impl AsRef<OsStr>) -> Command {
    let gives_way = output::lane().map_or(0, |lane| lane.gives_way);
    match find(&["nice"]).filter(|_| gives_way > 0) {
        Some(nice) => {
            let mut command = Command::new(nice);
            command.args(["-n", &gives_way.to_string()]).arg(program);
            command
        }
        None => Command::new(program),
    }
}

/// Runs a command with its output shown; an exit code other than 0 is an error that names the command.
pub(crate) fn run(command: &mut Command) -> Result<()> {
    if output::lane().is_some() {
        return tee(command)?.or_failed(&shown(command), telling::of_others);
    }
    let status = command
        .stdin(Stdio::null())
        .status()
        .with_context(|| format!("cannot start {}", shown(command)))?;
    if !status.success() {
        bail!("{} failed ({status})", shown(command));
    }
    Ok(())
}

/// Runs a command quietly and returns its standard output; an error carries the last lines of both outputs.
pub(crate) fn output(command: &mut Command) -> Result<String> {
    let told = quietly(command, None)?;
    said(command, told)
}

/// Runs a command quietly for at most `limit` and returns its standard output; one that takes longer is ended.
pub(crate) fn output_within(limit: Duration, command: &mut Command) -> Result<String> {
    let told = quietly(command, Some(limit))?;
    said(command, told)
}

fn said(command: &Command, told: Told) -> Result<String> {
    if !told.success {
        // Some programs say on standard output why they end.
        let (how, said) = (told.how(), last_lines(&told.all(), 5));
        bail!("{} {how}: {said}", shown(command));
    }
    Ok(told.output)
}

/// Runs a command and keeps both its outputs without showing them.
pub(crate) fn quietly(command: &mut Command, limit: Option<Duration>) -> Result<Told> {
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    ended::told(command, limit, false)
}

/// Runs a command, shows its output line by line and keeps what goes to standard output, in a lane also what goes to standard error.
pub(crate) fn tee(command: &mut Command) -> Result<Told> {
    if output::lane().is_some() {
        command.stderr(Stdio::piped());
    }
    ended::told(command.stdout(Stdio::piped()), None, true)
}

/// The same with what goes to standard error kept in any case.
pub(crate) fn tee_all(command: &mut Command) -> Result<Told> {
    tee(command.stderr(Stdio::piped()))
}

fn last_lines(text: &str, count: usize) -> String {
    let lines: Vec<&str> = text.trim_end().lines().collect();
    lines[lines.len().saturating_sub(count)..].join(" | ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::Lane;
    use crate::setup::failed::Failed;

    #[test]
    fn a_program_that_is_nowhere_is_not_found() {
        assert_eq!(find(&["fluoropose-no-such-program"]), None);
        assert_eq!(find_in(std::ffi::OsStr::new(""), &["cargo"]), None);
    }

    #[test]
    fn a_failure_names_the_command() {
        let error = output(Command::new("cargo").arg("--no-such-option"))
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("`cargo --no-such-option` failed"),
            "{error}"
        );
    }

    #[test]
    fn in_a_lane_both_outputs_are_shown_and_failures_told() {
        let lane = Lane {
            name: "lane",
            gives_way: 10,
        };
        lane.work(|| {
            let mut shell = of_lane("sh");
            let told = tee(shell.args(["-c", "echo out; echo error >&2"])).unwrap();
            assert!(told.success);
            assert_eq!(
                (told.output.as_str(), told.errors.as_str()),
                ("out\n", "error\n")
            );
            let failing = run(of_lane("sh").args(["-c", "echo why >&2; exit 3"])).unwrap_err();
            let failed = failing.downcast_ref::<Failed>().unwrap();
            assert_eq!(failed.lines, ["why"]);
        });
    }

    #[test]
    fn why_a_command_failed_is_told_wherever_it_says_so() {
        let told = |text: &str| {
            let mut shell = Command::new("sh");
            let error = output(shell.args(["-c", text])).unwrap_err();
            error.to_string()
        };
        let (loud, board) = (told("echo why >&2; exit 3"), told("echo panicked; exit 1"));
        assert!(loud.contains("3): why"), "{loud}");
        assert!(board.contains("1): panicked"), "{board}");
    }

    #[test]
    fn a_command_that_hangs_is_ended() {
        let mut sleep = Command::new("sleep");
        let error = output_within(Duration::from_millis(100), sleep.arg("60")).unwrap_err();
        assert!(error.to_string().contains("took longer"), "{error}");
        let said = output_within(Duration::from_secs(60), Command::new("echo").arg("done"));
        assert_eq!(said.unwrap(), "done\n");
    }

    #[test]
    fn the_end_of_a_long_error_is_kept() {
        assert_eq!(last_lines("a\nb\nc\n", 2), "b | c");
        assert_eq!(last_lines("a", 2), "a");
    }
}
