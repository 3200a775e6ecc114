//! Verb `track`: both components followed through a film on its grey frames.

mod anchors;
mod constants;
mod film;
mod follow;
mod journal;
mod judge;
mod metal;
mod part;
mod record;
mod request;
mod run;
mod search;
mod sides;
mod table;

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Result;

use crate::choice::report::NEAR_THE_POLE;
use crate::exit;
use crate::options::Shown;
use crate::progress::Stop;
use crate::signals::say_when_ended;
use crate::verbs::report::impossible;

pub use film::{Tracked, doubtful_frames, track};
pub use request::{Click, Fixed, FixedPoses, Listener, Request, Told};
pub use table::Row;

/// Options of `track`.
#[derive(clap::Args)]
#[command(
    after_help = format!("Poses that are known in some frames are followed to both ends of the film on its grey frames: those of --fixed, which \
never change, and those that a click leads to. A component without either is looked for in whole frames.\n\n\
Files in the folder: COMPONENT.jts (a row a frame, NaN where nothing was found), track.csv (frame, component, state, verdict, reason, the six \
numbers and one standard deviation of each, and last the name of the frame's file and the frame's number in it), COMPONENT.covariances.csv, film.csv (the constants of the \
film), and journal.txt, which is written after every frame: a run that was stopped goes on from there, \
and after other clicks or fixed poses only what lies between them is done again.\n\n\
States: fixed (a person gave the pose: each row of --fixed that is not NaN), followed, interpolated (see --interpolate), doubtful (look at it: the reason is told), untrackable \
(looked for and not there) and unsolved (never reached). The command exits with 7 where no component was found in any frame. A run that is stopped (Ctrl-C, a task's end) loses nothing but the step in hand.\n\n\
Of the standard deviations in track.csv: {}\n\n\
Examples:\n  cargo xtask track --study study.toml --out tracked\n  \
cargo xtask track --study study.toml --out tracked --click femur:1:512,400 --click tibia:1:500,640\n  \
cargo xtask track --study study.toml --out tracked --fixed femur=checked.jts", NEAR_THE_POLE)
)]
pub struct Args {
    /// Study file; it needs the key frames
    #[arg(long)]
    study: PathBuf,
    /// Folder for what is found
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// A place inside a component in a frame, from 1; pixels
    #[arg(long, value_name = "COMPONENT:FRAME:COLUMN,ROW")]
    click: Vec<Click>,
    /// Poses that a person fixed: a row a frame. Every row with a pose counts as one, so NaN stands where nobody checked it
    #[arg(long, value_name = "COMPONENT=FILE")]
    fixed: Vec<FixedPoses>,
    #[command(flatten)]
    shown: Shown,
    /// Fill gaps of at most so many frames between followed ones
    #[arg(long, value_name = "FRAMES", default_value_t = 0)]
    interpolate: usize,
    /// Begin anew, whatever the folder holds
    #[arg(long)]
    anew: bool,
}

/// Runs the verb; the code to exit with.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn run(args: Args) -> Result<u8> {
    let request = Request {
        study: args.study,
        out: args.out,
        clicks: args.click,
        fixed: args
            .fixed
            .iter()
            .map(FixedPoses::read)
            .collect::<Result<_>>()?,
        polarity: args.shown.stated(),
        interpolate: args.interpolate,
        anew: args.anew,
        listener: Arc::new(|told| match told {
            Told::Remark(what) | Told::Step { what, .. } => eprintln!("{what}"),
        }),
        stop: Stop::default(),
    };
    say_when_ended(format!(
        "what was done is kept in {}; the same command goes on from there",
        request.out.display()
    ));
    let tracked = track(&request)?;
    for part in &tracked {
        println!("{part}");
    }
    for told in impossible(&request.study, &request.out) {
        println!("{told}");
    }
    Ok(match tracked.iter().any(Tracked::is_found) {
        true => 0,
        false => exit::NOTHING_FOUND,
    })
}
