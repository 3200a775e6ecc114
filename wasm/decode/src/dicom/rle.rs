//! DICOM run-length coding (PS3.5 annex G).
//!
//! A frame is up to 15 segments in PackBits, one for each byte plane, high bytes first. The library's own reader indexes
//! past short segments and headers (a panic, which ends a WASM module), so the format is read here, with every access
//! checked.

use super::attributes::Attributes;
use super::problem::damaged;
use crate::error::Problem;

const HEADER: usize = 64;
const MAX_SEGMENTS: usize = 15;

/// Two bytes of run lengths stand for at most 128 bytes.
const MAX_EXPANSION: usize = 64;

/// Decodes one frame into interleaved little endian samples.
pub(super) fn decode_frame(coded: &[u8], attributes: &Attributes) -> Result<Vec<u8>, Problem> {
    let area = attributes.width as usize * attributes.height as usize;
    let bytes_per_sample = usize::from(attributes.bits_allocated / 8);
    decode(coded, area, attributes.samples.into(), bytes_per_sample)
}

/// `area` pixels of `samples` samples of `bytes_per_sample` bytes; the result has exactly their product.
fn decode(
    coded: &[u8],
    area: usize,
    samples: usize,
    bytes_per_sample: usize,
) -> Result<Vec<u8>, Problem> {
    let planes = samples * bytes_per_sample;
    let bounds = segment_bounds(coded, planes)?;
    if area * planes / MAX_EXPANSION > coded.len() {
        return Err(damaged(
            "a frame's run lengths are too short for its stated size",
        ));
    }
    let mut frame = vec![0; area * planes];
    for (plane, pair) in bounds.windows(2).enumerate() {
        let segment = coded.get(pair[0]..pair[1]).ok_or_else(|| {
            damaged(format!(
                "run-length segment {} lies outside its frame",
                plane + 1
            ))
        })?;
        // Segments come with a sample's high byte first, memory has it last.
        let (sample, byte) = (plane / bytes_per_sample, plane % bytes_per_sample);
        let first = sample * bytes_per_sample + bytes_per_sample - 1 - byte;
        let target = frame.iter_mut().skip(first).step_by(planes);
        if unpack(segment, target) < area {
            return Err(damaged(format!(
                "run-length segment {} ends too early",
                plane + 1
            )));
        }
    }
    Ok(frame)
}

/// Where the segments begin, and where the last ends.
fn segment_bounds(coded: &[u8], planes: usize) -> Result<Vec<usize>, Problem> {
    let header = coded
        .get(..HEADER)
        .ok_or_else(|| damaged("a run-length header is cut"))?;
    let mut words = header
        .as_chunks::<4>()
        .0
        .iter()
        .map(|w| u32::from_le_bytes(*w) as usize);
    let count = words.next().unwrap_or(0);
    if count != planes || planes > MAX_SEGMENTS {
        return Err(damaged(format!(
            "a frame has {count} run-length segments where {planes} are due"
        )));
    }
    Ok(words.take(planes).chain([coded.len()]).collect())
}

/// Unpacks until the target is full or the segment ends; gives the number of bytes written.
fn unpack<'a>(segment: &[u8], mut target: impl Iterator<Item = &'a mut u8>) -> usize {
    let (mut written, mut rest) = (0, segment);
    while let [control, tail @ ..] = rest {
        let control = isize::from(control.cast_signed());
        // From 0: this number of bytes plus one follow. Below 0: one byte follows, to be repeated. -128 does nothing.
        let (length, repeats) = match control {
            0.. => (control as usize + 1, 1),
            -127..0 => (1, (1 - control) as usize),
            _ => (0, 0),
        };
        let (run, after) = tail.split_at(tail.len().min(length));
        for value in run.iter().flat_map(|v| std::iter::repeat_n(*v, repeats)) {
            let Some(place) = target.next() else {
                return written;
            };
            *place = value;
            written += 1;
        }
        rest = after;
    }
    written
}
