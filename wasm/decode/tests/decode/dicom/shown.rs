//! What a file says of how its greys are shown.

use fluoropose_decode::Window;

use super::nested;
use crate::samples::dicom::{Builder, EXPLICIT};
use crate::samples::{bytes_of, only_frame, words_of};

fn with_window(mut file: Builder, centre: &str, width: &str) -> Builder {
    file.text(0x0028_1050, b"DS", centre);
    file.text(0x0028_1051, b"DS", width);
    file
}

/// What a pixel value is shown as, 0 black to 1 white, by the sentence of `Window`.
fn shown(window: Window, value: f64) -> f64 {
    ((value - window.centre) / window.width + 0.5).clamp(0.0, 1.0)
}

/// What PS3.3 C.11.2.1.2.1 shows of a rescaled value.
fn standard(centre: f64, width: f64, value: f64) -> f64 {
    ((value - (centre - 0.5)) / (width - 1.0) + 0.5).clamp(0.0, 1.0)
}

/// Checks the window of a file against the standard's formula for every given stored value.
fn check_window(file: Builder, pixels: &[u16], rescaled: impl Fn(u16) -> f64, dark: bool) {
    let frame = only_frame(&with_window(file, "100", "81").words(pixels), "a.dcm");
    let window = frame.window.unwrap();
    for (&stored, &value) in pixels.iter().zip(words_of(&frame)) {
        let due = standard(100.0, 81.0, rescaled(stored));
        let due = if dark { 1.0 - due } else { due };
        let got = shown(window, value.into());
        assert!(
            (got - due).abs() < 1e-12,
            "stored {stored}: {got} for {due}"
        );
    }
}

#[test]
fn the_window_is_in_units_of_the_pixels() {
    let stored = [0, 59, 60, 75, 99, 100, 101, 125, 140, 141, 4095];
    let image = |photometric, signed| {
        Builder::image_with(EXPLICIT, 11, 1, 1, photometric, [16, 12, 11, signed])
    };
    check_window(image("MONOCHROME2", 0), &stored, f64::from, false);
    check_window(image("MONOCHROME1", 0), &stored, f64::from, true);
    // As 12-bit two's complement, 4095 is -1.
    let signed = |v: u16| {
        if v >= 2048 {
            f64::from(v) - 4096.0
        } else {
            f64::from(v)
        }
    };
    check_window(image("MONOCHROME2", 1), &stored, signed, false);
    check_window(image("MONOCHROME1", 1), &stored, signed, true);
    for (slope, intercept) in [(2.0, -20.0), (0.25, 80.0), (-0.5, 150.0)] {
        let mut file = image("MONOCHROME2", 0);
        file.text(0x0028_1052, b"DS", &intercept.to_string());
        file.text(0x0028_1053, b"DS", &slope.to_string());
        // The window's elements come after these; readers do not depend on the order.
        check_window(file, &stored, |v| slope * f64::from(v) + intercept, false);
    }
}

#[test]
fn an_exact_linear_window_is_taken_as_it_is() {
    let mut file = Builder::image(EXPLICIT, 2, 1, 8, 1);
    file.text(0x0028_1050, b"DS", "100\\50");
    file.text(0x0028_1051, b"DS", "80\\20");
    file.text(0x0028_1056, b"CS", "LINEAR_EXACT");
    let frame = only_frame(&file.octets(&[1, 2]), "a.dcm");
    assert_eq!(
        frame.window,
        Some(Window {
            centre: 100.0,
            width: 80.0
        })
    );
}

/// Some programs leave further values empty.
#[test]
fn of_several_windows_the_first_counts_alone() {
    let file = with_window(Builder::image(EXPLICIT, 2, 1, 8, 1), "100.5\\", "81\\ ");
    let window = only_frame(&file.octets(&[1, 2]), "a.dcm").window;
    let (centre, width) = (100.0, 80.0);
    assert_eq!(window, Some(Window { centre, width }));
}

#[test]
fn a_window_of_no_width_is_none() {
    for (centre, width) in [("100", "0"), ("100", "-5"), ("nonsense", "10"), ("", "")] {
        let file = with_window(Builder::image(EXPLICIT, 2, 1, 8, 1), centre, width);
        assert_eq!(
            only_frame(&file.octets(&[1, 2]), "a.dcm").window,
            None,
            "{centre} {width}"
        );
    }
}

#[test]
fn monochrome_1_is_inverted_within_its_bits() {
    let file = Builder::image_with(EXPLICIT, 3, 1, 1, "MONOCHROME1", [16, 10, 9, 0]);
    let frame = only_frame(&file.words(&[0, 1, 1023]), "a.dcm");
    assert_eq!(words_of(&frame), [1023, 1022, 0]);
    assert_eq!(frame.notes.len(), 1);
}

/// What stands between stored and meaningful values is told, and its polarity followed.
#[test]
fn a_table_of_meaningful_values_is_told_and_leaves_no_window() {
    for (entries, shown) in [([1u16, 9], [3, 200]), ([9, 1], [252, 55])] {
        let mut table = Builder::new(EXPLICIT);
        table.bytes(
            0x0028_3006,
            b"US",
            entries.map(u16::to_le_bytes).as_flattened(),
        );
        let mut file = with_window(Builder::image(EXPLICIT, 2, 1, 8, 1), "100", "81");
        file.verbatim(&nested(
            EXPLICIT,
            0x0028_3000,
            true,
            &[table.into_data_set()],
        ));
        let frame = only_frame(&file.octets(&[3, 200]), "a.dcm");
        assert_eq!(bytes_of(&frame), shown);
        assert_eq!(frame.window, None);
        assert!(
            frame.notes.iter().any(|note| note.contains("modality LUT")),
            "{:?}",
            frame.notes
        );
    }
}

#[test]
fn the_window_of_narrowed_greys_is_in_their_units() {
    let file = Builder::image_with(EXPLICIT, 2, 1, 1, "MONOCHROME2", [32, 32, 31, 0]);
    let mut file = with_window(file, "32000", "6400");
    file.text(0x0028_1056, b"CS", "LINEAR_EXACT");
    let frame = only_frame(&file.long_words(&[0, 1 << 20]), "a.dcm");
    assert_eq!(
        frame.window,
        Some(Window {
            centre: 1000.0,
            width: 200.0
        })
    );
}
