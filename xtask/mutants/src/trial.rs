//! Runs of tests: each by itself to learn what it reaches, then those that reach a change with the change.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};

use crate::switch::{CHANGE, REACHED};

/// A test that takes so many times as long as without a change goes round in a circle.
const MOST_TIMES: u32 = 10;
const LEAST_LIMIT: Duration = Duration::from_secs(20);
/// Room that a program of tests may take, KiB: what goes round in a circle may ask for ever more.
const MOST_MEMORY: u64 = 6_000_000;

/// A test.
#[derive(Clone, Debug)]
pub(crate) struct Test {
    pub(crate) program: PathBuf,
    pub(crate) folder: PathBuf,
    pub(crate) name: String,
    /// How long it takes without a change.
    pub(crate) takes: Duration,
    /// The numbers of the changes that it reaches.
    pub(crate) reaches: HashSet<usize>,
}

/// How a run of tests ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    Passed,
    Failed,
    TooLong,
}

/// The tests of programs that hold one of some parts in their names, with what each reaches, by all processors.
///
/// # Errors
/// Where a program does not list its tests, or a test fails without a change.
pub(crate) fn recorded(
    programs: &[(PathBuf, PathBuf)],
    parts: &[String],
    longest: Duration,
    folder: &Path,
) -> Result<(Vec<Test>, Vec<String>)> {
    let mut tests = Vec::new();
    for (program, of) in programs {
        for name in listed(program, of)? {
            if parts.is_empty() || parts.iter().any(|part| name.contains(part.as_str())) {
                tests.push((program.clone(), of.clone(), name));
            }
        }
    }
    let results = by_all_processors(&tests, |at, (program, of, name)| {
        let file = folder.join(format!("reached-{at}"));
        let _ = fs::remove_file(&file);
        let start = Instant::now();
        let mut run = run_of(program, of, &[name]);
        run.env(REACHED, &file);
        let end = ended(run, longest)?;
        let told = fs::read_to_string(&file).unwrap_or_default();
        let _ = fs::remove_file(&file);
        if end == End::Failed {
            bail!("{name} fails without a change");
        }
        Ok((end == End::Passed).then(|| Test {
            program: program.clone(),
            folder: of.clone(),
            name: name.clone(),
            takes: start.elapsed(),
            reaches: told.lines().filter_map(|line| line.parse().ok()).collect(),
        }))
    })?;
    let long = tests
        .iter()
        .zip(&results)
        .filter(|(_, result)| result.is_none());
    let long = long.map(|((_, _, name), _)| name.clone()).collect();
    Ok((results.into_iter().flatten().collect(), long))
}

/// Whether the tests that reach a change notice it; the quickest are asked first.
///
/// # Errors
/// Where a program cannot be started.
pub(crate) fn noticed(change: usize, tests: &[Test]) -> Result<bool> {
    let mut reaching: Vec<&Test> = tests
        .iter()
        .filter(|test| test.reaches.contains(&change))
        .collect();
    reaching.sort_by_key(|test| test.takes);
    // One by one while they are quick, then more and more of a program at once.
    let mut at = 0;
    let mut together = 1;
    while at < reaching.len() {
        let first = reaching[at];
        let same = |test: &&&Test| test.program == first.program;
        let group: Vec<&Test> = reaching[at..]
            .iter()
            .take_while(same)
            .take(together)
            .copied()
            .collect();
        let names: Vec<&String> = group.iter().map(|test| &test.name).collect();
        let mut run = run_of(&first.program, &first.folder, &names);
        run.env(CHANGE, change.to_string());
        let takes: Duration = group.iter().map(|test| test.takes).sum();
        if ended(run, (takes * MOST_TIMES).max(LEAST_LIMIT))? != End::Passed {
            return Ok(true);
        }
        at += group.len();
        together *= 2;
    }
    Ok(false)
}

/// Does something with each of some, by as many threads as there are processors; results in order.
///
/// # Errors
/// The first error, after which nothing is begun.
pub(crate) fn by_all_processors<T: Sync, R: Send>(
    all: &[T],
    act: impl Fn(usize, &T) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let next = AtomicUsize::new(0);
    let results: Mutex<Vec<(usize, Result<R>)>> = Mutex::new(Vec::new());
    let work = || {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(one) = all.get(at) else { return };
            let result = act(at, one);
            if result.is_err() {
                next.store(all.len(), Ordering::Relaxed);
            }
            if let Ok(mut results) = results.lock() {
                results.push((at, result));
            }
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(work);
        }
    });
    let mut results = results.into_inner().ok().context("a thread ended early")?;
    results.sort_by_key(|(at, _)| *at);
    results.into_iter().map(|(_, result)| result).collect()
}

fn listed(program: &Path, folder: &Path) -> Result<Vec<String>> {
    let mut list = Command::new(program);
    list.current_dir(folder)
        .args(["--list", "--format", "terse"]);
    let said = list.stdin(Stdio::null()).output()?;
    ensure!(
        said.status.success(),
        "{} does not list its tests",
        program.display()
    );
    let text = String::from_utf8_lossy(&said.stdout).into_owned();
    Ok(text
        .lines()
        .filter_map(|line| line.strip_suffix(": test"))
        .map(str::to_owned)
        .collect())
}

/// Some tests of a program, one after the other.
fn run_of(program: &Path, folder: &Path, names: &[impl AsRef<str>]) -> Command {
    let mut run = Command::new("sh");
    run.args(["-c", &format!("ulimit -v {MOST_MEMORY}; exec \"$@\""), "sh"]);
    run.arg(program).args(["--exact", "--test-threads", "1"]);
    run.args(names.iter().map(AsRef::as_ref));
    run.current_dir(folder).env("RUST_MIN_STACK", "8388608");
    // What it finds this time is not to be tried first the next time.
    run.env("PROPTEST_FAILURE_PERSISTENCE", "off");
    run.stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    run
}

fn ended(mut run: Command, limit: Duration) -> Result<End> {
    let start = Instant::now();
    let mut child: Child = run.spawn().context("tests cannot be started")?;
    let mut pause = Duration::from_millis(1);
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(if status.success() {
                End::Passed
            } else {
                End::Failed
            });
        }
        if start.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Ok(End::TooLong);
        }
        std::thread::sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(20));
    }
}
