//! Verb `batch`: many studies tracked and reported, each by one task of perhaps many.

mod claim;
mod folders;
mod list;
mod manifest;
mod partition;
mod state;
mod work;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Result;
use fluoropose_report::counted;

use crate::options::above_0;
use crate::signals::say_when_ended;
use claim::Claim;
use folders::Folders;
use manifest::Look;
use state::{StudyState, results};

pub use list::{Entry, read_list};
pub use manifest::{Inputs, Manifest, Settings};
pub use partition::Partition;
pub use work::JOINT;

/// Which of a task's studies are worked on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Only {
    /// Those that were not done or not to their end; not those that failed
    Unfinished,
    /// Those that failed
    Failed,
}

/// Options of `batch`.
#[derive(clap::Args)]
#[command(
    after_help = "The list is a table (CSV) with a row a study: study (a study.toml or its folder, from the list's own folder), and where wanted \
name (of its results; else its folder's), knee and group (for `collect`), click and fixed (as of `track`, several with ; between them, and what has a \
comma in quotes):\n\n  study,knee,click\n  left/study.toml,p1,\"femur:1:512,400;tibia:1:500,640\"\n  right/study.toml,p2,\n\n\
Each study is tracked and reported as `track` and `report` do it, into DIR/NAME, with joint.csv and manifest.json: digests of all inputs and \
results, version and settings. Results are written aside and renamed, so what has a manifest is whole. What is done is not done again, unless \
inputs, version or settings have changed; a study that was broken off goes on where it was.\n\n\
Tasks may share a folder: each study is claimed by one. A claim whose task is gone is taken over, at once where the process is known to be gone, \
else after --stale seconds without a heartbeat. --status tells of each study whether it is done, doubtful (done, some frames doubtful), outdated \
(of another version or other settings), claimed, abandoned (its task is gone: the next one takes it over), failed, crashed or unfinished.\n\n\
It exits with the highest code that a study of the part gives, with --status too: 0 all done; 3 done, some frames doubtful or without a pose; 4 a study's \
input is bad (failed); 5 a study broke the program off (crashed); 6 a study is not done: another task works on it or did, it was left out, or its results \
are outdated. 1 and 2 are for what is wrong with the command itself.\n\n\
A task that is stopped loses nothing but the step in hand: the same command goes on from there.\n\n\
Examples:\n  cargo xtask batch studies.csv --out results --partition slice:1/4\n  cargo xtask batch studies.csv --out results --status"
)]
pub struct Args {
    /// List of studies (CSV)
    list: PathBuf,
    /// Folder of results; made if absent
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Part of the list that is this task's: slice:M/N every N-th study, hash:M/N by name [default: that of a Slurm array's task, else all]
    #[arg(long, value_name = "RULE:M/N")]
    partition: Option<Partition>,
    /// Say how far the studies are, and do nothing
    #[arg(long)]
    status: bool,
    /// Which studies to work on [default: all that are not done]
    #[arg(long, value_enum)]
    only: Option<Only>,
    /// Frames a second of studies that state none, neither by themselves nor by their DICOM frames
    #[arg(long, value_name = "HZ", value_parser = above_0)]
    fps: Option<f64>,
    /// Cutoff of a filter whose numbers stand beside the others in joint.csv
    #[arg(long, value_name = "HZ", value_parser = above_0)]
    cutoff: Option<f64>,
    /// Fill gaps of at most so many frames between followed ones
    #[arg(long, value_name = "FRAMES", default_value_t = 0)]
    interpolate: usize,
    /// Seconds without a heartbeat after which another task's claim is taken over
    #[arg(long, value_name = "SECONDS", default_value_t = 120, value_parser = clap::value_parser!(u64).range(1..))]
    stale: u64,
    /// Read the frames of studies that are done as well, to see whether they have changed
    #[arg(long)]
    verify: bool,
    /// Look for nothing: try list, partition, claims and folders out
    #[arg(long)]
    rehearse: bool,
}

/// Why a study of a folder of results failed, if it did.
pub fn failure_of(results: &Path, name: &str) -> Option<String> {
    Some(Folders::at(results).failure(name)?.because)
}

/// Runs the verb; the code to exit with.
///
/// # Errors
/// For a list that cannot be read and a folder that cannot be written. What is wrong with a study is noted, and the next is worked on.
pub fn run(args: Args) -> Result<u8> {
    let entries = read_list(&args.list)?;
    let partition = match args.partition {
        Some(partition) => partition,
        None => Partition::of_slurm(|name| std::env::var(name).ok())?.unwrap_or(Partition::WHOLE),
    };
    let own = entries.iter().enumerate();
    let own = own.filter(|(place, entry)| partition.holds(*place, &entry.name));
    let own: Vec<&Entry> = own.map(|(_, entry)| entry).collect();
    let folders = Folders::make(&args.out)?;
    if !args.status {
        say_when_ended(format!(
            "finished studies are in {0}, the one in hand is kept in {1}; the same command goes on from there (--status: how far all are)",
            args.out.display(),
            folders.aside("").display()
        ));
        crate::progress::without_bars();
        own.iter().try_for_each(|entry| args.one(entry, &folders))?;
    }
    let settings = args.settings();
    let states = own.iter().map(|entry| {
        Ok((
            *entry,
            StudyState::of(entry, &settings, &folders, args.stale())?,
        ))
    });
    let states = states.collect::<Result<Vec<_>>>()?;
    print(&states, args.status);
    Ok(states
        .iter()
        .map(|(_, state)| state.exit_code())
        .max()
        .unwrap_or(0))
}

impl Args {
    fn stale(&self) -> Duration {
        Duration::from_secs(self.stale)
    }

    fn settings(&self) -> Settings {
        Settings {
            frames_per_s: self.fps,
            cutoff_hz: self.cutoff,
            interpolate: self.interpolate,
            rehearsal: self.rehearse,
        }
    }

    /// Works on a study, if that is wanted, needed and free.
    fn one(&self, entry: &Entry, folders: &Folders) -> Result<()> {
        let settings = self.settings();
        let wanted = |failed: bool| match self.only {
            None => true,
            Some(Only::Unfinished) => !failed,
            Some(Only::Failed) => failed,
        };
        if !wanted(folders.failure(&entry.name).is_some())
            || self.is_done(entry, &settings, folders)?
        {
            return Ok(());
        }
        let Some(claim) = Claim::take(&folders.claims(), &entry.name, self.stale())? else {
            return Ok(());
        };
        // Whoever had the claim before may have just ended.
        if self.is_done(entry, &settings, folders)? {
            return Ok(());
        }
        match work::work(entry, &settings, folders, &claim)? {
            Ok(manifest) => println!(
                "{}: {}, {} doubtful",
                entry.name,
                counted(manifest.frames, "frame"),
                manifest.doubtful
            ),
            Err(failure) => eprintln!("{}: {}", entry.name, failure.because),
        }
        Ok(())
    }

    fn is_done(&self, entry: &Entry, settings: &Settings, folders: &Folders) -> Result<bool> {
        let Some(Ok(manifest)) = results(entry, settings, folders)? else {
            return Ok(false);
        };
        let look = if self.verify {
            Look::Whole
        } else {
            Look::Quick
        };
        // Inputs that cannot be read any more are told by working on the study.
        Ok(Inputs::read(entry, settings, look).is_ok_and(|now| now.agree(&manifest.inputs)))
    }
}

fn print(states: &[(&Entry, StudyState)], each: bool) {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for (entry, state) in states {
        *counts.entry(state.word()).or_default() += 1;
        if each {
            println!("{}\t{}\t{state}", entry.name, state.word());
        }
    }
    let counts: Vec<String> = counts
        .iter()
        .map(|(word, count)| format!("{word} {count}"))
        .collect();
    let all = match states.len() {
        1 => "1 study".to_owned(),
        more => format!("{more} studies"),
    };
    println!("{all}: {}", counts.join(", "));
}
