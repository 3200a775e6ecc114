//! Clicks whose poses do not convince: they are held back until it is known what the film finds without them.

use anyhow::Result;
use fluoropose::follow::{Anchor, BesideClick, FramePose, click_leads, leads_by_itself};
use fluoropose::pose::geodesic_deg;

use super::follow::followed_to;
use super::part::Part;
use super::request::{Click, Told};
use super::run::Run;
use super::search::{Beside, clicked};

/// Poses that hold the place and are turned by less than this against each other are one, degrees.
const SAME_DEG: f64 = 3.0;

/// A click whose pose does not convince.
#[derive(Clone)]
pub(super) struct Doubtful {
    pub(super) click: Click,
    pub(super) found: FramePose,
}

/// What a click comes to, once it is known what the film finds without it.
pub(super) enum Outcome {
    /// What is found without it is the same.
    Same,
    /// It leads.
    Leads,
    /// What is found without it leads, which was told.
    Outdone,
}

impl Doubtful {
    /// The same clicked once more beside another component, where one is known in the frame: the better of both.
    pub(super) fn again(
        self,
        run: &Run<'_>,
        part: &Part<'_>,
        others: &[(&Part<'_>, &[Anchor])],
    ) -> Result<Self> {
        let (frame, place) = (self.click.frame, self.click.place);
        let Some(known) = Beside::in_frame(frame, others) else {
            return Ok(self);
        };
        let again = clicked(run, part, frame, place, Some(known))?;
        let better = again.filter(|again| again.score() > self.found.score());
        Ok(Self {
            found: better.unwrap_or(self.found),
            ..self
        })
    }

    /// As a frame to follow the component from.
    pub(super) fn anchor(&self) -> Anchor {
        Anchor::found(self.click.frame, self.found)
    }

    /// Whether it leads by itself after all.
    pub(super) fn convinces(&self) -> bool {
        leads_by_itself(&self.found)
    }

    /// Compares it with what the nearest of the frames in which the component is `known` leads to in its own.
    pub(super) fn against(
        &self,
        run: &Run<'_>,
        part: &Part<'_>,
        known: &[Anchor],
    ) -> Result<Outcome> {
        let frame = self.click.frame;
        let Some(nearest) = known.iter().min_by_key(|one| one.frame.abs_diff(frame)) else {
            return Ok(Outcome::Leads);
        };
        let there = followed_to(run, part, nearest, frame)?;
        let holds = there.as_ref().map(|there| self.is_held(part, there));
        let holds = holds.transpose()?;
        if holds == Some(true) && there.is_some_and(|there| self.is_turned_as(&there)) {
            return Ok(Outcome::Same);
        }
        let other = BesideClick {
            found: there.as_ref().unwrap_or(&nearest.found),
            holds,
        };
        if click_leads(&self.found, self.is_held(part, &self.found)?, other) {
            return Ok(Outcome::Leads);
        }
        let told = format!(
            "{}: the pose that it leads to lies on weaker edges ({:.2}) than what is found of the {} in frame {} ({:.2}), which leads instead",
            self.click.called,
            self.found.score(),
            part.name(),
            nearest.frame + 1,
            other.found.score(),
        );
        (run.request.listener)(Told::Remark(told));
        Ok(Outcome::Outdone)
    }

    fn is_turned_as(&self, other: &FramePose) -> bool {
        geodesic_deg(&self.found.pose.rotation, &other.pose.rotation) < SAME_DEG
    }

    /// Whether what is drawn at a pose holds the place that was pointed at.
    fn is_held(&self, part: &Part<'_>, found: &FramePose) -> Result<bool> {
        let drawn = part.silhouette(&found.pose)?;
        let mask = drawn.mask();
        let [column, row] = self.click.place.map(|place| place as usize);
        Ok(column < mask.width() && row < mask.height() && mask.get(column, row))
    }
}
