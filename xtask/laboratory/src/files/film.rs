//! A film whose frames are read when they are looked at, however many there are.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use anyhow::{Context, Result, anyhow, bail};
use fluoropose_decode::{FrameFile, GreyFrame, Pixels};
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::frames::reduced;
use super::listing::{files_in, gaps_in};
use super::text::{name_of, read};

/// Decoded frames that are kept: both components look at the same frames at about the same time, from two ends.
const KEPT: usize = 8;
/// Files that cannot be read of which it is said why.
const NAMED: usize = 5;

/// A frame as it is decoded once for all who look at it.
type Slot = Arc<OnceLock<Result<Arc<GreyFrame>, String>>>;

/// The frames of a folder in the order of their files' names ([`files_in`]). A file may hold several, as DICOM and TIFF do: the last of
/// such files is kept in memory, and nothing else but a few decoded frames.
pub struct Film {
    paths: Vec<PathBuf>,
    /// Of each frame, its file, its number in it, and the number of frames in it.
    places: Vec<(usize, usize, usize)>,
    size: (usize, usize),
    digest: [u8; 32],
    /// Of each frame's pixels.
    prints: Vec<u64>,
    /// Where files state another order than their names have: the first file that stands elsewhere by that, and the one that would stand there.
    out_of_order: Option<[usize; 2]>,
    /// Side of the squares that frames are handed out in, pixels of the files.
    square_px: usize,
    decoded: Mutex<VecDeque<(usize, Slot)>>,
    opened: Mutex<Option<(usize, Arc<FrameFile<'static>>)>>,
}

/// What is known of a file before its frames are looked at.
struct Listed {
    digest: [u8; 32],
    /// Its place in its series, where it states one.
    number: Option<f64>,
    /// Width and height of each of its frames, and a hash of its pixels.
    frames: Vec<((u32, u32), u64)>,
}

impl Film {
    /// Lists the frames of a folder. Every file is read once, for its digest and its number of frames, and every frame is decoded once: what is
    /// damaged is told before hours of work, and all of it.
    ///
    /// # Errors
    /// For a folder or a file that cannot be read, a damaged frame, and frames of several sizes.
    pub fn read(folder: &Path) -> Result<Self> {
        let paths = files_in(folder)?;
        let listed = all_readable(folder, paths.par_iter().map(|path| list(path)).collect())?;
        let mut whole = Sha256::new();
        let mut places = Vec::new();
        for (file, listed) in listed.iter().enumerate() {
            whole.update(listed.digest);
            let count = listed.frames.len();
            places.extend((0..count).map(|index| (file, index, count)));
        }
        let numbers: Vec<Option<f64>> = listed.iter().map(|listed| listed.number).collect();
        let frames = listed.into_iter().flat_map(|listed| listed.frames);
        let (sizes, prints): (Vec<_>, Vec<_>) = frames.unzip();
        let mut film = Self {
            paths,
            places,
            size: (0, 0),
            digest: whole.finalize().into(),
            prints,
            out_of_order: out_of_order(&numbers),
            square_px: 1,
            decoded: Mutex::default(),
            opened: Mutex::default(),
        };
        film.check_sizes(&sizes)?;
        let first = film.frame(0)?;
        film.size = (first.width as usize, first.height as usize);
        for note in &first.notes {
            eprintln!("{}: {note}", folder.display());
        }
        Ok(film)
    }

    /// The same film in squares of `side` x `side` pixels ([`reduced`]).
    pub fn in_squares(&self, side: usize) -> Self {
        let (width, height) = self.size;
        Self {
            paths: self.paths.clone(),
            places: self.places.clone(),
            size: (width / side, height / side),
            digest: self.digest,
            prints: self.prints.clone(),
            out_of_order: self.out_of_order,
            square_px: side,
            decoded: Mutex::default(),
            opened: Mutex::default(),
        }
    }

    /// Side of the squares that frames are handed out in, pixels of the files.
    pub fn square_px(&self) -> usize {
        self.square_px
    }

    /// Refuses frames that are not of the first one's size: neither a camera nor a component's way is known between them.
    fn check_sizes(&self, sizes: &[(u32, u32)]) -> Result<()> {
        let (first, others) = sizes.split_first().context("there is no frame")?;
        let Some(other) = others.iter().position(|size| size != first) else {
            return Ok(());
        };
        let named = |frame: usize| {
            let ((file, place), (width, height)) = (self.place(frame), sizes[frame]);
            let place = match self.places[frame].2 {
                1 => String::new(),
                _ => format!(", frame {place}"),
            };
            format!("{file}{place} is {width} x {height} pixels")
        };
        let folder = self.paths[0].parent().unwrap_or(Path::new(""));
        bail!(
            "{}: {} but {}: a film has frames of one size, those that were calibrated; take the others out of the folder",
            folder.display(),
            named(other + 1),
            named(0)
        )
    }

    /// What the files' numbers tell to be missing, a sentence without its full stop.
    pub fn gaps(&self) -> Option<String> {
        let folder = self.paths.first()?.parent().unwrap_or(Path::new(""));
        gaps_in(&self.paths).map(|gaps| format!("{}: {gaps}", folder.display()))
    }

    /// Frames that follow each other and are the same to the last pixel, a sentence without its full stop: X-rays never are, for their noise.
    pub fn repeats(&self) -> Option<String> {
        let same = |&frame: &usize| self.prints[frame] == self.prints[frame + 1];
        let repeats: Vec<usize> = (0..self.count().saturating_sub(1)).filter(same).collect();
        if repeats.is_empty() {
            return None;
        }
        let pair = |&at: &usize| format!("{} and {}", at + 1, at + 2);
        let named: Vec<String> = repeats.iter().take(NAMED).map(pair).collect();
        let more = match repeats.len() - named.len() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let folder = self.paths[0].parent().unwrap_or(Path::new(""));
        Some(format!(
            "{}: frames {}{more} are the same to the last pixel: was one written twice? They are taken for neighbours at even times",
            folder.display(),
            named.join(", ")
        ))
    }

    /// What files that state another order than that of their names tell, a sentence without its full stop. The names stand, as rows of poses
    /// were written by them.
    pub fn disorder(&self) -> Option<String> {
        let [by_name, by_number] = self.out_of_order?.map(|file| &self.paths[file]);
        let folder = by_name.parent().unwrap_or(Path::new(""));
        Some(format!(
            "{}: frames stand by the names of their files, which state another order (Instance Number): {} stands where {} would by that. If that is the order of time, rename the files",
            folder.display(),
            name_of(by_name),
            name_of(by_number)
        ))
    }

    /// Number of frames.
    pub fn count(&self) -> usize {
        self.places.len()
    }

    /// Columns and rows of each frame.
    pub fn size(&self) -> (usize, usize) {
        self.size
    }

    /// The name of the file that a frame, from 0, stands in, and its number in that, from 1; no name for one that is not there.
    pub fn place(&self, frame: usize) -> (String, usize) {
        let place = self.places.get(frame);
        place.map_or((String::new(), 1), |&(file, index, _)| {
            (name_of(&self.paths[file]), index + 1)
        })
    }

    /// SHA-256 of the files' digests, in their order.
    pub fn digest(&self) -> [u8; 32] {
        self.digest
    }

    /// A frame, from 0.
    ///
    /// # Errors
    /// Those of the decoder, with the file's name; for a frame that is not there, and one of another size.
    pub fn frame(&self, frame: usize) -> Result<Arc<GreyFrame>> {
        let slot = self.slot(frame);
        let decoded = slot.get_or_init(|| self.decode(frame).map_err(|error| format!("{error:#}")));
        decoded.clone().map_err(|error| anyhow!(error))
    }

    fn slot(&self, frame: usize) -> Slot {
        let mut decoded = self.decoded.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, slot)) = decoded.iter().find(|(kept, _)| *kept == frame) {
            return slot.clone();
        }
        if decoded.len() == KEPT {
            decoded.pop_front();
        }
        let slot = Slot::default();
        decoded.push_back((frame, slot.clone()));
        slot
    }

    fn decode(&self, frame: usize) -> Result<Arc<GreyFrame>> {
        let &(file, index, count) = self.places.get(frame).context("there is no such frame")?;
        let decoded = match count {
            1 => open(&self.paths[file])?.frame(0)?,
            _ => self.opened(file)?.frame(index)?,
        };
        let decoded = match self.square_px {
            1 => decoded,
            side => reduced(&decoded, side)?,
        };
        let found = (decoded.width as usize, decoded.height as usize);
        if self.size != (0, 0) && found != self.size {
            bail!(
                "frame {} is {} x {} pixels but the first is {} x {}",
                frame + 1,
                found.0,
                found.1,
                self.size.0,
                self.size.1
            );
        }
        Ok(Arc::new(decoded))
    }

    fn opened(&self, file: usize) -> Result<Arc<FrameFile<'static>>> {
        let mut opened = self.opened.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((kept, found)) = opened.as_ref()
            && *kept == file
        {
            return Ok(found.clone());
        }
        let found = Arc::new(open(&self.paths[file])?);
        *opened = Some((file, found.clone()));
        Ok(found)
    }
}

fn open(path: &Path) -> Result<FrameFile<'static>> {
    Ok(FrameFile::open(read(path)?, &name_of(path))?)
}

fn list(path: &Path) -> Result<Listed> {
    let bytes = read(path)?;
    let digest = Sha256::digest(&bytes).into();
    let file = FrameFile::open(bytes, &name_of(path))?;
    let frame = |frame: usize| -> Result<((u32, u32), u64)> {
        // Headers alone do not tell a file that was cut off.
        let decoded = file.frame(frame)?;
        Ok(((decoded.width, decoded.height), print_of(&decoded.pixels)))
    };
    Ok(Listed {
        frames: (0..file.count()).map(frame).collect::<Result<_>>()?,
        number: file.instance_number(),
        digest,
    })
}

/// Of files, each of which states a number of its own, the first that does not stand in their order, and the one that would stand there;
/// `None` where all stand in it, or not all state one.
fn out_of_order(numbers: &[Option<f64>]) -> Option<[usize; 2]> {
    let stated: Vec<f64> = numbers.iter().copied().collect::<Option<_>>()?;
    let mut order: Vec<usize> = (0..stated.len()).collect();
    order.sort_by(|&a, &b| stated[a].total_cmp(&stated[b]));
    let each_its_own = order
        .windows(2)
        .all(|pair| stated[pair[0]] < stated[pair[1]]);
    let at = order
        .iter()
        .enumerate()
        .position(|(at, &file)| at != file)?;
    each_its_own.then(|| [at, order[at]])
}

/// A hash of pixels: the same of the same.
fn print_of(pixels: &Pixels) -> u64 {
    let mut hasher = DefaultHasher::new();
    match pixels {
        Pixels::U8(values) => values.hash(&mut hasher),
        Pixels::U16(values) => values.hash(&mut hasher),
    }
    hasher.finish()
}

/// All of what was listed, or what is wrong with the first few of those that cannot be read, and how many they are.
fn all_readable(folder: &Path, listed: Vec<Result<Listed>>) -> Result<Vec<Listed>> {
    let count = listed.len();
    let (mut readable, mut faults) = (Vec::with_capacity(count), Vec::new());
    for one in listed {
        match one {
            Ok(listed) => readable.push(listed),
            // Of the machine, perhaps, which who asked tells from a fault of the file.
            Err(error) if error.chain().any(|cause| cause.is::<std::io::Error>()) => {
                return Err(error.context(folder.display().to_string()));
            }
            Err(error) => faults.push(format!("{error:#}").trim_end_matches('.').to_owned()),
        }
    }
    if faults.is_empty() {
        return Ok(readable);
    }
    let all = faults.len();
    faults.truncate(NAMED);
    let more = match all - faults.len() {
        0 => String::new(),
        more => format!("; and {more} more"),
    };
    bail!(
        "{}: {all} of {count} files cannot be read: {}{more}. What belongs to no frame, or cannot be had again, is to be taken out of the folder; a frame with its row in files of poses",
        folder.display(),
        faults.join("; ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose_phantom::picture::write_grey;

    #[test]
    fn a_frame_of_another_size_is_told_at_the_start_and_places_bear_names() {
        let folder = std::env::temp_dir().join(format!("fluoropose-many-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let write = |name: &str, side: usize| {
            write_grey(&folder.join(name), (side, 8), &vec![7; 8 * side]).unwrap();
        };
        (1..6).for_each(|number| write(&format!("{number}.png"), 16));
        let film = Film::read(&folder).unwrap();
        assert_eq!(
            (film.place(4), film.size()),
            (("5.png".to_owned(), 1), (16, 8))
        );
        assert_eq!(film.place(5), (String::new(), 1));
        write("4.png", 15);
        let refused = Film::read(&folder).err().unwrap().to_string();
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(
            refused.contains("4.png is 15 x 8 pixels but 1.png is 16 x 8 pixels"),
            "{refused}"
        );
    }

    #[test]
    fn files_that_state_another_order_are_told_by_the_first_that_stands_elsewhere() {
        let told = |numbers: &[i32]| {
            let stated = numbers
                .iter()
                .map(|&number| (number > 0).then(|| f64::from(number)));
            out_of_order(&stated.collect::<Vec<_>>())
        };
        assert_eq!(told(&[3, 1, 2]), Some([0, 1]));
        assert_eq!(told(&[1, 9, 2]), Some([1, 2]));
        for in_order_or_untold in [&[][..], &[5], &[1, 2, 7], &[2, 1, 2], &[2, 1, -1]] {
            assert_eq!(told(in_order_or_untold), None, "{in_order_or_untold:?}");
        }
    }

    #[test]
    fn frames_that_are_the_same_are_told() {
        let folder = std::env::temp_dir().join(format!("fluoropose-twice-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let write = |number: usize, value: u8| {
            let mut pixels = [7; 64];
            pixels[9] = value;
            write_grey(&folder.join(format!("f{number}.png")), (8, 8), &pixels).unwrap();
        };
        (1..=6).for_each(|number| write(number, number as u8));
        let before = Film::read(&folder).unwrap().repeats();
        write(4, 3);
        write(6, 1);
        let told = Film::read(&folder).unwrap().repeats();
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(before, None);
        let told = told.unwrap();
        assert!(
            told.contains("frames 3 and 4 are the same to the last pixel"),
            "{told}"
        );
    }

    #[test]
    fn damaged_frames_are_told_at_the_start_with_their_folder_and_all_of_them() {
        let folder = std::env::temp_dir().join(format!("fluoropose-cut-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let pixels: Vec<u8> = (0..64 * 64).map(|k| (k * k % 251) as u8).collect();
        for number in 1..=12 {
            let path = folder.join(format!("f{number}.png"));
            write_grey(&path, (64, 64), &pixels).unwrap();
            if number % 5 == 0 {
                let whole = std::fs::read(&path).unwrap();
                std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
            }
        }
        let refused = Film::read(&folder).err().unwrap().to_string();
        std::fs::remove_file(folder.join("f5.png")).unwrap();
        std::fs::remove_file(folder.join("f10.png")).unwrap();
        let film = Film::read(&folder).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        let begin = format!(
            "{}: 2 of 12 files cannot be read: f5.png: ",
            folder.display()
        );
        assert!(
            refused.starts_with(&begin) && refused.contains("; f10.png: "),
            "{refused}"
        );
        assert_eq!(film.place(8).0, "f11.png");
        let gaps = film.gaps().unwrap();
        assert!(
            gaps.contains(
                "2 of the numbered files are missing, between f4.png and f6.png, f9.png and f11.png"
            ),
            "{gaps}"
        );
    }
}
