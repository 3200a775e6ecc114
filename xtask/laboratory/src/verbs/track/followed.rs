//! All components followed over their film, in the order in which one tells of the other.

use anyhow::Result;
use fluoropose::follow::{Anchor, Cell, Looked, Settling, take_better};
use fluoropose::image::blank::{ONE_GREY, is_blank};
use rayon::prelude::*;

use super::anchors::{again, fill, fill_in_joint};
use super::follow::follow;
use super::judged::{femur_of, good, is_tibia, other_of};
use super::part::Part;
use super::run::Run;
use super::sides::{Margins, settle, up_to_a_choice};

/// All components, side by side as far as they need no other: a tibia waits for its femur where its sides are chosen. A component that is lost after
/// all is looked for beside the other one of its joint.
pub(super) fn followed(
    run: &Run<'_>,
    parts: &[Part<'_>],
    anchors: &[Vec<Anchor>],
) -> Result<(Vec<Vec<Cell>>, Vec<Margins>)> {
    let alone = |(part, anchors): (&Part<'_>, &Vec<Anchor>)| -> Result<(Vec<Cell>, Settling)> {
        let mut cells = of_part(run, part, anchors)?;
        let mut settling = Settling::new(part.middle(), 0..cells.len());
        if up_to_a_choice(run, part, &mut settling, &mut cells)? && !is_tibia(part) {
            settle(run, part, None, &mut settling, &mut cells)?;
        }
        Ok((cells, settling))
    };
    let each = parts.par_iter().zip(anchors).map(alone);
    let each = each.collect::<Result<Vec<_>>>()?;
    let (mut films, mut settlings): (Vec<_>, Vec<_>) = each.into_iter().unzip();
    for (number, part) in parts.iter().enumerate().filter(|(_, part)| is_tibia(part)) {
        let femur = femur_of(part, parts, &films);
        let settling = &mut settlings[number];
        settle(run, part, femur.as_ref(), settling, &mut films[number])?;
    }
    for number in 0..parts.len() {
        find_lost(run, (number, parts), &mut films, &mut settlings)?;
    }
    let margins = margins_of(&settlings, &films);
    Ok((films, margins))
}

/// Looks for a component that is lost, or lies on other edges, beside the other one of its joint, and settles it once more where it is found.
fn find_lost(
    run: &Run<'_>,
    (number, parts): (usize, &[Part<'_>]),
    films: &mut [Vec<Cell>],
    settlings: &mut [Settling],
) -> Result<()> {
    let (part, Some(other)) = (&parts[number], other_of(number, parts)) else {
        return Ok(());
    };
    let margins = margins_of(settlings, films);
    let [own, known] = [number, other].map(|part| good(run, (part, parts), films, &margins));
    let mut anew = films[number].clone();
    fill_in_joint(run, (part, &own, &mut anew), (&parts[other], &known))?;
    if !take_better(&mut films[number], &anew) {
        return Ok(());
    }
    let femur = femur_of(part, parts, films);
    let cells = &mut films[number];
    let mut settling = Settling::new(part.middle(), 0..cells.len());
    if up_to_a_choice(run, part, &mut settling, cells)? {
        settle(run, part, femur.as_ref(), &mut settling, cells)?;
    }
    settlings[number] = settling;
    Ok(())
}

fn margins_of(settlings: &[Settling], films: &[Vec<Cell>]) -> Vec<Margins> {
    let each = settlings.iter().zip(films);
    each.map(|(settling, cells)| settling.margins(cells))
        .collect()
}

/// A component followed by itself.
fn of_part(run: &Run<'_>, part: &Part<'_>, anchors: &[Anchor]) -> Result<Vec<Cell>> {
    let mut cells = vec![Cell::default(); run.film.count()];
    let anchors = again(run, part, anchors)?;
    follow(run, part, &anchors, 0..cells.len(), &mut cells)?;
    fill(run, part, &mut cells)?;
    find_blank(run, part, &mut cells)?;
    Ok(cells)
}

/// Of frames that nothing led to, those that show nothing: that is why.
fn find_blank(run: &Run<'_>, part: &Part<'_>, cells: &mut [Cell]) -> Result<()> {
    for (frame, cell) in cells.iter_mut().enumerate() {
        if cell.looked.is_none()
            && part.see(run.film, frame, |_, image, _| {
                is_blank(image.frame, ONE_GREY)
            })?
        {
            cell.looked = Some(Looked::BLANK);
        }
    }
    Ok(())
}
