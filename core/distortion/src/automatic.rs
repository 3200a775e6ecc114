//! A distortion grid in a frame whose beads are of unknown size.

use crate::discs::{Disc, DiscSearch, find};
use crate::error::DistortionError;
use crate::lattice::{Bead, FEWEST, number};
use fluoropose::image::frame::{Frame, Pixel};
use fluoropose::memory::check_length;

#[cfg(feature = "alloc")]
use crate::discs::sums_needed;
#[cfg(feature = "alloc")]
use alloc::{vec, vec::Vec};

/// Radii that are tried, px, the usual ones first. Each finds beads of 2/3 to 3/2 of its radius.
const RADII: [f64; 8] = [4.5, 6.5, 3.0, 9.0, 2.0, 13.0, 19.0, 28.0];

/// Where this number of marks, and at least this fraction of all marks, have a number, no other radius is tried.
const PLENTY: (usize, f64) = (60, 0.8);

/// A number of marks that is enough for a plate of 45 x 45 beads.
pub const MARKS: usize = 2048;

/// Working memory of [`find_distortion_grid`].
#[derive(Debug)]
pub struct DistortionGridMemory<'a> {
    /// At least [`crate::discs::sums_needed`] sums.
    pub sums: &'a mut [u64],
    /// One disc for each mark that may be found: [`MARKS`] suffice.
    pub discs: &'a mut [Disc],
    /// At least the same number. Afterwards the first of them are the marks that were found.
    pub beads: &'a mut [Bead],
    /// At least the same number.
    pub queue: &'a mut [usize],
}

/// A distortion grid that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistortionGrid {
    /// Number of round marks. They are the first of [`DistortionGridMemory::beads`], with a number where they belong to
    /// the lattice.
    pub marks: usize,
    /// Number of the marks that have a number.
    pub numbered: usize,
    /// Mean radius of the marks, px.
    pub radius_px: f64,
    /// Distance between neighbours, px.
    pub step_px: f64,
}

/// Finds the largest square lattice of round marks that are darker, or with `bright` brighter, than what surrounds them.
/// Without a radius, px, all radii from 1.3 to 42 px are tried.
///
/// # Errors
/// [`DistortionError::FewBeads`] with the greatest number that was found, [`DistortionError::Overlapping`] where only what lies between beads
/// was found, as in a plate of the other brightness, [`DistortionError::Memory`], and [`DistortionError::Radius`].
pub fn find_distortion_grid<P: Pixel>(
    frame: &Frame<'_, P>,
    bright: bool,
    radius_px: Option<f64>,
    memory: &mut DistortionGridMemory<'_>,
) -> Result<DistortionGrid, DistortionError> {
    if let Some(radius_px) = radius_px {
        return attempt(frame, DiscSearch { radius_px, bright }, memory);
    }
    let mut best: Result<DistortionGrid, DistortionError> = Err(DistortionError::FewBeads {
        found: 0,
        needed: FEWEST,
    });
    for radius_px in RADII {
        let found = attempt(frame, DiscSearch { radius_px, bright }, memory);
        let plenty = |found: &DistortionGrid| {
            found.numbered >= PLENTY.0 && found.numbered as f64 >= PLENTY.1 * found.marks as f64
        };
        if is_better(&found, &best) {
            best = found;
        }
        if found.as_ref().is_ok_and(plenty) {
            break;
        }
    }
    // Once more with the radius of the marks. This also leaves the beads in memory.
    let own = best?.radius_px;
    let mut again = |radius_px: f64| attempt(frame, DiscSearch { radius_px, bright }, memory);
    again(own).or_else(|_| {
        let away = |radius: &f64| (radius - own).abs();
        let nearest = RADII.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        again(nearest.unwrap_or(own))
    })
}

/// More numbered beads are better; of two failures the one with more beads is reported.
fn is_better(
    found: &Result<DistortionGrid, DistortionError>,
    best: &Result<DistortionGrid, DistortionError>,
) -> bool {
    match (found, best) {
        (Ok(found), Ok(best)) => found.numbered > best.numbered,
        (Ok(_), Err(_)) => true,
        (
            Err(DistortionError::FewBeads { found, .. }),
            Err(DistortionError::FewBeads { found: best, .. }),
        ) => found > best,
        (Err(DistortionError::FewBeads { .. }), _) => false,
        // Too little memory does not depend on the radius.
        (Err(_), best) => best.is_err(),
    }
}

/// The same with memory of its own, for callers that have an allocator: the grid, and its marks.
///
/// # Errors
/// As [`find_distortion_grid`].
#[cfg(feature = "alloc")]
pub fn distortion_grid<P: Pixel>(
    frame: &Frame<'_, P>,
    bright: bool,
    radius_px: Option<f64>,
) -> Result<(DistortionGrid, Vec<Bead>), DistortionError> {
    let mut beads = vec![Bead::default(); MARKS];
    let mut memory = DistortionGridMemory {
        sums: &mut vec![0; sums_needed(frame.width(), frame.height())],
        discs: &mut vec![Disc::default(); MARKS],
        beads: &mut beads,
        queue: &mut vec![0; MARKS],
    };
    let found = find_distortion_grid(frame, bright, radius_px, &mut memory)?;
    beads.truncate(found.marks);
    Ok((found, beads))
}

fn attempt<P: Pixel>(
    frame: &Frame<'_, P>,
    search: DiscSearch,
    memory: &mut DistortionGridMemory<'_>,
) -> Result<DistortionGrid, DistortionError> {
    let most = memory.discs.len();
    check_length("beads", most, memory.beads.len())?;
    let marks = find(frame, search, memory.sums, memory.discs)?;
    let discs = memory.discs.get(..marks).unwrap_or_default();
    for (bead, disc) in memory.beads.iter_mut().zip(discs) {
        *bead = Bead::from(*disc);
    }
    let radius = discs.iter().map(|disc| disc.radius_px).sum::<f64>() / marks.max(1) as f64;
    let beads = memory.beads.get_mut(..marks).unwrap_or_default();
    let step_px = number(beads, memory.queue)?;
    // What lies between beads of the other brightness is a lattice as well.
    if 2.0 * radius > step_px {
        return Err(DistortionError::Overlapping {
            radius_px: radius,
            step_px,
        });
    }
    Ok(DistortionGrid {
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

    use super::*;
    use crate::correction::fit;
    use crate::discs::sums_needed;
    use crate::lattice::tests::plate;

    /// A frame of a distorted plate with beads of this radius, darker towards the corners, with noise.
    fn picture(strength: f64, radius: f64) -> Vec<u8> {
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
    fn a_picture_of_a_plate_gives_the_correction_whose_beads_are_of_unknown_size() {
        for radius in [2.5, 6.0, 11.0] {
            let pixels = picture(0.05, radius);
            let frame = Frame::new(&pixels, 1024, 1024, 1024).expect("fits");
            let mut sums = vec![0; sums_needed(1024, 1024)];
            let (mut discs, mut beads) =
                (vec![Disc::default(); MARKS], vec![Bead::default(); MARKS]);
            let mut queue = vec![0; MARKS];
            let mut memory = DistortionGridMemory {
                sums: &mut sums,
                discs: &mut discs,
                beads: &mut beads,
                queue: &mut queue,
            };
            let found = find_distortion_grid(&frame, false, None, &mut memory).expect("a grid");
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
        let mut memory = DistortionGridMemory {
            sums: &mut sums,
            discs: &mut discs,
            beads: &mut beads,
            queue: &mut queue,
        };
        assert!(matches!(
            find_distortion_grid(&frame, false, None, &mut memory),
            Err(DistortionError::FewBeads { .. })
        ));
        for strength in [0.0, 0.05] {
            let dark = picture(strength, 6.0);
            let frame = Frame::new(&dark, 1024, 1024, 1024).expect("fits");
            let found = find_distortion_grid(&frame, true, None, &mut memory);
            assert!(
                matches!(
                    found,
                    Err(DistortionError::FewBeads { .. } | DistortionError::Overlapping { .. })
                ),
                "{found:?}"
            );
        }
        let frame = Frame::new(&plain, 300, 200, 300).expect("fits");
        memory.sums = &mut [];
        assert!(matches!(
            find_distortion_grid(&frame, false, None, &mut memory),
            Err(DistortionError::Memory(_))
        ));
    }
}
