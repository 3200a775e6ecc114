//! A click into each component, somewhere within its silhouette.

use std::path::Path;

use anyhow::Result;
use fluoropose::image::mask::Mask;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::files::{Component, Study, files_in, read_mask};
use crate::verbs::track::Click;

/// Streams of random numbers that neither frames nor models have.
const CLICKS: u64 = 1 << 62;
/// A person's click keeps so far from the border, pixels.
const WITHIN: usize = 3;
/// Draws of a frame before none is thought to show the component.
const DRAWS: usize = 100;

/// A click into each component of a disguised film.
///
/// # Errors
/// For a study and masks that cannot be read.
pub(super) fn within_each(folder: &Path, seed: u64) -> Result<Vec<Click>> {
    let study = Study::read_quietly(&folder.join("study.toml"))?;
    let mut clicks = Vec::new();
    for component in &study.components {
        if let Some(masks) = component.masks.get("truth") {
            clicks.extend(click(component, masks, seed)?);
        }
    }
    Ok(clicks)
}

/// A click in a frame that is drawn among those which show the component; none where no frame does.
///
/// # Errors
/// For masks that cannot be read.
fn click(component: &Component, masks: &Path, seed: u64) -> Result<Option<Click>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(CLICKS);
    let files = files_in(masks)?;
    for _ in 0..DRAWS {
        let frame = random.random_range(0..files.len());
        let read = read_mask(&files[frame])?;
        let mask = read.mask();
        let inside: Vec<usize> = (0..mask.width() * mask.height())
            .filter(|&at| is_within(&mask, at % mask.width(), at / mask.width()))
            .collect();
        if inside.is_empty() {
            continue;
        }
        let at = inside[random.random_range(0..inside.len())];
        let (column, row) = (at % mask.width(), at / mask.width());
        let name = &component.name;
        return Ok(Some(
            format!("{name}:{}:{column},{row}", frame + 1).parse()?,
        ));
    }
    Ok(None)
}

fn is_within(mask: &Mask<'_>, column: usize, row: usize) -> bool {
    let across = column.checked_sub(WITHIN).zip(row.checked_sub(WITHIN));
    let is_on = |column: usize, row: usize| {
        column < mask.width() && row < mask.height() && mask.get(column, row)
    };
    across.is_some_and(|(left, above)| {
        let (right, below) = (column + WITHIN, row + WITHIN);
        [
            (left, row),
            (right, row),
            (column, above),
            (column, below),
            (column, row),
        ]
        .into_iter()
        .all(|(column, row)| is_on(column, row))
    })
}
