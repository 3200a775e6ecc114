//! Grey frames beside the masks of a sequence.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use fluoropose::image::frame::{Frame, Pixel};
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::image::shuttered::Shuttered;
use fluoropose_decode::{FrameFile, Geometry, GreyFrame, Pixels};

use super::listing::files_in;
use super::text::{name_of, read};

/// The frames of a sequence in the order of their files' names. A file may hold several, as
/// DICOM and TIFF do. They are decoded one by one when they are looked at: a film in full size
/// may be larger than memory.
pub struct Frames(From);

/// Where frames come from.
enum From {
    Files {
        files: Vec<FrameFile<'static>>,
        /// Of each frame, its file and its number in it.
        places: Vec<(usize, usize)>,
    },
    Memory(Vec<Arc<GreyFrame>>),
}

impl Frames {
    /// Reads a folder of `count` frames of `size` (columns, rows) pixels. What the decoder notes
    /// about the pixels is said on standard error, once each.
    ///
    /// # Errors
    /// For a folder or a file that cannot be read, and frames that differ from the masks in
    /// number or size.
    pub fn read(folder: &Path, count: usize, size: (usize, usize)) -> Result<Self> {
        let paths = files_in(folder)?;
        let open = |path: &PathBuf| -> Result<FrameFile<'static>> {
            Ok(FrameFile::open(read(path)?, &name_of(path))?)
        };
        let files = paths.iter().map(open).collect::<Result<Vec<_>>>();
        let files = files.with_context(|| folder.display().to_string())?;
        let places: Vec<(usize, usize)> = files
            .iter()
            .enumerate()
            .flat_map(|(file, opened)| (0..opened.count()).map(move |index| (file, index)))
            .collect();
        if places.len() != count {
            bail!(
                "{} holds {} frames but there are {count} masks; each mask needs its own frame, in the same order of names",
                folder.display(),
                places.len()
            );
        }
        let frames = Self(From::Files { files, places });
        let mut notes = BTreeSet::new();
        for place in 0..count {
            let decoded = frames.decode(place);
            let decoded = decoded.with_context(|| folder.display().to_string())?;
            let found = (decoded.width as usize, decoded.height as usize);
            if found != size {
                bail!(
                    "{} is {} x {} pixels but its mask {} x {}; a mask must be as large as its frame",
                    frames.name(place),
                    found.0,
                    found.1,
                    size.0,
                    size.1
                );
            }
            notes.extend(decoded.notes.iter().cloned());
        }
        for note in notes {
            eprintln!("{}: {note}", folder.display());
        }
        Ok(frames)
    }

    /// Frames that were decoded elsewhere.
    pub fn of(frames: Vec<GreyFrame>) -> Self {
        Self(From::Memory(frames.into_iter().map(Arc::new).collect()))
    }

    /// Decodes a frame, from 0.
    ///
    /// # Errors
    /// Those of the decoder, with the file's name; and for a frame that is not there.
    pub fn decode(&self, frame: usize) -> Result<Arc<GreyFrame>> {
        const MISSING: &str = "there is no such frame";
        match &self.0 {
            From::Files { files, places } => {
                let &(file, index) = places.get(frame).context(MISSING)?;
                Ok(Arc::new(files[file].frame(index)?))
            }
            From::Memory(frames) => frames.get(frame).cloned().context(MISSING),
        }
    }

    fn name(&self, frame: usize) -> String {
        let From::Files { files, places } = &self.0 else {
            return format!("frame {}", frame + 1);
        };
        let (file, index) = places[frame];
        let opened = &files[file];
        match opened.count() {
            1 => opened.name().to_owned(),
            _ => format!("{}, frame {}", opened.name(), index + 1),
        }
    }
}

/// Frames a second as the first file of a folder states them, where it does.
///
/// # Errors
/// For a folder or a file that cannot be read.
pub fn stated_frames_per_s(folder: &Path) -> Result<Option<f64>> {
    let Some(first) = files_in(folder)?.into_iter().next() else {
        return Ok(None);
    };
    let file = FrameFile::open(read(&first)?, &name_of(&first))?;
    Ok(file.frames_per_s())
}

/// Whether a folder, or a file, holds another number of frames than `count`, and then which; nothing where it cannot be told, as where it is not there.
pub fn other_count(frames: &Path, count: usize) -> Option<usize> {
    let files = files_in(frames).ok()?;
    // A frame each, most often: none has to be read for that.
    if files.len() == count {
        return None;
    }
    let of_file = |path: &PathBuf| {
        let file = FrameFile::open(read(path).ok()?, &name_of(path)).ok()?;
        Some(file.count())
    };
    let found = files.iter().map(of_file).sum::<Option<usize>>()?;
    (found != count).then_some(found)
}

/// A decoded frame as the core looks at it: what is behind a shutter is beyond the picture.
///
/// # Errors
/// For a frame without pixels.
pub fn grey(frame: &GreyFrame) -> Result<Box<dyn Grey + '_>> {
    let (width, height) = (frame.width as usize, frame.height as usize);
    Ok(match &frame.pixels {
        Pixels::U8(pixels) => shuttered(Frame::new(pixels, width, height, width)?, frame)?,
        Pixels::U16(pixels) => shuttered(Frame::new(pixels, width, height, width)?, frame)?,
    })
}

/// A decoded frame in squares of `side` x `side` pixels ([`Frame::reduce`]). Geometry, which is of the file's pixels, stays behind.
///
/// # Errors
/// For a frame without pixels, or smaller than a square.
pub fn reduced(frame: &GreyFrame, side: usize) -> Result<GreyFrame> {
    let (width, height) = (frame.width as usize, frame.height as usize);
    let pixels = match &frame.pixels {
        Pixels::U8(pixels) => Pixels::U8(Frame::new(pixels, width, height, width)?.reduced(side)?),
        Pixels::U16(pixels) => {
            Pixels::U16(Frame::new(pixels, width, height, width)?.reduced(side)?)
        }
    };
    Ok(GreyFrame {
        width: frame.width / side as u32,
        height: frame.height / side as u32,
        pixels,
        bits: frame.bits,
        window: frame.window,
        geometry: Geometry::default(),
        shutter: frame.shutter.as_ref().map(|one| one.reduced(side as u32)),
        notes: Vec::new(),
    })
}

fn shuttered<'f, P: Pixel>(pixels: Frame<'f, P>, frame: &GreyFrame) -> Result<Box<dyn Grey + 'f>> {
    let Some(shutter) = &frame.shutter else {
        return Ok(Box::new(pixels));
    };
    let (width, height) = (pixels.width(), pixels.height());
    let mut words = vec![0; words_needed(width, height)];
    let mut behind = MaskMut::new(&mut words, width, height)?;
    for row in 0..frame.height {
        let mut covered = 0;
        for open in shutter.open(row, frame.width) {
            behind.fill_span(row as usize, covered, i64::from(open.start));
            covered = i64::from(open.end);
        }
        behind.fill_span(row as usize, covered, i64::from(frame.width));
    }
    Ok(Box::new(Shuttered::new(pixels, words)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose_phantom::picture::{write_grey, write_grey_16};

    #[test]
    fn what_a_shutter_covers_is_beyond_the_picture() {
        let file = include_bytes!("../../../../tests/corpus/frames/shutter.dcm");
        let frames = Frames::of(fluoropose_decode::decode_frames(file, "shutter.dcm").unwrap());
        let decoded = frames.decode(0).unwrap();
        let shutter = decoded.shutter.as_ref().unwrap();
        let grey = grey(&decoded).unwrap();
        let mut covered = 0;
        for row in 0..decoded.height {
            let open = shutter.open(row, decoded.width);
            for column in 0..decoded.width {
                let is_open = open.iter().any(|span| span.contains(&column));
                let read = grey.at(f64::from(column) + 0.5, f64::from(row) + 0.5);
                assert_eq!(read.is_some(), is_open, "{column} {row}");
                covered += u32::from(!is_open);
            }
        }
        assert_eq!(covered, 1570);
    }

    #[test]
    fn frames_of_both_depths_are_read_in_order_and_must_fit_the_masks() {
        let folder = std::env::temp_dir().join(format!("fluoropose-frames-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let eight: Vec<u8> = (0..200).map(|k| k % 20).collect();
        let sixteen: Vec<u16> = (0..200).map(|k| 1000 * (k % 20)).collect();
        write_grey(&folder.join("1.png"), (20, 10), &eight).unwrap();
        write_grey_16(&folder.join("2.png"), (20, 10), &sixteen).unwrap();
        let frames = Frames::read(&folder, 2, (20, 10)).unwrap();
        for (frame, step) in [(0, 1.0), (1, 1000.0)] {
            let decoded = frames.decode(frame).unwrap();
            let grey = grey(&decoded).unwrap();
            assert_eq!(grey.size(), (20, 10));
            // The middle between the centres of columns 7 and 8.
            assert_eq!(grey.at(8.0, 4.5), Some(7.5 * step));
        }
        let message = |count, size| {
            let read = Frames::read(&folder, count, size);
            read.err().unwrap().to_string()
        };
        assert!(message(3, (20, 10)).contains("2 frames but there are 3 masks"));
        assert!(message(2, (20, 12)).contains("1.png is 20 x 10 pixels but its mask 20 x 12"));
        std::fs::remove_dir_all(folder).unwrap();
    }
}
