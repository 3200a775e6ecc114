//! A folder of masks and the camera that saw them.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose::camera::Camera;
use fluoropose::camera::calibration::Calibration;
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::Mask;
use fluoropose_decode::GreyFrame;
use rayon::prelude::*;

use super::seen::Seen;
use crate::files::{
    Frames, MaskBuffer, camera_of_frames, doubt_beside, files_in, gaps_in, grey, read_masks,
    reduced,
};
use crate::noise::{DisturbanceOptions, Disturbed};
use crate::progress::say_once;

/// Masks, and what belongs to them, that are in memory; as many of each.
pub struct InMemory {
    /// Masks, all of one size.
    pub masks: Vec<MaskBuffer>,
    /// Pixels of each that are not known.
    pub unknown: Option<Vec<MaskBuffer>>,
    /// Grey frames, as large as the masks.
    pub frames: Option<Vec<GreyFrame>>,
}

/// Reads the masks of a file and drops their specks ([`MaskBuffer::drop_specks`]), which is said on standard
/// error.
fn read_whole(path: &Path) -> Result<Vec<(PathBuf, MaskBuffer)>> {
    let mut masks = read_masks(path)?;
    for (name, mask) in &mut masks {
        let dropped = mask.drop_specks()?;
        if dropped > 0 {
            eprintln!("{}: {dropped} pixels of specks left out", name.display());
        }
    }
    Ok(masks)
}

/// Says of masks that are in pieces that they are: of the first, and how many more there are.
fn say_pieces(masks: &[(PathBuf, MaskBuffer)]) -> Result<()> {
    let told = masks.par_iter().map(|(name, mask)| {
        let told = mask.in_pieces()?;
        Ok(told.map(|told| format!("{}: {told}", name.display())))
    });
    let told: Vec<Option<String>> = told.collect::<Result<_>>()?;
    let mut told = told.into_iter().flatten();
    if let Some(first) = told.next() {
        match told.count() {
            0 => eprintln!("{first}"),
            more => eprintln!("{first}; so it is of {more} more"),
        }
    }
    Ok(())
}

/// The folders of a sequence; the order of names is that of the frames in each.
#[derive(Clone, Copy, Debug)]
pub struct Folders<'p> {
    /// Masks.
    pub masks: &'p Path,
    /// Masks of unknown pixels, as many.
    pub unknown: Option<&'p Path>,
    /// Grey frames, as many.
    pub frames: Option<&'p Path>,
}

/// The masks of a sequence, in the order of their names, all of one size.
pub struct Source {
    /// Each mask and the file it came from.
    pub masks: Vec<(PathBuf, MaskBuffer)>,
    /// The pixels of each mask that are not known, where a folder of them was given.
    pub unknown: Option<Vec<MaskBuffer>>,
    /// The grey frames, where a folder of them was given.
    pub frames: Option<Frames>,
    /// The camera for their size.
    pub camera: Camera,
}

impl Source {
    /// Reads the folders of a sequence.
    ///
    /// # Errors
    /// For a folder or a file that cannot be read, masks and frames that differ in size or
    /// number, and a calibration for another size.
    pub fn read(folders: &Folders<'_>, calibration: &Calibration) -> Result<Self> {
        let files = files_in(folders.masks)?;
        if let Some(gaps) = gaps_in(&files) {
            eprintln!("{}: {gaps}", folders.masks.display());
        }
        let masks: Vec<_> = files
            .par_iter()
            .map(|path| read_whole(path))
            .collect::<Result<_>>()?;
        let masks: Vec<_> = masks.into_iter().flatten().collect();
        let (_, first) = masks.first().context("a folder of masks is never empty")?;
        let size = (first.mask().width(), first.mask().height());
        for (path, mask) in &masks {
            check_size(path, mask, size)?;
        }
        match inverted(&masks) {
            Some(doubt) => eprintln!("{}: {doubt}", folders.masks.display()),
            // What is told to be unknown may divide them.
            None if folders.unknown.is_none() => say_pieces(&masks)?,
            None => {}
        }
        let count = masks.len();
        let folder = || folders.masks.display().to_string();
        let (camera, doubts) = camera_of_frames(calibration, size).with_context(folder)?;
        for doubt in doubts {
            say_once(&doubt);
        }
        let unknown = folders.unknown.map(|path| read_unknown(path, count, size));
        let frames = folders.frames.map(|path| Frames::read(path, count, size));
        let frames = frames.transpose()?;
        if let Some(frames) = &frames
            && let Some(doubt) = doubt_beside(&camera, &*frames.decode(0)?)
        {
            eprintln!("{doubt}");
        }
        Ok(Self {
            camera,
            unknown: unknown.transpose()?,
            frames,
            masks,
        })
    }

    /// The same from memory. Specks are dropped from each mask; how many pixels of them comes back too.
    ///
    /// # Errors
    /// Where the calibration is for frames of another size, and for no masks.
    pub fn of(given: InMemory, calibration: &Calibration) -> Result<(Self, Vec<u64>)> {
        let first = given.masks.first().context("there is no mask")?.mask();
        let camera = calibration.camera(first.width(), first.height())?;
        let whole = |mut mask: MaskBuffer| {
            let dropped = mask.drop_specks()?;
            Ok((mask, dropped))
        };
        let whole: Vec<_> = given
            .masks
            .into_par_iter()
            .map(whole)
            .collect::<Result<_>>()?;
        let (masks, dropped): (Vec<_>, Vec<u64>) = whole.into_iter().unzip();
        let named = |(number, mask)| (PathBuf::from(format!("mask {}", number + 1)), mask);
        let source = Self {
            masks: masks.into_iter().enumerate().map(named).collect(),
            unknown: given.unknown,
            frames: given.frames.map(Frames::of),
            camera,
        };
        Ok((source, dropped))
    }

    /// The sequence as a method gets to see it: each mask, with what is not known of it, after a
    /// disturbance.
    ///
    /// # Errors
    /// Those of [`DisturbanceOptions::disturb`], with the file's name.
    pub fn disturbed(&self, options: &DisturbanceOptions) -> Result<Sequence<'_>> {
        let disturb = |(frame, (path, mask)): (usize, &(PathBuf, MaskBuffer))| {
            let unknown = self.unknown.as_ref().and_then(|unknown| unknown.get(frame));
            let unknown = unknown.map(MaskBuffer::mask);
            options
                .disturb(&mask.mask(), unknown.as_ref(), frame as u64)
                .with_context(|| format!("{} cannot be disturbed", path.display()))
        };
        let masks = self.masks.iter().enumerate().map(disturb);
        Ok(Sequence {
            masks: masks.collect::<Result<_>>()?,
            source: self,
        })
    }
}

/// A source after a disturbance.
pub struct Sequence<'s> {
    source: &'s Source,
    masks: Vec<Disturbed>,
}

impl Sequence<'_> {
    /// The camera.
    pub fn camera(&self) -> Camera {
        self.source.camera
    }

    /// Each mask's file and the mask.
    pub fn masks(&self) -> impl ExactSizeIterator<Item = (&Path, &Disturbed)> {
        let files = self.source.masks.iter().map(|(path, _)| path.as_path());
        files.zip(&self.masks)
    }

    /// Calls `look` with what is known of a frame, from 0.
    ///
    /// # Errors
    /// For a frame that is not there or cannot be decoded, and those of `look`.
    pub fn look<T>(&self, frame: usize, look: impl FnOnce(&Seen<'_>) -> Result<T>) -> Result<T> {
        let mask = self.masks.get(frame).context("there is no such frame")?;
        let frames = self.source.frames.as_ref();
        let decoded = frames.map(|frames| frames.decode(frame)).transpose()?;
        let grey = decoded.as_deref().map(grey).transpose()?;
        mask.see(|silhouette| {
            look(&Seen {
                silhouette,
                frame: grey.as_deref(),
            })
        })
    }

    /// Calls `look` with a grey frame, from 0, in squares with sides of so many pixels, after the camera that saw it so and before what is not
    /// known of it.
    ///
    /// # Errors
    /// For a frame that is not there or cannot be decoded, squares that do not fit, and those of `look`.
    pub fn look_in<T>(
        &self,
        side: usize,
        frame: usize,
        look: impl FnOnce(&Camera, &dyn Grey, Option<&Mask<'_>>) -> Result<T>,
    ) -> Result<T> {
        let mask = self.masks.get(frame).context("there is no such frame")?;
        let frames = self.source.frames.as_ref();
        let frames = frames.context("the method image needs the grey frames, not only masks")?;
        let (decoded, unknown) = (frames.decode(frame)?, mask.unknown.as_ref());
        if side <= 1 {
            let unknown = unknown.map(MaskBuffer::mask);
            return look(&self.camera(), &*grey(&decoded)?, unknown.as_ref());
        }
        let unknown = unknown.map(|unknown| unknown.mask().reduced(side));
        let unknown = unknown.as_ref();
        let unknown = unknown.map(|(width, height, words)| Mask::new(words, *width, *height));
        look(
            &self.camera().reduced(side)?,
            &*grey(&reduced(&decoded, side)?)?,
            unknown.transpose()?.as_ref(),
        )
    }
}

/// Masks that cover more than half of their frames, as those do that are black inside: a sentence without its full stop.
fn inverted(masks: &[(PathBuf, MaskBuffer)]) -> Option<String> {
    let is_most = |(_, mask): &&(PathBuf, MaskBuffer)| {
        let mask = mask.mask();
        2 * mask.area() > (mask.width() * mask.height()) as u64
    };
    let count = masks.iter().filter(is_most).count();
    (2 * count > masks.len()).then(|| {
        format!(
            "{count} of {} masks cover more than half of their frame, and no implant does: what is inside is bright in a mask; turn black and white around",
            masks.len()
        )
    })
}

fn read_unknown(folder: &Path, count: usize, size: (usize, usize)) -> Result<Vec<MaskBuffer>> {
    let files = files_in(folder)?;
    let read: Vec<_> = files
        .iter()
        .map(|path| read_masks(path))
        .collect::<Result<_>>()?;
    let masks: Vec<_> = read.into_iter().flatten().collect();
    if masks.len() != count {
        bail!(
            "{} holds {} masks of unknown pixels but there are {count} masks; each needs its own",
            folder.display(),
            masks.len()
        );
    }
    let checked = masks.into_iter().map(|(path, mask)| {
        check_size(&path, &mask, size)?;
        Ok(mask)
    });
    checked.collect()
}

fn check_size(path: &Path, mask: &MaskBuffer, size: (usize, usize)) -> Result<()> {
    let (width, height) = (mask.mask().width(), mask.mask().height());
    if (width, height) != size {
        bail!(
            "{} is {width} x {height} pixels and differs in size from the first mask, {} x {}: all are as large as the frames that were calibrated",
            path.display(),
            size.0,
            size.1
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose_phantom::picture::write_grey;

    /// A folder of masks with a square each, at a column that tells the frame.
    fn folder(name: &str, columns: &[usize], side: usize) -> PathBuf {
        let folder =
            std::env::temp_dir().join(format!("fluoropose-source-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for (frame, &column) in columns.iter().enumerate() {
            let mut picture = vec![0; side * side];
            for (x, y) in (0..100).map(|k| (k % 10, k / 10)) {
                picture[(20 + y) * side + column + x] = 255;
            }
            write_grey(
                &folder.join(format!("{frame:03}.png")),
                (side, side),
                &picture,
            )
            .unwrap();
        }
        folder
    }

    #[test]
    fn unknown_pixels_are_read_beside_the_masks() {
        let calibration = Calibration::parse("JT_INTCALIB\n1000\n0\n0\n0.5\n").unwrap();
        let masks = folder("masks", &[10, 30], 64);
        let unknown = folder("unknown", &[15, 40], 64);
        let read = |unknown: &Path| {
            let folders = Folders {
                masks: &masks,
                unknown: Some(unknown),
                // Any picture serves as a frame.
                frames: Some(&masks),
            };
            Source::read(&folders, &calibration)
        };
        let source = read(&unknown).unwrap();
        let sequence = source.disturbed(&DisturbanceOptions::default()).unwrap();
        for (frame, column) in [(0, 15), (1, 40)] {
            let original = source.masks[frame].1.mask();
            let look = |seen: &Seen<'_>| {
                let told = seen.silhouette.unknown().unwrap();
                assert!(told.get(column, 20) && !told.get(column - 1, 20));
                assert_eq!(seen.silhouette.mask().words(), original.words());
                assert_eq!(seen.frame.unwrap().size(), (64, 64));
                Ok(())
            };
            sequence.look(frame, look).unwrap();
            let in_squares = |camera: &Camera, grey: &dyn Grey, told: Option<&Mask<'_>>| {
                assert_eq!((camera.width(), camera.height()), (32, 32));
                assert_eq!(grey.size(), (32, 32));
                // Of a square that begins before them, too.
                let told = told.unwrap();
                assert!(told.get(column / 2, 10) && !told.get(column / 2 - 1, 10));
                Ok(())
            };
            sequence.look_in(2, frame, in_squares).unwrap();
        }
        assert!(sequence.look(2, |_| Ok(())).is_err());
        let message = |unknown: &Path| format!("{:#}", read(unknown).err().unwrap());
        let few = folder("few", &[15], 64);
        assert!(message(&few).contains("1 masks of unknown pixels"));
        let small = folder("small", &[15, 15], 32);
        assert!(message(&small).contains("differs in size"));
        for folder in [masks, unknown, few, small] {
            std::fs::remove_dir_all(folder).unwrap();
        }
    }

    #[test]
    fn the_masks_of_a_film_may_be_one_file() {
        let separate = folder("separate", &[15, 25], 64);
        let alone = separate.join("000.png");
        let read = |path: &Path| {
            let folders = Folders {
                masks: path,
                unknown: None,
                frames: None,
            };
            let calibration = Calibration::parse("JT_INTCALIB\n1000\n0\n0\n1\n").unwrap();
            Source::read(&folders, &calibration).unwrap()
        };
        let expected = read(&separate);
        let mut film = b"\x93NUMPY\x01\0\x40\0".to_vec();
        film.extend(
            format!(
                "{:63}\n",
                "{'descr': '|b1', 'fortran_order': False, 'shape': (2, 64, 64)}"
            )
            .bytes(),
        );
        for (_, mask) in &expected.masks {
            let inside = |at: usize| u8::from(mask.mask().get(at % 64, at / 64));
            film.extend((0..64 * 64).map(inside));
        }
        let file = separate.join("film.npy");
        std::fs::write(&file, film).unwrap();
        let together = read(&file);
        let error = crate::files::read_mask(&file).unwrap_err().to_string();
        assert!(crate::files::read_mask(&alone).is_ok());
        std::fs::remove_dir_all(&separate).unwrap();
        let names = together
            .masks
            .iter()
            .map(|(path, _)| path.to_string_lossy());
        for (number, name) in names.enumerate() {
            assert!(
                name.ends_with(&format!("film.npy #{}", number + 1)),
                "{name}"
            );
        }
        for ((_, one), (_, other)) in expected.masks.iter().zip(&together.masks) {
            assert_eq!(one.mask().words(), other.mask().words());
        }
        assert!(
            error.ends_with("film.npy holds 2 masks, and one is wanted here"),
            "{error}"
        );
    }

    #[test]
    fn masks_that_are_black_inside_are_told() {
        let folder = std::env::temp_dir().join(format!("fluoropose-black-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("1.png");
        let read = |inside: u8| {
            let mut picture = vec![255 - inside; 64];
            picture[..8].fill(inside);
            write_grey(&path, (8, 8), &picture).unwrap();
            inverted(&read_masks(&path).unwrap())
        };
        let (right, black) = (read(255), read(0));
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(right, None);
        assert!(
            black
                .unwrap()
                .starts_with("1 of 1 masks cover more than half")
        );
    }
}
