//! DICOM files made by hand.

mod coded;
mod groups;
mod pixels;
mod place;
mod rate;
mod refused;
mod shown;
mod shutter;
mod start;

use crate::samples::dicom::{BIG_ENDIAN, Builder, DEFLATED, EXPLICIT, IMPLICIT};

const UNCOMPRESSED: [&str; 4] = [IMPLICIT, EXPLICIT, DEFLATED, BIG_ENDIAN];

/// A sequence of items.
pub(crate) fn nested(syntax: &str, tag: u32, stated: bool, items: &[Vec<u8>]) -> Vec<u8> {
    let mut file = Builder::new(syntax);
    let length: usize = items.iter().map(|item| 8 + item.len()).sum();
    file.header(tag, b"SQ", if stated { length as u32 } else { u32::MAX });
    for item in items {
        file.item(
            0xFFFE_E000,
            if stated { item.len() as u32 } else { u32::MAX },
        );
        file.verbatim(item);
        if !stated {
            file.item(0xFFFE_E00D, 0);
        }
    }
    if !stated {
        file.item(0xFFFE_E0DD, 0);
    }
    file.into_data_set()
}

/// Elements of one builder before those of another.
fn join(mut first: Builder, second: Builder) -> Builder {
    first.verbatim(&second.into_data_set());
    first
}
