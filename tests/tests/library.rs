//! A library survives the way through its bytes, and nothing damaged is taken for one.

use fluoropose::canonical::CanonicalSpec;
use fluoropose::library::{
    Builder, Grid, GridAxis, HEADER_BYTES, Library, LibraryError, ViewScratch,
};
use fluoropose::raster::Projected;
use fluoropose_tests::{camera, femur, mesh};

fn axis(count: usize) -> GridAxis {
    GridAxis {
        first: -4.0,
        step: 4.0,
        count,
    }
}

/// Six views in frames of 64 x 64.
fn small_library() -> Vec<u8> {
    let model = femur();
    let grid = Grid {
        x: axis(3),
        y: axis(2),
    };
    let canonical = CanonicalSpec::new(64, 900).expect("possible");
    let builder = Builder::new(mesh(&model), camera(), canonical, grid, 1080.0).expect("possible");
    let mut bytes = vec![0; builder.bytes_needed()];
    let mut scratch = ViewScratch {
        projected: &mut vec![Projected::default(); builder.projected_needed()],
        render: &mut vec![0; builder.render_words_needed()],
        canonical: &mut vec![0; canonical.words_needed()],
    };
    builder.build(&mut bytes, &mut scratch).expect("renders");
    bytes
}

#[test]
fn what_was_built_is_read_back() {
    let bytes = small_library();
    let library = Library::open(&bytes).expect("valid");
    let model = femur();
    assert_eq!(library.views(), 6);
    assert_eq!(library.info().model, mesh(&model).digest());
    assert_eq!(library.info().camera, camera());
    assert_eq!(library.info().distance, 1080.0);
    assert_eq!(library.info().canonical.area(), 900);
    for view in 0..6 {
        let record = library.record(view);
        let (x, y) = library.info().grid.place(view);
        assert_eq!(record.x_deg, -4.0 + 4.0 * x as f64);
        assert_eq!(record.y_deg, -4.0 + 4.0 * y as f64);
        let set: u32 = library
            .bits(view)
            .iter()
            .map(|byte| byte.count_ones())
            .sum();
        assert!((800..=950).contains(&set), "view {view} has {set} pixels");
    }
    assert!(library.bits(6).is_empty());
    assert_eq!(library.all_bits().count(), 6);
}

#[test]
fn views_rendered_in_any_order_make_the_same_file() {
    let model = femur();
    let options = xtask::pipeline::build::ViewOptions {
        x: "-4:4:4".parse().expect("a range"),
        y: "-4:0:4".parse().expect("a range"),
        area: 900,
        size: 64,
        ..Default::default()
    };
    let built = xtask::pipeline::build::build_library(mesh(&model), camera(), &options, 1080.0)
        .expect("renders");
    assert!(built.bytes == small_library());
}

#[test]
fn any_one_flipped_bit_is_noticed() {
    let mut bytes = small_library();
    for bit in 0..8 * bytes.len() {
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert!(Library::open(&bytes).is_err(), "bit {bit} went unnoticed");
        bytes[bit / 8] ^= 1 << (bit % 8);
    }
    assert!(Library::open(&bytes).is_ok());
}

#[test]
fn a_file_cut_or_padded_anywhere_is_noticed() {
    let mut bytes = small_library();
    for length in 0..bytes.len() {
        assert!(Library::open(&bytes[..length]).is_err(), "{length} bytes");
    }
    bytes.push(0);
    assert!(matches!(
        Library::open(&bytes),
        Err(LibraryError::Length { .. })
    ));
}

#[test]
fn errors_say_what_is_wrong() {
    let bytes = small_library();
    let error = |bytes: &[u8]| Library::open(bytes).err().map(|e| e.to_string());
    assert_eq!(
        error(b"solid cube").as_deref(),
        Some("this is not a library file: it does not begin with FLUOROPL")
    );
    let mut damaged = bytes.clone();
    damaged[HEADER_BYTES + 100] ^= 4;
    assert_eq!(
        error(&damaged).as_deref(),
        Some("the library's body is damaged: its checksum does not fit. Build or fetch it again")
    );
    let mut newer = bytes.clone();
    newer[8] = 7;
    assert!(error(&newer).is_some_and(|text| text.contains("version 7")));
}

/// A file with right checksums and impossible numbers, as a faulty writer would leave it.
#[test]
fn impossible_numbers_under_right_checksums_are_refused() {
    let good = small_library();
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let patched = |at: usize, value: f64| {
        let mut bytes = good.clone();
        bytes[at..at + 8].copy_from_slice(&value.to_le_bytes());
        let body = crc.checksum(&bytes[HEADER_BYTES..]).to_le_bytes();
        // The body's checksum stands behind model digest and body length.
        bytes[BODY_CRC_AT..BODY_CRC_AT + 4].copy_from_slice(&body);
        let header = crc.checksum(&bytes[..HEADER_BYTES - 4]).to_le_bytes();
        bytes[HEADER_BYTES - 4..HEADER_BYTES].copy_from_slice(&header);
        Library::open(&bytes).map(|_| ())
    };
    assert_eq!(patched(DISTANCE_AT, 1080.0), Ok(()));
    for value in [f64::NAN, f64::INFINITY, -1080.0, 0.0] {
        assert!(patched(DISTANCE_AT, value).is_err(), "distance {value}");
    }
    let scale_at = HEADER_BYTES + 16;
    for value in [f64::NAN, f64::NEG_INFINITY, 0.0] {
        assert!(patched(scale_at, value).is_err(), "scale {value}");
    }
    assert!(patched(HEADER_BYTES, 3.0).is_err(), "rotation off the grid");
}

const DISTANCE_AT: usize = 56;
const BODY_CRC_AT: usize = 176;
