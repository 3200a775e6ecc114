//! Libraries of any silhouettes, for tests.

use proptest::prelude::*;
use std::vec::Vec;

use super::pack::{pack, packed_most};
use super::wire::{Body, HEADER_BYTES, PLAIN_VERSION, RECORD_BYTES, write_header, write_record};
use super::{Assembly, Library, LibraryInfo, ViewAxis, ViewGrid, ViewRecord};
use crate::camera::Camera;
use crate::canonical::CanonicalSpec;
use crate::checksum::checksum;
use crate::image::mask::{Mask, MaskMut, Word};

/// A plain library of these canonical masks: `columns` views along x.
pub(crate) fn plain_library(views: &[Vec<Word>], columns: usize, spec: CanonicalSpec) -> Vec<u8> {
    plain_library_of(views, columns, spec, |x, y| ViewRecord {
        scale: 1.0 + (y * columns + x) as f64,
        ..ViewRecord::default()
    })
}

/// The same with records of one's own, by the place of each, but for rotations and areas.
pub(crate) fn plain_library_of(
    views: &[Vec<Word>],
    columns: usize,
    spec: CanonicalSpec,
    record: impl Fn(usize, usize) -> ViewRecord,
) -> Vec<u8> {
    let axis = |count| ViewAxis {
        first: -2.0,
        step: 1.0,
        count,
    };
    let grid = ViewGrid {
        x: axis(columns),
        y: axis(views.len() / columns),
    };
    plain_library_on(views, grid, spec, record)
}

/// The same of any grid.
pub(crate) fn plain_library_on(
    views: &[Vec<Word>],
    grid: ViewGrid,
    spec: CanonicalSpec,
    record: impl Fn(usize, usize) -> ViewRecord,
) -> Vec<u8> {
    let info = LibraryInfo {
        canonical: spec,
        grid,
        distance: 1000.0,
        reference: [0.0; 3],
        focal: 100.0,
        camera: Camera::new(640, 480, [1000.0; 2], [320.0, 240.0]).expect("possible"),
        model: [7; 32],
    };
    let mut bytes = std::vec![0; HEADER_BYTES];
    for view in 0..views.len() {
        let (x, y) = info.grid.place(view);
        let record = ViewRecord {
            x_deg: info.grid.x.at(x as f64),
            y_deg: info.grid.y.at(y as f64),
            area: 1 + view as u32,
            ..record(x, y)
        };
        let mut place = [0; RECORD_BYTES];
        write_record(&mut place, &record);
        bytes.extend(place);
    }
    bytes.extend(views.iter().flatten().flat_map(|word| word.to_le_bytes()));
    let (header, rest) = bytes.split_first_chunk_mut().expect("long enough");
    let body = Body {
        version: PLAIN_VERSION,
        blocks: 0,
        bytes: rest.len() as u64,
        crc: checksum([&*rest]),
    };
    write_header(header, &info, &body);
    bytes
}

/// The same in the compact layout; it may be larger.
pub(crate) fn compact_library(plain: &[u8]) -> Vec<u8> {
    let library = Library::open(plain).expect("valid");
    let packed = packed(&library);
    let packed: Vec<&[u8]> = packed.iter().map(Vec::as_slice).collect();
    let assembly = Assembly::new(library.info(), &packed).expect("as many as views");
    let mut bytes = std::vec![0; assembly.compact_bytes()];
    assembly.write_compact(&mut bytes).expect("fits");
    bytes
}

fn packed(library: &Library<'_>) -> Vec<Vec<u8>> {
    let spec = library.info().canonical;
    let mut words = std::vec![0; spec.words_needed()];
    let views = (0..library.views()).map(|view| {
        library.draw(view, &mut words);
        let mask = Mask::new(&words, spec.size(), spec.size()).expect("a view");
        let mut bytes = std::vec![0; packed_most(&spec)];
        let length = pack(&library.record(view), &mask, &mut bytes).expect("fits");
        bytes.truncate(length);
        bytes
    });
    views.collect()
}

/// Silhouettes of `size` x `size` pixels from a few spots of any size, some cut out again.
pub(crate) fn spots(size: usize) -> impl Strategy<Value = Vec<Word>> {
    let spot = (0..size, 0..size, 1..size, 1..64usize, any::<bool>());
    proptest::collection::vec(spot, 0..24).prop_map(move |spots| {
        let mut words = std::vec![0; size * size / 32];
        let mut mask = MaskMut::new(&mut words, size, size).expect("fits");
        for (column, row, width, height, value) in spots {
            for row in row..row + height {
                (column..column + width).for_each(|column| mask.set(column, row, value));
            }
        }
        words
    })
}

mod tests {
    use super::*;
    use crate::library::compact::Sketches;
    use crate::library::sketch::BLOCK;
    use crate::library::{BuildError, VERSION};
    use crate::search::exhaustive::score;
    use crate::search::scores_needed;

    /// Set pixels of each block of a view, by its sketch and by its pixels.
    fn said(sketches: &Sketches<'_>, view: usize) -> Vec<u8> {
        let mut counts = sketches.common.to_vec();
        for (place, &count) in sketches.places().zip(sketches.of(view)) {
            counts[place] = count;
        }
        counts
    }

    fn counted(library: &Library<'_>, view: usize) -> Vec<u8> {
        let size = library.info().canonical.size();
        let mut words = std::vec![0; size * size / 32];
        library.draw(view, &mut words);
        let mask = Mask::new(&words, size, size).expect("a view");
        let mut counts = std::vec![0u8; (size / BLOCK) * (size / BLOCK)];
        for (row, column) in (0..size).flat_map(|row| (0..size).map(move |column| (row, column))) {
            let count = &mut counts[row / BLOCK * (size / BLOCK) + column / BLOCK];
            *count = count.saturating_add(u8::from(mask.get(column, row)));
        }
        counts
    }

    fn words_of(library: &Library<'_>) -> Vec<Word> {
        std::vec![0; library.info().canonical.words_needed()]
    }

    properties! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Both layouts say the same.
        #[test]
        fn what_is_compacted_is_read_again(
            views in proptest::collection::vec(spots(64), 6),
            silhouette in spots(64)
        ) {
            let plain = plain_library(&views, 3, CanonicalSpec::new(64, 900).expect("possible"));
            let bytes = compact_library(&plain);
            let [plain, compact] = [&plain, &bytes].map(|bytes| Library::open(bytes).expect("valid"));
            prop_assert_eq!(bytes[8], VERSION as u8);
            prop_assert_eq!(plain.info(), compact.info());
            let mut scores = [[0; scores_needed(6)]; 2];
            let mut turned = silhouette.clone();
            for (library, scores) in [plain, compact].iter().zip(&mut scores) {
                let mut drawn = silhouette.clone();
                for view in 0..7 {
                    library.draw(view, &mut drawn);
                    let wanted = views.get(view).cloned().unwrap_or(std::vec![0; drawn.len()]);
                    prop_assert_eq!(&drawn, &wanted);
                    prop_assert_eq!(library.record(view), plain.record(view));
                    prop_assert_eq!(library.pixels(view), plain.pixels(view));
                    prop_assert_eq!(library.overlap(view, 2), plain.overlap(view, 2));
                }
                score(library, &silhouette, &mut turned, scores).expect("right lengths");
            }
            prop_assert_eq!(scores[0], scores[1]);
            // What matching says is what bits say.
            for (view, (bits, score)) in views.iter().zip(scores[0]).enumerate() {
                let naive: u32 = bits.iter().zip(&silhouette).map(|(a, b)| (a ^ b).count_ones()).sum();
                prop_assert_eq!(score, naive, "{}", view);
            }
        }

        /// Packed views become a library of the smaller layout, whichever that is, and it says the same.
        #[test]
        fn what_is_assembled_is_read_again(views in proptest::collection::vec(spots(64), 6)) {
            let plain = plain_library(&views, 3, CanonicalSpec::new(64, 900).expect("possible"));
            let library = Library::open(&plain).expect("valid");
            let packed = packed(&library);
            let mut packed: Vec<&[u8]> = packed.iter().map(Vec::as_slice).collect();
            let assembly = Assembly::new(library.info(), &packed).expect("as many as views");
            let mut bytes = std::vec![0; assembly.bytes_needed()];
            assembly.write(&mut words_of(&library), &mut bytes).expect("fits");
            let compact = compact_library(&plain);
            prop_assert_eq!(&bytes, if compact.len() < plain.len() { &compact } else { &plain });
            prop_assert!(assembly.write(&mut words_of(&library), &mut bytes[1..]).is_err());
            packed[4] = &packed[4][..40];
            prop_assert_eq!(Assembly::new(library.info(), &packed).err(), Some(BuildError::Packed(4)));
            prop_assert!(Assembly::new(library.info(), &packed[..5]).is_err());
        }

        /// A sketch that is not its view's would make the search miss views.
        #[test]
        fn sketches_that_lie_are_refused(
            views in proptest::collection::vec(spots(64), 4),
            at in 0usize..4096,
            change in 1u8..
        ) {
            let plain = plain_library(&views, 2, CanonicalSpec::new(64, 900).expect("possible"));
            let mut bytes = compact_library(&plain);
            let at = HEADER_BYTES + at % (bytes.len() - HEADER_BYTES);
            bytes[at] ^= change;
            let (header, body) = bytes.split_first_chunk_mut::<HEADER_BYTES>().expect("long enough");
            header[176..180].copy_from_slice(&checksum([&*body]).to_le_bytes());
            let crc = checksum([&header[..252]]).to_le_bytes();
            header[252..].copy_from_slice(&crc);
            // A change of runs may go unnoticed, because a full block counts as one with a pixel less. What the
            // sketch says still holds.
            if let Ok(opened) = Library::open(&bytes) {
                let sketches = opened.sketches().expect("compact");
                for view in 0..4 {
                    prop_assert_eq!(said(&sketches, view), counted(&opened, view));
                }
            }
        }
    }
}
