//! Poses brought to where the film's edges agree with those of the model as the film would show it.
//!
//! Both edges are measured by one procedure, so what blur, display and thin metal do to them cancels. Their difference changes
//! slowly with the pose: some undamped steps from where refinement on the frame's edges alone has ended.
//!
//! Each step sees other pixels of the border, a fifth of them; what the others have shown before is carried along to first
//! order, so that all of them decide on each step (an incremental gradient: Blatt, Hero and Gauchman, SIAM J. Optim. 18, 2007).
//! A drawing in whole pixels lets steps go to and fro at the end: once one is not shorter than the one before, the `n`-th from
//! there is made by its `n`-th part. Poses then rest where steps are none in the mean (Robbins and Monro, Ann. Math. Statist. 22,
//! 1951), wherever they come from.

use super::equations::Equations;
use super::error::RefineError;
use super::memory::{FILM_EVERY, RefineMemory};
use super::problem::Problem;
use super::result::{Iterate, Refined};
use super::stages::Pass;
use crate::render::RenderError;

/// Steps at most.
const STEPS: usize = 16;
/// A step of this size ends the work, as far as it is made: 0.002 degrees or 0.01 mm,
const SMALL: f64 = 0.002;
/// or one of so many standard deviations of the pose.
const NOTHING: f64 = 0.02;

impl Problem<'_> {
    /// Whether the film of any view is known.
    pub(super) fn has_film(&self) -> bool {
        self.views.iter().any(|view| view.target.film().is_some())
    }

    /// Corrects a pose that was refined on frames alone. Its equations, a fifth each, are no part of the stack of outlines.
    #[inline(never)]
    pub(super) fn correct(
        &self,
        pass: &Pass,
        state: &mut Refined,
        memory: &mut RefineMemory<'_>,
        trace: &mut dyn FnMut(&Iterate),
    ) -> Result<(), RefineError> {
        let mut next = *state;
        let mut fifths: [Equations; FILM_EVERY] = core::array::from_fn(|_| Equations::new());
        let (mut last, mut parts) = (f64::INFINITY, 1.0);
        next.converged = false;
        for turn in 0..STEPS {
            let pass = &Pass { turn, ..*pass };
            fifths[turn % FILM_EVERY] = self.look(&mut next, pass, memory)?.equations;
            let all = joined(&fifths);
            let Some((step, more)) = self.step(&all, 0.0, pass, &next.pose) else {
                return Err(RefineError::TooFar);
            };
            let has_all = turn + 1 >= FILM_EVERY;
            if has_all && (step.size() > last || parts > 1.0) {
                parts += 1.0;
            }
            last = step.size();
            let (step, more) = (step.scaled(1.0 / parts), more / parts);
            next.pose = self.apply(&step, &next.pose);
            next.offset_px += more;
            if has_all && (last < SMALL * parts || all.deviations(&step) < NOTHING) {
                next.converged = true;
                break;
            }
            for fifth in &mut fifths {
                fifth.follow(&step, more);
            }
        }
        let all = self.look_at_all(&mut next, pass, memory)?;
        all.report(&mut next);
        trace(&all.iterate(pass, &next));
        *state = next;
        Ok(())
    }

    /// What all border pixels see: rival poses are compared by it. At once where there is room for as many lines, otherwise a
    /// fifth at a time.
    fn look_at_all(
        &self,
        state: &mut Refined,
        pass: &Pass,
        memory: &mut RefineMemory<'_>,
    ) -> Result<Equations, RefineError> {
        let whole = Pass {
            whole: true,
            ..*pass
        };
        match self.look(state, &whole, memory) {
            Err(RefineError::Memory(_) | RefineError::Render(RenderError::Memory(_))) => {
                self.look_by_fifths(state, pass, memory)
            }
            seen => Ok(seen?.equations),
        }
    }

    fn look_by_fifths(
        &self,
        state: &mut Refined,
        pass: &Pass,
        memory: &mut RefineMemory<'_>,
    ) -> Result<Equations, RefineError> {
        let mut all = Equations::new();
        for turn in 0..FILM_EVERY {
            let pass = Pass { turn, ..*pass };
            self.look_into(&mut all, state, &pass, memory)?;
        }
        Ok(all)
    }
}

fn joined(fifths: &[Equations]) -> Equations {
    let mut all = Equations::new();
    fifths.iter().for_each(|fifth| all.join(fifth));
    all
}
