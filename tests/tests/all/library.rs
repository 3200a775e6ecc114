//! A library survives the way through its bytes, and nothing damaged is taken for one.

use fluoropose::canonical::CanonicalSpec;
use fluoropose::library::{
    Builder, HEADER_BYTES, Library, LibraryError, ViewAxis, ViewGrid, ViewScratch,
};
use fluoropose::render::Projected;
use fluoropose_tests::{camera, femur, home, mesh, regenerating};
use sha2::{Digest as _, Sha256};

fn axis(count: usize) -> ViewAxis {
    ViewAxis {
        first: -4.0,
        step: 4.0,
        count,
    }
}

/// Six views in frames of 64 x 64, in the plain layout and in the compact one.
fn libraries() -> [Vec<u8>; 2] {
    let model = femur();
    let grid = ViewGrid {
        x: axis(3),
        y: axis(2),
    };
    let canonical = CanonicalSpec::new(64, 900).expect("possible");
    let builder = Builder::new(mesh(&model), camera(), canonical, grid, 1080.0).expect("possible");
    let mut plain = vec![0; builder.bytes_needed()];
    let mut scratch = ViewScratch {
        projected: &mut vec![Projected::default(); builder.projected_needed()],
        render: &mut vec![0; builder.render_words_needed()],
        canonical: &mut vec![0; canonical.words_needed()],
    };
    builder.build(&mut plain, &mut scratch).expect("renders");
    // In any order.
    let mut packed = [(); 6].map(|()| vec![0; builder.packed_most()]);
    for view in [3, 0, 5, 1, 4, 2] {
        let out = &mut packed[view];
        let length = builder.pack_view(view, &mut scratch, out).expect("fits");
        out.truncate(length);
    }
    let packed = packed.each_ref().map(Vec::as_slice);
    let assembly = builder.assemble(&packed).expect("all are there");
    let mut compact = vec![0; assembly.bytes_needed()];
    assembly
        .write(scratch.canonical, &mut compact)
        .expect("fits");
    [plain, compact]
}

fn plain_library() -> Vec<u8> {
    let [plain, _] = libraries();
    plain
}

fn small_library() -> Vec<u8> {
    let [_, compact] = libraries();
    compact
}

/// SHA-256 of the file of each version.
const OLD_FILES: [&str; 2] = [
    "1ec7a4c5629063e324009ae28f723628e716012a672a587e346b56018cb4d5f1",
    "8d0c7e8e4ea97b46a302e7613a4b66d59cb34c675c6db2b6010982e0fcaf5ef5",
];
/// That of what opening gives, which is the same in both: [`contents`].
const OLD_CONTENTS: &str = "1851cf434fa7d3b3f4ec20f978abfb9320795044b8c5de31232ab99c3bd03d21";

fn sha256(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Every number and every pixel of all views, as bytes.
fn contents(library: &Library<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut pixels = vec![0; 128];
    for view in 0..library.views() {
        let record = library.record(view);
        let [right, up] = record.offset;
        let numbers = [
            record.x_deg,
            record.y_deg,
            record.scale,
            record.angle,
            right,
            up,
        ];
        bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        bytes.extend(record.area.to_le_bytes());
        bytes.extend(record.elongation.to_le_bytes());
        library.draw(view, &mut pixels);
        bytes.extend(pixels.iter().flat_map(|word| word.to_le_bytes()));
    }
    bytes
}

/// The files of all versions of the layout that ever were are read for ever, and say the same.
#[test]
fn old_files_are_read() {
    let files = libraries();
    let opened: Vec<Vec<u8>> = files
        .iter()
        .enumerate()
        .map(|(version, bytes)| {
            let file = home().join(format!("golden/version-{version}.library"));
            // A file is written when its version is new, and never again.
            if regenerating() && !file.exists() {
                std::fs::write(&file, bytes).expect("the file can be written");
            }
            std::fs::read(&file).expect("there is one of each version")
        })
        .collect();
    let [plain, compact] = [0, 1].map(|version| Library::open(&opened[version]).expect("valid"));
    assert_eq!([opened[0][8], opened[1][8]], [0, 1]);
    assert_eq!([0, 1].map(|version| sha256(&opened[version])), OLD_FILES);
    for library in [&plain, &compact] {
        assert_eq!(sha256(&contents(library)), OLD_CONTENTS);
    }
    assert_eq!(plain.info(), compact.info());
    let mut bits = [vec![0; 128], vec![0; 128]];
    for view in 0..6 {
        assert_eq!(plain.record(view), compact.record(view));
        plain.draw(view, &mut bits[0]);
        compact.draw(view, &mut bits[1]);
        assert_eq!(bits[0], bits[1]);
        assert!((800..=950).contains(&compact.pixels(view)));
    }
}

#[test]
fn what_was_built_is_read_back() {
    let bytes = small_library();
    let library = Library::open(&bytes).expect("valid");
    let model = femur();
    assert_eq!(library.views(), 6);
    assert_eq!(library.info().model, mesh(&model).digest());
    // A file records the projection, and no detector.
    let recorded = |camera: fluoropose::camera::Camera| {
        let size = (camera.width(), camera.height());
        (size, camera.focal(), camera.principal_point())
    };
    assert_eq!(recorded(library.info().camera), recorded(camera()));
    assert_eq!(library.info().distance, 1080.0);
    assert_eq!(library.info().canonical.area(), 900);
    for view in 0..6 {
        let record = library.record(view);
        let (x, y) = library.info().grid.place(view);
        assert_eq!(record.x_deg, -4.0 + 4.0 * x as f64);
        assert_eq!(record.y_deg, -4.0 + 4.0 * y as f64);
        let set = library.pixels(view);
        assert!((800..=950).contains(&set), "view {view} has {set} pixels");
    }
    assert_eq!(library.pixels(6), 0);
}

#[test]
fn views_rendered_in_any_order_make_the_same_file() {
    let model = femur();
    let options = fluoropose_laboratory::finding::ViewOptions {
        x: Some("-4:4:4".parse().expect("a range")),
        y: Some("-4:0:4".parse().expect("a range")),
        area: Some(900),
        size: Some(64),
        ..Default::default()
    };
    let built =
        fluoropose_laboratory::finding::build_library(mesh(&model), camera(), &options, 1080.0)
            .expect("renders");
    assert!(built.bytes == small_library());
}

#[test]
fn any_one_flipped_bit_is_noticed() {
    for mut bytes in libraries() {
        for bit in 0..8 * bytes.len() {
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert!(Library::open(&bytes).is_err(), "bit {bit} went unnoticed");
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        assert!(Library::open(&bytes).is_ok());
    }
}

#[test]
fn a_file_cut_or_padded_anywhere_is_noticed() {
    for mut bytes in libraries() {
        for length in 0..bytes.len() {
            assert!(Library::open(&bytes[..length]).is_err(), "{length} bytes");
        }
        bytes.push(0);
        assert!(matches!(
            Library::open(&bytes),
            Err(LibraryError::Length { .. })
        ));
    }
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
    let good = plain_library();
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
    assert_eq!(patched(scale_at, 0.5), Ok(()));
    for value in [
        f64::NAN,
        f64::NEG_INFINITY,
        0.0,
        5e-324,
        1e-9,
        1e9,
        f64::MAX,
    ] {
        assert!(patched(scale_at, value).is_err(), "scale {value}");
    }
    assert!(patched(HEADER_BYTES, 3.0).is_err(), "rotation off the grid");
}

const DISTANCE_AT: usize = 56;
const BODY_CRC_AT: usize = 176;
