//! A component's whole film judged.

use alloc::vec;
use alloc::vec::Vec;

use super::cell::Cell;
use super::conclusion::{Conclusion, doubt_between_doubts, doubt_few, fill_gaps};
use super::distrust::Distrust;
use super::known_femur::KnownFemur;
use super::side_margin::SideMargin;
use super::trust::{FrameEvidence, Trust, judge_film};
use super::trust_limits::TrustLimits;
use crate::joint::beside::Beside;
use crate::math::Vector3;
use crate::mesh::anatomy::KneeComponent;

/// What is known besides a component's own frames when its film is judged.
#[derive(Clone, Copy, Debug, Default)]
pub struct KnownBeside<'b> {
    /// Where the other component is, in the camera's frame at the middle of its box, where that is known ([`trusted_middles`]), mm; may be
    /// shorter than the film.
    pub other_middles: &'b [Option<Vector3>],
    /// Of a tibia its femur.
    pub femur: Option<&'b KnownFemur>,
    /// What is told of each frame of a film whose components lie beside each other ([`Middles::judge_poses`](crate::joint::beside::Middles::judge_poses));
    /// may be shorter than the film.
    pub joint: &'b [Option<Beside>],
    /// The component that the model has the shape of, where that is the other one.
    pub other_shape: Option<KneeComponent>,
    /// Gaps of at most so many frames between frames to be trusted are filled.
    pub longest_gap: usize,
}

/// Concludes for every frame of a component. `side_margins` tell by how much another pose of each frame is less likely
/// ([`super::other_margins`]), and may be shorter than the film. `middle` is the model's.
#[must_use]
pub fn conclude(
    cells: &[Cell],
    side_margins: &[Option<SideMargin>],
    beside: &KnownBeside<'_>,
    middle: &Vector3,
) -> Vec<Conclusion> {
    let mut film = judged(cells, side_margins, beside, &TrustLimits::USUAL, middle);
    if let Some(shape) = beside.other_shape {
        // Right or not, they are not those of the component whose name they bear.
        film.iter_mut()
            .for_each(|one| one.distrust(Distrust::Shape(shape)));
    }
    distrust_by_joint(&mut film, beside);
    doubt_between_doubts(&mut film);
    doubt_few(&mut film);
    // Only now is it known which frames are to be trusted; what is taken from these is asked what its joint says as well.
    fill_gaps(&mut film, beside.longest_gap, middle);
    distrust_by_joint(&mut film, beside);
    film
}

/// Makes poses doubtful against which their joint with the other component speaks.
fn distrust_by_joint(film: &mut [Conclusion], beside: &KnownBeside<'_>) {
    if let Some(femur) = beside.femur {
        femur.distrust_impossible(film);
    }
    for (one, told) in film.iter_mut().zip(beside.joint) {
        match told {
            Some(told) if told.of_film => one.distrust_before_all(Distrust::Mirrored(*told)),
            Some(told) => one.distrust(Distrust::Mirrored(*told)),
            None => {}
        }
    }
}

/// Where a component is in each frame, in the camera's frame at the `middle` of its box, mm; only where its pose is to be trusted by
/// itself: else it says nothing of the other component. A jump along the image plane does not count: whether the other one makes it too is
/// what is asked next.
#[must_use]
pub fn trusted_middles(
    cells: &[Cell],
    side_margins: &[Option<SideMargin>],
    middle: &Vector3,
) -> Vec<Option<Vector3>> {
    let limits = TrustLimits {
        jump_mm: f64::INFINITY,
        ..TrustLimits::USUAL
    };
    let alone = judged(
        cells,
        side_margins,
        &KnownBeside::default(),
        &limits,
        middle,
    );
    let place = |one: &Conclusion| {
        let pose = one.pose.filter(|_| one.is_trusted())?;
        Some(pose.transform(middle))
    };
    alone.iter().map(place).collect()
}

/// What the frames of a component come to by what they say of each other.
fn judged(
    cells: &[Cell],
    side_margins: &[Option<SideMargin>],
    beside: &KnownBeside<'_>,
    limits: &TrustLimits,
    middle: &Vector3,
) -> Vec<Conclusion> {
    let evidence = cells.iter().enumerate().map(|(frame, cell)| {
        let margin = side_margins.get(frame).copied().flatten();
        let other = beside.other_middles.get(frame).copied().flatten();
        FrameEvidence::of(cell, margin, other)
    });
    let evidence: Vec<FrameEvidence> = evidence.collect();
    let mut trusts = vec![Trust::default(); cells.len()];
    let mut sorted = vec![0.0; cells.len()];
    judge_film(&evidence, limits, middle, &mut sorted, &mut trusts);
    let one = |(cell, trust)| Conclusion::of(cell, trust);
    cells.iter().zip(&trusts).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::{looked, turned};
    use crate::pose::Pose;

    /// Twelve frames at rest, but for the sixth, which lies so far to the right, mm.
    fn film(off_mm: f64) -> Vec<Cell> {
        let cell = |frame: usize| {
            let mut found = turned(0.0, 0.1);
            found.pose.translation[0] = if frame == 5 { off_mm } else { 0.0 };
            Cell::on_the_way(looked(Ok(found)))
        };
        (0..12).map(cell).collect()
    }

    /// The frames that are doubtful beside another component.
    fn doubtful(cells: &[Cell], other: Option<&[Cell]>) -> Vec<usize> {
        let middle = [3.0, -2.0, 1.0];
        let other_middles = other.map_or(Vec::new(), |cells| trusted_middles(cells, &[], &middle));
        let beside = KnownBeside {
            other_middles: &other_middles,
            ..KnownBeside::default()
        };
        let film = conclude(cells, &[], &beside, &middle);
        (0..film.len())
            .filter(|&frame| !film[frame].is_trusted())
            .collect()
    }

    /// A gap is as good as what lies on both sides of it, and what lies there may be doubtful for a reason of the joint, of the film or of the
    /// model.
    #[test]
    fn no_gap_is_filled_from_a_pose_that_is_not_to_be_trusted() {
        use crate::follow::State;
        use crate::follow::look::Missing;
        let mut cells = film(0.0);
        cells[7] = Cell::on_the_way(looked(Err(Missing::Hidden)));
        // From here on the tibia is turned as no knee is.
        for cell in &mut cells[8..] {
            *cell = Cell::on_the_way(looked(Ok(turned(70.0, 0.1))));
        }
        let axes = Pose::IDENTITY;
        let femur = |turned_deg: f64| KnownFemur {
            poses: vec![Some(turned(turned_deg, 0.1).pose); cells.len()],
            axes,
        };
        let state = |femur: Option<&KnownFemur>, other_shape, longest_gap| {
            let beside = KnownBeside {
                femur,
                other_shape,
                longest_gap,
                ..KnownBeside::default()
            };
            let film = conclude(&cells, &[], &beside, &[0.0; 3]);
            (film[7].state, film[7].pose.is_some())
        };
        let (filled, empty) = ((State::Interpolated, true), (State::Untrackable, false));
        assert_eq!(state(None, None, 1), filled);
        assert_eq!(state(None, None, 0), empty);
        assert_eq!(state(Some(&femur(35.0)), None, 1), filled);
        for deg in [0.0, 70.0, 150.0] {
            assert_eq!(state(Some(&femur(deg)), None, 1), empty, "{deg}");
        }
        assert_eq!(state(None, Some(KneeComponent::Femur), 1), empty);
    }

    #[test]
    fn a_jump_of_one_component_is_doubtful_and_one_of_both_is_their_motion() {
        let (still, jumps) = (film(0.0), film(20.0));
        assert_eq!(doubtful(&jumps, None), [4, 5, 6]);
        assert_eq!(doubtful(&jumps, Some(&still)), [4, 5, 6]);
        assert!(doubtful(&jumps, Some(&jumps)).is_empty());
        assert!(doubtful(&still, Some(&jumps)).is_empty());
        assert!(doubtful(&still, None).is_empty());
    }
}
