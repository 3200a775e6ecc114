//! What decided, counted over a sequence.

use std::fmt;

use fluoropose::finder::choice::Reason;
use serde::Serialize;

use super::decide::Decision;

/// How many frames were decided by what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Reasons {
    /// There was one pose alone.
    pub only: usize,
    /// The residual, or the unmatched pixels.
    pub residual: usize,
    /// The other component, with which another pose makes no knee.
    pub knee: usize,
    /// The coronal tilt against the other component.
    pub tilt: usize,
    /// The frames before and after.
    pub continuity: usize,
    /// Nothing.
    pub undecided: usize,
    /// Frames in which another pose is open, undecided ones among them.
    pub open: usize,
}

impl Reasons {
    /// Counts decisions.
    pub fn of(decisions: &[Option<Decision>]) -> Self {
        let mut counts = Self::default();
        for decision in decisions.iter().flatten() {
            counts.open += usize::from(!decision.choice.is_decided());
            let count = match decision.choice.reason {
                Reason::Only => &mut counts.only,
                Reason::Residual { .. } => &mut counts.residual,
                Reason::Knee { .. } => &mut counts.knee,
                Reason::Tilt { .. } => &mut counts.tilt,
                Reason::Turn { .. } | Reason::Film { .. } => &mut counts.continuity,
                Reason::Undecided { .. } => &mut counts.undecided,
            };
            *count += 1;
        }
        counts
    }
}

impl fmt::Display for Reasons {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words = [
            ("the only pose", self.only),
            ("residual", self.residual),
            ("the other component", self.knee),
            ("coronal tilt", self.tilt),
            ("continuity", self.continuity),
            ("undecided", self.undecided),
        ];
        let counted = words.iter().filter(|(_, count)| *count > 0);
        let counted: Vec<String> = counted
            .map(|(word, count)| format!("{word} {count}"))
            .collect();
        f.write_str(&counted.join(", "))?;
        match self.open {
            0 => Ok(()),
            open => write!(f, "; another pose is open in {open}"),
        }
    }
}
