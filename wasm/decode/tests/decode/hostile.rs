//! Cut, flipped and random files: an error in words or a decoded file, never a panic, never more memory or time than
//! the file's length justifies.

use std::sync::LazyLock;
use std::time::{Duration, Instant};

use fluoropose_decode::{FrameFile, decode_frames, decode_mask, decode_model, sniff};
use png::{BitDepth, ColorType};
use proptest::prelude::*;
use tiff::encoder::colortype::{Gray8, Gray16, Gray32Float};
use tiff::encoder::{Compression, DeflateLevel};

use crate::samples::dicom::{
    BIG_ENDIAN, Builder, DEFLATED, EXPLICIT, IMPLICIT, JPEG_BASELINE, JPEG_EXTENDED, JPEG_LOSSLESS,
    JPEG_LS, RLE, run_lengths,
};
use crate::samples::models::{obj, ply_ascii, ply_big_double, ply_little, stl_ascii, stl_binary};
use crate::samples::{
    big_tiff, foreign, jpeg, jpeg_of, jpeg2000, lossless, pattern, png, predicted_tiff, tiff,
    tiffs, tiled_tiff,
};

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

/// A file that is read whole, and whether it says where it ends: then every shorter one must be refused.
pub(crate) struct Sample {
    pub name: &'static str,
    pub bytes: Vec<u8>,
    has_end: bool,
}

fn sample(name: &'static str, bytes: Vec<u8>) -> Sample {
    Sample {
        name,
        bytes,
        has_end: true,
    }
}

fn images() -> Vec<Sample> {
    let pixels = pattern(12, 9);
    let words: Vec<u16> = pixels.iter().map(|&p| u16::from(p) * 16).collect();
    let octets: Vec<u8> = words.iter().flat_map(|w| w.to_be_bytes()).collect();
    let two_pages = |compression| {
        tiff(compression, |encoder| {
            encoder.write_image::<Gray8>(12, 9, &pixels).unwrap();
            encoder.write_image::<Gray16>(12, 9, &words).unwrap();
        })
    };
    let float = tiff(Compression::Lzw, |encoder| {
        encoder
            .write_image::<Gray32Float>(2, 2, &[0.0, 1.0, 2.0, 3.0])
            .unwrap();
    });
    let predicted = predicted_tiff(|encoder| encoder.write_image::<Gray8>(12, 9, &pixels).unwrap());
    vec![
        sample(
            "grey.png",
            png(12, 9, ColorType::Grayscale, BitDepth::Eight, &pixels),
        ),
        sample(
            "deep.png",
            png(12, 9, ColorType::Grayscale, BitDepth::Sixteen, &octets),
        ),
        sample(
            "colour.png",
            png(12, 3, ColorType::Rgb, BitDepth::Eight, &pixels),
        ),
        sample("baseline.jpg", jpeg(12, 9, &pixels, false)),
        sample("progressive.jpg", jpeg(12, 9, &pixels, true)),
        sample(
            "colour.jpg",
            jpeg_of(6, 6, &pixels, jpeg_encoder::ColorType::Rgb, false),
        ),
        sample("lossless.jpg", lossless::jpeg(12, 9, 12, &words)),
        sample(
            "restart.jpg",
            lossless::coded(
                12,
                9,
                &[&words],
                lossless::Coding {
                    precision: 12,
                    predictor: 6,
                    shift: 1,
                    restart_rows: 4,
                },
            ),
        ),
        sample("grey.j2k", jpeg2000::bytes(jpeg2000::TWELVE)),
        sample("colour.j2k", jpeg2000::bytes(jpeg2000::COLOUR)),
        sample("lossy.j2k", jpeg2000::bytes(jpeg2000::LOSSY)),
        sample("grey.jp2", jpeg2000::bytes(jpeg2000::JP2)),
        sample("plain.tif", two_pages(Compression::Uncompressed)),
        sample("lzw.tif", two_pages(Compression::Lzw)),
        sample(
            "deflate.tif",
            two_pages(Compression::Deflate(DeflateLevel::Fast)),
        ),
        sample("packbits.tif", two_pages(Compression::Packbits)),
        sample("float.tif", float),
        sample("predicted.tif", predicted),
        sample(
            "tiled.tif",
            tiled_tiff(11, 7, &std::array::from_fn(|i| i as u8)),
        ),
        sample("big.tif", big_tiff(12, 9, &pixels)),
    ]
}

fn dicoms() -> Vec<Sample> {
    let pixels = pattern(12, 9);
    let words: Vec<u16> = pixels.iter().map(|&p| u16::from(p) * 16).collect();
    let mut window = Builder::image(EXPLICIT, 12, 9, 16, 1);
    window.text(0x0028_1050, b"DS", "100");
    window.text(0x0028_1051, b"DS", "80");
    window.text(0x0028_1053, b"DS", "2.5");
    let mut nested = Builder::new(IMPLICIT);
    nested.header(0x0008_1115, b"SQ", u32::MAX);
    nested.item(0xFFFE_E000, u32::MAX);
    nested.text(0x0020_000E, b"UI", "1.2.3");
    nested.item(0xFFFE_E00D, 0);
    nested.item(0xFFFE_E0DD, 0);
    nested.verbatim(&Builder::image(IMPLICIT, 12, 9, 8, 1).into_data_set());
    let high: Vec<u8> = words.iter().map(|w| (w >> 8) as u8).collect();
    let low: Vec<u8> = words.iter().map(|w| *w as u8).collect();
    let run = run_lengths(&[high, low]);
    let (baseline, exact) = (
        jpeg(12, 9, &pixels, false),
        lossless::jpeg(12, 9, 12, &words),
    );
    let deep = Builder::image_with(JPEG_LOSSLESS, 12, 9, 1, "MONOCHROME1", [16, 12, 11, 0]);
    vec![
        sample("window.dcm", window.words(&words)),
        sample("nested.dcm", nested.octets(&pixels)),
        sample(
            "big.dcm",
            Builder::image(BIG_ENDIAN, 12, 9, 16, 1).words(&words),
        ),
        sample(
            "deflated.dcm",
            Builder::image(DEFLATED, 12, 9, 8, 1).octets(&pixels),
        ),
        sample(
            "rle.dcm",
            Builder::image(RLE, 12, 9, 16, 2).fragments(&[], &[&run, &run]),
        ),
        sample(
            "baseline.dcm",
            Builder::image(JPEG_BASELINE, 12, 9, 8, 1).fragments(&[0], &[&baseline]),
        ),
        sample("lossless.dcm", deep.fragments(&[], &[&exact])),
    ]
}

/// Pages by hand: palettes, planes, fax codes, JPEG.
fn pages() -> Vec<Sample> {
    let mut palette = tiffs::fields(4, 1, &[2], 3);
    palette.push((320, 3, (0..12).collect()));
    let mut planes = tiffs::fields(2, 2, &[16, 16, 16], 2);
    planes.push((284, 3, vec![2]));
    let mut fax = tiffs::fields(foreign::GREY.0.into(), foreign::GREY.1.into(), &[1], 1);
    fax[3].2 = vec![4];
    let mut coded = tiffs::fields(12, 9, &[8], 1);
    coded[3].2 = vec![7];
    let image = jpeg(12, 9, &pattern(12, 9), false);
    let wide = tiffs::fields(1, 2, &[32], 1);
    let fax_2 = include_bytes!("../../../../tests/corpus/frames/fax-2.tif");
    let fax_3 = include_bytes!("../../../../tests/corpus/frames/fax-3-rows-above.tif");
    vec![
        sample("palette.tif", tiffs::of_strips(&palette, &[&[0x1B]])),
        sample(
            "planes.tif",
            tiffs::of_strips(&planes, &[&[1; 8], &[2; 8], &[3; 8]]),
        ),
        sample("fax.tif", tiffs::of_strips(&fax, &[foreign::FAX])),
        sample("fax-2.tif", fax_2.to_vec()),
        sample("fax-3.tif", fax_3.to_vec()),
        sample("jpeg.tif", tiffs::of_strips(&coded, &[&image])),
        sample("wide.tif", tiffs::of_strips(&wide, &[&[7; 8]])),
    ]
}

/// Images that other programs coded, and kinds of pixels beyond plain greys.
fn rare_dicoms() -> Vec<Sample> {
    let grey = |syntax, bits: [u16; 4], image: &[u8]| {
        let (width, height) = foreign::GREY;
        let file = Builder::image_with(syntax, width, height, 1, "MONOCHROME2", bits);
        file.fragments(&[], &[image])
    };
    let mut shutter = Builder::new(EXPLICIT);
    shutter.text(0x0018_1600, b"CS", "CIRCULAR\\POLYGONAL");
    shutter.text(0x0018_1610, b"IS", "1\\2");
    shutter.text(0x0018_1612, b"IS", "2");
    shutter.text(0x0018_1620, b"IS", "1\\1\\1\\4\\3\\2");
    shutter.verbatim(&Builder::image(EXPLICIT, 4, 3, 8, 1).into_data_set());
    let (width, height) = foreign::COLOUR;
    let colour = |image: &[u8]| {
        let file = Builder::image_with(JPEG_LS, width, height, 1, "RGB", [8, 8, 7, 0]);
        file.fragments(&[], &[image])
    };
    let mut palette = Builder::image_with(IMPLICIT, 2, 2, 1, "PALETTE COLOR", [8, 8, 7, 0]);
    for colour in 0..3 {
        palette.bytes(0x0028_1101 + colour, b"US", &[2, 0, 0, 0, 16, 0]);
    }
    for colour in 0..3 {
        palette.bytes(0x0028_1201 + colour, b"OW", &[1, 2, 3, 4]);
    }
    let mut bare = Builder::image(EXPLICIT, 2, 2, 32, 1);
    bare.bytes(0x7FE0_0010, b"OW", &[7; 16]);
    vec![
        sample("ls.dcm", grey(JPEG_LS, [8, 8, 7, 0], foreign::LS_8_NEAR_3)),
        sample("ls-colour.dcm", colour(foreign::LS_COLOUR_SAMPLES)),
        sample(
            "extended.dcm",
            grey(JPEG_EXTENDED, [16, 12, 11, 0], foreign::COSINES_12),
        ),
        sample("palette.dcm", palette.octets(&[0, 1, 1, 0])),
        sample(
            "bits.dcm",
            Builder::image_with(EXPLICIT, 5, 3, 2, "MONOCHROME2", [1, 1, 0, 0]).octets(&[7; 4]),
        ),
        sample("bare.dcm", bare.into_data_set()),
        sample("shutter.dcm", shutter.octets(&[7; 12])),
    ]
}

fn models() -> Vec<Sample> {
    let endless = |name, bytes| Sample {
        name,
        bytes,
        has_end: false,
    };
    vec![
        sample("binary.stl", stl_binary("made by hand")),
        sample("solid.stl", stl_binary("solid facet")),
        sample(
            "ascii.stl",
            stl_ascii()
                .replace("endsolid tetrahedron", "endsolid")
                .into_bytes(),
        ),
        endless("text.obj", obj().into_bytes()),
        endless("ascii.ply", ply_ascii().into_bytes()),
        sample("little.ply", ply_little()),
        sample("big.ply", ply_big_double()),
    ]
}

pub(crate) static SAMPLES: LazyLock<Vec<Sample>> = LazyLock::new(|| {
    images()
        .into_iter()
        .chain(dicoms())
        .chain(rare_dicoms())
        .chain(pages())
        .chain(models())
        .collect()
});

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

#[test]
fn any_flipped_bit_is_survived() {
    for sample in SAMPLES.iter() {
        let mut bytes = sample.bytes.clone();
        for bit in 0..8 * bytes.len() {
            bytes[bit / 8] ^= 1 << (bit % 8);
            read_all(&bytes, sample.name);
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
    }
}

#[test]
fn any_four_bytes_of_ones_or_zeros_are_survived() {
    for sample in SAMPLES.iter() {
        for start in 0..sample.bytes.len().saturating_sub(3) {
            for lie in [[0xFF; 4], [0; 4], [0xFF, 0xFF, 0xFF, 0x7F], [0, 0, 0, 0x80]] {
                let mut bytes = sample.bytes.clone();
                bytes[start..start + 4].copy_from_slice(&lie);
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
