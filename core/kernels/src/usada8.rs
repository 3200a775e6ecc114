//! Bounds on a Cortex-M4 or M7: one instruction adds the differences of four bytes.
#![allow(
    unsafe_code,
    reason = "the instruction has no safe name; it reads and writes the registers that it is given, and nothing else"
)]

#[cfg(usada8)]
use core::arch::asm;

use fluoropose::search::kernels::Kernels;

pub(crate) const KERNELS: Kernels = Kernels {
    name: "USADA8",
    distances,
    ..Kernels::PORTABLE
};

/// As [`fluoropose::search::kernels::distances`], four bytes at a time.
fn distances(sketch: &[u8], sketches: &[u8], stride: usize, base: u32, out: &mut [u32]) {
    let (ours, rest) = sketch.as_chunks::<4>();
    for (out, other) in out.iter_mut().zip(sketches.chunks_exact(stride.max(1))) {
        let mut sum = base;
        let (theirs, _) = other.as_chunks::<4>();
        for (&a, &b) in ours.iter().zip(theirs) {
            sum = add_differences(sum, a, b);
        }
        let behind = other.get(4 * ours.len()..).unwrap_or_default();
        for (a, b) in rest.iter().zip(behind) {
            sum += u32::from(a.abs_diff(*b));
        }
        *out = sum;
    }
}

/// A sum and the differences of four bytes each.
#[cfg(usada8)]
#[inline(always)]
fn add_differences(sum: u32, a: [u8; 4], b: [u8; 4]) -> u32 {
    let (a, b) = (u32::from_ne_bytes(a), u32::from_ne_bytes(b));
    let added: u32;
    // SAFETY: `build.rs` lets this be compiled for processors alone that have the instruction; it touches no memory.
    unsafe {
        asm!(
            "usada8 {added}, {a}, {b}, {sum}",
            added = lateout(reg) added,
            a = in(reg) a,
            b = in(reg) b,
            sum = in(reg) sum,
            options(pure, nomem, nostack, preserves_flags)
        );
    }
    added
}

/// What the instruction does, for tests of the loop around it elsewhere.
#[cfg(not(usada8))]
fn add_differences(sum: u32, a: [u8; 4], b: [u8; 4]) -> u32 {
    let pairs = a.iter().zip(&b);
    sum + pairs.map(|(a, b)| u32::from(a.abs_diff(*b))).sum::<u32>()
}
