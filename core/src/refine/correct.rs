//! Poses brought to where the film's edges agree with those of the model as the film would show it.
//!
//! Both edges are measured by one procedure, so what blur, display and thin metal do to them cancels. Their difference changes
//! slowly with the pose: some undamped steps from where refinement on the frame's edges alone has ended.
//!
//! Each step sees other pixels of the border, a third of them; what the others have shown before is carried along to first
//! order, so that all of them decide on each step (an incremental gradient: Blatt, Hero and Gauchman, SIAM J. Optim. 18, 2007).

use super::equations::Equations;
use super::error::RefineError;
use super::memory::RefineMemory;
use super::problem::Problem;
use super::result::{Iterate, Refined};
use super::stages::{FILM_PARTS, Pass};
use super::step::Step;
use super::unless::Ended;
use crate::math::sqrt;
use crate::render::RenderError;

/// Looks at most.
const LOOKS: usize = 5 * FILM_PARTS;
/// Looks after which a correction is given up, and how many times more than what is hopeless at its end its loss is then: each part has
/// been seen twice, or three times.
const GIVE_UP: [(usize, f64); 2] = [(2 * FILM_PARTS, 4.0), (3 * FILM_PARTS, 2.0)];
/// One that comes nearer to a known pose than this leads there, standard deviations of the pose. At half of one, other minima beside it are some.
const THERE: f64 = 1.0 / 3.0;
/// A step of this size is the last: 0.002 degrees or 0.01 mm,
const SMALL: f64 = 0.002;
/// or one of so many standard deviations of the pose: what it leaves is a small part of it.
const LITTLE: f64 = 0.06;

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
    ) -> Result<Ended, RefineError> {
        let mut next = *state;
        let mut parts: [Equations; FILM_PARTS] = core::array::from_fn(|_| Equations::new());
        let mut ended = Ended::Itself;
        next.converged = false;
        for turn in 0..LOOKS {
            let part = &mut parts[turn % FILM_PARTS];
            self.look_at_part(part, &mut next, turn, pass, memory)?;
            let all = joined(&parts);
            let Some((step, more)) = self.step(&all, 0.0, pass, &next.pose) else {
                return Err(RefineError::TooFar);
            };
            next.pose = self.apply(&step, &next.pose);
            next.offset_px += more;
            for part in &mut parts {
                part.follow(&step, more);
            }
            if turn + 1 < FILM_PARTS {
                continue;
            }
            next.converged = step.size() < SMALL || deviations(&all, &step) < LITTLE;
            ended = match self.is_hopeless(all.loss(), turn + 1) {
                true => Ended::Hopeless,
                false if self.is_there(&all, &next) => Ended::Known,
                false => Ended::Itself,
            };
            if next.converged || ended != Ended::Itself {
                break;
            }
        }
        // All border pixels have a part in what rival poses are compared by.
        let all = joined(&parts);
        all.report(&mut next);
        trace(&all.iterate(pass, &next));
        *state = next;
        Ok(ended)
    }

    /// Whether it is not worth going on after so many looks.
    fn is_hopeless(&self, loss: f64, looks: usize) -> bool {
        let mut limits = GIVE_UP.iter();
        limits.any(|&(after, times)| looks == after && loss > times * self.unless.hopeless)
    }

    /// Whether it has come to a pose that is known.
    fn is_there(&self, all: &Equations, state: &Refined) -> bool {
        let mut known = self.unless.known.iter();
        known.any(|pose| {
            let step = Step::between(&state.pose, pose, &self.middle);
            deviations(all, &step) < THERE
        })
    }

    /// What a part of the border pixels sees; a smaller one where there is not room for as many lines.
    fn look_at_part(
        &self,
        equations: &mut Equations,
        state: &mut Refined,
        turn: usize,
        pass: &Pass,
        memory: &mut RefineMemory<'_>,
    ) -> Result<(), RefineError> {
        let part = Pass {
            turn,
            corrects: true,
            ..*pass
        };
        let seen = match self.look(equations, state, &part, memory) {
            Err(RefineError::Memory(_) | RefineError::Render(RenderError::Memory(_))) => {
                let smaller = Pass {
                    corrects: false,
                    ..part
                };
                self.look(equations, state, &smaller, memory)
            }
            seen => seen,
        };
        seen.map(drop)
    }
}

/// Size of a step in standard deviations of the pose. Each part stands for all of them, so that together they seem to tell as many times more.
fn deviations(all: &Equations, step: &Step) -> f64 {
    all.deviations(step) / sqrt(FILM_PARTS as f64)
}

fn joined(parts: &[Equations]) -> Equations {
    let mut all = Equations::new();
    parts.iter().for_each(|part| all.join(part));
    all
}
