//! A bead grid in a picture without being told how large its beads are.

use super::GridError;
use super::discs::{Disc, Search, find};
use super::lattice::{Bead, number};
use fluoropose::image::frame::{Frame, Pixel};

/// Radii that are tried, px, the usual ones first; each finds beads from two thirds to one and a half times its own.
const RADII: [f64; 8] = [4.5, 6.5, 3.0, 9.0, 2.0, 13.0, 19.0, 28.0];

/// Where so many marks have a number, and at least this part of all, no other radius is tried.
const PLENTY: (usize, f64) = (60, 0.8);

/// Marks that are looked at: enough for a plate of 45 x 45 beads.
pub const MARKS: usize = 2048;

/// Working memory of [`find_grid`].
pub struct Memory<'a> {
    /// As many as [`super::discs::sums_needed`] says.
    pub sums: &'a mut [u64],
    /// As many as marks are to be looked at; [`MARKS`] will do.
    pub discs: &'a mut [Disc],
    /// As many; the numbered beads are left here.
    pub beads: &'a mut [Bead],
    /// As many.
    pub queue: &'a mut [usize],
}

/// A grid that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundGrid {
    /// Round marks; they are the first of the lent beads, with a number where they belong to the lattice.
    pub marks: usize,
    /// How many of them have a number.
    pub numbered: usize,
    /// Radius of the beads, px.
    pub radius_px: f64,
    /// Between neighbours, px.
    pub step_px: f64,
}

/// Finds the largest square lattice of round marks; without a radius, over all radii from 1.3 to 42 px.
///
/// # Errors
/// [`GridError::FewBeads`] with the most that were found, [`GridError::Memory`] and [`GridError::Radius`].
pub fn find_grid<P: Pixel>(
    frame: &Frame<'_, P>,
    bright: bool,
    radius_px: Option<f64>,
    memory: &mut Memory<'_>,
) -> Result<FoundGrid, GridError> {
    if let Some(radius_px) = radius_px {
        return attempt(frame, Search { radius_px, bright }, memory);
    }
    let mut best: Result<FoundGrid, GridError> = Err(GridError::FewBeads {
        found: 0,
        needed: super::lattice::FEWEST,
    });
    for radius_px in RADII {
        let found = attempt(frame, Search { radius_px, bright }, memory);
        let plenty = |found: &FoundGrid| {
            found.numbered >= PLENTY.0 && found.numbered as f64 >= PLENTY.1 * found.marks as f64
        };
        if is_better(&found, &best) {
            best = found;
        }
        if found.as_ref().is_ok_and(plenty) {
            break;
        }
    }
    // Once more at the beads' own radius, which the marks tell; it is also what leaves the beads in the memory.
    let coarse = best?;
    match attempt(
        frame,
        Search {
            radius_px: coarse.radius_px,
            bright,
        },
        memory,
    ) {
        Ok(found) => Ok(found),
        Err(_) => {
            let nearest = RADII.into_iter().min_by(|a, b| {
                (a - coarse.radius_px)
                    .abs()
                    .total_cmp(&(b - coarse.radius_px).abs())
            });
            attempt(
                frame,
                Search {
                    radius_px: nearest.unwrap_or(coarse.radius_px),
                    bright,
                },
                memory,
            )
        }
    }
}

/// More numbered beads are better; a failure that found more is worth telling.
fn is_better(found: &Result<FoundGrid, GridError>, best: &Result<FoundGrid, GridError>) -> bool {
    match (found, best) {
        (Ok(found), Ok(best)) => found.numbered > best.numbered,
        (Ok(_), Err(_)) => true,
        (Err(GridError::FewBeads { found, .. }), Err(GridError::FewBeads { found: best, .. })) => {
            found > best
        }
        (Err(GridError::FewBeads { .. }), _) => false,
        // Short memory is no matter of radius.
        (Err(_), best) => best.is_err(),
    }
}

fn attempt<P: Pixel>(
    frame: &Frame<'_, P>,
    search: Search,
    memory: &mut Memory<'_>,
) -> Result<FoundGrid, GridError> {
    let most = memory.discs.len();
    if memory.beads.len() < most {
        return Err(GridError::Memory {
            needed: most,
            given: memory.beads.len(),
        });
    }
    let marks = find(frame, search, memory.sums, memory.discs)?;
    let discs = memory.discs.get(..marks).unwrap_or_default();
    for (bead, disc) in memory.beads.iter_mut().zip(discs) {
        *bead = Bead::from(*disc);
    }
    let radius = discs.iter().map(|disc| disc.radius_px).sum::<f64>() / marks.max(1) as f64;
    let beads = memory.beads.get_mut(..marks).unwrap_or_default();
    let step_px = number(beads, memory.queue)?;
    Ok(FoundGrid {
        marks,
        numbered: beads.iter().filter(|bead| bead.index.is_some()).count(),
        radius_px: radius,
        step_px,
    })
}

#[cfg(test)]
mod tests {
    use std::vec;
    use std::vec::Vec;

    use super::super::correction::fit;
    use super::super::discs::sums_needed;
    use super::super::lattice::tests::plate;
    use super::*;

    /// A picture of a bent plate with beads of this radius, darker to the corners, with noise.
    pub(crate) fn picture(strength: f64, radius: f64) -> Vec<u8> {
        let mut pixels = vec![0f64; 1024 * 1024];
        for (index, pixel) in pixels.iter_mut().enumerate() {
            let (x, y) = (
                (index % 1024) as f64 / 512.0 - 1.0,
                (index / 1024) as f64 / 512.0 - 1.0,
            );
            *pixel = 190.0 - 35.0 * (x * x + y * y);
        }
        for (_, [column, row]) in plate(strength) {
            let reach = radius + 5.0;
            for r in (row - reach) as usize..=((row + reach) as usize).min(1023) {
                for c in (column - reach) as usize..=((column + reach) as usize).min(1023) {
                    let away = f64::hypot(c as f64 + 0.5 - column, r as f64 + 0.5 - row);
                    pixels[r * 1024 + c] *= 1.0 - 0.5 / (1.0 + f64::exp(2.0 * (away - radius)));
                }
            }
        }
        let mut seed = 9u32;
        let noisy = pixels.iter().map(|grey| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (grey + f64::from(seed >> 24) / 40.0 - 3.2) as u8
        });
        noisy.collect()
    }

    #[test]
    fn a_picture_of_a_plate_gives_the_correction_without_being_told_the_beads_size() {
        for radius in [2.5, 6.0, 11.0] {
            let pixels = picture(0.05, radius);
            let frame = Frame::new(&pixels, 1024, 1024, 1024).expect("fits");
            let mut sums = vec![0; sums_needed(1024, 1024)];
            let (mut discs, mut beads) =
                (vec![Disc::default(); MARKS], vec![Bead::default(); MARKS]);
            let mut queue = vec![0; MARKS];
            let mut memory = Memory {
                sums: &mut sums,
                discs: &mut discs,
                beads: &mut beads,
                queue: &mut queue,
            };
            let found = find_grid(&frame, false, None, &mut memory).expect("a grid");
            let all = plate(0.05).len();
            assert!(found.numbered * 100 > all * 90, "{found:?} of {all}");
            assert!((found.radius_px / radius - 1.0).abs() < 0.3, "{found:?}");
            let corrected = fit(&mut beads[..found.marks], (1024, 1024)).expect("fits");
            assert!(
                corrected.before_px > 2.0 && corrected.after_px < 0.1,
                "{corrected:?}"
            );
        }
    }

    #[test]
    fn a_picture_without_a_plate_and_a_plate_of_the_other_brightness_have_none() {
        let plain = vec![100u8; 300 * 200];
        let frame = Frame::new(&plain, 300, 200, 300).expect("fits");
        let mut sums = vec![0; sums_needed(1024, 1024)];
        let (mut discs, mut beads) = (vec![Disc::default(); MARKS], vec![Bead::default(); MARKS]);
        let mut queue = vec![0; MARKS];
        let mut memory = Memory {
            sums: &mut sums,
            discs: &mut discs,
            beads: &mut beads,
            queue: &mut queue,
        };
        assert!(matches!(
            find_grid(&frame, false, None, &mut memory),
            Err(GridError::FewBeads { .. })
        ));
        memory.sums = &mut [];
        assert!(matches!(
            find_grid(&frame, false, None, &mut memory),
            Err(GridError::Memory { .. })
        ));
    }
}
