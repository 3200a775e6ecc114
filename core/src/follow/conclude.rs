//! A component's whole film judged.

use alloc::vec;
use alloc::vec::Vec;

use super::cell::Cell;
use super::conclusion::Conclusion;
use super::side_margin::SideMargin;
use super::trust::{FrameEvidence, Trust, TrustLimits, judge_film};
use crate::math::Vector3;

/// Concludes for every frame of a component. `side_margins` tell by how much another pose of each frame is less likely
/// ([`super::other_margins`]), `other_depths_mm` how far the other component is from the camera, at the middle of its box, where
/// that is known; either may be shorter than the film. `middle` is the model's.
#[must_use]
pub fn conclude(
    cells: &[Cell],
    side_margins: &[Option<SideMargin>],
    other_depths_mm: &[Option<f64>],
    middle: &Vector3,
) -> Vec<Conclusion> {
    let evidence = cells.iter().enumerate().map(|(frame, cell)| {
        let margin = side_margins.get(frame).copied().flatten();
        let depth = other_depths_mm.get(frame).copied().flatten();
        FrameEvidence::of(cell, margin, depth)
    });
    let evidence: Vec<FrameEvidence> = evidence.collect();
    let mut trusts = vec![Trust::default(); cells.len()];
    let mut sorted = vec![0.0; cells.len()];
    let limits = TrustLimits::USUAL;
    judge_film(&evidence, &limits, middle, &mut sorted, &mut trusts);
    let one = |(cell, trust)| Conclusion::of(cell, trust);
    cells.iter().zip(&trusts).map(one).collect()
}

/// How far a component is from the camera in each frame, at the `middle` of its box, mm; only where its pose is to be trusted by
/// itself: else it says nothing of the other component.
#[must_use]
pub fn trusted_depths(
    cells: &[Cell],
    side_margins: &[Option<SideMargin>],
    middle: &Vector3,
) -> Vec<Option<f64>> {
    let alone = conclude(cells, side_margins, &[], middle);
    let depth = |one: &Conclusion| {
        let pose = one.pose.filter(|_| one.is_trusted())?;
        Some(-pose.transform(middle)[2])
    };
    alone.iter().map(depth).collect()
}
