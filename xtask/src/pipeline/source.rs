//! A folder of masks and the camera that saw them.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose::calibration::Calibration;
use fluoropose::camera::Camera;

use super::disturb::{DisturbanceOptions, Disturbed};
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
    /// The pixels of each mask that are not known, where a folder of them was given.
    pub unknown: Option<Vec<MaskBuffer>>,
    /// The camera for their size.
    pub camera: Camera,
}

impl Source {
    /// Reads a folder of masks, and one of as many masks of unknown pixels where it is given; the
    /// order of names is that of the frames in both.
    ///
    /// # Errors
    /// For a folder or a file that cannot be read, masks that differ in size or number, and a
    /// calibration for another size.
    pub fn read(folder: &Path, unknown: Option<&Path>, calibration: &Calibration) -> Result<Self> {
        let masks: Vec<_> = files_in(folder)?
            .into_iter()
            .map(|path| read_whole(&path).map(|mask| (path, mask)))
            .collect::<Result<_>>()?;
        let (_, first) = masks.first().context("a folder of masks is never empty")?;
        let size = (first.mask().width(), first.mask().height());
        for (path, mask) in &masks {
            check_size(path, mask, size)?;
        }
        Ok(Self {
            camera: calibration.camera(size.0, size.1)?,
            unknown: unknown
                .map(|unknown| read_unknown(unknown, masks.len(), size))
                .transpose()?,
            masks,
        })
    }

    /// Each mask, with what is not known of it, after a disturbance; and the file it came from.
    ///
    /// # Errors
    /// Each time those of [`DisturbanceOptions::disturb`], with the file's name.
    pub fn disturbed(
        &self,
        options: &DisturbanceOptions,
    ) -> impl Iterator<Item = Result<(&Path, Disturbed)>> {
        let masks = self.masks.iter().enumerate();
        masks.map(move |(frame, (path, mask))| {
            let unknown = self.unknown.as_ref().and_then(|unknown| unknown.get(frame));
            let unknown = unknown.map(MaskBuffer::mask);
            options
                .disturb(&mask.mask(), unknown.as_ref(), frame as u64)
                .map(|disturbed| (path.as_path(), disturbed))
                .with_context(|| format!("{} cannot be disturbed", path.display()))
        })
    }
}

fn read_unknown(folder: &Path, count: usize, size: (usize, usize)) -> Result<Vec<MaskBuffer>> {
    let files = files_in(folder)?;
    if files.len() != count {
        bail!(
            "{} holds {} masks of unknown pixels but there are {count} masks; each needs its own",
            folder.display(),
            files.len()
        );
    }
    let read = |path: &PathBuf| {
        let mask = read_mask(path)?;
        check_size(path, &mask, size)?;
        Ok(mask)
    };
    files.iter().map(read).collect()
}

fn check_size(path: &Path, mask: &MaskBuffer, size: (usize, usize)) -> Result<()> {
    if (mask.mask().width(), mask.mask().height()) != size {
        bail!("{} differs in size from the first mask", path.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{GrayImage, Luma};

    /// A folder of masks with a square each, at a column that tells the frame.
    fn folder(name: &str, columns: &[u32], side: u32) -> PathBuf {
        let folder =
            std::env::temp_dir().join(format!("fluoropose-source-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for (frame, &column) in columns.iter().enumerate() {
            let mut picture = GrayImage::new(side, side);
            for (x, y) in (0..100).map(|k| (k % 10, k / 10)) {
                picture.put_pixel(column + x, 20 + y, Luma([255]));
            }
            picture
                .save(folder.join(format!("{frame:03}.png")))
                .unwrap();
        }
        folder
    }

    #[test]
    fn unknown_pixels_are_read_beside_the_masks() {
        let calibration = Calibration::parse("JT_INTCALIB\n1000\n0\n0\n0.5\n").unwrap();
        let masks = folder("masks", &[10, 30], 64);
        let unknown = folder("unknown", &[15, 40], 64);
        let source = Source::read(&masks, Some(&unknown), &calibration).unwrap();
        let none = DisturbanceOptions::default();
        let seen: Vec<Disturbed> = source
            .disturbed(&none)
            .map(|found| found.unwrap().1)
            .collect();
        for (frame, column) in [(0, 15), (1, 40)] {
            let told = seen[frame].unknown.as_ref().unwrap();
            assert!(told.mask().get(column, 20) && !told.mask().get(column - 1, 20));
            assert_eq!(
                seen[frame].mask.mask().words(),
                source.masks[frame].1.mask().words()
            );
        }
        let message = |unknown: &Path| {
            let read = Source::read(&masks, Some(unknown), &calibration);
            format!("{:#}", read.err().unwrap())
        };
        let few = folder("few", &[15], 64);
        assert!(message(&few).contains("1 masks of unknown pixels"));
        let small = folder("small", &[15, 15], 32);
        assert!(message(&small).contains("differs in size"));
        for folder in [masks, unknown, few, small] {
            std::fs::remove_dir_all(folder).unwrap();
        }
    }
}
