//! The squares of pixels that a film is followed in.

use anyhow::Result;
use fluoropose::film::SquareChoice;
use fluoropose::film::estimate::MOST_COMPONENTS;
use fluoropose::follow::Anchor;

use super::constants::{first_profiles, pooled};
use super::part::Part;
use super::record::Blur;
use super::run::Run;
use crate::finding::Stated;

/// Their side, pixels of the files, by what the first frames that are known of each component tell in the squares that are tried. Chosen once
/// for a folder, as the film's constants are; `parts` are the components as they are seen in squares.
pub(super) fn chosen_square<'s>(
    run: &Run<'_>,
    stated: &Stated,
    anchors: &[Vec<Anchor>],
    parts: impl Fn(usize) -> Result<Vec<Part<'s>>>,
) -> Result<usize> {
    let given = match stated {
        Stated::Part(given) => *given,
        Stated::Whole(constants, _) => {
            return Ok(SquareChoice::new(Some(constants.blur_px)).square_px());
        }
    };
    let mut choice = SquareChoice::new(given.blur_px);
    while let Some(side) = choice.wanted() {
        let Blur(told) = run.journal.step(&format!("squares/{side}"), || {
            let film = run.film.in_squares(side);
            let (run, parts) = (run.on(&film), parts(side)?);
            let each = parts.iter().zip(anchors).take(MOST_COMPONENTS);
            let read = each.map(|(part, anchors)| first_profiles(&run, part, anchors));
            let found = pooled(side, read.collect::<Result<_>>()?).estimate(given);
            Ok(Blur(found.map(|found| found.constants.blur_px)))
        })?;
        choice.take(told);
    }
    Ok(choice.square_px())
}
