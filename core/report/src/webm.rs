//! Pictures as a film that browsers and players show: WebM, of key frames of VP8.
//!
//! A lossy WebP image is such a key frame, so what writes these writes films. Every frame is coded by itself: a player goes to any of
//! them at once, and pictures are coded side by side.

use thiserror::Error;
use webp_rust::encoder::{LossyEncodingConfig, encode_lossy_rgba_to_vp8_with_config};

use crate::picture::Picture;

/// 0 to 100: of 85 a picture's grey values are off by one (mean), and its letters are sharp.
const QUALITY: f32 = 85.0;
/// 0 to 6: of 0 a frame of 1600 x 1024 is coded in a twentieth of a second, of 2 in a fifth, a third smaller.
const METHOD: u8 = 0;
/// Nanoseconds of a tick of the film's times.
const TICK_NS: u64 = 1_000_000;
const NS_PER_S: f64 = 1e9;

/// A picture is not coded.
#[derive(Debug, Error)]
#[error("a picture of {columns} x {rows} pixels cannot be coded for a film: {why}")]
pub struct CodingError {
    columns: usize,
    rows: usize,
    why: String,
}

impl Picture {
    /// As a frame of a film, a key frame of VP8.
    ///
    /// # Errors
    /// Where it has no pixels, or more than 16 383 columns or rows.
    pub fn coded(&self) -> Result<Vec<u8>, CodingError> {
        let [columns, rows] = self.size();
        let opaque = |&[red, green, blue]: &[u8; 3]| [red, green, blue, u8::MAX];
        let rgba: Vec<u8> = self.pixels().iter().flat_map(opaque).collect();
        let config = LossyEncodingConfig {
            quality: QUALITY,
            method: METHOD,
            ..LossyEncodingConfig::default()
        };
        encode_lossy_rgba_to_vp8_with_config(columns, rows, &rgba, &config).map_err(|error| {
            CodingError {
                columns,
                rows,
                why: error.to_string(),
            }
        })
    }
}

/// A film of coded pictures, all of one size (columns and rows), so many a second.
#[must_use]
pub fn webm(frames: Vec<Vec<u8>>, size: [usize; 2], frames_per_s: f64) -> Vec<u8> {
    let ms_at = |frame: usize| (frame as f64 * 1000.0 / frames_per_s).round() as u64;
    let information = information(ms_at(frames.len()));
    let track = track(size, (NS_PER_S / frames_per_s).round() as u64);
    // Where a cluster begins is told before the clusters: the list's own length does not depend on what it tells.
    let sizes: Vec<usize> = frames.iter().map(|frame| cluster_len(frame)).collect();
    let before = information.len() + track.len();
    let list = |first: usize| {
        let mut place = first;
        let places = sizes.iter().enumerate().map(|(frame, &len)| {
            let at = place;
            place += len;
            cue(ms_at(frame), at as u64)
        });
        master(id::CUES, places)
    };
    let cues = list(before + list(0).len());
    let inside = before + cues.len() + sizes.iter().sum::<usize>();
    let mut film = head();
    film.extend(heading(id::SEGMENT, inside));
    for part in [information, track, cues] {
        film.extend(part);
    }
    for (number, frame) in frames.into_iter().enumerate() {
        cluster(&mut film, ms_at(number), &frame);
    }
    film
}

fn head() -> Vec<u8> {
    let parts = [
        text(id::DOC_TYPE, "webm"),
        number(id::DOC_TYPE_VERSION, 4),
        number(id::DOC_TYPE_READ_VERSION, 2),
    ];
    master(id::EBML, parts)
}

fn information(length_ms: u64) -> Vec<u8> {
    let parts = [
        number(id::TIMESTAMP_SCALE, TICK_NS),
        element(id::DURATION, &(length_ms as f64).to_be_bytes()),
        text(id::MUXING_APP, "fluoropose"),
        text(id::WRITING_APP, "fluoropose"),
    ];
    master(id::INFO, parts)
}

/// The colours are those of WebP (ITU-R BT.601, black at 16 and white at 235), which players do not take for granted in large pictures.
fn track([columns, rows]: [usize; 2], frame_ns: u64) -> Vec<u8> {
    const BT_601: u64 = 6;
    const BT_709: u64 = 1;
    const SRGB: u64 = 13;
    const STUDIO: u64 = 1;
    let colour = [
        number(id::MATRIX, BT_601),
        number(id::RANGE, STUDIO),
        number(id::TRANSFER, SRGB),
        number(id::PRIMARIES, BT_709),
    ];
    let video = [
        number(id::PIXEL_WIDTH, columns as u64),
        number(id::PIXEL_HEIGHT, rows as u64),
        master(id::COLOUR, colour),
    ];
    let parts = [
        number(id::TRACK_NUMBER, 1),
        number(id::TRACK_UID, 1),
        number(id::TRACK_TYPE, 1),
        number(id::FLAG_LACING, 0),
        number(id::DEFAULT_DURATION, frame_ns),
        text(id::CODEC, "V_VP8"),
        master(id::VIDEO, video),
    ];
    master(id::TRACKS, [master(id::TRACK, parts)])
}

fn cue(ms: u64, place: u64) -> Vec<u8> {
    let at = [
        number(id::CUE_TRACK, 1),
        number(id::CUE_CLUSTER_POSITION, place),
    ];
    let parts = [number(id::CUE_TIME, ms), master(id::CUE_POSITIONS, at)];
    master(id::CUE, parts)
}

/// Track 1, no time after the cluster's, a key frame.
const BLOCK: [u8; 4] = [0x81, 0, 0, 0x80];

/// A frame with its time.
fn cluster(film: &mut Vec<u8>, ms: u64, frame: &[u8]) {
    let time = number(id::TIMESTAMP, ms);
    let block = heading(id::SIMPLE_BLOCK, BLOCK.len() + frame.len());
    let inside = time.len() + block.len() + BLOCK.len() + frame.len();
    film.extend(heading(id::CLUSTER, inside));
    for part in [&time, &block, &BLOCK[..], frame] {
        film.extend_from_slice(part);
    }
}

fn cluster_len(frame: &[u8]) -> usize {
    let time = number(id::TIMESTAMP, 0).len();
    let block = heading(id::SIMPLE_BLOCK, 0).len() + BLOCK.len() + frame.len();
    heading(id::CLUSTER, 0).len() + time + block
}

/// Numbers have eight bytes and lengths too, whatever they are: then no place depends on what is told there.
fn number(id: u32, value: u64) -> Vec<u8> {
    element(id, &value.to_be_bytes())
}

fn text(id: u32, value: &str) -> Vec<u8> {
    element(id, value.as_bytes())
}

fn master(id: u32, parts: impl IntoIterator<Item = Vec<u8>>) -> Vec<u8> {
    let inside: Vec<u8> = parts.into_iter().flatten().collect();
    element(id, &inside)
}

fn element(id: u32, inside: &[u8]) -> Vec<u8> {
    let mut whole = heading(id, inside.len());
    whole.extend_from_slice(inside);
    whole
}

/// An element's name, which begins at its first byte that is not zero, and its length.
fn heading(id: u32, len: usize) -> Vec<u8> {
    const EIGHT_BYTES: u64 = 1 << 56;
    let name = id.to_be_bytes();
    let unused = id.leading_zeros() as usize / 8;
    let mut heading = name[unused..].to_vec();
    heading.extend((EIGHT_BYTES | len as u64).to_be_bytes());
    heading
}

#[cfg(test)]
mod tests;

/// Names of elements (RFC 8794, RFC 9559).
mod id {
    pub(super) const EBML: u32 = 0x1a45_dfa3;
    pub(super) const DOC_TYPE: u32 = 0x4282;
    pub(super) const DOC_TYPE_VERSION: u32 = 0x4287;
    pub(super) const DOC_TYPE_READ_VERSION: u32 = 0x4285;
    pub(super) const SEGMENT: u32 = 0x1853_8067;
    pub(super) const INFO: u32 = 0x1549_a966;
    pub(super) const TIMESTAMP_SCALE: u32 = 0x002a_d7b1;
    pub(super) const DURATION: u32 = 0x4489;
    pub(super) const MUXING_APP: u32 = 0x4d80;
    pub(super) const WRITING_APP: u32 = 0x5741;
    pub(super) const TRACKS: u32 = 0x1654_ae6b;
    pub(super) const TRACK: u32 = 0xae;
    pub(super) const TRACK_NUMBER: u32 = 0xd7;
    pub(super) const TRACK_UID: u32 = 0x73c5;
    pub(super) const TRACK_TYPE: u32 = 0x83;
    pub(super) const FLAG_LACING: u32 = 0x9c;
    pub(super) const DEFAULT_DURATION: u32 = 0x0023_e383;
    pub(super) const CODEC: u32 = 0x86;
    pub(super) const VIDEO: u32 = 0xe0;
    pub(super) const PIXEL_WIDTH: u32 = 0xb0;
    pub(super) const PIXEL_HEIGHT: u32 = 0xba;
    pub(super) const COLOUR: u32 = 0x55b0;
    pub(super) const MATRIX: u32 = 0x55b1;
    pub(super) const RANGE: u32 = 0x55b9;
    pub(super) const TRANSFER: u32 = 0x55ba;
    pub(super) const PRIMARIES: u32 = 0x55bb;
    pub(super) const CUES: u32 = 0x1c53_bb6b;
    pub(super) const CUE: u32 = 0xbb;
    pub(super) const CUE_TIME: u32 = 0xb3;
    pub(super) const CUE_POSITIONS: u32 = 0xb7;
    pub(super) const CUE_TRACK: u32 = 0xf7;
    pub(super) const CUE_CLUSTER_POSITION: u32 = 0xf1;
    pub(super) const CLUSTER: u32 = 0x1f43_b675;
    pub(super) const TIMESTAMP: u32 = 0xe7;
    pub(super) const SIMPLE_BLOCK: u32 = 0xa3;
}
