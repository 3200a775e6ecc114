//! Whether what remains at a pose on a known film is usual for that film.
//!
//! What a right pose leaves differs from film to film: a tenth of a pixel where all of its physics is known, half a pixel where bone,
//! cement or a hand-made calibration add to it. It does not differ much within a film: between frames of a component least, and
//! between components by their contrast. A pose on another edge, or mirrored, leaves several times as much wherever right ones
//! leave little.

use super::verdict::Doubt;

/// Misfits of other poses on the same film ([`super::Candidate::misfit`]).
#[derive(Clone, Copy, Debug, Default)]
pub struct FilmMisfits<'m> {
    /// Of the same component in other frames, pixels.
    pub own: &'m [f64],
    /// Of other components in any frame, pixels.
    pub others: &'m [f64],
}

/// From so many frames of the component itself on they tell what is usual of it.
const LEAST: usize = 3;
/// A misfit is unusual from these multiples of the median on: of the component's own, and of those of others. Right poses of two studies left 1.2 times
/// the median at most, wrong ones on poor masks 1.4 times and more (tests/records/refinement.md).
const OF_OWN: f64 = 1.5;
const OF_OTHERS: f64 = 3.0;
/// Where nothing tells what is usual, a pose that leaves this part of another's misfit is the right one of both.
const ENOUGH: f64 = 0.5;

/// A component that left so much on the frame before leaves no more than this multiple.
const OF_BEFORE: f64 = 2.0;

/// What rounding to pixels leaves of an exact outline at the right pose: nothing on one frame, so much on the next.
const ROUNDED_PX: f64 = 0.1;

impl FilmMisfits<'_> {
    /// The largest usual misfit, pixels; `None` where nothing tells.
    #[must_use]
    pub fn limit_px(&self) -> Option<f64> {
        let own = median(self.own).filter(|_| self.own.len() >= LEAST);
        let limits = [
            own.map(|px| OF_OWN * px),
            median(self.others).map(|px| OF_OTHERS * px),
        ];
        limits.into_iter().flatten().reduce(f64::min)
    }

    /// See [`look_beyond`].
    #[must_use]
    pub fn look_beyond(&self, px: f64, is_nearly_symmetric: bool) -> Option<f64> {
        look_beyond(self.limit_px(), px, is_nearly_symmetric)
    }

    /// What is doubtful of a pose with this misfit.
    #[must_use]
    pub fn doubt(&self, px: f64) -> Option<Doubt> {
        let limit_px = self.limit_px()?;
        (px > limit_px).then_some(Doubt::Unusual { px, limit_px })
    }
}

/// The largest misfit that is usual of a component which left so much on the frame before, pixels.
pub(super) fn usual_px(before_px: f64) -> f64 {
    OF_BEFORE * before_px.max(ROUNDED_PX)
}

/// The misfit at which the search for other poses around one with misfit `px` may end, `limit_px` being the largest usual one;
/// `None` where there is no need of any.
///
/// Where a part is nearly its own mirror image and nothing tells what is usual on its film, others are always looked for: an
/// inner rim or the wrong side of the mirror shows by a pose that leaves less, and by nothing else.
#[must_use]
pub fn look_beyond(limit_px: Option<f64>, px: f64, is_nearly_symmetric: bool) -> Option<f64> {
    match limit_px {
        Some(limit_px) => (px > limit_px).then_some(limit_px),
        None => is_nearly_symmetric.then_some(ENOUGH * px),
    }
}

/// The lower median; not of many, so that it is found by counting.
fn median(values: &[f64]) -> Option<f64> {
    let rank = values.len().checked_sub(1)? / 2;
    let below = |value: f64| values.iter().filter(|&&other| other < value).count();
    let at_most = |value: f64| values.iter().filter(|&&other| other <= value).count();
    let is_median = |value: &&f64| below(**value) <= rank && rank < at_most(**value);
    values.iter().find(is_median).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle_one() {
        assert_eq!(median(&[]), None);
        assert_eq!(median(&[3.0]), Some(3.0));
        assert_eq!(median(&[3.0, 1.0, 2.0, 2.0]), Some(2.0));
        assert_eq!(median(&[5.0, 1.0, 4.0]), Some(4.0));
    }

    /// The mirrored tray that was called good left 0.44 px, the right pose 0.13 px; on a real film right ones leave 0.6.
    #[test]
    fn what_is_unusual_depends_on_the_film() {
        let femurs = [0.12, 0.14, 0.13];
        let misfits = FilmMisfits {
            own: &[0.15],
            others: &femurs,
        };
        assert!(matches!(misfits.doubt(0.44), Some(Doubt::Unusual { px, .. }) if px == 0.44));
        assert_eq!(misfits.doubt(0.16), None);
        let real = [0.57, 0.61, 0.77, 0.56];
        let misfits = FilmMisfits {
            own: &real,
            others: &[0.59, 0.45],
        };
        assert_eq!(misfits.doubt(0.80), None);
        assert!(misfits.doubt(0.90).is_some());
        assert!(misfits.doubt(1.4).is_some());
    }

    /// In larger or smaller pixels, and on films that are explained better or worse.
    #[test]
    fn what_is_unusual_is_told_by_ratios_alone() {
        let own = [0.57, 0.61, 0.77, 0.56, 0.58];
        for times in [0.1, 0.5, 2.0, 40.0] {
            let own = own.map(|px| times * px);
            let misfits = FilmMisfits {
                own: &own,
                others: &[],
            };
            for (px, is_usual) in [(0.86, true), (0.88, false)] {
                assert_eq!(
                    misfits.doubt(times * px).is_none(),
                    is_usual,
                    "{times} {px}"
                );
            }
        }
    }

    #[test]
    fn few_frames_of_its_own_tell_nothing() {
        let misfits = FilmMisfits {
            own: &[0.1, 0.1],
            others: &[],
        };
        assert_eq!(misfits.limit_px(), None);
        assert_eq!(misfits.doubt(3.0), None);
        // A tray alone on its film is looked around, a femur is not.
        assert_eq!(misfits.look_beyond(0.4, true), Some(0.2));
        assert_eq!(misfits.look_beyond(0.4, false), None);
        let misfits = FilmMisfits {
            own: &[0.1, 0.1, 0.7],
            others: &[],
        };
        assert_eq!(misfits.limit_px(), Some(OF_OWN * 0.1));
        assert_eq!(misfits.look_beyond(0.3, false), Some(OF_OWN * 0.1));
        assert_eq!(misfits.look_beyond(0.1, true), None);
    }
}
