//! Sizes of memory, and how deep the stack went: it is painted first, later the paint that is left is counted.
#![expect(unsafe_code, reason = "the stack is only reachable through addresses")]

use core::ptr::{addr_of, read_volatile, write_volatile};

unsafe extern "C" {
    /// First address above the stack, from the linker script.
    static _stack_start: u32;
    /// First address of the statics.
    static __sdata: u32;
    /// First address after the statics, where the stack may grow down to.
    static __euninit: u32;
    /// First address of the code, and the first after it.
    static __stext: u32;
    static __etext: u32;
    /// First address of constants, and the first after them.
    static __srodata: u32;
    static __erodata: u32;
}

const PAINT: u32 = 0x5afe_57ac;
/// Words painted: far more than the stack is expected to take, far fewer than there is room for.
const PAINTED: usize = 32 * 1024;
/// Words below the caller's frame left alone while painting, for the frames of painting itself.
const MARGIN: usize = 256;

/// Paints the unused stack. Call it first of all.
#[inline(never)]
pub(crate) fn paint() {
    let local = 0u32;
    let here = addr_of!(local) as usize / 4 - MARGIN;
    for word in bottom()..here {
        // SAFETY: between the statics and the live stack there is nothing else.
        unsafe { write_volatile((word * 4) as *mut u32, PAINT) };
    }
}

/// The most bytes of stack that were ever used since [`paint`]; `None` where nothing is left of the paint: what was below it, statics
/// or more stack than is watched, may be overwritten.
pub(crate) fn most_used() -> Option<usize> {
    let painted = |word: &usize| {
        // SAFETY: these are words of RAM, and reading them has no effect.
        unsafe { read_volatile((word * 4) as *const u32) == PAINT }
    };
    let lowest = (bottom()..top())
        .find(|word| !painted(word))
        .unwrap_or(top());
    (lowest > bottom()).then(|| (top() - lowest) * 4)
}

/// Bytes of all statics: initialised, zeroed and uninitialised.
pub(crate) fn statics() -> usize {
    addr_of!(__euninit) as usize - addr_of!(__sdata) as usize
}

/// Bytes of code: the core's, that of the arithmetic which software does, and the proof's own.
pub(crate) fn code() -> usize {
    addr_of!(__etext) as usize - addr_of!(__stext) as usize
}

/// Bytes of constants: tables, sentences, and what was put into flash to be read there.
pub(crate) fn constants() -> usize {
    addr_of!(__erodata) as usize - addr_of!(__srodata) as usize
}

fn top() -> usize {
    addr_of!(_stack_start) as usize / 4
}

/// The lowest painted word.
fn bottom() -> usize {
    (top() - PAINTED).max(addr_of!(__euninit) as usize / 4)
}
