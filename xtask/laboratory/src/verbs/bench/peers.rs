//! Other libraries at the same work, in a Python process that answers one request a line.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;

use crate::progress::announce;

/// What is installed from Python's package registry.
const PACKAGES: [&str; 5] = [
    "numpy>=2",
    "faiss-cpu",
    "usearch",
    "opencv-python-headless",
    "vtk",
];

/// The program that holds them.
const PROGRAM: &str = include_str!("peers.py");

/// A peer's answer.
#[derive(Debug, Deserialize)]
pub(super) struct Answer<T> {
    /// Its own time without ours of asking, ms.
    pub(super) ms: f64,
    /// What it found.
    pub(super) answer: T,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Line<T> {
    Error { error: String },
    Answer(Answer<T>),
}

/// The running process.
pub(super) struct Peers {
    process: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Peers {
    /// Installs the peers into the folder `home`, if that has not been done, and starts them on the data in `folder`.
    ///
    /// Errors where Python or a package cannot be had.
    pub(super) fn start(folder: &Path, home: &Path) -> Result<Self> {
        let python = installed(home)?;
        let program = folder.join("peers.py");
        fs::write(&program, PROGRAM)?;
        let mut process = Command::new(python)
            .arg(&program)
            .arg(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("cannot start the peers")?;
        let requests = process.stdin.take().context("the peers take no requests")?;
        let answers = process.stdout.take().context("the peers give no answers")?;
        Ok(Self {
            process,
            requests,
            answers: BufReader::new(answers),
        })
    }

    /// Asks a peer to do one piece of work.
    ///
    /// Errors with what the peer said where it could not.
    pub(super) fn ask<T: for<'de> Deserialize<'de>>(
        &mut self,
        name: &str,
        number: usize,
    ) -> Result<Answer<T>> {
        writeln!(self.requests, "{name} {number}").context("the peers have ended")?;
        self.requests.flush()?;
        let mut line = String::new();
        self.answers.read_line(&mut line)?;
        match serde_json::from_str(&line).with_context(|| format!("the peers ended at {name}"))? {
            Line::Answer(answer) => Ok(answer),
            Line::Error { error } => bail!("{error}"),
        }
    }
}

impl Drop for Peers {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The Python of the peers' own folder.
fn installed(folder: &Path) -> Result<PathBuf> {
    let python = folder.join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    });
    let done = folder.join("installed");
    let wanted = PACKAGES.join("\n");
    if fs::read_to_string(&done).is_ok_and(|text| text == wanted) {
        return Ok(python);
    }
    let system = ["python3", "python"]
        .into_iter()
        .find(|name| run(Command::new(name).arg("--version")).is_ok())
        .context("the peers need Python 3 with venv and pip; `python3` is not on the PATH")?;
    announce("installing the peers (pip)");
    run(Command::new(system).args(["-m", "venv"]).arg(folder))?;
    run(Command::new(&python)
        .args(["-m", "pip", "install", "--quiet"])
        .args(PACKAGES))?;
    fs::write(&done, wanted)?;
    Ok(python)
}

fn run(command: &mut Command) -> Result<()> {
    let program = command.get_program().to_string_lossy().into_owned();
    let status = command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .status()
        .with_context(|| format!("cannot start {program}"))?;
    ensure!(status.success(), "{program} failed ({status})");
    Ok(())
}
