//! Reads changed files in every way there is, until the time is over or one of them ends the program (`cargo xtask fuzz`).
//!
//! `mutated SECONDS SEED FOLDER`, with the paths of whole files on the standard input, a line each. What panics, or takes
//! longer than [`PATIENCE`], is kept in the folder.

use std::io::{self, BufRead};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::exit;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use std::{env, fs, thread};

use fluoropose_decode::{FrameFile, decode_mask, decode_model, sniff};

/// Larger files are left out: a second is to be for many.
const LARGEST: u64 = 100_000;

/// Longest that a file of that size may take.
const PATIENCE: Duration = Duration::from_secs(20);

/// Most frames of a file that are decoded.
const FRAMES: usize = 4;

fn main() -> io::Result<()> {
    let words: Vec<String> = env::args().skip(1).collect();
    let [seconds, seed, folder] = words.as_slice() else {
        return Err(io::ErrorKind::InvalidInput.into());
    };
    let wrong = |_| io::Error::from(io::ErrorKind::InvalidInput);
    let end = Instant::now() + Duration::from_secs(seconds.parse().map_err(wrong)?);
    let mut random = Random(seed.parse::<u64>().map_err(wrong)? | 1);
    let folder = PathBuf::from(folder);
    fs::create_dir_all(&folder)?;
    let mut files = Vec::new();
    for path in io::stdin().lock().lines() {
        let path = PathBuf::from(path?);
        if fs::metadata(&path)?.len() <= LARGEST {
            files.push((name(&path), fs::read(path)?));
        }
    }
    let now = Arc::new(Mutex::new((Instant::now(), Vec::new(), String::new())));
    watch(Arc::clone(&now), folder.clone());
    let mut count = 0u64;
    while Instant::now() < end {
        let (name, whole) = &files[random.below(files.len())];
        let bytes = changed(whole, &files, &mut random);
        *now.lock().unwrap_or_else(PoisonError::into_inner) =
            (Instant::now(), bytes.clone(), name.clone());
        if catch_unwind(AssertUnwindSafe(|| read(&bytes, name))).is_err() {
            keep(&folder, "panic", name, &bytes);
        }
        count += 1;
    }
    println!(
        "{count} changed files of {} were read without a panic",
        files.len()
    );
    Ok(())
}

fn name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

fn read(bytes: &[u8], name: &str) {
    let _ = sniff(bytes, name);
    let _ = decode_model(bytes, name);
    let _ = decode_mask(bytes, name);
    if let Ok(file) = FrameFile::open(bytes, name) {
        for index in 0..file.count().min(FRAMES) {
            let _ = file.frame(index);
        }
    }
}

/// What is being read, since when, and under which name.
type Now = Arc<Mutex<(Instant, Vec<u8>, String)>>;

/// Ends the program where a file takes too long.
fn watch(now: Now, folder: PathBuf) {
    thread::spawn(move || {
        loop {
            thread::sleep(Duration::from_secs(1));
            let (since, bytes, name) = &*now.lock().unwrap_or_else(PoisonError::into_inner);
            if since.elapsed() > PATIENCE {
                keep(&folder, "slow", name, bytes);
            }
        }
    });
}

/// Keeps a file, says where, and ends the program.
fn keep(folder: &Path, what: &str, name: &str, bytes: &[u8]) -> ! {
    let path = folder.join(format!("{what}-{name}"));
    match fs::write(&path, bytes) {
        Ok(()) => eprintln!("{what}: kept in {}", path.display()),
        Err(error) => eprintln!("{what}: {name} could not be kept ({error})"),
    }
    exit(1)
}

/// Xorshift of 64 bits.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 >> 11
    }

    fn below(&mut self, most: usize) -> usize {
        (self.next() % most.max(1) as u64) as usize
    }
}

/// Numbers that mean something as a count, a length or a side.
const NUMBERS: [u32; 10] = [
    0,
    1,
    2,
    0x10,
    0x7F,
    0xFF,
    0x2000,
    0xFFFF,
    0x7FFF_FFFF,
    u32::MAX,
];

/// One to six changes, half of them near the beginning, where headers are.
fn changed(whole: &[u8], files: &[(String, Vec<u8>)], random: &mut Random) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for _ in 0..1 + random.below(6) {
        let near = [bytes.len(), bytes.len().min(400)][random.below(2)];
        let at = random.below(near);
        let end = (at + 1 + random.below(32)).min(bytes.len());
        let number = NUMBERS[random.below(NUMBERS.len())];
        match random.below(8) {
            0 => overwrite(&mut bytes, at, &[random.next() as u8]),
            1 => overwrite(&mut bytes, at, &(number as u16).to_be_bytes()),
            2 => overwrite(&mut bytes, at, &(number as u16).to_le_bytes()),
            3 => overwrite(&mut bytes, at, &number.to_be_bytes()),
            4 => overwrite(&mut bytes, at, &number.to_le_bytes()),
            5 => bytes.truncate(at),
            6 => {
                let (_, other) = &files[random.below(files.len())];
                let from = random.below(other.len());
                let part = &other[from..(from + end.saturating_sub(at)).min(other.len())];
                overwrite(&mut bytes, at, part);
            }
            _ => {
                let part = bytes.get(at..end).unwrap_or_default().to_vec();
                bytes.splice(at..at, part);
            }
        }
    }
    bytes
}

fn overwrite(bytes: &mut [u8], at: usize, new: &[u8]) {
    for (place, value) in bytes.iter_mut().skip(at).zip(new) {
        *place = *value;
    }
}
