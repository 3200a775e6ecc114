//! The state of every frame, at the end.

use fluoropose::follow::{FrameEvidence, Missing, State, Trust, TrustLimits, between, judge_film};
use fluoropose::pose::Pose;

use super::follow::Cell;
use super::part::Part;
use super::sides::Margins;

/// A frame at the end.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    /// What is known of it.
    pub(super) state: State,
    /// The pose; none where there is none.
    pub(super) pose: Option<Pose>,
    /// Why the frame is in its state, in a sentence without its full stop.
    pub(super) because: String,
    /// How bad it is: above 1 it is doubtful.
    pub(super) badness: f64,
}

/// Judges a component's frames. `depths` are those of the other component.
pub(super) fn judge(
    part: &Part<'_>,
    cells: &[Cell],
    margins: &Margins,
    depths: &[Option<f64>],
    interpolate: usize,
) -> Vec<Judged> {
    let evidence: Vec<FrameEvidence> = cells
        .iter()
        .enumerate()
        .map(|(frame, cell)| FrameEvidence {
            found: cell.found().copied(),
            side_margin: margins.get(frame).copied().flatten(),
            other_way: cell.other_way,
            other_depth_mm: depths.get(frame).copied().flatten(),
            fixed: cell.fixed,
        })
        .collect();
    let mut trusts = vec![Trust::default(); cells.len()];
    let mut sorted = vec![0.0; cells.len()];
    let limits = TrustLimits::USUAL;
    judge_film(&evidence, &limits, &part.middle(), &mut sorted, &mut trusts);
    let one = |(cell, trust): (&Cell, &Trust)| Judged {
        state: state(cell, trust),
        pose: cell.found().map(|found| found.pose),
        because: because(cell, trust),
        badness: trust.badness,
    };
    let mut judged: Vec<Judged> = cells.iter().zip(&trusts).map(one).collect();
    fill_gaps(part, &mut judged, interpolate);
    judged
}

fn state(cell: &Cell, trust: &Trust) -> State {
    match (&cell.looked, cell.fixed) {
        (_, true) => State::Fixed,
        (None, _) => State::Unsolved,
        (Some(looked), _) => match (&looked.found, trust.distrust) {
            (Err(_), _) => State::Untrackable,
            (Ok(_), Some(_)) => State::Doubtful,
            (Ok(_), None) => State::Followed,
        },
    }
}

fn because(cell: &Cell, trust: &Trust) -> String {
    let Some(looked) = &cell.looked else {
        return "it was not found in any frame that leads here".to_owned();
    };
    match looked.found {
        Ok(_) if cell.fixed => "a person fixed the pose".to_owned(),
        Ok(_) => trust.distrust.map_or_else(
            || "the edges lie on the outline, and the frames beside it agree".to_owned(),
            |distrust| format!("{}: {distrust}", distrust.word()),
        ),
        Err(Missing::Outside) => format!(
            "only {:.0} % of the component would be in the frame",
            100.0 * looked.known
        ),
        Err(Missing::Hidden) => "there are no edges of it where it is expected".to_owned(),
    }
}

/// Fills gaps of at most so many frames between frames to be trusted.
fn fill_gaps(part: &Part<'_>, judged: &mut [Judged], longest: usize) {
    let trusted = |one: &Judged| matches!(one.state, State::Fixed | State::Followed);
    let mut at = 0;
    while at < judged.len() {
        let end = (at + 1..judged.len()).find(|&k| judged[k].pose.is_some());
        let Some(end) = end else { return };
        let gap = end - at - 1;
        if let (Some(from), Some(to)) = (judged[at].pose, judged[end].pose)
            && (1..=longest).contains(&gap)
            && trusted(&judged[at])
            && trusted(&judged[end])
        {
            for (k, one) in judged[at + 1..end].iter_mut().enumerate() {
                let fraction = (k + 1) as f64 / (end - at) as f64;
                one.pose = Some(between(&from, &to, fraction, &part.middle()));
                one.state = State::Interpolated;
                one.because = format!("taken from the frames on both sides; {}", one.because);
            }
        }
        at = end;
    }
}
