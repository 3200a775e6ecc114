//! Verb `track`: both components followed through a film on its grey frames.

mod anchors;
mod clicks;
mod constants;
mod film;
mod follow;
mod followed;
mod journal;
mod judged;
mod left_over;
mod metal;
mod mirrored;
mod part;
mod record;
mod request;
mod run;
mod search;
mod sides;
mod squares;
mod table;

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::Result;

use crate::choice::report::NEAR_THE_POLE;
use crate::exit;
use crate::files::Study;
use crate::options::{Shown, study_files};
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
never change, and those that a click leads to. A component without either is looked for in whole frames, and one whose clicks do not convince too: what is better leads, which is told.\n\n\
Frames stand in the order of their files' names, numbers by their value: f2 before f10. Files that are damaged are told before anything is looked for.\n\n\
Files in the folder: COMPONENT.jts (a row a frame, NaN where nothing was found), track.csv, COMPONENT.covariances.csv, film.csv (the constants of the \
film, in pixels of the file, and square_px: the side of the squares of pixels that it is read in, 1 unless pixels are much finer than the blur), found_with.csv (digests of \
calibration and models: `report` says where they are others since), and journal.txt, which is written after every frame: a run that was stopped goes on from there, \
and after other clicks or fixed poses only what lies between them is done again, with the constants of the film as the folder's first run told them: what they come to with \
other poses, --anew tells.\n\n\
track.csv: frame, component, state, verdict (good, doubtful or none), because (the reason of both), the six numbers and one standard deviation of each (sd_*), misfit_px (what remains between the model's outline and the edges \
of the frame, in pixels of the file), badness (how much the frame speaks against the pose: above 1 it is doubtful, and below 1 for another reason, which because tells), file (the name of the frame's file) and frame_of_file (the frame's \
number in it, from 1).\n\n\
COMPONENT.covariances.csv: frame, and c11 to c66, row by row, the covariance of a turn about the middle of the model's box (a rotation vector, radians: numbers 1 to 3) and a \
shift of that middle (mm: 4 to 6), both along the camera's axes; film1_1 to film2_6: how turn and shift answer to one standard deviation of each of two constants of the film, which \
is in the covariance already and moves both components together.\n\n\
States: fixed (a person gave the pose: each row of --fixed that is not NaN), followed, interpolated (see --interpolate), doubtful (look at it: the reason is told), untrackable \
(looked for and not there) and unsolved (never reached). The command exits with 7 where no component was found in any frame, and with 3 where no pose of a component is good or \
numbers are such as no knee has. A run that is stopped (Ctrl-C, a task's end) loses nothing but the step in hand.\n\n\
Of the standard deviations in track.csv: {}\n\n\
Examples:\n  cargo xtask track --study study.toml --out tracked\n  \
cargo xtask track --study study.toml --out tracked --click femur:1:512,400 --click tibia:1:500,640\n  \
cargo xtask track --study study.toml --out tracked --fixed femur=checked.jts", NEAR_THE_POLE)
)]
pub struct Args {
    /// Study file, or its folder; it needs the key frames
    #[arg(long, value_parser = study_files())]
    study: PathBuf,
    /// Folder for what is found
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// A place inside a component in a frame, from 1: pixels from the frame's upper left corner, to the right and down
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
    let remarks: Arc<Mutex<Vec<String>>> = Arc::default();
    let heard = remarks.clone();
    let request = Request {
        fixed: fixed(&args)?,
        study: args.study,
        out: args.out,
        clicks: args.click,
        polarity: args.shown.stated(),
        interpolate: args.interpolate,
        anew: args.anew,
        listener: Arc::new(move |told| match told {
            Told::Step { what, .. } | Told::Taken(what) => eprintln!("{what}"),
            Told::Remark(what) => {
                eprintln!("{what}");
                let mut heard = heard.lock().unwrap_or_else(PoisonError::into_inner);
                heard.push(what);
            }
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
    for part in tracked.iter().filter(|part| !part.is_found()) {
        let name = &part.component;
        println!(
            "{name} was not found in any frame; a place inside it leads there: --click {name}:FRAME:COLUMN,ROW"
        );
    }
    let mut wrong = false;
    for told in impossible(&request.study, &request.out) {
        wrong = true;
        println!("{told}");
    }
    // Told when the run began, which hundreds of lines may stand below by now.
    for remark in &*remarks.lock().unwrap_or_else(PoisonError::into_inner) {
        println!("remark: {remark}");
    }
    Ok(match &tracked {
        none if !none.iter().any(Tracked::is_found) => exit::NOTHING_FOUND,
        all if wrong || !all.iter().all(Tracked::is_good) => exit::DOUBTFUL,
        _ => 0,
    })
}

/// The poses that a person fixed, in the order of the study's frames.
fn fixed(args: &Args) -> Result<Vec<Fixed>> {
    if args.fixed.is_empty() {
        return Ok(Vec::new());
    }
    let study = Study::read_quietly(&args.study)?;
    let frames = study.frames_folder()?;
    args.fixed.iter().map(|one| one.read(frames)).collect()
}
