//! Poses brought to where the film's edges agree with those of the model as the film would show it.
//!
//! Both edges are measured by one procedure, so what blur, display and thin metal do to them cancels. Their difference changes
//! slowly with the pose: some undamped steps from where refinement on the frame's edges alone has ended.

use super::error::RefineError;
use super::memory::RefineMemory;
use super::problem::Problem;
use super::result::{Iterate, Refined};
use super::stages::Pass;

/// Steps at most; usually three are made, of a tray on real films up to twenty.
const STEPS: usize = 24;
/// A step of this size ends the work: 0.004 degrees or 0.02 mm.
const SMALL: f64 = 0.004;

impl Problem<'_> {
    /// Whether the film of any view is known.
    pub(super) fn has_film(&self) -> bool {
        self.views.iter().any(|view| view.target.film().is_some())
    }

    /// Corrects a pose that was refined on frames alone.
    pub(super) fn correct(
        &self,
        pass: &Pass,
        state: &mut Refined,
        memory: &mut RefineMemory<'_>,
        trace: &mut dyn FnMut(&Iterate),
    ) -> Result<(), RefineError> {
        let mut next = *state;
        let mut seen = self.look(&mut next, pass, memory)?;
        let (mut last, mut fraction) = (f64::INFINITY, 1.0);
        next.converged = false;
        for _ in 0..STEPS {
            let Some((step, more)) = self.step(&seen.equations, 0.0, pass, &next.pose) else {
                return Err(RefineError::TooFar);
            };
            if step.size() > last {
                fraction *= 0.6;
            }
            last = step.size();
            next.pose = self.apply(&step.scaled(fraction), &next.pose);
            next.offset_px += fraction * more;
            if last < SMALL {
                next.converged = true;
                break;
            }
            seen = self.look(&mut next, pass, memory)?;
        }
        seen.equations.report(&mut next);
        trace(&seen.equations.iterate(pass, &next));
        *state = next;
        Ok(())
    }
}
