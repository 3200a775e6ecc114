//! Programs run to their end, or to a limit of time: a browser or an emulator that hangs would be waited for without end, and nobody told which.

use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

use super::failed::Failed;
use super::telling;
use crate::output::{self, say};

/// Where steps run side by side, and so in CI, nothing takes as long: the longest compilation takes a third of it on a slow machine.
const IN_A_LANE: Duration = Duration::from_secs(40 * 60);
/// What is still to be read when a program has ended comes at once, unless something that it left behind holds its output open.
const LEFT_TO_READ: Duration = Duration::from_secs(5);

/// What a command that has ended wrote.
pub(crate) struct Told {
    pub success: bool,
    /// To standard output.
    pub output: String,
    /// To standard error, as far as it was kept.
    pub errors: String,
    status: ExitStatus,
    /// Why it was not waited for to the end.
    given_up: Option<String>,
}

impl Told {
    /// An error that says what failed, with the lines that tell by what.
    pub(crate) fn or_failed(&self, what: &str, lines_of: fn(&str) -> Vec<String>) -> Result<()> {
        if self.success {
            return Ok(());
        }
        let what = format!("{what} {}", self.how());
        let lines = lines_of(&telling::without_colours(&self.all()));
        Err(Failed { what, lines }.into())
    }

    /// How it failed, as what follows its name.
    pub(super) fn how(&self) -> String {
        let given_up = self.given_up.clone();
        given_up.unwrap_or_else(|| format!("failed ({})", self.status))
    }

    /// Both, one after the other.
    pub(crate) fn all(&self) -> String {
        format!("{}{}", self.output, self.errors)
    }

    /// The same without colours, and with why its end was not waited for.
    pub(crate) fn text(&self) -> String {
        let mut text = telling::without_colours(&self.all());
        if let Some(how) = &self.given_up {
            text.push_str(&format!("error: {how}\n"));
        }
        text
    }
}

/// Runs a command as its streams are set, those that are piped kept and, where that is asked, shown line by line.
/// One that takes longer than `limit`, or than anything may in a lane, is ended with all that it started.
pub(super) fn told(command: &mut Command, limit: Option<Duration>, aloud: bool) -> Result<Told> {
    let mut child = command
        .stdin(Stdio::null())
        .spawn()
        .with_context(|| format!("cannot start {}", shown(command)))?;
    let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
    let (stdout, stderr) = (
        stdout.map(|stdout| Reading::begin(stdout, aloud)),
        stderr.map(|stderr| Reading::begin(stderr, aloud)),
    );
    let limit = limit.or_else(|| output::lane().map(|_| IN_A_LANE));
    let (status, given_up) = wait(&mut child, limit)?;
    let all = |reading: Option<Reading>| {
        reading
            .map_or(Ok(String::new()), Reading::end)
            .with_context(|| format!("reading of {} broke off", shown(command)))
    };
    Ok(Told {
        success: given_up.is_none() && status.success(),
        output: all(stdout)?,
        errors: all(stderr)?,
        status,
        given_up,
    })
}

/// Waits for the end; where that does not come, makes it, and says so.
fn wait(child: &mut Child, limit: Option<Duration>) -> Result<(ExitStatus, Option<String>)> {
    let Some(limit) = limit else {
        return Ok((child.wait()?, None));
    };
    let end = Instant::now() + limit;
    let mut pause = Duration::from_millis(1);
    while Instant::now() < end {
        if let Some(status) = child.try_wait()? {
            return Ok((status, None));
        }
        thread::sleep(pause);
        pause = (2 * pause).min(Duration::from_millis(50));
    }
    let names = end_all(child)?;
    let mut how = format!("took longer than {} s and was ended", limit.as_secs());
    if !names.is_empty() {
        how.push_str(&format!(", with what it ran: {}", names.join(", ")));
    }
    Ok((child.wait()?, Some(how)))
}

/// Ends a program and all that it started, whose names are returned.
fn end_all(child: &mut Child) -> Result<Vec<String>> {
    let below = Process::below(child.id(), Process::all().unwrap_or_default());
    // It first, so that it starts nothing in their place.
    child.kill()?;
    for process in &below {
        // One that has ended meanwhile is what was wanted.
        let number = process.number.to_string();
        let _ = Command::new("kill").args(["-9", &number]).output();
    }
    Ok(below.into_iter().map(|process| process.name).collect())
}

/// A command as it is told of.
pub(super) fn shown(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_stem().unwrap_or(program.as_os_str());
    let words = std::iter::once(name).chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    format!("`{}`", words.join(" "))
}

/// A program that runs on this machine.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Process {
    number: u32,
    /// Which started it.
    parent: u32,
    name: String,
}

impl Process {
    /// All that run; an error where no `ps` tells it.
    fn all() -> Result<Vec<Self>> {
        let said = Command::new("ps")
            .args(["-A", "-o", "pid=,ppid=,comm="])
            .output()?;
        let said = String::from_utf8_lossy(&said.stdout);
        Ok(said.lines().filter_map(Self::of_line).collect())
    }

    fn of_line(line: &str) -> Option<Self> {
        let (number, rest) = line.trim().split_once(' ')?;
        let (parent, name) = rest.trim().split_once(' ')?;
        Some(Self {
            number: number.parse().ok()?,
            parent: parent.parse().ok()?,
            name: name.trim().to_owned(),
        })
    }

    /// Those that one started, and that these started.
    fn below(first: u32, all: Vec<Self>) -> Vec<Self> {
        let mut below: Vec<Self> = Vec::new();
        let mut others = all;
        loop {
            let (found, left): (Vec<_>, Vec<_>) = others.into_iter().partition(|process| {
                process.parent == first || below.iter().any(|one| one.number == process.parent)
            });
            if found.is_empty() {
                return below;
            }
            below.extend(found);
            others = left;
        }
    }
}

/// One of a program's outputs, read while it runs.
struct Reading {
    kept: Arc<Mutex<String>>,
    ended: Receiver<io::Result<()>>,
}

impl Reading {
    fn begin(from: impl Read + Send + 'static, shown: bool) -> Self {
        let kept = Arc::new(Mutex::new(String::new()));
        let (end, ended) = mpsc::channel();
        let (lane, into) = (output::lane(), Arc::clone(&kept));
        thread::spawn(move || {
            let read = || lines(from, &into, shown);
            let read = match lane {
                Some(lane) => lane.work(read),
                None => read(),
            };
            // Nobody may wait for it any more.
            let _ = end.send(read);
        });
        Self { kept, ended }
    }

    /// What it was, when the program has ended.
    fn end(self) -> io::Result<String> {
        match self.ended.recv_timeout(LEFT_TO_READ) {
            Ok(read) => read?,
            Err(_) => say("something that the program left behind holds its output open"),
        }
        Ok(std::mem::take(&mut *locked(&self.kept)))
    }
}

/// Keeps lines as they come, and shows them where that is asked.
fn lines(from: impl Read, into: &Mutex<String>, shown: bool) -> io::Result<()> {
    for line in BufReader::new(from).split(b'\n') {
        let line = line?;
        let line = String::from_utf8_lossy(&line);
        if shown {
            say(&line);
        }
        let mut kept = locked(into);
        kept.push_str(&line);
        kept.push('\n');
    }
    Ok(())
}

fn locked(kept: &Mutex<String>) -> MutexGuard<'_, String> {
    kept.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(text: &str, limit: Duration) -> Told {
        let mut shell = Command::new("sh");
        shell.args(["-c", text]);
        shell.stdout(Stdio::piped()).stderr(Stdio::piped());
        told(&mut shell, Some(limit), false).unwrap()
    }

    #[test]
    fn what_hangs_is_ended_with_all_that_it_started_and_what_it_said_is_kept() {
        let told = shell(
            "echo begun; sleep 61.25 & sh -c 'sleep 61.25; true'",
            Duration::from_millis(300),
        );
        assert!(!told.success);
        assert_eq!(told.output, "begun\n");
        let how = told.how();
        assert!(how.starts_with("took longer than 0 s"), "{how}");
        assert!(how.matches("sleep").count() == 2, "{how}");
        let failed = told.or_failed("a test", telling::of_others).unwrap_err();
        assert!(failed.to_string().starts_with("a test took longer"));
        let alive = Command::new("ps").args(["-A", "-o", "args="]).output();
        let alive = String::from_utf8_lossy(&alive.unwrap().stdout).into_owned();
        assert!(!alive.lines().any(|line| line == "sleep 61.25"), "{alive}");
    }

    #[test]
    fn what_is_left_behind_is_not_waited_for() {
        let begun = Instant::now();
        let told = shell("echo done; sleep 37.5 &", Duration::from_secs(60));
        assert!(told.success);
        assert_eq!(told.output, "done\n");
        assert!(begun.elapsed() < Duration::from_secs(37));
    }

    #[test]
    fn programs_below_one_are_found_over_several_steps() {
        let lines = "  10 1 sh\n 12 10 node\n 11 12 chrome --a\n 13 1 sh\n14 11 x\nnothing";
        let all: Vec<Process> = lines.lines().filter_map(Process::of_line).collect();
        assert_eq!(all.len(), 5);
        let below = Process::below(10, all);
        let names: Vec<&str> = below.iter().map(|process| process.name.as_str()).collect();
        assert_eq!(names, ["node", "chrome --a", "x"]);
    }
}
