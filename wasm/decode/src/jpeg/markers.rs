//! Markers of a JPEG image, walked before a decoder sees a byte.

use crate::error::Problem;

pub(super) const FORMAT: &str = "JPEG";
pub(super) const REMEDY: &str = "Export it as an ordinary JPEG, PNG or TIFF";

/// Most scans of one image. Encoders write about ten; a file of thousands would keep the decoder busy for hours.
pub(super) const MAX_SCANS: usize = 100;

pub(super) const TABLES: u8 = 0xC4;
pub(super) const QUANTISATION: u8 = 0xDB;
pub(super) const RESTART_INTERVAL: u8 = 0xDD;
/// Starts the frame of a JPEG-LS image.
const JPEG_LS: u8 = 0xF7;
/// Parameters of a JPEG-LS image.
pub(super) const PARAMETERS: u8 = 0xF8;

pub(super) const START_OF_IMAGE: u8 = 0xD8;
pub(super) const END_OF_IMAGE: u8 = 0xD9;
pub(super) const START_OF_SCAN: u8 = 0xDA;

/// How pixels are coded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Process {
    /// Baseline or extended: cosines, one block after the other.
    Sequential,
    /// Cosines, several scans for one block.
    Progressive,
    /// Differences of neighbours in Huffman codes.
    Lossless,
    /// JPEG-LS, lossless or near-lossless.
    Ls,
    /// Hierarchical or arithmetic.
    Rare,
}

/// What the frame header of a JPEG image says.
pub(super) struct Header {
    pub(super) process: Process,
    pub(super) precision: u8,
    pub(super) width: u16,
    pub(super) height: u16,
    pub(super) components: u8,
    /// A segment or the components' names tell what three components are.
    pub(super) tells_colours: bool,
}

/// Segments of JFIF and Adobe, which tell it, what they begin with, and up to where.
const TELLING: [(u8, &[u8], usize); 2] = [(0xE0, b"JFIF", 5), (0xEE, b"Adobe", 12)];

/// Names of components that tell it: those of red, green and blue.
const TELLING_NAMES: [[u8; 3]; 2] = [*b"RGB", *b"rgb"];

/// Whether `marker` starts a frame: C0 to CF without the tables C4, C8 and CC, and that of JPEG-LS.
pub(super) fn starts_frame(marker: u8) -> bool {
    marker == JPEG_LS || (0xC0..=0xCF).contains(&marker) && !matches!(marker, 0xC4 | 0xC8 | 0xCC)
}

/// The position of the next marker's `0xFF` at or after `at`, over entropy-coded bytes: stuffed zeros and restart
/// markers belong to the scan, and in JPEG-LS, which stuffs a bit, any byte below `0x80`.
pub(super) fn end_of_scan(bytes: &[u8], mut at: usize, process: Process) -> Option<usize> {
    loop {
        at += bytes.get(at..)?.iter().position(|&b| b == 0xFF)?;
        match *bytes.get(at + 1)? {
            0x00 | 0xD0..=0xD7 => at += 2,
            0x01..0x80 if process == Process::Ls => at += 2,
            0xFF => at += 1,
            _ => return Some(at),
        }
    }
}

/// The body of the segment whose length field is at `at`.
pub(super) fn segment(bytes: &[u8], at: usize) -> Option<&[u8]> {
    let length = u16::from_be_bytes([*bytes.get(at)?, *bytes.get(at + 1)?]);
    bytes.get(at + 2..at + usize::from(length))
}

pub(super) fn frame_header(marker: u8, body: &[u8]) -> Option<Header> {
    let [precision, h1, h0, w1, w0, components, ..] = *body else {
        return None;
    };
    Some(Header {
        process: match marker {
            0xC0 | 0xC1 => Process::Sequential,
            0xC2 => Process::Progressive,
            0xC3 => Process::Lossless,
            JPEG_LS => Process::Ls,
            _ => Process::Rare,
        },
        precision,
        width: u16::from_be_bytes([w1, w0]),
        height: u16::from_be_bytes([h1, h0]),
        components,
        tells_colours: match *body {
            [_, _, _, _, _, 3, a, _, _, b, _, _, c, ..] => TELLING_NAMES.contains(&[a, b, c]),
            _ => false,
        },
    })
}

/// The number of units between restart marks; 0 for none.
pub(super) fn restart_interval(body: &[u8]) -> Result<usize, Problem> {
    match *body {
        [high, low] => Ok(u16::from_be_bytes([high, low]).into()),
        _ => Err(cut("its restart interval is not one")),
    }
}

pub(super) fn cut(what: &str) -> Problem {
    Problem::damaged(FORMAT, what)
}

/// Follows the markers from the start to the end-of-image mark.
pub(super) fn walk(bytes: &[u8]) -> Result<Header, Problem> {
    if !bytes.starts_with(&[0xFF, START_OF_IMAGE]) {
        return Err(cut("it does not begin with the JPEG mark"));
    }
    let ends = || cut("it ends before the end-of-image mark");
    let (mut at, mut header, mut scans, mut told) = (2, None::<Header>, 0, false);
    loop {
        if bytes.get(at) != Some(&0xFF) {
            return Err(bytes.get(at).map_or_else(ends, |_| {
                cut(&format!(
                    "there is no marker at byte {at} where one must be"
                ))
            }));
        }
        match *bytes.get(at + 1).ok_or_else(ends)? {
            0xFF => at += 1,
            END_OF_IMAGE => break,
            marker => {
                let body = segment(bytes, at + 2).ok_or_else(ends)?;
                at += 4 + body.len();
                told |= TELLING.iter().any(|&(known, words, length)| {
                    marker == known && body.starts_with(words) && body.len() >= length
                });
                if starts_frame(marker) {
                    if header.is_some() {
                        return Err(cut("it holds a second image inside the first"));
                    }
                    header = frame_header(marker, body);
                } else if marker == START_OF_SCAN {
                    scans += 1;
                    let process = header
                        .as_ref()
                        .map_or(Process::Rare, |header| header.process);
                    at = end_of_scan(bytes, at, process).ok_or_else(ends)?;
                }
                if scans > MAX_SCANS {
                    return Err(cut(&format!("it has more than {MAX_SCANS} scans")));
                }
            }
        }
    }
    header
        .filter(|_| scans > 0)
        .map(|header| Header {
            tells_colours: header.tells_colours || told,
            ..header
        })
        .ok_or_else(|| cut("it has no image between its marks"))
}
