//! A folder of masks and the camera that saw them.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose::calibration::Calibration;
use fluoropose::camera::Camera;

use super::files::{MaskBuffer, files_in, read_mask};

/// Reads a mask and drops its specks ([`MaskBuffer::drop_specks`]), which is said on standard
/// error.
fn read_whole(path: &Path) -> Result<MaskBuffer> {
    let mut mask = read_mask(path)?;
    let dropped = mask.drop_specks()?;
    if dropped > 0 {
        eprintln!("{}: {dropped} pixels of specks left out", path.display());
    }
    Ok(mask)
}

/// The masks of a sequence, in the order of their names, all of one size.
pub struct Source {
    /// Each mask and the file it came from.
    pub masks: Vec<(PathBuf, MaskBuffer)>,
    /// The camera for their size.
    pub camera: Camera,
}

impl Source {
    /// Reads a folder of masks.
    ///
    /// # Errors
    /// For a folder or a file that cannot be read, masks that differ in size, and a calibration
    /// for another size.
    pub fn read(folder: &Path, calibration: &Calibration) -> Result<Self> {
        let masks: Vec<_> = files_in(folder)?
            .into_iter()
            .map(|path| read_whole(&path).map(|mask| (path, mask)))
            .collect::<Result<_>>()?;
        let (_, first) = masks.first().context("a folder of masks is never empty")?;
        let (width, height) = (first.mask().width(), first.mask().height());
        for (path, mask) in &masks {
            if (mask.mask().width(), mask.mask().height()) != (width, height) {
                bail!("{} differs in size from the first mask", path.display());
            }
        }
        Ok(Self {
            camera: calibration.camera(width, height)?,
            masks,
        })
    }
}
