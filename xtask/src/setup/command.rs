//! Other programs: found on the PATH, run, and their failures told in words.
//!
//! None of them gets our standard input: cargo hands it on to a `rustc -`, which would take it for source.

use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, bail};

use super::failed::Failed;
use super::telling;
use crate::output::{self, say};

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

/// Runs a command quietly and returns its standard output; an error carries the last lines of standard error.
pub(crate) fn output(command: &mut Command) -> Result<String> {
    let output = command
        .stdin(Stdio::null())
        .output()
        .with_context(|| format!("cannot start {}", shown(command)))?;
    if !output.status.success() {
        let errors = String::from_utf8_lossy(&output.stderr);
        bail!(
            "{} failed ({}): {}",
            shown(command),
            output.status,
            last_lines(&errors, 5)
        );
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// What a command that has ended wrote.
pub(crate) struct Told {
    pub success: bool,
    /// To standard output.
    pub output: String,
    /// To standard error, as far as it was kept.
    pub errors: String,
}

impl Told {
    /// An error that says what failed, with the lines that tell by what.
    pub(crate) fn or_failed(&self, what: &str, lines_of: fn(&str) -> Vec<String>) -> Result<()> {
        if self.success {
            return Ok(());
        }
        let what = format!("{what} failed");
        let lines = lines_of(&telling::without_colours(&self.all()));
        Err(Failed { what, lines }.into())
    }

    /// Both, one after the other.
    pub(crate) fn all(&self) -> String {
        format!("{}{}", self.output, self.errors)
    }
}

/// Runs a command, shows its output line by line and keeps what goes to standard output, in a lane also what goes to standard error.
pub(crate) fn tee(command: &mut Command) -> Result<Told> {
    if output::lane().is_some() {
        command.stderr(Stdio::piped());
    }
    teed(command)
}

/// The same with what goes to standard error kept in any case.
pub(crate) fn tee_all(command: &mut Command) -> Result<Told> {
    teed(command.stderr(Stdio::piped()))
}

fn teed(command: &mut Command) -> Result<Told> {
    let lane = output::lane();
    command.stdin(Stdio::null()).stdout(Stdio::piped());
    let mut child = command
        .spawn()
        .with_context(|| format!("cannot start {}", shown(command)))?;
    let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
    let errors = std::thread::spawn(move || {
        let show = || stderr.map(show).transpose();
        match lane {
            Some(lane) => lane.work(show),
            None => show(),
        }
    });
    let kept = stdout.map(show).transpose()?.unwrap_or_default();
    let errors = errors.join();
    let errors = errors.map_err(|_| anyhow!("reading of {} broke off", shown(command)))??;
    Ok(Told {
        success: child.wait()?.success(),
        output: kept,
        errors: errors.unwrap_or_default(),
    })
}

/// Shows lines as they come and keeps them.
fn show(from: impl Read) -> Result<String> {
    let mut kept = String::new();
    for line in BufReader::new(from).split(b'\n') {
        let line = line?;
        let line = String::from_utf8_lossy(&line);
        say(&line);
        kept.push_str(&line);
        kept.push('\n');
    }
    Ok(kept)
}

/// Runs a command quietly for at most `limit` and returns its standard output; one that takes longer is ended.
pub(crate) fn output_within(limit: Duration, command: &mut Command) -> Result<String> {
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .with_context(|| format!("cannot start {}", shown(command)))?;
    let mut stdout = child.stdout.take();
    let reader = std::thread::spawn(move || {
        let mut text = String::new();
        let read = stdout
            .as_mut()
            .map(|stdout| stdout.read_to_string(&mut text));
        read.transpose().map(|_| text)
    });
    let end = Instant::now() + limit;
    let status = loop {
        match child.try_wait()? {
            Some(status) => break status,
            None if Instant::now() < end => std::thread::sleep(Duration::from_millis(20)),
            None => {
                child.kill()?;
                child.wait()?;
                bail!("{} took longer than {} s", shown(command), limit.as_secs());
            }
        }
    };
    let text = reader
        .join()
        .map_err(|_| anyhow!("reading of {} broke off", shown(command)))??;
    if !status.success() {
        bail!(
            "{} failed ({status}): {}",
            shown(command),
            last_lines(&text, 5)
        );
    }
    Ok(text)
}

fn shown(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_stem().unwrap_or(program.as_os_str());
    let words = std::iter::once(name).chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    format!("`{}`", words.join(" "))
}

fn last_lines(text: &str, count: usize) -> String {
    let lines: Vec<&str> = text.trim_end().lines().collect();
    lines[lines.len().saturating_sub(count)..].join(" | ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::Lane;

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
