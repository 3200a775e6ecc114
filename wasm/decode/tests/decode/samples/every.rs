//! A file of every kind that is read, each with its name.

use std::sync::LazyLock;

use png::{BitDepth, ColorType};
use tiff::encoder::colortype::{Gray8, Gray16, Gray32Float};
use tiff::encoder::{Compression, DeflateLevel};

use super::dicom::{
    BIG_ENDIAN, Builder, DEFLATED, EXPLICIT, IMPLICIT, JPEG_BASELINE, JPEG_EXTENDED, JPEG_LOSSLESS,
    JPEG_LS, RLE, run_lengths,
};
use super::models::{obj, ply_ascii, ply_big_double, ply_little, stl_ascii, stl_binary};
use super::numpy::npy;
use super::{
    big_tiff, bmp, foreign, jpeg, jpeg_of, jpeg2000, lossless, pattern, png, predicted_tiff, tiff,
    tiffs, tiled_tiff,
};

/// A file that is read whole, and whether it says where it ends: then every shorter one must be refused.
pub(crate) struct Sample {
    pub name: &'static str,
    pub bytes: Vec<u8>,
    pub has_end: bool,
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
            .write_image::<Gray32Float>(2, 2, &[0.0, 1.5, 2.0, 3.0])
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
        sample("grey.bmp", bmp::grey(12, 9, &pixels)),
    ]
}

fn arrays() -> Vec<Sample> {
    let pixels = pattern(12, 9);
    vec![
        sample("film.npy", npy("|u1", "False", "(3, 4, 9)", &pixels)),
        sample("floats.npy", npy("<f2", "True", "(6, 9)", &pixels)),
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
    let fax_2 = include_bytes!("../../../../../tests/corpus/frames/fax-2.tif");
    let fax_3 = include_bytes!("../../../../../tests/corpus/frames/fax-3-rows-above.tif");
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

/// Of every kind that is read.
pub(crate) static SAMPLES: LazyLock<Vec<Sample>> = LazyLock::new(|| {
    images()
        .into_iter()
        .chain(arrays())
        .chain(dicoms())
        .chain(rare_dicoms())
        .chain(pages())
        .chain(models())
        .collect()
});
