//! Opening a library: everything is checked once, afterwards nothing can fail.

use super::compact::{Compact, Sketches};
use super::error::{DISTANCE, LibraryError, X_ROTATIONS, Y_ROTATIONS};
use super::info::{LibraryInfo, ViewGrid, ViewRecord};
use super::runs::{bands, draw_runs, overlap};
use super::wire::{
    Body, HEADER_BYTES, HEADER_CRC_AT, MAGIC, PLAIN_VERSION, RECORD_BYTES, Reader, VERSION,
    read_grid, read_record,
};
use crate::camera::Camera;
use crate::canonical::CanonicalSpec;
use crate::checksum::checksum;
use crate::image::mask::{MaskMut, Word};

/// A library read in place.
#[derive(Clone, Copy, Debug)]
pub struct Library<'a> {
    info: LibraryInfo,
    pub(super) views: Views<'a>,
}

/// The views in either layout.
#[derive(Clone, Copy, Debug)]
pub(super) enum Views<'a> {
    /// Bits.
    Plain { records: &'a [u8], bits: &'a [u8] },
    /// Runs and sketches.
    Compact(Compact<'a>),
}

/// Bytes of the canonical bits of one view.
pub(super) fn view_bytes(canonical: &CanonicalSpec) -> usize {
    canonical.size() * canonical.size() / 8
}

/// Bytes of a whole library in the plain layout; `None` where that overflows.
pub(super) fn library_bytes(canonical: &CanonicalSpec, grid: &ViewGrid) -> Option<usize> {
    let views = grid.x.count.checked_mul(grid.y.count)?;
    views
        .checked_mul(RECORD_BYTES + view_bytes(canonical))?
        .checked_add(HEADER_BYTES)
}

impl<'a> Library<'a> {
    /// Checks `bytes` and reads them in place: all that [`Self::intact`] does, that every
    /// number is finite and possible, that runs stay in their frames and sketches are those of
    /// their runs. Takes time proportional to the length, once.
    ///
    /// # Errors
    /// [`LibraryError`] says what is wrong. A file in which any one bit was flipped is refused.
    pub fn open(bytes: &'a [u8]) -> Result<Self, LibraryError> {
        let library = Self::intact(bytes)?;
        library.check_records()?;
        if let Views::Compact(compact) = &library.views {
            compact.check(&library.info)?;
        }
        Ok(library)
    }

    /// Reads bytes in place that are as they were written: heading, length and both checksums. What these cannot tell, that what was
    /// written is possible, does not change with time: [`Self::open`] asks it where a file is made or a program is built, a
    /// device that starts again each day need not. Takes a fifth of its time.
    ///
    /// # Errors
    /// [`LibraryError`] says what is wrong. A file in which any one bit was flipped is refused.
    pub fn intact(bytes: &'a [u8]) -> Result<Self, LibraryError> {
        let (header, rest) = split_header(bytes)?;
        let (info, body) = read_header(header)?;
        let given = bytes.len() as u64;
        let length = |needed| LibraryError::Length { needed, given };
        if body.bytes != rest.len() as u64 {
            return Err(length(body.bytes.saturating_add(HEADER_BYTES as u64)));
        }
        let plain_bytes = library_bytes(&info.canonical, &info.grid)
            .ok_or(LibraryError::Value("number of views"))? as u64;
        if body.version == PLAIN_VERSION && given != plain_bytes {
            return Err(length(plain_bytes));
        }
        if checksum([rest]) != body.crc {
            return Err(LibraryError::Checksum("body"));
        }
        Self::split(rest, info, &body)
    }

    /// Reads bytes in place of which it is known that they are whole and right, as [`Self::open`] would have found.
    ///
    /// # Errors
    /// [`LibraryError`] for bytes that no library begins with, or of another length.
    pub fn trusted(bytes: &'a [u8]) -> Result<Self, LibraryError> {
        let (header, rest) = split_header(bytes)?;
        let (info, body) = read_header(header)?;
        let given = bytes.len() as u64;
        let needed = body.bytes.saturating_add(HEADER_BYTES as u64);
        if needed != given {
            return Err(LibraryError::Length { needed, given });
        }
        Self::split(rest, info, &body)
    }

    /// A library whose bytes are not looked at yet.
    fn split(rest: &'a [u8], info: LibraryInfo, body: &Body) -> Result<Self, LibraryError> {
        let views = match body.version {
            PLAIN_VERSION => Self::plain(info, rest).views,
            _ => Compact::split(rest, &info, body.blocks)
                .map(Views::Compact)
                .ok_or(LibraryError::Value("length of the body"))?,
        };
        Ok(Self { info, views })
    }

    /// A plain body that is right by construction: of the length that `info` gives.
    pub(super) fn plain(info: LibraryInfo, body: &'a [u8]) -> Self {
        let length = info.grid.views() * RECORD_BYTES;
        let (records, bits) = body.split_at_checked(length).unwrap_or((body, &[]));
        Self {
            info,
            views: Views::Plain { records, bits },
        }
    }

    /// What the library was made from.
    #[must_use]
    pub fn info(&self) -> &LibraryInfo {
        &self.info
    }

    /// Number of views.
    #[must_use]
    pub fn views(&self) -> usize {
        self.info.grid.views()
    }

    /// The record of a view; all zero beyond the last.
    #[must_use]
    pub fn record(&self, view: usize) -> ViewRecord {
        match &self.views {
            Views::Plain { records, .. } => {
                let start = view.saturating_mul(RECORD_BYTES);
                read_record(records.get(start..).unwrap_or_default())
            }
            Views::Compact(compact) if view < self.views() => {
                compact.record(view, self.info.grid.rotations(view))
            }
            Views::Compact(_) => ViewRecord::default(),
        }
    }

    /// Draws the canonical bits of a view into the words of a canonical mask
    /// ([`CanonicalSpec::words_needed`]); clears them for a view beyond the last. A slice of another
    /// length stays as it is.
    pub fn draw(&self, view: usize, out: &mut [Word]) {
        let size = self.info.canonical.size();
        if out.len() != self.info.canonical.words_needed() {
            return;
        }
        match &self.views {
            Views::Plain { .. } => {
                out.fill(0);
                for (word, &four) in out.iter_mut().zip(self.bits(view).as_chunks().0) {
                    *word = Word::from_le_bytes(four);
                }
            }
            Views::Compact(compact) => {
                if let Ok(mut mask) = MaskMut::new(out, size, size) {
                    draw_runs(compact.runs(view), &mut mask);
                }
            }
        }
    }

    /// Number of canonical pixels set in both of two views.
    #[must_use]
    pub(crate) fn overlap(&self, a: usize, b: usize) -> u32 {
        if a == b {
            return self.pixels(a);
        }
        match &self.views {
            Views::Plain { .. } => {
                let ours = words(self.bits(a)).zip(words(self.bits(b)));
                ours.map(|(a, b)| (a & b).count_ones()).sum()
            }
            Views::Compact(compact) => overlap(compact.runs(a), compact.runs(b)),
        }
    }

    /// Number of canonical pixels set in a view.
    #[must_use]
    pub fn pixels(&self, view: usize) -> u32 {
        match &self.views {
            Views::Plain { .. } => words(self.bits(view)).map(|word| word.count_ones()).sum(),
            Views::Compact(compact) => {
                let pieces = bands(compact.runs(view)).flat_map(|band| band.pieces);
                pieces.map(|&[_, pixels]| u32::from(pixels)).sum()
            }
        }
    }

    /// The canonical bits of a view of a plain library, row by row, least significant bit
    /// leftmost; empty beyond the last, and in a compact library.
    pub(crate) fn bits(&self, view: usize) -> &'a [u8] {
        let Views::Plain { bits, .. } = &self.views else {
            return &[];
        };
        let length = view_bytes(&self.info.canonical);
        let start = view.saturating_mul(length);
        bits.get(start..start.saturating_add(length))
            .unwrap_or_default()
    }

    /// Sketches, where the library is compact.
    pub(crate) fn sketches(&self) -> Option<Sketches<'a>> {
        match &self.views {
            Views::Plain { .. } => None,
            Views::Compact(compact) => Some(compact.sketches()),
        }
    }

    /// The runs of a view of a compact library; none in a plain one.
    #[inline]
    pub(crate) fn runs(&self, view: usize) -> &'a [u8] {
        match &self.views {
            Views::Plain { .. } => &[],
            Views::Compact(compact) => compact.runs(view),
        }
    }

    fn check_records(&self) -> Result<(), LibraryError> {
        for view in 0..self.views() {
            let (record, agrees) = match &self.views {
                Views::Plain { .. } => {
                    let record = self.record(view);
                    let rotations = [record.x_deg, record.y_deg];
                    (record, rotations == self.info.grid.rotations(view))
                }
                // They are the grid's.
                Views::Compact(compact) => (compact.record(view, [0.0; 2]), true),
            };
            if !agrees {
                return Err(LibraryError::Value("view rotation"));
            }
            if !is_possible(&record) {
                return Err(LibraryError::Value("view record"));
            }
        }
        Ok(())
    }
}

fn is_possible(record: &ViewRecord) -> bool {
    // A scale is positive: that of a silhouette that fills the largest frame down to one of a pixel, and more room than either takes.
    within(record.scale, 1e4)
        && !within(record.scale, 1e-4f64.next_down())
        && record.scale.is_sign_positive()
        && (0.0..=1.0).contains(&record.elongation)
        && within(record.angle, 2.0)
        && record
            .offset
            .iter()
            .all(|&value| within(value, 1e6f64.next_down()))
        && record.area > 0
}

/// Whether a number lies no further from zero than a positive one. By its bits: comparing what they mean takes a processor
/// without numbers of 64 bits several times as long.
fn within(value: f64, most: f64) -> bool {
    value.abs().to_bits() <= most.to_bits()
}

/// Little-endian words of canonical bits.
fn words(bytes: &[u8]) -> impl Iterator<Item = Word> + '_ {
    let four = bytes.as_chunks::<4>().0.iter();
    four.map(|&four| Word::from_le_bytes(four))
}

fn split_header(bytes: &[u8]) -> Result<(&[u8; HEADER_BYTES], &[u8]), LibraryError> {
    if !bytes.starts_with(&MAGIC) {
        return Err(LibraryError::Magic);
    }
    let short = LibraryError::Length {
        needed: HEADER_BYTES as u64,
        given: bytes.len() as u64,
    };
    bytes.split_first_chunk().ok_or(short)
}

fn read_header(header: &[u8; HEADER_BYTES]) -> Result<(LibraryInfo, Body), LibraryError> {
    let (checked, crc) = header.split_at(HEADER_CRC_AT);
    let reader = &mut Reader::new(checked);
    let _: [u8; MAGIC.len()] = reader.bytes();
    let version = reader.u16();
    // The version comes before the checksum: a later layout may keep it elsewhere.
    if version != PLAIN_VERSION && version != VERSION {
        return Err(LibraryError::Version(version));
    }
    if checksum([checked]) != Reader::new(crc).u32() {
        return Err(LibraryError::Checksum("header"));
    }
    if usize::from(reader.u16()) != HEADER_BYTES {
        return Err(LibraryError::Value("header length"));
    }
    let area = reader.u32();
    let canonical = CanonicalSpec::new(usize::from(reader.u16()), area)?;
    let counts = [reader.u16(), reader.u16()].map(usize::from);
    let _reserved = reader.u16();
    let grid = read_grid(reader, counts[0], counts[1]);
    let distance = reader.f64();
    let reference = [reader.f64(), reader.f64(), reader.f64()];
    let focal = reader.f64();
    let size = [reader.u32(), reader.u32()].map(|side| side as usize);
    let focals = [reader.f64(), reader.f64()];
    let centre = [reader.f64(), reader.f64()];
    let info = LibraryInfo {
        canonical,
        grid,
        distance,
        reference,
        focal,
        camera: Camera::new(size[0], size[1], focals, centre)?,
        model: reader.bytes(),
    };
    check_info(&info)?;
    let body = Body {
        version,
        bytes: reader.u64(),
        crc: reader.u32(),
        blocks: usize::from(reader.u16()),
    };
    Ok((info, body))
}

pub(super) fn check_info(info: &LibraryInfo) -> Result<(), LibraryError> {
    let axis = |axis: &super::ViewAxis, reach: f64| {
        let last = axis.at(axis.count.saturating_sub(1) as f64);
        (1..=4096).contains(&axis.count) && axis.step > 0.0 && axis.first >= -reach && last <= reach
    };
    let checks = [
        (X_ROTATIONS, axis(&info.grid.x, 89.0)),
        (Y_ROTATIONS, axis(&info.grid.y, 360.0)),
        (DISTANCE, info.distance > 0.0 && info.distance <= 1e5),
        ("focal length", info.focal >= 1.0 && info.focal <= 1e7),
        (
            "reference point",
            info.reference.iter().all(|value| value.abs() <= 1e4),
        ),
    ];
    match checks.iter().find(|(_, holds)| !holds) {
        Some((name, _)) => Err(LibraryError::Value(name)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::ViewAxis;

    fn info() -> LibraryInfo {
        LibraryInfo {
            canonical: CanonicalSpec::default(),
            grid: ViewGrid::default(),
            distance: 1000.0,
            reference: [1.0, 2.0, 3.0],
            focal: 3000.0,
            camera: Camera::new(64, 64, [500.0; 2], [32.0; 2]).expect("valid"),
            model: [0; 32],
        }
    }

    fn axis(first: f64, step: f64, count: usize) -> ViewAxis {
        ViewAxis { first, step, count }
    }

    /// Which number of a library is told to be impossible.
    fn told(change: impl FnOnce(&mut LibraryInfo)) -> Option<&'static str> {
        let mut info = info();
        change(&mut info);
        match check_info(&info) {
            Ok(()) => None,
            Err(LibraryError::Value(name)) => Some(name),
            Err(other) => panic!("{other}"),
        }
    }

    #[test]
    fn rotations_of_a_library_stay_within_their_reach() {
        for (axis, x, y) in [
            (axis(-89.0, 1.0, 179), true, true),
            (axis((-89.0f64).next_up(), 1.0, 1), true, true),
            (axis((-89.0f64).next_down(), 1.0, 1), false, true),
            (axis(-89.0, 1.0, 180), false, true),
            (axis(-360.0, 1.0, 721), false, true),
            (axis(-360.0, 1.0, 722), false, false),
            (axis((-360.0f64).next_down(), 1.0, 3), false, false),
            (axis(0.0, 0.0, 3), false, false),
            (axis(0.0, -1.0, 3), false, false),
            (axis(0.0, f64::NAN, 3), false, false),
            (axis(f64::NAN, 1.0, 3), false, false),
            (axis(0.0, 1.0, 0), false, false),
            (axis(0.0, 1.0, 1), true, true),
            (axis(0.0, 0.02, 4096), true, true),
            (axis(0.0, 0.02, 4097), false, false),
        ] {
            let possible = |possible: bool, name| (!possible).then_some(name);
            let told_x = told(|info| info.grid.x = axis);
            assert_eq!(told_x, possible(x, X_ROTATIONS), "{axis:?}");
            let told_y = told(|info| info.grid.y = axis);
            assert_eq!(told_y, possible(y, Y_ROTATIONS), "{axis:?}");
        }
    }

    #[test]
    fn lengths_of_a_library_stay_within_their_limits() {
        assert_eq!(told(|_| {}), None);
        for (distance, possible) in [
            (f64::MIN_POSITIVE, true),
            (1e5, true),
            (0.0, false),
            (1e5f64.next_up(), false),
            (f64::NAN, false),
        ] {
            let told = told(|info| info.distance = distance);
            assert_eq!(told, (!possible).then_some(DISTANCE), "{distance}");
        }
        for (focal, possible) in [
            (1.0, true),
            (1e7, true),
            (1.0f64.next_down(), false),
            (1e7f64.next_up(), false),
            (f64::NAN, false),
        ] {
            let told = told(|info| info.focal = focal);
            assert_eq!(told, (!possible).then_some("focal length"), "{focal}");
        }
        for (at, possible) in [
            (1e4, true),
            (-1e4, true),
            (1e4f64.next_up(), false),
            (-(1e4f64.next_up()), false),
            (f64::NAN, false),
        ] {
            for k in 0..3 {
                let told = told(|info| info.reference[k] = at);
                assert_eq!(told, (!possible).then_some("reference point"), "{at}");
            }
        }
    }

    #[test]
    fn records_of_views_stay_within_their_limits() {
        let usual = ViewRecord {
            scale: 1.0,
            area: 1,
            ..ViewRecord::default()
        };
        let is = |change: &dyn Fn(&mut ViewRecord)| {
            let mut record = usual;
            change(&mut record);
            is_possible(&record)
        };
        assert!(is(&|_| {}));
        assert!(!is(&|record| record.area = 0));
        let scales = [1e-4, 1e4].map(|scale| (scale, true));
        let beyond = [1e-4f64.next_down(), 1e4f64.next_up(), 0.0, -1.0, f64::NAN];
        for (scale, possible) in scales.into_iter().chain(beyond.map(|scale| (scale, false))) {
            assert_eq!(is(&|record| record.scale = scale), possible, "{scale}");
        }
        for (angle, possible) in [(2.0, true), (2.0f64.next_up(), false), (f64::NAN, false)] {
            assert_eq!(is(&|record| record.angle = angle), possible, "{angle}");
            assert_eq!(is(&|record| record.angle = -angle), possible, "-{angle}");
        }
        for (at, possible) in [(1e6f64.next_down(), true), (1e6, false), (f64::NAN, false)] {
            for k in 0..2 {
                assert_eq!(is(&|record| record.offset[k] = at), possible, "{at}");
                assert_eq!(is(&|record| record.offset[k] = -at), possible, "-{at}");
            }
        }
        for (elongation, possible) in [(0.0, true), (1.0, true), (-0.1, false), (1.1, false)] {
            let told = is(&|record| record.elongation = elongation);
            assert_eq!(told, possible, "{elongation}");
        }
        assert!(!is(&|record| record.elongation = f32::NAN));
    }
}
