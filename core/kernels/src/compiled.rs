//! The kernels compiled for kinds of machines.
#![allow(
    unsafe_code,
    reason = "a function compiled for instructions that not every machine has may be called only where they were found"
)]

use fluoropose::search::kernels::Kernels;

/// Compiles the kernels for some instructions.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
macro_rules! compile_for {
    ($module:ident, $name:literal, $features:literal) => {
        mod $module {
            use fluoropose::image::mask::Word;
            use fluoropose::search::kernels::{self, Kernels};

            #[target_feature(enable = $features)]
            fn unmatched_here(words: &[Word], bytes: &[u8]) -> u32 {
                kernels::unmatched(words, bytes)
            }

            #[target_feature(enable = $features)]
            fn distances_here(
                sketch: &[u8],
                sketches: &[u8],
                stride: usize,
                base: u32,
                out: &mut [u32],
            ) {
                kernels::distances(sketch, sketches, stride, base, out);
            }

            #[target_feature(enable = $features)]
            fn gap_here(ours: [&[u8]; 2], theirs: [&[u8]; 2]) -> u32 {
                kernels::gap(ours, theirs)
            }

            // SAFETY, of all three: they are reached through `KERNELS` alone, which `available` hands
            // out only where the instructions were found.
            fn unmatched(words: &[Word], bytes: &[u8]) -> u32 {
                unsafe { unmatched_here(words, bytes) }
            }

            fn distances(
                sketch: &[u8],
                sketches: &[u8],
                stride: usize,
                base: u32,
                out: &mut [u32],
            ) {
                unsafe { distances_here(sketch, sketches, stride, base, out) }
            }

            fn gap(ours: [&[u8]; 2], theirs: [&[u8]; 2]) -> u32 {
                unsafe { gap_here(ours, theirs) }
            }

            pub(super) const KERNELS: Kernels = Kernels {
                name: $name,
                unmatched,
                distances,
                gap,
            };
        }
    };
}

#[cfg(target_arch = "x86_64")]
compile_for!(popcnt, "popcnt", "popcnt");
#[cfg(target_arch = "x86_64")]
compile_for!(avx2, "AVX2", "avx2,popcnt,bmi1,bmi2");
#[cfg(target_arch = "x86_64")]
compile_for!(
    avx512,
    "AVX-512",
    "avx512f,avx512bw,avx512vl,avx512dq,avx2,popcnt,bmi1,bmi2"
);
#[cfg(target_arch = "x86_64")]
compile_for!(
    avx512_popcnt,
    "AVX-512 with VPOPCNTDQ",
    "avx512vpopcntdq,avx512f,avx512bw,avx512vl,avx512dq,avx2,popcnt,bmi1,bmi2"
);
#[cfg(target_arch = "aarch64")]
compile_for!(neon, "NEON", "neon");

/// All kernels that this machine can run, the slowest first.
#[cfg(target_arch = "x86_64")]
pub fn available() -> impl Iterator<Item = Kernels> {
    let popcnt = is_x86_feature_detected!("popcnt");
    let avx2 = popcnt
        && is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2");
    let avx512 = avx2
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512dq");
    let vpopcnt = avx512 && is_x86_feature_detected!("avx512vpopcntdq");
    let all = [
        (true, Kernels::PORTABLE),
        (popcnt, popcnt::KERNELS),
        (avx2, avx2::KERNELS),
        (avx512, avx512::KERNELS),
        (vpopcnt, avx512_popcnt::KERNELS),
    ];
    all.into_iter()
        .filter_map(|(found, kernels)| found.then_some(kernels))
}

/// All kernels that this machine can run, the slowest first.
#[cfg(target_arch = "aarch64")]
pub fn available() -> impl Iterator<Item = Kernels> {
    let neon = std::arch::is_aarch64_feature_detected!("neon").then_some(neon::KERNELS);
    [Kernels::PORTABLE].into_iter().chain(neon)
}

/// All kernels that a Cortex-M4 or M7 can run, the slowest first.
#[cfg(usada8)]
pub fn available() -> impl Iterator<Item = Kernels> {
    [Kernels::PORTABLE, super::usada8::KERNELS].into_iter()
}

/// All kernels that this machine can run: of a WASM module those that it was compiled for, `simd128` or not; what has
/// fewer instructions cannot be chosen while it runs.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64", usada8)))]
pub fn available() -> impl Iterator<Item = Kernels> {
    let name = if cfg!(target_feature = "simd128") {
        "simd128"
    } else {
        "portable"
    };
    [Kernels {
        name,
        ..Kernels::PORTABLE
    }]
    .into_iter()
}
