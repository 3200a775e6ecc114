//! Who works on a study: a file that one task can make and all can see, with a heartbeat.
//!
//! A claim whose task is gone is taken over: at once where it is known to be gone (a process of this machine that is no more, an
//! earlier life of the same task of an array), else when its heart has not beaten for a while. Times are those of the file system
//! alone, so the clocks of machines may differ.

use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime};

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};

use crate::files::read_text;

/// Beats within the time after which a claim is stale.
const BEATS: u32 = 4;

/// Who claims.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Claimant {
    /// The machine's name.
    pub(super) host: String,
    /// The process.
    pub(super) process: u32,
    /// Job, task and process of an array, where there is one.
    pub(super) task: Option<String>,
    /// How often that was put back into the queue and started again.
    restarts: u32,
    /// Tells one claim from all others.
    token: String,
}

impl Claimant {
    /// This process.
    fn own() -> Self {
        let host = fs::read_to_string("/proc/sys/kernel/hostname").ok();
        let host = host
            .or_else(|| std::env::var("HOSTNAME").ok())
            .unwrap_or_default();
        let variable = |name| std::env::var(name).ok();
        let job = variable("SLURM_ARRAY_JOB_ID").zip(variable("SLURM_ARRAY_TASK_ID"));
        let step = variable("SLURM_PROCID").unwrap_or_default();
        let restarts = variable("SLURM_RESTART_COUNT").and_then(|count| count.parse().ok());
        let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        let process = std::process::id();
        Self {
            host: host.trim().to_owned(),
            process,
            task: job.map(|(job, task)| format!("{job}_{task}.{step}")),
            restarts: restarts.unwrap_or(0),
            token: format!("{process}-{}", since.unwrap_or_default().as_nanos()),
        }
    }

    /// Whether the task of a claim is known to be gone.
    fn is_gone(&self, own: &Self) -> bool {
        let lives = || Path::new("/proc").join(self.process.to_string()).exists();
        let is_here = self.host == own.host && Path::new("/proc/self").exists();
        let is_earlier =
            self.task.is_some() && self.task == own.task && self.restarts < own.restarts;
        (is_here && !lives()) || is_earlier
    }
}

/// What became of a task whose study the next one takes over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// It is known to be gone.
    Gone,
    /// Its heart has not beaten for so long.
    Silent(Duration),
}

/// A claim as another task finds it.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// Whose it is.
    pub(super) claimant: Claimant,
    /// Whether it is over.
    pub(super) end: Option<End>,
}

impl Held {
    /// The claim on a study, if there is one.
    pub(super) fn on(folder: &Path, name: &str, stale: Duration) -> Option<Self> {
        Self::at(&folder.join(name), &Claimant::own(), stale)
    }

    fn at(path: &Path, own: &Claimant, stale: Duration) -> Option<Self> {
        let claimant = holder(path)?;
        let silent = || held_for(path).filter(|age| *age >= stale).map(End::Silent);
        let end = match claimant.is_gone(own) {
            true => Some(End::Gone),
            false => silent(),
        };
        Some(Self { claimant, end })
    }
}

/// A study that is this task's for as long as this value lives.
pub(super) struct Claim {
    path: PathBuf,
    own: Claimant,
    end: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Claim {
    /// Claims a study; `None` where another task has it, whose heart has beaten within `stale`.
    ///
    /// # Errors
    /// Where the folder cannot be written.
    pub(super) fn take(folder: &Path, name: &str, stale: Duration) -> Result<Option<Self>> {
        let path = folder.join(name);
        let own = Claimant::own();
        for _ in 0..3 {
            if make(&path, &own)? {
                return Ok(Some(Self::beating(path, own, stale)));
            }
            let Some(other) = Held::at(&path, &own, stale) else {
                // It is being written, or was just given back.
                thread::sleep(Duration::from_millis(50));
                if held_for(&path).is_some_and(|age| age < stale) {
                    return Ok(None);
                }
                take_away(&path, None)?;
                continue;
            };
            if other.end.is_none() {
                return Ok(None);
            }
            take_away(&path, Some(&other.claimant))?;
        }
        Ok(None)
    }

    /// Whether the study still is this task's.
    ///
    /// # Errors
    /// Where another has taken it, because this one's heart was not seen to beat.
    pub(super) fn check(&self) -> Result<()> {
        if holder(&self.path).as_ref() == Some(&self.own) {
            return Ok(());
        }
        bail!("another task has taken this study over: this one was too slow to be seen alive")
    }

    fn beating(path: PathBuf, own: Claimant, stale: Duration) -> Self {
        let (sender, receiver) = channel();
        let beat = (path.clone(), own.clone());
        let heart = thread::spawn(move || beat_until(&receiver, &beat.0, &beat.1, stale / BEATS));
        Self {
            path,
            own,
            end: Some((sender, heart)),
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        if let Some((sender, heart)) = self.end.take() {
            drop(sender);
            // A heart that broke off has nothing to tell.
            let _ = heart.join();
        }
        if self.check().is_ok() {
            // One that stays is stale.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Who has a study now.
fn holder(path: &Path) -> Option<Claimant> {
    serde_json::from_str(&read_text(path).ok()?).ok()
}

/// Makes the claim's file, unless there is one.
fn make(path: &Path, own: &Claimant) -> Result<bool> {
    match OpenOptions::new().write(true).create_new(true).open(path) {
        Ok(mut file) => {
            file.write_all(&serde_json::to_vec(own)?)?;
            Ok(true)
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Ok(false),
        Err(error) => Err(error).with_context(|| format!("cannot write {}", path.display())),
    }
}

/// Since when the heart of a claim has not beaten, by the file system's own clock.
fn held_for(path: &Path) -> Option<Duration> {
    let beaten = fs::metadata(path).ok()?.modified().ok()?;
    let probe = path.with_file_name(format!(".now-{}", std::process::id()));
    File::create(&probe).ok()?;
    let now = fs::metadata(&probe).ok()?.modified().ok();
    let _ = fs::remove_file(&probe);
    now?.duration_since(beaten).ok()
}

/// Takes a stale claim away. Where it turns out to be a new one, because another task was quicker, that is put back.
fn take_away(path: &Path, stale: Option<&Claimant>) -> Result<()> {
    let aside = path.with_file_name(format!(".stale-{}", Claimant::own().token));
    match fs::rename(path, &aside) {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Err(error) => {
            return Err(error).with_context(|| format!("cannot take {} away", path.display()));
        }
    }
    if holder(&aside).as_ref() != stale {
        // A link is made only where nobody has claimed since; otherwise the task notices that it has lost its claim.
        let _ = fs::hard_link(&aside, path);
    }
    let _ = fs::remove_file(&aside);
    Ok(())
}

fn beat_until(end: &Receiver<()>, path: &Path, own: &Claimant, pause: Duration) {
    while end.recv_timeout(pause) == Err(RecvTimeoutError::Timeout) {
        if holder(path).as_ref() != Some(own) {
            return;
        }
        // A blank at the end of the file is no change of what it says. A beat that fails is made up for by the next.
        let beat = OpenOptions::new().append(true).open(path);
        let _ = beat.and_then(|mut file| file.write_all(b"\n"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONG: Duration = Duration::from_secs(600);

    fn folder(name: &str) -> PathBuf {
        let folder =
            std::env::temp_dir().join(format!("fluoropose-claim-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    /// A claim of a task that lives elsewhere, beaten so long ago.
    fn foreign(path: &Path, ago: Duration) -> Claimant {
        let other = Claimant {
            host: "elsewhere".to_owned(),
            process: 1,
            task: None,
            restarts: 0,
            token: "1-1".to_owned(),
        };
        fs::write(path, serde_json::to_vec(&other).unwrap()).unwrap();
        let file = OpenOptions::new().append(true).open(path).unwrap();
        file.set_modified(SystemTime::now() - ago).unwrap();
        other
    }

    #[test]
    fn one_of_many_gets_a_study_and_gives_it_back() {
        let folder = folder("one");
        let taken = Claim::take(&folder, "a", LONG).unwrap().unwrap();
        let others = (0..8).map(|_| {
            let folder = folder.clone();
            thread::spawn(move || Claim::take(&folder, "a", LONG).unwrap().is_some())
        });
        let others: Vec<bool> = others
            .collect::<Vec<_>>()
            .into_iter()
            .map(|one| one.join().unwrap())
            .collect();
        assert_eq!(others, [false; 8]);
        assert!(taken.check().is_ok());
        drop(taken);
        assert!(Claim::take(&folder, "a", LONG).unwrap().is_some());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_stale_claim_is_taken_over_by_one_task_and_a_live_one_is_not() {
        let folder = folder("stale");
        let path = folder.join("a");
        foreign(&path, Duration::from_secs(60));
        assert!(Claim::take(&folder, "a", LONG).unwrap().is_none());
        assert_eq!(Held::on(&folder, "a", LONG).unwrap().end, None);
        foreign(&path, 2 * LONG);
        let end = Held::on(&folder, "a", LONG).unwrap().end;
        assert!(
            matches!(end, Some(End::Silent(ago)) if ago >= LONG),
            "{end:?}"
        );
        let takers = (0..8).map(|_| {
            let folder = folder.clone();
            thread::spawn(move || Claim::take(&folder, "a", LONG).unwrap())
        });
        let taken: Vec<Option<Claim>> = takers
            .collect::<Vec<_>>()
            .into_iter()
            .map(|one| one.join().unwrap())
            .collect();
        let valid = taken.iter().flatten().filter(|claim| claim.check().is_ok());
        assert_eq!(valid.count(), 1);
        drop(taken);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_process_that_is_gone_holds_nothing() {
        let folder = folder("gone");
        let mut child = std::process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        let gone = Claimant {
            process: child.id(),
            ..Claimant::own()
        };
        fs::write(folder.join("a"), serde_json::to_vec(&gone).unwrap()).unwrap();
        let held = Held::on(&folder, "a", LONG).unwrap();
        let is_told = held.end == Some(End::Gone);
        assert_eq!(is_told, Path::new("/proc/self").exists());
        let taken = Claim::take(&folder, "a", LONG).unwrap();
        assert_eq!(taken.is_some(), Path::new("/proc/self").exists());
        drop(taken);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn an_earlier_life_of_a_task_is_over_and_its_neighbours_are_not() {
        let life = |step: &str, restarts| Claimant {
            host: step.to_owned(),
            process: 1,
            task: Some(format!("12_3.{step}")),
            restarts,
            token: String::new(),
        };
        assert!(life("0", 0).is_gone(&life("0", 1)));
        assert!(!life("0", 1).is_gone(&life("0", 1)));
        assert!(!life("1", 0).is_gone(&life("0", 1)));
    }

    #[test]
    fn a_heart_beats_and_a_lost_claim_is_noticed() {
        let folder = folder("heart");
        let stale = Duration::from_millis(200);
        let claim = Claim::take(&folder, "a", stale).unwrap().unwrap();
        thread::sleep(3 * stale);
        assert!(held_for(&folder.join("a")).unwrap() < stale);
        foreign(&folder.join("a"), Duration::ZERO);
        assert!(claim.check().is_err());
        drop(claim);
        assert!(folder.join("a").exists(), "another's claim stays");
        fs::remove_dir_all(folder).unwrap();
    }
}
