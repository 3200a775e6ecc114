//! Memory and work by a file's size, counted and not timed: what is allocated at once, and all that is allocated.

use allocation_counter::{AllocationInfo, measure};
use fluoropose_decode::{FrameFile, decode_model};
use tiff::encoder::Compression;
use tiff::encoder::colortype::Gray8;

use crate::hostile::{read_all, tried};
use crate::samples::dicom::{Builder, EXPLICIT, JPEG_2000, RLE, run_lengths};
use crate::samples::every::SAMPLES;
use crate::samples::{foreign, jpeg2000, pattern, png, tiff};

/// Bytes that may be held at once whatever a file's size, and for each of its bytes: any coding but JPEG 2000 makes at most
/// some thousand of one.
const AT_ONCE: u64 = 1 << 20;
const AT_ONCE_PER_BYTE: u64 = 8192;

/// The same of JPEG 2000, whose codestreams of some hundred bytes may be blank frames of 1024 x 1024 pixels.
const AT_ONCE_OF_BLANK: u64 = 64 << 20;

/// Numbers that a small file lies with: counts, lengths and sides far above what it holds.
const LIES: [&[u8]; 8] = [
    &[0xFF; 4],
    &[0xFF, 0xFF, 0xFF, 0x7F],
    &[0, 0, 0x20, 0],
    &[0, 0x20, 0, 0],
    &[0x20, 0],
    &[0, 0x20],
    &[0xFF],
    &[0],
];

#[test]
fn small_files_take_little_memory_whatever_they_state() {
    for sample in SAMPLES.iter() {
        let most = match sample.name.ends_with(".j2k") || sample.name.ends_with(".jp2") {
            true => AT_ONCE_OF_BLANK,
            false => AT_ONCE + AT_ONCE_PER_BYTE * sample.bytes.len() as u64,
        };
        for at in 0..sample.bytes.len() {
            for lie in tried(at, LIES.len()).map(|lie| LIES[lie]) {
                let mut bytes = sample.bytes.clone();
                let end = bytes.len().min(at + lie.len());
                bytes[at..end].copy_from_slice(&lie[..end - at]);
                let held = measure(|| _ = read_all(&bytes, sample.name)).bytes_max;
                assert!(
                    held <= most,
                    "{} with {lie:?} at {at}: {held} bytes",
                    sample.name
                );
            }
        }
    }
}

/// What is known of blocks of coefficients is kept for each layer, of which a header may state 65 535.
#[test]
fn an_image_that_states_more_than_it_can_hold_is_refused_before_the_library_reads_it() {
    // Sides; layers, levels and sizes of blocks, as the coding style has them.
    let stating = |side: u16, style: [u8; 5]| {
        let mut image = jpeg2000::bytes(jpeg2000::EIGHT);
        for at in [10, 14, 26, 30] {
            image[at..at + 2].copy_from_slice(&side.to_be_bytes());
        }
        let at = image
            .windows(2)
            .position(|pair| pair == [0xFF, 0x52])
            .unwrap();
        image[at + 6..at + 8].copy_from_slice(&style[..2]);
        image[at + 9..at + 12].copy_from_slice(&style[2..]);
        let pixels = Builder::image(JPEG_2000, side, side, 8, 1);
        pixels.fragments(&[], &[&image])
    };
    let refusal = |file: Vec<u8>| {
        let mut said = String::new();
        let held = measure(|| {
            let frame = FrameFile::open(file.as_slice(), "a.dcm").unwrap().frame(0);
            said = frame.unwrap_err().to_string();
        });
        assert!(held.bytes_max < 10_000, "{} bytes: {said}", held.bytes_max);
        said
    };
    let many_layers = refusal(stating(1000, [0xFF, 0xFF, 0, 4, 4]));
    assert!(
        many_layers.contains("more packets than it has bytes"),
        "{many_layers}"
    );
    let small_blocks = refusal(stating(1000, [0, 20, 0, 0, 0]));
    assert!(
        small_blocks.contains("more layers of blocks"),
        "{small_blocks}"
    );
    let large = refusal(stating(8000, [0, 1, 0, 4, 4]));
    assert!(large.contains("too short for its stated size"), "{large}");
    let many_levels = refusal(stating(1000, [0, 1, 200, 4, 4]));
    assert!(many_levels.contains("200 levels"), "{many_levels}");
}

/// All that is allocated while a file of frames is opened and each frame decoded.
fn all_frames(bytes: &[u8]) -> AllocationInfo {
    measure(|| {
        let file = FrameFile::open(bytes, "a").unwrap();
        for index in 0..file.count() {
            file.frame(index).unwrap();
        }
    })
}

fn model(bytes: &[u8]) -> AllocationInfo {
    measure(|| drop(decode_model(bytes, "a").unwrap()))
}

/// Checks that a file four times as large takes four times as much, and what growing lists leave over.
fn check_growth(
    what: &str,
    work: impl Fn(&[u8]) -> AllocationInfo,
    make: impl Fn(usize) -> Vec<u8>,
) {
    let (small, large) = (make(256), make(1024));
    assert!(
        large.len() < 5 * small.len(),
        "{what}: the files themselves grow otherwise"
    );
    let (small, large) = (work(&small), work(&large));
    for (of, small, large) in [
        ("allocations", small.count_total, large.count_total),
        ("bytes", small.bytes_total, large.bytes_total),
        ("bytes at once", small.bytes_max, large.bytes_max),
    ] {
        assert!(
            large <= 5 * small + 4096,
            "{what}: {of} grow from {small} to {large}"
        );
    }
}

#[test]
fn films_take_what_their_length_takes() {
    let pages = |compression| {
        move |count: usize| {
            tiff(compression, |encoder| {
                for _ in 0..count {
                    encoder.write_image::<Gray8>(6, 4, &pattern(6, 4)).unwrap();
                }
            })
        }
    };
    check_growth("pages", all_frames, pages(Compression::Uncompressed));
    check_growth("LZW pages", all_frames, pages(Compression::Lzw));
    check_growth("frames", all_frames, |count| {
        Builder::image(EXPLICIT, 4, 2, 16, count).words(&vec![7; 8 * count])
    });
    check_growth("frames of 32 bits", all_frames, |count| {
        Builder::image(EXPLICIT, 4, 2, 32, count).long_words(&vec![1 << 20; 8 * count])
    });
    check_growth("run lengths", all_frames, |count| {
        let frame = run_lengths(&[pattern(6, 4)]);
        Builder::image(RLE, 6, 4, 8, count).fragments(&[], &vec![&frame[..]; count])
    });
    check_growth("fragments", all_frames, |count| {
        let (width, height) = foreign::GREY;
        let file = Builder::image(crate::samples::dicom::JPEG_LS, width, height, 8, count);
        let (head, tail) = foreign::LS_8.split_at(foreign::LS_8.len() / 2 * 2 - 2);
        file.fragments(&[], &[head, tail].repeat(count))
    });
    check_growth("functional groups", all_frames, |count| {
        let mut file = Builder::image(EXPLICIT, 4, 2, 8, count);
        let mut window = Builder::new(EXPLICIT);
        window.text(0x0028_1050, b"DS", "100");
        window.text(0x0028_1051, b"DS", "80");
        let group = crate::dicom::nested(EXPLICIT, 0x0028_9132, false, &[window.into_data_set()]);
        file.verbatim(&crate::dicom::nested(
            EXPLICIT,
            0x5200_9230,
            false,
            &vec![group; count],
        ));
        file.octets(&vec![1; 8 * count])
    });
}

#[test]
fn pictures_take_what_their_size_takes() {
    check_growth("PNG rows", all_frames, |rows| {
        let (grey, eight) = (png::ColorType::Grayscale, png::BitDepth::Eight);
        // Numbers that do not pack.
        let noise = (0..64 * rows as u32).map(|i| (i.wrapping_mul(2_654_435_769) >> 24) as u8);
        png(64, rows as u32, grey, eight, &noise.collect::<Vec<_>>())
    });
    check_growth("PNG texts", all_frames, |count| {
        let grey = png::ColorType::Grayscale;
        crate::samples::png_with(8, 8, grey, png::BitDepth::Eight, &[7; 64], |encoder| {
            for _ in 0..count {
                encoder
                    .add_text_chunk("Comment".into(), "a word".into())
                    .unwrap();
            }
        })
    });
}

/// A strip of triangles whose corners are shared.
fn corners(count: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..count).map(|i| [i, i + 1, i + 2])
}

fn place(i: usize) -> [f32; 3] {
    [i as f32, (i % 2) as f32, (i * i % 7) as f32]
}

#[test]
fn models_take_what_their_size_takes() {
    let lines =
        |count: usize, line: &dyn Fn(usize) -> String| -> String { (0..count).map(line).collect() };
    let vertex = |i: usize| {
        let [x, y, z] = place(i);
        format!("{x} {y} {z}")
    };
    check_growth("OBJ", model, |count| {
        let vertices = lines(count + 2, &|i| format!("v {}\n", vertex(i)));
        let faces = corners(count).map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
        (vertices + &faces.collect::<String>()).into_bytes()
    });
    check_growth("an OBJ face of many corners", model, |count| {
        let face: String = (1..=count + 2).map(|corner| format!(" {corner}")).collect();
        (lines(count + 2, &|i| format!("v {}\n", vertex(i))) + "f" + &face + "\n").into_bytes()
    });
    check_growth("PLY", model, |count| {
        let head = format!(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
             element face {count}\nproperty list uchar int vertex_indices\nend_header\n",
            count + 2
        );
        let faces = corners(count).map(|[a, b, c]| format!("3 {a} {b} {c}\n"));
        (head + &lines(count + 2, &|i| vertex(i) + "\n") + &faces.collect::<String>()).into_bytes()
    });
    check_growth("ASCII STL", model, |count| {
        let facet = |[a, b, c]: [usize; 3]| {
            let corner = |i| format!("vertex {}\n", vertex(i));
            format!(
                "facet normal 0 0 1\nouter loop\n{}{}{}endloop\nendfacet\n",
                corner(a),
                corner(b),
                corner(c)
            )
        };
        let facets: String = corners(count).map(facet).collect();
        format!("solid a\n{facets}endsolid a\n").into_bytes()
    });
    check_growth("many small ASCII STL solids", model, |count| {
        let solid = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
        solid.repeat(count).into_bytes()
    });
}
