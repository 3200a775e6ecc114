//! Where a data set begins and how it is written: by the group of elements that says so, or by what the content proves.

use super::element::{Element, REPRESENTATIONS, UNDEFINED};
use super::problem::damaged;
use super::syntax::Syntax;
use crate::error::Problem;

/// Length of the preamble before `DICM`. It may hold the header of another format, TIFF as a rule.
const PREAMBLE: usize = 128;
const MARK: &[u8; 4] = b"DICM";

/// Groups that a data set without preamble begins with: identification, patient, acquisition, image.
const FIRST_GROUPS: [u16; 5] = [0x0002, 0x0008, 0x0010, 0x0018, 0x0028];

/// Elements in a row that prove a syntax.
const PROOF: usize = 4;

/// Bytes of an element before its value, at most.
const LONGEST_HEADER: usize = 12;

/// Where the data set begins and how it is written.
pub(super) struct Start {
    pub at: usize,
    pub syntax: Syntax,
}

/// Whether the beginning of a file of `length` bytes is that of a DICOM file.
pub(crate) fn is_dicom(head: &[u8], length: usize) -> bool {
    is_marked(head)
        || syntaxes()
            .iter()
            .any(|syntax| is_proven(head, 0, length, syntax))
}

fn is_marked(bytes: &[u8]) -> bool {
    bytes.get(PREAMBLE..PREAMBLE + MARK.len()) == Some(MARK)
}

/// The ways in which elements are written: implicit, explicit, big endian.
fn syntaxes() -> [Syntax; 3] {
    [Syntax::IMPLICIT, Syntax::EXPLICIT, Syntax::BIG_ENDIAN]
}

/// Reads the group of elements (always explicit little endian) that names the transfer syntax, where it is there.
pub(super) fn of(bytes: &[u8]) -> Result<Start, Problem> {
    let begin = if is_marked(bytes) {
        PREAMBLE + MARK.len()
    } else {
        0
    };
    let walker = Syntax::EXPLICIT.walker(bytes);
    let (mut at, mut stated) = (begin, None);
    while at < bytes.len() && walker.u16(at)? == 0x0002 {
        let element = walker.element(at)?;
        let value = element.range(bytes)?;
        at = value.end;
        if element.tag == 0x0002_0010 {
            let text = String::from_utf8_lossy(&bytes[value]);
            let padding = |c: char| c == '\0' || c.is_whitespace();
            stated = Some(text.trim_matches(padding).to_owned());
        }
    }
    let proven = |syntax: &Syntax| is_proven(bytes, at, bytes.len(), syntax);
    let Some(stated) = stated.filter(|uid| !uid.is_empty()) else {
        let syntax = syntaxes().into_iter().find(proven);
        let syntax = syntax.ok_or_else(|| damaged(unknown(bytes)))?;
        return Ok(Start {
            at,
            syntax: syntax.of_unknown_pixels(),
        });
    };
    let syntax = Syntax::of(&stated)?;
    // Some programs write the elements of compressed images without representations, against the standard.
    let implicit =
        syntax.explicit && !syntax.deflated && !proven(&syntax) && proven(&Syntax::IMPLICIT);
    Ok(Start {
        at,
        syntax: if implicit {
            Syntax {
                explicit: false,
                ..syntax
            }
        } else {
            syntax
        },
    })
}

/// What is said of a file that neither names nor shows its syntax.
fn unknown(bytes: &[u8]) -> &'static str {
    match is_marked(bytes) {
        true => "it names no transfer syntax, and its content shows none",
        false => "the mark DICM is missing at byte 128, and its content is no data set",
    }
}

/// Whether elements in this syntax follow each other from `at`, of which `bytes` may be the beginning alone.
fn is_proven(bytes: &[u8], at: usize, length: usize, syntax: &Syntax) -> bool {
    let walker = syntax.walker(bytes);
    let (mut at, mut last) = (at, None);
    for count in 0..PROOF {
        // A data set may be shorter than the proof, if it ends where an element does.
        if count > 0 && at == length {
            return true;
        }
        // The rest lies beyond what was read of the file.
        let Ok(element) = walker.element(at) else {
            return count > 0 && bytes.len() < length && at + LONGEST_HEADER > bytes.len();
        };
        let group = (element.tag >> 16) as u16;
        let begins = last.is_some() || FIRST_GROUPS.contains(&group);
        let rises = last.is_none_or(|last| element.tag > last);
        if !begins || !rises || !is_plausible(&element, syntax) {
            return false;
        }
        // What has no stated length ends the proof: a sequence, or the pixels.
        if element.length == UNDEFINED {
            return count > 0;
        }
        let value = usize::try_from(element.length).unwrap_or(usize::MAX);
        let Some(end) = element
            .value
            .checked_add(value)
            .filter(|&end| end <= length)
        else {
            return false;
        };
        (at, last) = (end, Some(element.tag));
    }
    true
}

fn is_plausible(element: &Element, syntax: &Syntax) -> bool {
    // Lengths are even, but some programs forget it in text.
    let known = |representation: [u8; 2]| REPRESENTATIONS.contains(&&representation);
    element.representation.map_or(!syntax.explicit, known)
}
