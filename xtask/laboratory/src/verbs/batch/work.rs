//! One study, from its files to its results.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;

use anyhow::Result;

use super::claim::Claim;
use super::folders::{Failure, FailureKind, Folders};
use super::list::Entry;
use super::manifest::{Inputs, Look, Manifest, Settings};
use crate::files::{Study, write_text};
use crate::progress::Stop;
use crate::verbs::report::knee::Filtering;
use crate::verbs::report::{self, own_frames_per_s, report};
use crate::verbs::track::{Request, Told, Tracked, doubtful_frames, track};

/// The study's joint, frame by frame.
pub const JOINT: &str = "joint.csv";

/// Works on a study that was claimed; its results are in their place then, or the failure is noted.
///
/// # Errors
/// Where neither can be written.
pub(super) fn work(
    entry: &Entry,
    settings: &Settings,
    folders: &Folders,
    claim: &Claim,
) -> Result<Result<Manifest, Failure>> {
    let whole = catch_unwind(AssertUnwindSafe(|| whole(entry, settings, folders, claim)));
    let failure = match whole {
        Ok(Ok(manifest)) => return Ok(Ok(manifest)),
        Ok(Err(error)) => Failure {
            kind: kind_of(&error),
            because: format!("{error:#}"),
        },
        Err(panic) => Failure {
            kind: FailureKind::Crash,
            because: words_of(panic.as_ref()),
        },
    };
    folders.note(&entry.name, Some(&failure))?;
    Ok(Err(failure))
}

fn whole(entry: &Entry, settings: &Settings, folders: &Folders, claim: &Claim) -> Result<Manifest> {
    let inputs = Inputs::read(entry, settings, Look::Whole)?;
    let aside = folders.begin(&entry.name, &inputs)?;
    let (frames, doubtful) = match settings.rehearsal {
        true => rehearse(&aside, &inputs)?,
        false => found(entry, settings, &aside)?,
    };
    let manifest = Manifest {
        name: entry.name.clone(),
        inputs,
        frames,
        doubtful,
        outputs: Default::default(),
    };
    claim.check()?;
    folders.publish(&entry.name, manifest)
}

/// Number of frames, and of doubtful ones.
fn found(entry: &Entry, settings: &Settings, aside: &Path) -> Result<(usize, usize)> {
    let name = entry.name.clone();
    let study = Study::read(&entry.study)?;
    let frames_per_s = rate(&study, settings);
    if study.is_knee() {
        // Its report needs them, at the end of all work.
        study.known_side()?;
        Filtering::new(frames_per_s, settings.cutoff_hz)?;
    }
    let tracked = track(&Request {
        study: entry.study.clone(),
        out: aside.to_owned(),
        clicks: entry.clicks.clone(),
        fixed: entry
            .fixed
            .iter()
            .map(|fixed| fixed.read(study.frames_folder()?))
            .collect::<Result<_>>()?,
        polarity: None,
        interpolate: settings.interpolate,
        anew: false,
        listener: Arc::new(move |told| {
            if let Told::Remark(remark) = told {
                eprintln!("{name}: {remark}");
            }
        }),
        stop: Stop::default(),
    })?;
    let mut doubtful = doubtful_frames(&tracked);
    if study.is_knee() {
        let of_study = report::Args {
            study: Some(entry.study.clone()),
            group: Vec::new(),
            poses: Some(aside.to_owned()),
            out: aside.to_owned(),
            fps: frames_per_s,
            cutoff: settings.cutoff_hz,
            overlay: false,
        };
        // What no knee does shows in no pose alone.
        let reported = report(&entry.study, &of_study)?;
        doubtful.extend(reported.doubtful_frames());
    }
    // It says how far an unfinished run has come, in the order in which threads came there.
    std::fs::remove_file(aside.join("journal.txt"))?;
    Ok((frames_of(&tracked), doubtful.len()))
}

/// Frames a second of a study: its own, and of one that has none those of the batch.
fn rate(study: &Study, settings: &Settings) -> Option<f64> {
    own_frames_per_s(study).or(settings.frames_per_s)
}

fn rehearse(aside: &Path, inputs: &Inputs) -> Result<(usize, usize)> {
    write_text(&aside.join("rehearsal.txt"), "nothing was looked for\n")?;
    Ok((inputs.frames.0, 0))
}

fn frames_of(tracked: &[Tracked]) -> usize {
    tracked
        .iter()
        .map(|part| part.rows.len())
        .max()
        .unwrap_or(0)
}

/// A disk that is full is no fault of a study.
fn kind_of(error: &anyhow::Error) -> FailureKind {
    use std::io::ErrorKind::{
        InvalidData, InvalidInput, IsADirectory, NotADirectory, NotFound, PermissionDenied,
        UnexpectedEof,
    };
    let of_input = [
        NotFound,
        InvalidData,
        InvalidInput,
        IsADirectory,
        NotADirectory,
        PermissionDenied,
        UnexpectedEof,
    ];
    let machine = |error: &std::io::Error| !of_input.contains(&error.kind());
    let mut causes = error.chain().filter_map(|cause| cause.downcast_ref());
    match causes.any(machine) {
        true => FailureKind::Crash,
        false => FailureKind::Input,
    }
}

fn words_of(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    format!(
        "the program broke off: {}",
        text.unwrap_or("no reason was given")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_study_keeps_its_own_rate_and_a_filter_that_cannot_be_is_told_before_all_work() {
        let place = std::env::temp_dir().join(format!("fluoropose-rates-{}", std::process::id()));
        std::fs::create_dir_all(&place).expect("a folder");
        let file = place.join("study.toml");
        let of = |key: &str, settings: &Settings| {
            let component =
                |name: &str| format!("[[component]]\nname = '{name}'\nmodel = 'm.stl'\n");
            let parts = ["femur", "tibia"].map(component).concat();
            let text = format!(
                "name = 'k'\nside = 'left'\ncalibration = 'c.txt'\nframes = 'none'\n{key}\n{parts}"
            );
            std::fs::write(&file, text).expect("a file");
            let entry = Entry {
                name: "k".to_owned(),
                study: file.clone(),
                knee: "k".to_owned(),
                group: "all".to_owned(),
                clicks: Vec::new(),
                fixed: Vec::new(),
            };
            let study = Study::read(&file).expect("a study");
            let told = found(&entry, settings, &place.join("aside")).expect_err("no model");
            (rate(&study, settings), format!("{told:#}"))
        };
        let settings = |frames_per_s, cutoff_hz| Settings {
            frames_per_s,
            cutoff_hz,
            ..Settings::default()
        };
        let (own, other) = ("frames_per_s = 7.5", settings(Some(30.0), None));
        assert_eq!(
            [of(own, &other).0, of("", &other).0],
            [Some(7.5), Some(30.0)]
        );
        assert_eq!(of("", &settings(None, None)).0, None);
        for (key, settings, words) in [
            ("", settings(None, Some(3.0)), "needs the frames a second"),
            (own, settings(Some(30.0), Some(4.0)), "7.5 frames a second"),
        ] {
            let told = of(key, &settings).1;
            assert!(told.contains(words), "{told}");
        }
        std::fs::remove_dir_all(&place).expect("it was there");
    }

    #[test]
    fn a_full_disk_is_no_fault_of_the_study() {
        let of = |kind| {
            kind_of(&anyhow::Error::from(std::io::Error::from(kind)).context("cannot write a.csv"))
        };
        assert_eq!(of(std::io::ErrorKind::StorageFull), FailureKind::Crash);
        assert_eq!(of(std::io::ErrorKind::NotFound), FailureKind::Input);
        assert_eq!(kind_of(&anyhow::anyhow!("no femur")), FailureKind::Input);
    }
}
