//! Every kernel against counting bit by bit and byte by byte.

use super::*;
use proptest::prelude::*;

fn naive_unmatched(words: &[u32], bytes: &[u8]) -> u32 {
    let bit =
        |at: usize| words[at / 32] >> (at % 32) & 1 != u32::from(bytes[at / 8] >> (at % 8)) & 1;
    (0..8 * bytes.len()).filter(|&at| bit(at)).count() as u32
}

fn naive_gap(ours: [&[u8]; 2], theirs: [&[u8]; 2]) -> u32 {
    let between = |at: usize| {
        let ([a, b], [c, d]) = (
            ours.map(|o| i32::from(o[at])),
            theirs.map(|t| i32::from(t[at])),
        );
        (c - b).max(0) + (a - d).max(0)
    };
    (0..ours[0].len()).map(between).sum::<i32>() as u32
}

proptest! {
    #[test]
    fn every_kernel_counts_unmatched_bits(
        words in (1..40usize).prop_flat_map(|pairs| proptest::collection::vec(any::<u32>(), 2 * pairs)),
        other in proptest::collection::vec(any::<u8>(), 320)
    ) {
        let bytes = &other[..4 * words.len()];
        for kernels in available() {
            let count = (kernels.unmatched)(&words, bytes);
            prop_assert_eq!(count, naive_unmatched(&words, bytes), "{}", kernels.name);
        }
    }

    #[test]
    fn every_kernel_sums_differences(
        length in 1..200usize,
        padding in 0..40usize,
        base in 0..70_000u32,
        bytes in proptest::collection::vec(any::<u8>(), 1000)
    ) {
        let (sketch, sketches) = bytes.split_at(length);
        // Its loop runs here, its instruction in the proof on a board.
        for kernels in available().chain([usada8::KERNELS]) {
            let stride = length + padding;
            let mut out = vec![0; sketches.len() / stride];
            (kernels.distances)(sketch, sketches, stride, base, &mut out);
            for (out, other) in out.iter().zip(sketches.chunks(stride)) {
                let naive = naive_gap([sketch, sketch], [other, other]);
                prop_assert_eq!(*out, naive + base, "{}", kernels.name);
            }
        }
    }

    #[test]
    fn every_kernel_sums_gaps(
        length in 0..200usize,
        bytes in proptest::collection::vec(any::<u8>(), 800)
    ) {
        let parts: Vec<&[u8]> = bytes.chunks(200).map(|part| &part[..length]).collect();
        let pick = |one: usize, of: fn(u8, u8) -> u8| -> Vec<u8> {
            let pairs = parts[one].iter().zip(parts[one + 1]);
            pairs.map(|(&a, &b)| of(a, b)).collect()
        };
        let (a, b) = (pick(0, u8::min), pick(0, u8::max));
        let (c, d) = (pick(2, u8::min), pick(2, u8::max));
        let (a, b, c, d) = (&a[..], &b[..], &c[..], &d[..]);
        for kernels in available() {
            prop_assert_eq!(
                (kernels.gap)([a, b], [c, d]),
                naive_gap([a, b], [c, d]),
                "{}",
                kernels.name
            );
        }
    }
}

#[test]
fn the_fastest_is_one_of_them() {
    assert!(available().any(|kernels| kernels.name == fastest().name));
    assert!(available().count() > 0);
}
