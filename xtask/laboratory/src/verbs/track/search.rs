//! A component looked for in a whole frame, or where a person clicked.

use anyhow::Result;
use fluoropose::finder::Component;
use fluoropose::follow::{FramePose, From, refined_on_frame};
use fluoropose::image::contour::Point;
use fluoropose::library::Library;
use fluoropose_tracing::one_click::{Answer, OneClick, Progress, Prompt};
use fluoropose_tracing::seeds::{expected_size, seeds, seeds_needed};

use super::part::Part;
use super::run::Run;
use crate::files::grey;
use crate::finding::Clicker;

/// Of the answers to a click so many are refined once more and compared.
const ANSWERS: usize = 4;
/// A pose that nobody pointed at must have answers at least so good, its outline met by this part, its edges nearer than
/// this and seen by this part.
const LEAST_SCORE: f64 = 0.5;
const LEAST_MET: f64 = 0.9;
const MOST_PX: f64 = 1.5;
const LEAST_KNOWN: f64 = 0.7;
/// A place is left where its best answer has a smaller score than this before its surroundings are searched once more, and
/// before poses around that answer are tried; how far the work is then.
const WORTH: f64 = 0.2;
const AGAIN: f64 = 0.575;
const WORTH_MUCH: f64 = 0.45;
const AROUND: f64 = 0.655;
/// Better ones are not looked for beyond this score.
const ENOUGH: f64 = 0.75;

/// The pose that a click leads to; `None` where it leads nowhere.
pub(super) fn clicked(
    run: &Run<'_>,
    part: &Part<'_>,
    frame: usize,
    place: [f64; 2],
) -> Result<Option<FramePose>> {
    let [column, row] = place.map(f64::to_bits);
    let key = format!(
        "click/{}/{}/{frame}/{column:x}/{row:x}",
        part.number,
        part.phase()
    );
    run.journal.step(&key, || {
        let at = Point::new(place[0], place[1]);
        let mut found: Option<FramePose> = None;
        for (number, distance) in part.distances().into_iter().enumerate() {
            let bytes = part.library(number, distance)?;
            let mut clicker = Clicker::open(bytes, part.model(), part.camera)?;
            let answers = answers(run, part, &mut clicker, frame, at, |_| true)?;
            let one = best(run, part, frame, &answers)?;
            let better = |one: &FramePose| found.is_none_or(|found| one.score() > found.score());
            found = one.filter(better).or(found);
        }
        Ok(found)
    })
}

/// The pose of a component in a frame that nobody clicked into; `None` where none is good.
pub(super) fn searched(run: &Run<'_>, part: &Part<'_>, frame: usize) -> Result<Option<FramePose>> {
    let key = format!("search/{}/{}/{frame}", part.number, part.phase());
    run.journal.step(&key, || {
        let mut found: Option<FramePose> = None;
        for (number, distance) in part.distances().into_iter().enumerate() {
            let bytes = part.library(number, distance)?;
            found = found.or(search(run, part, bytes, frame)?);
        }
        Ok(found)
    })
}

fn search(run: &Run<'_>, part: &Part<'_>, bytes: &[u8], frame: usize) -> Result<Option<FramePose>> {
    let mut clicker = Clicker::open(bytes, part.model(), part.camera)?;
    let mut found: Option<FramePose> = None;
    for at in places(run, part, bytes, frame)? {
        let answers = answers(run, part, &mut clicker, frame, at, is_worth_it)?;
        run.debug(|| {
            let best = answers
                .first()
                .map(|best| (best.score, best.support.fraction));
            let (name, at) = (part.name(), [at.column, at.row]);
            format!("{name} frame {}: {at:.0?}: {best:.2?}", frame + 1)
        });
        let good = |answer: &&Answer| answer.score >= LEAST_SCORE;
        let answers: Vec<Answer> = answers.iter().filter(good).copied().collect();
        let Some(one) = best(run, part, frame, &answers)?.filter(is_good) else {
            continue;
        };
        if found.is_none_or(|found| one.score() > found.score()) {
            found = Some(one);
        }
        if found.is_some_and(|found| found.score() >= ENOUGH) {
            break;
        }
    }
    Ok(found)
}

/// Whether a click at a place that nobody chose is worth going on with: most lead nowhere.
fn is_worth_it(work: &OneClick) -> bool {
    let best = work.answers().first().map_or(0.0, |best| best.score);
    match work.progress() {
        Progress::Poses(part) if part >= AROUND => best >= WORTH_MUCH,
        Progress::Poses(part) if part >= AGAIN => best >= WORTH,
        _ => true,
    }
}

fn is_good(found: &FramePose) -> bool {
    found.fit.met >= LEAST_MET && found.misfit_px <= MOST_PX && found.fit.known >= LEAST_KNOWN
}

/// Places worth a click.
fn places(run: &Run<'_>, part: &Part<'_>, bytes: &[u8], frame: usize) -> Result<Vec<Point>> {
    let (library, model) = (Library::open(bytes)?, part.model());
    let component = Component {
        library: &library,
        model: &model,
        planes: &part.planes,
    };
    let size = expected_size(&component, &part.camera);
    let mut sums = vec![0.0; seeds_needed(&part.camera)];
    let decoded = run.film.frame(frame)?;
    let frame = grey(&decoded)?;
    let found = seeds(&*frame, &part.camera, size, part.polarity, &mut sums)?;
    Ok(found.to_vec())
}

fn answers(
    run: &Run<'_>,
    part: &Part<'_>,
    clicker: &mut Clicker<'_>,
    frame: usize,
    at: Point,
    go_on: fn(&OneClick) -> bool,
) -> Result<Vec<Answer>> {
    let decoded = run.film.frame(frame)?;
    let grey = grey(&decoded)?;
    let prompt = Prompt::Click(at);
    let clicked = clicker.click_while(&*grey, prompt, part.polarity, go_on);
    // A click that leads nowhere has no answers.
    Ok(clicked.map_or(Vec::new(), |clicked| clicked.answers))
}

fn best(
    run: &Run<'_>,
    part: &Part<'_>,
    frame: usize,
    answers: &[Answer],
) -> Result<Option<FramePose>> {
    part.see(run.film, frame, |subject, image, memory| {
        let mut best: Option<FramePose> = None;
        for answer in answers.iter().take(ANSWERS) {
            let start = (&answer.refined.pose, From::Far);
            let Ok(found) = refined_on_frame(subject, image, start, memory) else {
                continue;
            };
            if best.is_none_or(|best| found.score() > best.score()) {
                best = Some(found);
            }
        }
        best
    })
}
