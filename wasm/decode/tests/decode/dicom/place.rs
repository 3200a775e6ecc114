//! The place of a file in its series.

use fluoropose_decode::FrameFile;

use super::{UNCOMPRESSED, join};
use crate::samples::dicom::{Builder, EXPLICIT};

fn place(syntax: &str, stated: Option<&str>) -> Option<f64> {
    let mut file = Builder::new(syntax);
    if let Some(number) = stated {
        file.text(0x0020_0013, b"IS", number);
    }
    let bytes = join(file, Builder::image(syntax, 2, 1, 8, 1)).octets(&[1, 2]);
    FrameFile::open(bytes, "a.dcm").unwrap().instance_number()
}

/// However the file is written, and whatever spaces a number is padded with.
#[test]
fn a_file_states_its_place_among_those_of_its_series() {
    for syntax in UNCOMPRESSED {
        assert_eq!(place(syntax, Some("17")), Some(17.0), "{syntax}");
    }
    assert_eq!(place(EXPLICIT, Some(" 3")), Some(3.0));
    for nothing in [None, Some(""), Some("three")] {
        assert_eq!(place(EXPLICIT, nothing), None, "{nothing:?}");
    }
}
