//! A component looked for in a whole frame, or where a person clicked.

use std::time::{Duration, Instant};

use anyhow::Result;
use fluoropose::follow::{
    Anchor, FramePose, From, InJoint, JointSearch, Limb, Places, refined_on_frame,
};
use fluoropose::image::contour::Point;
use fluoropose::pose::Pose;
use fluoropose_tracing::one_click::{Answer, Prompt};

use super::follow::mark;
use super::part::Part;
use super::run::Run;
use crate::files::{MaskBuffer, grey};
use crate::finding::{Clicker, Neighbour};

/// Of the answers to a click so many are refined once more and compared.
const ANSWERS: usize = 4;
/// So often a search says how far it is.
const TELLS: Duration = Duration::from_millis(250);

/// The pose that a click leads to, perhaps beside another component that is known there; `None` where it leads nowhere.
pub(super) fn clicked(
    run: &Run<'_>,
    part: &Part<'_>,
    frame: usize,
    place: [f64; 2],
    beside: Option<Beside<'_, '_>>,
) -> Result<Option<FramePose>> {
    let [column, row] = place.map(f64::to_bits);
    let (number, phase) = (part.number, part.phase());
    let known = beside.as_ref().map_or(String::new(), Beside::key);
    let key = format!("click/{number}/{phase}/{frame}/{column:x}/{row:x}{known}");
    run.step((part, frame), "clicked into", &key, || {
        let at = Point::new(place[0], place[1]);
        let knee = match beside {
            Some(beside) => Knee::of(part, &beside)?,
            None => None,
        };
        let knee = knee.as_ref();
        let mut found: Option<FramePose> = None;
        let distances = part.distances(None);
        for &(number, distance) in &distances {
            let bytes = part.library(number, distance)?;
            let mut clicker = Clicker::open(bytes, part.model(), part.camera)?;
            let answers = answers(run, part, &mut clicker, frame, at, knee)?;
            let one = best(run, part, frame, &answers, knee)?;
            let better = |one: &FramePose| found.is_none_or(|found| one.score() > found.score());
            found = one.filter(better).or(found);
        }
        // Where nobody told a distance the farthest library is not the last word.
        if let (None, &[(number, farthest), _, ..]) = (&found, distances.as_slice()) {
            let bytes = part.library(number, farthest)?;
            let mut clicker = Clicker::open(bytes, part.model(), part.camera)?.or_farther();
            let answers = answers(run, part, &mut clicker, frame, at, knee)?;
            found = best(run, part, frame, &answers, knee)?;
        }
        Ok(found)
    })
}

/// Another component in a frame, as it follows from one of its anchors.
#[derive(Clone, Copy)]
pub(super) struct Beside<'b, 's> {
    pub(super) part: &'b Part<'s>,
    pub(super) from: &'b Anchor,
    pub(super) pose: Pose,
}

impl<'b, 's> Beside<'b, 's> {
    /// The first of other components that is known in a frame.
    pub(super) fn in_frame(frame: usize, others: &[(&'b Part<'s>, &'b [Anchor])]) -> Option<Self> {
        let mut known = others
            .iter()
            .flat_map(|&(part, own)| own.iter().map(move |from| (part, from)));
        let (part, from) = known.find(|(_, from)| from.frame == frame)?;
        Some(Self {
            part,
            from,
            pose: from.found.pose,
        })
    }
}

impl Beside<'_, '_> {
    /// What a step that goes by it is called after.
    fn key(&self) -> String {
        format!("/beside-{}-{}", self.part.number, mark(self.from))
    }
}

/// What a component beside another one is told of that.
struct Knee<'k> {
    joint: InJoint,
    clicked: &'k Limb<'k>,
    covered: MaskBuffer,
}

impl<'k> Knee<'k> {
    /// `None` where the shape of either does not tell which way it lies.
    fn of(part: &'k Part<'_>, beside: &Beside<'_, '_>) -> Result<Option<Self>> {
        let (Some(clicked), Some(other)) = (&part.limb, &beside.part.limb) else {
            return Ok(None);
        };
        Ok(Some(Self {
            joint: InJoint::beside(other, &beside.pose),
            clicked,
            covered: beside.part.silhouette(&beside.pose)?,
        }))
    }

    fn neighbour(&self) -> Neighbour<'_> {
        Neighbour {
            joint: &self.joint,
            clicked: self.clicked,
            covered: self.covered.mask(),
        }
    }
}

/// The pose of a component in a frame that nobody clicked into, perhaps beside another that is known; `None` where none is good.
/// `depth` is about how far away it is, mm, where that is known of other frames or of the other component; `places` are those of the frame
/// that are tried.
pub(super) fn searched(
    run: &Run<'_>,
    part: &Part<'_>,
    frame: usize,
    (depth, places): (Option<f64>, Places),
    beside: Option<Beside<'_, '_>>,
) -> Result<Option<FramePose>> {
    let known = beside.as_ref().map_or(String::new(), Beside::key);
    let (number, phase) = (part.number, part.phase());
    let at = match places {
        Places::Shaped => "/shaped",
        Places::Dark => "/dark",
        Places::All => "",
    };
    let key = format!("search/{number}/{phase}/{frame}{at}{known}");
    run.step((part, frame), "searched", &key, || {
        let unknown = match beside {
            Some(beside) => Some(beside.part.silhouette(&beside.pose)?),
            None => None,
        };
        let unknown = unknown.as_ref().map(MaskBuffer::mask);
        let middle = beside.map(|beside| beside.pose.transform(&beside.part.middle()));
        for (number, distance) in part.distances(depth) {
            run.say(format!(
                "{} frame {}: compared with views from {distance:.0} mm",
                part.name(),
                frame + 1
            ));
            let mut clicker =
                Clicker::open(part.library(number, distance)?, part.model(), part.camera)?;
            let found =
                part.see_beside(run.film, frame, unknown.as_ref(), |subject, image, _| {
                    let told = search_told(run, part, frame);
                    clicker.search(subject, image, (places, middle), told)
                })??;
            if let Some(found) = found.filter(|found| part.may_be_at(&found.pose.pose)) {
                return Ok(Some(found.pose));
            }
        }
        Ok(None)
    })
}

/// The pose of a component in a frame where its joint leaves it `beside` the other one; `None` where it does not show there, or where the
/// shape of either does not tell which way it lies.
pub(super) fn in_joint(
    run: &Run<'_>,
    part: &Part<'_>,
    frame: usize,
    beside: Beside<'_, '_>,
) -> Result<Option<FramePose>> {
    let known = format!("{}-{}", beside.part.number, mark(beside.from));
    let (number, phase) = (part.number, part.phase());
    let key = format!("joint/{number}/{phase}/{frame}/{known}");
    let what = format!("looked for beside the {}", beside.part.name());
    run.step((part, frame), &what, &key, || {
        let Some(knee) = Knee::of(part, &beside)? else {
            return Ok(None);
        };
        let unknown = knee.covered.mask();
        let stop = &run.request.stop;
        part.see_beside(run.film, frame, Some(&unknown), |subject, image, memory| {
            let mut search = JointSearch::new(image, &knee.joint, knee.clicked);
            while search.step(subject, image, memory) {
                stop.check()?;
            }
            let possible = |found: &&FramePose| part.may_be_at(&found.pose);
            Ok(search.found().filter(possible).copied())
        })?
    })
}

/// Tells how far the search of a frame is, and ends it where the run is to stop.
fn search_told(run: &Run<'_>, part: &Part<'_>, frame: usize) -> impl FnMut(f64) -> Result<()> {
    let mut told = Instant::now();
    move |done| {
        if told.elapsed() >= TELLS {
            told = Instant::now();
            let (name, percent) = (part.name(), 100.0 * done);
            run.say(format!(
                "{name} frame {}: {percent:.0} % searched",
                frame + 1
            ));
        }
        run.request.stop.check()
    }
}

fn answers(
    run: &Run<'_>,
    part: &Part<'_>,
    clicker: &mut Clicker<'_>,
    frame: usize,
    at: Point,
    knee: Option<&Knee<'_>>,
) -> Result<Vec<Answer>> {
    let decoded = run.film.frame(frame)?;
    let grey = grey(&decoded)?;
    let prompt = Prompt::Click(at);
    let neighbour = knee.map(Knee::neighbour);
    let clicked = clicker.click(&*grey, prompt, part.polarity, neighbour.as_ref());
    // A click that leads nowhere has no answers.
    Ok(clicked.map_or(Vec::new(), |clicked| clicked.answers))
}

fn best(
    run: &Run<'_>,
    part: &Part<'_>,
    frame: usize,
    answers: &[Answer],
    knee: Option<&Knee<'_>>,
) -> Result<Option<FramePose>> {
    let unknown = knee.map(|knee| knee.covered.mask());
    part.see_beside(
        run.film,
        frame,
        unknown.as_ref(),
        |subject, image, memory| {
            let mut best: Option<FramePose> = None;
            let possible = |answer: &&Answer| part.may_be_at(&answer.refined.pose);
            for answer in answers.iter().filter(possible).take(ANSWERS) {
                let start = (&answer.refined.pose, From::Far);
                let found = refined_on_frame(subject, image, start, memory);
                let Some(found) = found.ok().filter(|found| part.may_be_at(&found.pose)) else {
                    continue;
                };
                if best.is_none_or(|best| found.score() > best.score()) {
                    best = Some(found);
                }
            }
            best
        },
    )
}
