//! Cut, flipped and random files: an error in words or a decoded file, never a panic, never more memory or time than
//! the file's length justifies.

use std::time::{Duration, Instant};

use fluoropose_decode::{FrameFile, decode_frames, decode_mask, decode_model, sniff};
use png::{BitDepth, ColorType};
use proptest::prelude::*;

use crate::samples::dicom::{Builder, DEFLATED, EXPLICIT, IMPLICIT};
use crate::samples::every::SAMPLES;
use crate::samples::{jpeg, pattern, png};

/// No small file may keep the reader longer than this, in any build.
const PATIENCE: Duration = Duration::from_secs(5);

/// What a thread has taken: of the processor where the system tells, because others may keep it busy; else by the clock.
enum Taken {
    Processor(Duration),
    Clock(Instant),
}

impl Taken {
    fn begin() -> Self {
        ran().map_or_else(|| Self::Clock(Instant::now()), Self::Processor)
    }

    fn so_far(&self) -> Duration {
        match self {
            Self::Processor(before) => ran().unwrap_or_default().saturating_sub(*before),
            Self::Clock(begun) => begun.elapsed(),
        }
    }
}

/// How long this thread has run (Linux).
fn ran() -> Option<Duration> {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds = told.split_whitespace().next()?.parse().ok()?;
    Some(Duration::from_nanos(nanoseconds))
}

/// Reads a file in every way there is; whether it could be read as a whole.
pub(crate) fn read_all(bytes: &[u8], name: &str) -> bool {
    let begun = Instant::now();
    let could = read(bytes, name);
    // A thread runs no longer than the clock says, and to ask the system each time took longer than to read most files.
    if begun.elapsed() >= PATIENCE {
        let taken = Taken::begin();
        read(bytes, name);
        let taken = taken.so_far();
        assert!(taken < PATIENCE, "{name} took {taken:?}");
    }
    could
}

/// Whether a model or frames are in it; what can be read says nothing that is not so.
fn read(bytes: &[u8], name: &str) -> bool {
    let _ = sniff(bytes, name);
    let model = decode_model(bytes, name);
    let frames = decode_frames(bytes, name);
    let mask = decode_mask(bytes, name);
    if let Ok(file) = FrameFile::open(bytes, name) {
        let last = file.count() - 1;
        if let Ok(frame) = file.frame(last) {
            let told = Some((frame.width, frame.height));
            assert_eq!(file.size(last), told, "told before it is decoded");
        }
        assert_eq!(file.size(last + 1), None);
    }
    for error in [
        model.as_ref().err(),
        frames.as_ref().err(),
        mask.as_ref().err(),
    ]
    .into_iter()
    .flatten()
    {
        let sentence = error.to_string();
        assert!(
            sentence.ends_with('.') && !sentence.contains('\n'),
            "{sentence:?}"
        );
        assert!(sentence.chars().count() < 500, "{sentence}");
    }
    if let Ok(model) = &model {
        assert!(model.vertices.as_flattened().iter().all(|c| c.is_finite()));
        let corners = model.triangles.as_flattened();
        assert!(corners.iter().all(|&i| (i as usize) < model.vertices.len()));
    }
    for frame in frames.iter().flatten() {
        assert_eq!(
            frame.pixels.len(),
            frame.width as usize * frame.height as usize
        );
    }
    model.is_ok() || frames.is_ok()
}

#[test]
fn whole_samples_are_read() {
    for sample in SAMPLES.iter() {
        assert!(read_all(&sample.bytes, sample.name), "{}", sample.name);
    }
}

#[test]
fn cut_anywhere_is_an_error() {
    for sample in SAMPLES.iter() {
        for length in 0..sample.bytes.len() {
            for name in [sample.name, "nameless"] {
                let read = read_all(&sample.bytes[..length], name);
                let total = sample.bytes.len();
                assert!(
                    !(read && sample.has_end),
                    "{} was read from {length} of {total} bytes",
                    sample.name
                );
            }
        }
    }
}

/// How many of so many changes at a place are tried: one, another at each place, or all of them where FLUOROPOSE_EVERY_BIT says so (`cargo xtask fuzz --flips`).
pub(crate) fn tried(place: usize, of: usize) -> std::ops::Range<usize> {
    let every = std::env::var("FLUOROPOSE_EVERY_BIT").is_ok_and(|value| value == "1");
    // So that not all even places have the same.
    let one = (place + place / of) % of;
    if every { 0..of } else { one..one + 1 }
}

#[test]
fn every_change_is_tried_at_some_place() {
    for of in [4, 8] {
        let mut counts = vec![0; of];
        for place in 0..of * of {
            tried(place, of).for_each(|change| counts[change] += 1);
        }
        assert!(counts.iter().all(|&count| count >= of), "{counts:?}");
    }
}

#[test]
fn any_flipped_bit_is_survived() {
    for sample in SAMPLES.iter() {
        let mut bytes = sample.bytes.clone();
        for bit in (0..bytes.len()).flat_map(|at| tried(at, 8).map(move |bit| 8 * at + bit)) {
            bytes[bit / 8] ^= 1 << (bit % 8);
            read_all(&bytes, sample.name);
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
    }
}

/// Counts, lengths and sides.
const LIES: [[u8; 4]; 4] = [[0xFF; 4], [0; 4], [0xFF, 0xFF, 0xFF, 0x7F], [0, 0, 0, 0x80]];

#[test]
fn any_four_bytes_of_ones_or_zeros_are_survived() {
    for sample in SAMPLES.iter() {
        for start in 0..sample.bytes.len().saturating_sub(3) {
            for lie in tried(start, LIES.len()) {
                let mut bytes = sample.bytes.clone();
                bytes[start..start + 4].copy_from_slice(&LIES[lie]);
                read_all(&bytes, sample.name);
            }
        }
    }
}

#[test]
fn deep_nesting_is_refused() {
    for syntax in [IMPLICIT, EXPLICIT] {
        let mut file = Builder::new(syntax);
        for _ in 0..100_000 {
            file.header(0x0008_1115, b"SQ", u32::MAX);
            file.item(0xFFFE_E000, u32::MAX);
        }
        let error = decode_frames(&file.finish(), "deep.dcm")
            .unwrap_err()
            .to_string();
        assert!(error.contains("nested deeper"), "{error}");
    }
}

#[test]
fn a_deflated_bomb_is_refused() {
    let mut file = Builder::image(DEFLATED, 12, 9, 8, 1);
    file.bytes(0x0029_1010, b"OB", &vec![0; 600 << 20]);
    let bytes = file.octets(&pattern(12, 9));
    assert!(bytes.len() < 8 << 20);
    let error = decode_frames(&bytes, "bomb.dcm").unwrap_err().to_string();
    assert!(error.contains("beyond all bounds"), "{error}");
}

#[test]
fn small_files_that_state_huge_frames_are_refused() {
    let mut bytes = png(8, 8, ColorType::Grayscale, BitDepth::Eight, &[0; 64]);
    bytes[16..24].copy_from_slice(&[0, 0, 0x20, 0, 0, 0, 0x20, 0]);
    let crc = crc_of(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&crc.to_be_bytes());
    let error = decode_frames(&bytes, "x.png").unwrap_err().to_string();
    assert!(error.contains("too short for its stated size"), "{error}");

    let mut bytes = jpeg(8, 8, &[0; 64], false);
    let frame = bytes.windows(2).position(|w| w == [0xFF, 0xC0]).unwrap();
    bytes[frame + 5..frame + 9].copy_from_slice(&[0x20, 0, 0x20, 0]);
    let error = decode_frames(&bytes, "x.jpg").unwrap_err().to_string();
    assert!(error.contains("too short for its stated size"), "{error}");
}

/// The check sum of a PNG chunk, bit by bit.
fn crc_of(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg())
        })
    })
}

/// A change to a file: bytes overwritten, removed or repeated.
#[derive(Debug, Clone)]
enum Change {
    Overwrite(usize, Vec<u8>),
    Remove(usize, usize),
    Repeat(usize, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let place = 0..4096usize;
    prop_oneof![
        (place.clone(), prop::collection::vec(any::<u8>(), 1..9))
            .prop_map(|(at, new)| Change::Overwrite(at, new)),
        (place.clone(), 1..40usize).prop_map(|(at, length)| Change::Remove(at, length)),
        (place, 1..40usize).prop_map(|(at, length)| Change::Repeat(at, length)),
    ]
}

fn changed(mut bytes: Vec<u8>, changes: Vec<Change>) -> Vec<u8> {
    for change in changes {
        let length = bytes.len().max(1);
        match change {
            Change::Overwrite(at, new) => {
                for (place, value) in bytes.iter_mut().skip(at % length).zip(new) {
                    *place = value;
                }
            }
            Change::Remove(at, count) => {
                let start = (at % length).min(bytes.len());
                bytes.drain(start..(start + count).min(bytes.len()));
            }
            Change::Repeat(at, count) => {
                let start = (at % length).min(bytes.len());
                let copy = bytes[start..(start + count).min(bytes.len())].to_vec();
                bytes.splice(start..start, copy);
            }
        }
    }
    bytes
}

/// 4000 cases each, or as many as `PROPTEST_CASES` says.
fn config() -> ProptestConfig {
    match std::env::var_os("PROPTEST_CASES") {
        Some(_) => ProptestConfig::default(),
        None => ProptestConfig::with_cases(4000),
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn random_changes_are_survived(which in any::<prop::sample::Index>(), changes in prop::collection::vec(change(), 1..6)) {
        let sample = which.get(&SAMPLES);
        read_all(&changed(sample.bytes.clone(), changes), sample.name);
    }

    #[test]
    fn random_bytes_are_survived(which in any::<prop::sample::Index>(), keep in 0..200usize, tail in prop::collection::vec(any::<u8>(), 0..600)) {
        let sample = which.get(&SAMPLES);
        let mut bytes = sample.bytes[..keep.min(sample.bytes.len())].to_vec();
        bytes.extend(tail);
        read_all(&bytes, sample.name);
    }
}
