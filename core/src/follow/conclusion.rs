//! The state of every frame at the end, with the reason.

use core::fmt;

use super::cell::Cell;
use super::distrust::Distrust;
use super::look::Missing;
use super::motion::between;
use super::side_margin::SideMargin;
use super::state::State;
use super::trust::{FrameEvidence, Trust};
use crate::image::blank::BLANK;
use crate::math::Vector3;
use crate::pose::Pose;

/// Why a frame is in its state. Displayed, it is a sentence without its full stop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Why {
    /// No frame that leads there has the component.
    #[default]
    NeverReached,
    /// A person gave the pose.
    GivenByPerson,
    /// Nothing speaks against the pose.
    Agrees,
    /// The same of a frame that has no poses on both sides of it: the first and the last of a film, or one by itself.
    AgreesAlone,
    /// This does.
    Distrusted(Distrust),
    /// Only this part of the outline would be in the frame.
    Outside(f64),
    /// There are no edges of it.
    Hidden,
    /// The frame shows nothing at all.
    Blank,
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NeverReached => f.write_str("it was not found in any frame that leads here"),
            Self::GivenByPerson => f.write_str("a person fixed the pose"),
            Self::Agrees => {
                f.write_str("the edges lie on the outline, and the frames beside it agree")
            }
            Self::AgreesAlone => f.write_str(
                "the edges lie on the outline; it has no frames on both sides to be compared with",
            ),
            Self::Distrusted(distrust) => write!(f, "{}: {distrust}", distrust.word()),
            Self::Outside(known) => {
                let percent = 100.0 * known;
                write!(
                    f,
                    "only {percent:.0} % of the component would be in the frame"
                )
            }
            Self::Hidden => f.write_str("there are no edges of it where it is expected"),
            Self::Blank => f.write_str(BLANK),
        }
    }
}

/// Where fewer than one pose of so many is to be trusted, none is.
#[cfg(any(feature = "alloc", test))]
const FEW: usize = 4;

/// A frame at the end. Displayed, it is the reason for its state, a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conclusion {
    /// What is known of it.
    pub state: State,
    /// `camera_from_model`; none where there is none.
    pub pose: Option<Pose>,
    /// Why the frame is in its state; of an interpolated one, why nothing was found.
    pub why: Why,
    /// How bad it is: above 1 it is doubtful, and the worst have the most.
    pub badness: f64,
}

impl Conclusion {
    /// The same in pixels of the frames, where these are followed in squares with sides of so many of them.
    #[must_use]
    pub fn in_pixels(&self, side: usize) -> Self {
        let times = side.max(1) as f64;
        let why = match self.why {
            Why::Distrusted(Distrust::Apart(px, usual_px)) => {
                Why::Distrusted(Distrust::Apart(times * px, times * usual_px))
            }
            why => why,
        };
        Self { why, ..*self }
    }

    /// What a frame comes to, and how far its pose is to be trusted.
    #[must_use]
    pub fn of(cell: &Cell, trust: &Trust) -> Self {
        let (state, why) = match (&cell.looked, cell.fixed, trust.distrust) {
            (_, true, None) => (State::Fixed, Why::GivenByPerson),
            // It stays as it is, and is not believed.
            (_, true, Some(distrust)) => (State::Fixed, Why::Distrusted(distrust)),
            (None, ..) => (State::Unsolved, Why::NeverReached),
            (Some(looked), _, distrust) => match (looked.found, distrust) {
                (Err(Missing::Outside), _) => (State::Untrackable, Why::Outside(looked.known)),
                (Err(Missing::Hidden), _) => (State::Untrackable, Why::Hidden),
                (Err(Missing::Blank), _) => (State::Untrackable, Why::Blank),
                (Ok(_), Some(distrust)) => (State::Doubtful, Why::Distrusted(distrust)),
                (Ok(_), None) if trust.is_between => (State::Followed, Why::Agrees),
                (Ok(_), None) => (State::Followed, Why::AgreesAlone),
            },
        };
        Self {
            state,
            pose: cell.found().map(|found| found.pose),
            why,
            badness: trust.badness,
        }
    }

    /// Makes a pose that was to be trusted doubtful, for a reason that lies beyond the frame. One that a person gave stays.
    pub fn distrust(&mut self, distrust: Distrust) {
        if matches!(self.state, State::Followed | State::Interpolated) {
            self.state = State::Doubtful;
            self.why = Why::Distrusted(distrust);
            self.badness = self.badness.max(2.0);
        }
    }

    /// The same for a reason that explains any other doubt: it is told in place of that.
    pub fn distrust_before_all(&mut self, distrust: Distrust) {
        if self.state == State::Doubtful {
            self.why = Why::Distrusted(distrust);
        }
        self.distrust(distrust);
    }

    /// Whether the pose is to be trusted.
    #[must_use]
    pub fn is_trusted(&self) -> bool {
        let doubted = matches!(self.why, Why::Distrusted(_));
        matches!(self.state, State::Fixed | State::Followed) && !doubted
    }

    /// The same, whatever the film's other poses of the component are.
    #[must_use]
    pub fn stands_by_itself(&self) -> bool {
        self.is_trusted() || matches!(self.why, Why::Distrusted(Distrust::Few { .. }))
    }
}

impl fmt::Display for Conclusion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.state == State::Interpolated {
            f.write_str("taken from the frames on both sides; ")?;
        }
        self.why.fmt(f)
    }
}

impl FrameEvidence {
    /// What a frame says when its film is judged. `side_margin` and `other_middle` are those of the fields.
    #[must_use]
    pub fn of(cell: &Cell, side_margin: Option<SideMargin>, other_middle: Option<Vector3>) -> Self {
        Self {
            found: cell.found().copied(),
            side_margin,
            other_way: cell.other_way,
            other_middle,
            fixed: cell.fixed,
        }
    }
}

/// Fills gaps of at most `longest` frames between frames to be trusted. `middle` is the model's.
pub fn fill_gaps(film: &mut [Conclusion], longest: usize, middle: &Vector3) {
    let mut at = 0;
    while at < film.len() {
        let Some(end) = (at + 1..film.len()).find(|&k| film[k].pose.is_some()) else {
            return;
        };
        let gap = end - at - 1;
        if let (Some(from), Some(to)) = (film[at].pose, film[end].pose)
            && (1..=longest).contains(&gap)
            && film[at].is_trusted()
            && film[end].is_trusted()
        {
            for (k, one) in film[at + 1..end].iter_mut().enumerate() {
                let fraction = (k + 1) as f64 / (end - at) as f64;
                one.pose = Some(between(&from, &to, fraction, middle));
                one.state = State::Interpolated;
            }
        }
        at = end;
    }
}

/// Makes a pose doubtful that stands between two doubtful ones, of which one may be another pose itself: that they agree says little.
/// `film` has all frames of a component.
#[cfg(any(feature = "alloc", test))]
pub(super) fn doubt_between_doubts(film: &mut [Conclusion]) {
    let mut before = None;
    for at in 0..film.len() {
        let one = film[at];
        let after = film.get(at + 1).map(|one| one.why);
        if let (Why::Agrees, Some(Why::Distrusted(before)), Some(Why::Distrusted(after))) =
            (one.why, before, after)
            && (before.is_of_another_pose() || after.is_of_another_pose())
        {
            film[at].distrust(Distrust::Beside);
        }
        // As it was: of several in a row each is asked by itself.
        before = Some(one.why);
    }
}

/// Makes the few poses of a film that are to be trusted doubtful where nearly all that was found is: they share model, calibration, constants of
/// the film, and often the way to them. What a person gave counts on neither side.
#[cfg(any(feature = "alloc", test))]
pub(super) fn doubt_few(film: &mut [Conclusion]) {
    let found = |one: &&Conclusion| matches!(one.state, State::Followed | State::Doubtful);
    let poses = film.iter().filter(found).count();
    let good = film
        .iter()
        .filter(found)
        .filter(|one| one.is_trusted())
        .count();
    if FEW * good < poses {
        film.iter_mut()
            .for_each(|one| one.distrust(Distrust::Few { good, poses }));
    }
}

#[cfg(test)]
mod tests;
