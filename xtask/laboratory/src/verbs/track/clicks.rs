//! Clicks whose poses do not convince: they are held back until it is known what the film finds without them.

use anyhow::Result;
use fluoropose::follow::{
    Anchor, BesideClick, ClickOutcome, FramePose, click_outcome, holds_place, leads_by_itself,
};

use super::follow::followed_to;
use super::part::Part;
use super::request::{Click, Told};
use super::run::Run;
use super::search::{Beside, clicked};

/// A click whose pose does not convince.
#[derive(Clone)]
pub(super) struct Doubtful {
    pub(super) click: Click,
    pub(super) found: FramePose,
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
    ) -> Result<ClickOutcome> {
        let frame = self.click.frame;
        let Some(nearest) = known.iter().min_by_key(|one| one.frame.abs_diff(frame)) else {
            return Ok(ClickOutcome::Leads);
        };
        let there = followed_to(run, part, nearest, frame)?;
        let holds = there.as_ref().map(|there| self.is_held(part, there));
        let holds = holds.transpose()?;
        let other = BesideClick {
            found: there.as_ref().unwrap_or(&nearest.found),
            holds,
        };
        let outcome = click_outcome(&self.found, self.is_held(part, &self.found)?, other);
        if outcome != ClickOutcome::Outdone {
            return Ok(outcome);
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
        Ok(outcome)
    }

    /// Whether what is drawn at a pose holds the place that was pointed at.
    fn is_held(&self, part: &Part<'_>, found: &FramePose) -> Result<bool> {
        let drawn = part.silhouette(&found.pose)?;
        Ok(holds_place(&drawn.mask(), self.click.place))
    }
}
