//! Corrections of distortion as files: the same JSON that the page saves and opens.

use std::cell::OnceCell;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use fluoropose::image::frame::{Frame, Pixel};
use fluoropose_distortion::Distortion;
use fluoropose_distortion::correction::Corrected;
use fluoropose_distortion::distortion::NUMBERS;
use fluoropose_distortion::polynomial::TERMS;
use fluoropose_distortion::resample::{map_row, resample_row};
use serde::{Deserialize, Serialize};

use super::text::{read_text, write_json};

const KIND: &str = "fluoropose-distortion";
const VERSION: u32 = 1;
/// Numbers before the polynomials.
const HEAD: usize = NUMBERS - 2 * TERMS;

/// The file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Stored {
    kind: String,
    version: u32,
    name: String,
    applies_to: String,
    order: u8,
    width: u32,
    height: u32,
    centre: [f64; 2],
    scale: f64,
    column: Vec<f64>,
    row: Vec<f64>,
    quality: Quality,
}

/// How good it is; root mean squares in px.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Quality {
    beads: usize,
    dropped: usize,
    before: f64,
    after: f64,
    left_out: [Option<f64>; 3],
    largest_shift: f64,
}

/// Writes a correction that was fitted to a grid in the file of this name.
///
/// # Errors
/// Names the file.
pub fn write_distortion(path: &Path, corrected: &Corrected, name: &str) -> Result<()> {
    let distortion = &corrected.distortion;
    let numbers = distortion.numbers();
    let (width, height) = distortion.size();
    let stored = Stored {
        kind: KIND.to_owned(),
        version: VERSION,
        name: name.to_owned(),
        applies_to: "frames".to_owned(),
        order: distortion.order(),
        width: u32::try_from(width)?,
        height: u32::try_from(height)?,
        centre: [numbers[3], numbers[4]],
        scale: numbers[5],
        column: numbers[HEAD..HEAD + TERMS].to_vec(),
        row: numbers[HEAD + TERMS..].to_vec(),
        quality: Quality {
            beads: corrected.used,
            dropped: corrected.dropped,
            before: corrected.before_px,
            after: corrected.after_px,
            left_out: corrected.left_out_px,
            largest_shift: distortion.largest_shift_px(),
        },
    };
    write_json(Some(path), &stored)
}

/// Reads a correction.
///
/// # Errors
/// Names the file and what is wrong with it.
pub fn read_distortion(path: &Path) -> Result<Distortion> {
    let cannot = || {
        format!(
            "{} is no correction of distortion, as `calibrate --distortion` writes it",
            path.display()
        )
    };
    let stored: Stored = serde_json::from_str(&read_text(path)?).with_context(cannot)?;
    if stored.kind != KIND || stored.version != VERSION {
        bail!(
            "{} is {} of version {}; a correction of distortion is {KIND} of version {VERSION}",
            path.display(),
            stored.kind,
            stored.version
        );
    }
    ensure!(
        stored.column.len() == TERMS && stored.row.len() == TERMS,
        "{}: each polynomial should hold {TERMS} coefficients",
        path.display()
    );
    let head = [
        stored.order.into(),
        stored.width.into(),
        stored.height.into(),
        stored.centre[0],
        stored.centre[1],
        stored.scale,
    ];
    let numbers: Vec<f64> = head
        .into_iter()
        .chain(stored.column)
        .chain(stored.row)
        .collect();
    Distortion::from_numbers(&numbers).with_context(cannot)
}

/// Where each pixel of the straight frames is in the frames as taken: the same for all frames of a correction.
#[derive(Debug)]
pub struct Undistorter {
    distortion: Distortion,
    map: OnceCell<Vec<[f32; 2]>>,
}

impl Undistorter {
    /// Of frames that are yet to come: the first of the correction's size takes the memory, whatever size a file claims.
    #[must_use]
    pub fn new(distortion: Distortion) -> Self {
        Self {
            distortion,
            map: OnceCell::new(),
        }
    }

    fn map(&self, (width, height): (usize, usize)) -> &[[f32; 2]] {
        self.map.get_or_init(|| {
            let mut map = vec![[0.0; 2]; width * height];
            for (row, out) in map.chunks_exact_mut(width).enumerate() {
                map_row(&self.distortion, row, out);
            }
            map
        })
    }

    /// The straight frame, row by row.
    ///
    /// # Errors
    /// When the frame has another size than the correction is for.
    pub fn straight<P: Pixel>(&self, pixels: &[P], size: (usize, usize)) -> Result<Vec<P>> {
        let wanted = self.distortion.size();
        ensure!(
            size == wanted,
            "the frame has {} x {} pixels and the correction is for {} x {}",
            size.0,
            size.1,
            wanted.0,
            wanted.1
        );
        let frame = Frame::new(pixels, size.0, size.1, size.0)?;
        let mut out = vec![P::default(); pixels.len()];
        let places = self.map(size).chunks_exact(size.0);
        for (places, row) in places.zip(out.chunks_exact_mut(size.0)) {
            resample_row(&frame, places, row);
        }
        Ok(out)
    }
}
