//! Every single bit of a file, flipped: refused, or nothing is changed by it.

use std::ops::Range;

use fluoropose::implant::ImplantFile;
use fluoropose::library::Library;
use fluoropose_tests::fuzz::implant_file;
use fluoropose_tests::home;

use crate::made_implant::Words;

#[test]
fn every_bit_of_a_library_is_refused() {
    for version in [0, 1] {
        let path = home().join(format!("golden/version-{version}.library"));
        let mut bytes = std::fs::read(path).expect("a library");
        assert!(Library::open(&bytes).is_ok());
        for bit in 0..8 * bytes.len() {
            bytes[bit / 8] ^= 1 << (bit % 8);
            let refused = Library::open(&bytes).is_err() && Library::intact(&bytes).is_err();
            assert!(refused, "version {version}, bit {bit}");
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        println!(
            "library of version {version}: {} bits, all refused",
            8 * bytes.len()
        );
    }
}

/// A checksum tells any one bit wherever it lies, so some of every part do here; `cargo xtask fuzz --flips` takes every one.
#[test]
fn bits_of_a_firmware_image_are_refused() {
    let every = std::env::var("FLUOROPOSE_EVERY_BIT").is_ok_and(|value| value == "1");
    let image = implant_file(8.0);
    let bits = 8 * image.len();
    let step = if every { 1 } else { 1009 };
    let halves = [0..bits / 2, bits / 2..bits];
    let count: usize = std::thread::scope(|scope| {
        let image = &image;
        let half = move |bits: Range<usize>| {
            let mut words = Words::of(image);
            let flipped = bits.step_by(step).inspect(|&bit| {
                words.flip(bit);
                let bytes = words.bytes();
                let refused =
                    ImplantFile::open(bytes).is_err() && ImplantFile::intact(bytes).is_err();
                assert!(refused, "bit {bit}");
                words.flip(bit);
            });
            flipped.count()
        };
        let threads = halves.map(|bits| scope.spawn(move || half(bits)));
        threads
            .into_iter()
            .map(|thread| thread.join().expect("refused"))
            .sum()
    });
    assert_eq!(count, 2 * (bits / 2).div_ceil(step));
    println!(
        "firmware image of {} bytes: {count} bits, all refused",
        image.len()
    );
}
