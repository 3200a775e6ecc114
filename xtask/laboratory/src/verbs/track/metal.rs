//! The frames that components are followed from, in a film that shows metal darker or brighter than what surrounds it.

use anyhow::Result;
use fluoropose::follow::{
    Anchor, ClickOutcome, FramePose, KnownFrame, NOWHERE, Other, Places, Search, SearchPlan,
    SearchStep, Sought, VAIN,
};
use fluoropose::refine::{Polarity, polarity_at, polarity_near};

use super::anchors::{fixed_poses, given};
use super::clicks::Doubtful;
use super::follow::ends_beside;
use super::part::Part;
use super::run::Run;
use super::search::{Beside, in_joint, searched};
use crate::files::{Role, grey};
use crate::options::most;

/// So many fixed poses of a component are asked at most.
const VOTES: usize = 3;

/// The components, and the frames that each is followed from: what a person gave, and what is found of the rest in the order that
/// [`SearchPlan`] tells. Where nobody says how the film shows metal, and nothing is pointed at that would tell it, that is in two ways.
pub(super) fn begun<'s>(
    run: &Run<'_>,
    parts: impl Fn(Polarity) -> Vec<Part<'s>>,
) -> Result<(Vec<Part<'s>>, Vec<Vec<Anchor>>)> {
    let told = match run.request.polarity {
        Some(stated) => Some(stated),
        None => told_by_what_is_given(run, &parts(Polarity::default()))?,
    };
    let mut ways = vec![Way::begin(run, parts(told.unwrap_or_default()))?];
    if told.is_none() {
        ways.push(Way::begin(run, parts(Polarity::BrightImplant))?);
    }
    let (mut way, mut is_given_up) = search(run, ways)?;
    if way.settle_clicks(run)? {
        // What a click leads to after all leads to others.
        (way, is_given_up) = search(run, vec![way])?;
    }
    way.tell_missing(run, is_given_up);
    Ok((way.parts, way.anchors))
}

/// Looks for what is missing in each way of showing metal; the way that counts, and whether what is missing in it was given up.
fn search<'s>(run: &Run<'_>, mut ways: Vec<Way<'s>>) -> Result<(Way<'s>, bool)> {
    let mut sought: Vec<Sought> = ways.iter().flat_map(Way::sought).collect();
    let mut plan = SearchPlan::new(run.film.count(), ways.len() == 1);
    let each = sought.len() / ways.len();
    loop {
        let step = plan.next(&mut sought);
        for (way, sought) in ways.iter_mut().zip(sought.chunks(each.max(1))) {
            way.take(run, sought);
        }
        let Some(step) = step else { break };
        let way = &mut ways[step.way];
        match step.search {
            Search::Follow { from } => {
                let ends = ends_beside(run, &way.parts[step.part], &way.anchors[step.part][from])?;
                plan.followed(ends, &mut sought);
            }
            _ => {
                let found = way.look(run, &step)?;
                plan.found(found.map(|one| (one.pose, one.score())), &mut sought);
            }
        }
    }
    Ok((
        ways.swap_remove(plan.way().unwrap_or(0)),
        plan.is_given_up(),
    ))
}

/// All components of a film that shows metal in one way.
struct Way<'s> {
    parts: Vec<Part<'s>>,
    anchors: Vec<Vec<Anchor>>,
    /// Of each component the clicks whose poses do not convince.
    doubtful: Vec<Vec<Doubtful>>,
    /// What searches led to.
    found: Vec<(SearchStep, FramePose)>,
}

impl<'s> Way<'s> {
    /// With what a person gave.
    fn begin(run: &Run<'_>, parts: Vec<Part<'s>>) -> Result<Self> {
        let (trays, others): (Vec<_>, Vec<_>) = parts
            .iter()
            .partition(|part| part.role() == Some(Role::Tibia));
        let mut anchors = vec![Vec::new(); parts.len()];
        let mut doubtful = vec![Vec::new(); parts.len()];
        for part in others.iter().copied() {
            (anchors[part.number], doubtful[part.number]) = given(run, part, &[])?;
        }
        // A tray stands out less than its femur, which tells where it is.
        for part in trays {
            let known: Vec<_> = others
                .iter()
                .map(|other| (*other, &*anchors[other.number]))
                .collect();
            (anchors[part.number], doubtful[part.number]) = given(run, part, &known)?;
        }
        let mut way = Self {
            parts,
            anchors,
            doubtful,
            found: Vec::new(),
        };
        way.click_beside(run)?;
        Ok(way)
    }

    /// Clicks whose poses do not convince once more, beside what is known in their frames.
    fn click_beside(&mut self, run: &Run<'_>) -> Result<()> {
        for (number, part) in self.parts.iter().enumerate() {
            for one in std::mem::take(&mut self.doubtful[number]) {
                let all = self.parts.iter().zip(&self.anchors);
                let others = all.filter(|(other, _)| other.number != number);
                let others: Vec<_> = others.map(|(part, own)| (part, &**own)).collect();
                let again = one.again(run, part, &others)?;
                match again.convinces() {
                    true => know(&mut self.anchors[number], again.anchor()),
                    false => self.doubtful[number].push(again),
                }
            }
        }
        Ok(())
    }

    /// Compares clicks whose poses do not convince, the best first, with what was found without them. Returns whether one of them leads
    /// where nothing else did.
    fn settle_clicks(&mut self, run: &Run<'_>) -> Result<bool> {
        self.click_beside(run)?;
        let mut leads = false;
        for (number, part) in self.parts.iter().enumerate() {
            let mut doubtful = std::mem::take(&mut self.doubtful[number]);
            doubtful.sort_by(|a, b| b.found.score().total_cmp(&a.found.score()));
            for one in doubtful {
                let anchors = &mut self.anchors[number];
                if let ClickOutcome::Leads = one.against(run, part, anchors)? {
                    anchors.retain(|anchor| !is_of(&self.found, (number, anchor)));
                    leads |= anchors.is_empty();
                    know(anchors, one.anchor());
                }
            }
        }
        Ok(leads)
    }

    /// The components as the order of work knows them.
    fn sought(&self) -> impl Iterator<Item = Sought> {
        let each = self.parts.iter().zip(&self.anchors);
        each.map(|(part, anchors)| {
            let role = part.role().map(Role::component);
            let mut sought = Sought::new(role, part.limb.is_some(), part.middle());
            for anchor in anchors {
                let (frame, found) = (anchor.frame, &anchor.found);
                sought.know(KnownFrame::new(frame, found.pose, found.score()));
            }
            sought
        })
    }

    /// Takes what is known now of components that were missing, and tells it.
    fn take(&mut self, run: &Run<'_>, sought: &[Sought]) {
        for (number, known) in sought.iter().enumerate() {
            let (Some(known), true) = (known.known().first(), self.anchors[number].is_empty())
            else {
                continue;
            };
            let is_it = |(step, found): &&(SearchStep, FramePose)| {
                (step.part, step.frame) == (number, known.frame) && found.pose == known.pose
            };
            if let Some((step, found)) = self.found.iter().find(is_it) {
                self.anchors[number].push(Anchor::found(known.frame, *found));
                let how = match step.search {
                    Search::Joint(_) => ", by its joint".to_owned(),
                    Search::Beside { other, .. } => {
                        format!(", beside the {}", self.parts[other.part].name())
                    }
                    _ => String::new(),
                };
                let (name, frame) = (self.parts[number].name(), known.frame + 1);
                run.say(format!("{name}: found in frame {frame}{how}"));
            }
        }
    }

    /// Does a step of the search.
    fn look(&mut self, run: &Run<'_>, step: &SearchStep) -> Result<Option<FramePose>> {
        let (part, frame) = (&self.parts[step.part], step.frame);
        let beside = |other: Other| Beside {
            part: &self.parts[other.part],
            from: &self.anchors[other.part][other.from],
            pose: other.pose,
        };
        let found = match step.search {
            Search::Whole { depth_mm, places } => {
                let name = part.name();
                run.say(format!("{name}: looked for in frame {}", frame + 1));
                searched(run, part, frame, (depth_mm, places), None)?
            }
            Search::Joint(other) => in_joint(run, part, frame, beside(other))?,
            Search::Beside { other, depth_mm } => {
                let (name, beside) = (part.name(), beside(other));
                let place = format!("beside the {} in frame {}", beside.part.name(), frame + 1);
                run.say(format!("{name}: looked for {place}"));
                searched(
                    run,
                    part,
                    frame,
                    (Some(depth_mm), Places::All),
                    Some(beside),
                )?
            }
            Search::Follow { .. } => None,
        };
        self.found.extend(found.map(|found| (*step, found)));
        Ok(found)
    }

    fn tell_missing(&self, run: &Run<'_>, is_given_up: bool) {
        let spent = match is_given_up {
            true => format!(", and after {VAIN} long searches in vain no more are done"),
            false => String::new(),
        };
        let each = self.parts.iter().zip(&self.anchors);
        for (part, _) in each.filter(|(_, anchors)| anchors.is_empty()) {
            let name = part.name();
            run.say(format!(
                "{name}: {NOWHERE}{spent}; click into it, or fix a pose"
            ));
        }
    }
}

/// Adds a frame that a component is followed from to those that are known.
fn know(anchors: &mut Vec<Anchor>, anchor: Anchor) {
    anchors.push(anchor);
    anchors.sort_by_key(|anchor| anchor.frame);
}

/// Whether a search led to a frame of a component.
fn is_of(found: &[(SearchStep, FramePose)], (part, anchor): (usize, &Anchor)) -> bool {
    let is_it = |(step, found): &(SearchStep, FramePose)| {
        (step.part, step.frame) == (part, anchor.frame) && *found == anchor.found
    };
    found.iter().any(is_it)
}

/// How the film shows metal, by clicks and fixed poses.
fn told_by_what_is_given(run: &Run<'_>, parts: &[Part<'_>]) -> Result<Option<Polarity>> {
    let mut votes = Vec::new();
    for click in &run.request.clicks {
        let decoded = run.film.frame(click.frame)?;
        votes.push(polarity_near(&*grey(&decoded)?, click.place));
    }
    for part in parts {
        for (frame, pose) in fixed_poses(run, part).into_iter().take(VOTES) {
            let told = part.see(run.film, frame, |subject, image, memory| {
                polarity_at(subject.model, subject.camera, &pose, image.frame, memory)
            })?;
            // A pose that cannot be drawn is told where it is used.
            votes.extend(told.ok());
        }
    }
    Ok(most(votes))
}
