//! Which functions an image for the board calls, counted from its bytes: panics, and doubles that software computes.

use anyhow::{Context, Result};

/// Calls in the code of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Calls {
    /// To what ends in a panic, from the core and from what it calls of the language; those from the proof's own lines, and among
    /// panics themselves, do not count.
    pub panics: usize,
    /// To arithmetic of 64-bit floating point, which a Cortex-M4F does in software.
    pub doubles: usize,
    /// Bytes of the language's functions that write numbers and words: what the core needs of no program that shows neither.
    pub writing: usize,
}

/// Counts the calls in a 32-bit little-endian ELF file of Thumb code, whose names were not stripped.
///
/// Errors where it is none.
pub(crate) fn count(elf: &[u8]) -> Result<Calls> {
    let sections = sections(elf).context("this is no 32-bit ELF file with sections")?;
    let named = |name: &str| sections.iter().find(|section| section.name == name);
    let (text, symbols, strings) = (named(".text"), named(".symtab"), named(".strtab"));
    let (text, symbols, strings) = text
        .zip(symbols)
        .zip(strings)
        .map(|((text, symbols), strings)| (text, symbols, strings))
        .context("the image has no code, or its names were stripped")?;
    let names = Names::of(symbols.bytes, strings.bytes);
    let mut calls = Calls {
        writing: names.writing,
        ..Calls::default()
    };
    let halves = text.bytes.as_chunks().0.iter();
    let halves: Vec<u16> = halves.map(|&two| u16::from_le_bytes(two)).collect();
    for (at, pair) in halves.windows(2).enumerate() {
        let address = text.address + 2 * at as u32;
        let Some(target) = target(address, [pair[0], pair[1]]) else {
            continue;
        };
        calls.panics += usize::from(names.panics.contains(&target) && names.is_core(address));
        calls.doubles += usize::from(names.doubles.contains(&target));
    }
    Ok(calls)
}

/// Bytes of code in such a file.
///
/// Errors where it is none.
pub(crate) fn code_bytes(elf: &[u8]) -> Result<usize> {
    let sections = sections(elf).context("this is no 32-bit ELF file with sections")?;
    let text = sections.iter().find(|section| section.name == ".text");
    Ok(text.context("the image has no code")?.bytes.len())
}

/// Addresses that names tell of.
#[derive(Default)]
struct Names {
    panics: Vec<u32>,
    doubles: Vec<u32>,
    writing: usize,
    /// Where each function begins, rising, and whether it is one of the core's or of what it calls.
    functions: Vec<(u32, bool)>,
}

impl Names {
    fn of(symbols: &[u8], strings: &[u8]) -> Self {
        let mut names = Self::default();
        for symbol in symbols.as_chunks::<16>().0 {
            let [word, address, size, ..] = symbol.as_chunks::<4>().0 else {
                continue;
            };
            let size = u32::from_le_bytes(*size) as usize;
            let name = strings.get(u32::from_le_bytes(*word) as usize..);
            let name = name.unwrap_or_default().split(|&byte| byte == 0).next();
            let name = String::from_utf8_lossy(name.unwrap_or_default());
            // The lowest bit says that it is Thumb code.
            let address = u32::from_le_bytes(*address) & !1;
            if symbol[12] & 0xf == FUNCTION {
                names.functions.push((address, is_core(&name)));
                names.writing += if is_writing(&name) { size } else { 0 };
            }
            if is_panic(&name) {
                names.panics.push(address);
            } else if is_double(&name) {
                names.doubles.push(address);
            }
        }
        names.functions.sort_unstable();
        names
    }

    /// Whether an address is in a function of the core.
    fn is_core(&self, address: u32) -> bool {
        let after = self
            .functions
            .partition_point(|&(first, _)| first <= address);
        after
            .checked_sub(1)
            .is_some_and(|own| self.functions[own].1)
    }
}

/// The type of symbols that are functions (System V ABI, figure 4-18).
const FUNCTION: u8 = 2;

/// Whether a mangled name is one of the core's, or of what it calls.
fn is_core(name: &str) -> bool {
    !name.contains("fluoropose_firmware") && !is_panic(name) && !is_writing(name)
}

/// Whether a mangled name is of a function that writes.
fn is_writing(name: &str) -> bool {
    !name.contains("fluoropose") && (name.contains("core3fmt") || name.contains("core..fmt"))
}

fn is_panic(name: &str) -> bool {
    [
        "panicking",
        "slice_index_fail",
        "expect_failed",
        "unwrap_failed",
        "panic_on_ord",
    ]
    .iter()
    .any(|part| name.contains(part))
}

/// Names of the run-time ABI for the Arm architecture, 4.1.2: those with a `d` for double.
fn is_double(name: &str) -> bool {
    let rest = name.strip_prefix("__aeabi_");
    rest.is_some_and(|rest| {
        rest.starts_with('d')
            || [
                "f2d", "i2d", "ui2d", "l2d", "ul2d", "cdcmpeq", "cdcmple", "cdrcmple",
            ]
            .contains(&rest)
    })
}

/// Where a long branch leads, with a link or without (Arm v7-M ARM, A7.7.12 and A7.7.18, encodings T4 and T1).
fn target(address: u32, [first, second]: [u16; 2]) -> Option<u32> {
    let is_branch = first >> 11 == 0b11110 && second >> 14 == 0b10 && second >> 12 & 1 == 1;
    let is_call = first >> 11 == 0b11110 && second >> 14 == 0b11 && second >> 12 & 1 == 1;
    if !is_branch && !is_call {
        return None;
    }
    let bit = |number: u16, place: u32| u32::from(number >> place & 1);
    let sign = bit(first, 10);
    let [i1, i2] = [13, 11].map(|place| 1 ^ bit(second, place) ^ sign);
    let high = u32::from(first & 0x3ff);
    let low = u32::from(second & 0x7ff);
    let offset = sign << 24 | i1 << 23 | i2 << 22 | high << 12 | low << 1;
    // Of 25 bits with a sign.
    let offset = (offset << 7) as i32 >> 7;
    Some(address.wrapping_add(4).wrapping_add_signed(offset))
}

struct Section<'e> {
    name: String,
    address: u32,
    bytes: &'e [u8],
}

/// The sections of an ELF file (System V ABI, chapter 4).
fn sections(elf: &[u8]) -> Option<Vec<Section<'_>>> {
    if !elf.starts_with(b"\x7fELF\x01\x01") {
        return None;
    }
    let half = |at: usize| Some(u16::from_le_bytes(*elf.get(at..)?.first_chunk()?));
    let word = |at: usize| Some(u32::from_le_bytes(*elf.get(at..)?.first_chunk()?));
    let (table, size) = (word(32)? as usize, usize::from(half(46)?));
    let (count, names) = (usize::from(half(48)?), usize::from(half(50)?));
    let header = |number: usize| table + number * size;
    let bytes = |number: usize| {
        let (at, length) = (word(header(number) + 16)?, word(header(number) + 20)?);
        // Sections of zeros are not in the file.
        let is_there = word(header(number) + 4)? != 8;
        let length = if is_there { length } else { 0 };
        elf.get(at as usize..(at + length) as usize)
    };
    let names = bytes(names)?;
    let section = |number: usize| {
        let name = names.get(word(header(number))? as usize..)?;
        let name = name.split(|&byte| byte == 0).next()?;
        Some(Section {
            name: String::from_utf8_lossy(name).into_owned(),
            address: word(header(number) + 12)?,
            bytes: bytes(number)?,
        })
    };
    (0..count).map(section).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_branches_lead_where_they_say() {
        // As an assembler wrote them: `bl`, forwards and back, and `b.w` at 0x400.
        assert_eq!(target(0x400, [0xf000, 0xf801]), Some(0x406));
        assert_eq!(target(0x400, [0xf7ff, 0xfffe]), Some(0x400));
        assert_eq!(target(0x400, [0xf000, 0xb800]), Some(0x404));
        assert_eq!(target(0x400, [0xf7ff, 0xbf00]), Some(0x204));
        assert_eq!(target(0x400, [0x4770, 0xbf00]), None);
    }

    #[test]
    fn names_tell_what_they_are() {
        assert!(is_panic("_ZN4core9panicking18panic_bounds_check17h0E"));
        assert!(!is_panic("_ZN10fluoropose4find17h0E") && is_core("_ZN10fluoropose4find17h0E"));
        assert!(!is_core("_ZN4core9panicking18panic_bounds_check17h0E"));
        assert!(!is_core("_ZN19fluoropose_firmware7finding17h0E"));
        // A part of a list that the core asks the language for may panic as well.
        assert!(is_core(
            "_ZN4core5slice29_$LT$impl$u20$$u5b$T$u5d$$GT$8split_at17h7f63E"
        ));
        assert!(
            is_writing("_ZN4core3fmt9Formatter3pad17h0E") && !is_writing("_ZN4core5slice17h0E")
        );
        assert!(is_double("__aeabi_dmul") && is_double("__aeabi_f2d"));
        assert!(!is_double("__aeabi_fmul") && !is_double("__aeabi_memcpy"));
        assert!(count(b"not an ELF file").is_err() && code_bytes(b"not an ELF file").is_err());
    }
}
