use super::*;
use crate::drawing::{Drawing, WHITE};

fn drawn() -> Figure {
    let mut drawing = Drawing::default();
    let green = Colour([0, 0x75, 0x5e]);
    drawing.open("all");
    drawing.line(
        &[[0.0, 0.0], [720.0, 664.0]],
        Stroke::of(green, 1.2).dashed(&[5.0, 3.0]),
    );
    drawing.shape(
        &[[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]],
        Dress::faint(green, 0.14),
    );
    drawing.point(
        [10.0, 20.0],
        2.0,
        Dress::filled(WHITE).within(Stroke::of(green, 0.7)),
        "frame 1",
    );
    drawing.square([30.0, 40.0], 2.5, Dress::filled(green));
    drawing.words([50.0, 60.0], Anchor::End, 11.0, "\u{2212}10\u{b0} (x)");
    drawing.bold([70.0, 80.0], 15.0, "\u{3c9}");
    drawing.upwards([90.0, 100.0], 12.0, "up");
    drawing.close();
    drawing.finish([720.0, 664.0], 180.0, "Knee \u{3c9}".to_owned())
}

#[test]
fn a_page_has_the_size_in_print_and_its_letters_stay_letters() {
    let pdf = drawn().pdf();
    assert!(pdf.starts_with(b"%PDF-1."));
    let text: String = pdf.iter().map(|&byte| char::from(byte)).collect();
    // 180 mm are 510.24 points.
    assert!(text.contains("/MediaBox [0 0 510.23"), "{text}");
    for part in [
        "/Helvetica\n",
        "/Helvetica-Bold\n",
        "[5 3] 0 d",
        "/Opacity14 gs",
        "/CA 0.14",
        "/Title",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    // The code page's dash for a minus sign, 1, 0, the degree, a space, (x); then a letter that is not there.
    assert!(text.contains("<963130B020287829> Tj"), "{text}");
    assert!(text.contains("(?)"));
    assert!(!text.contains("frame 1"));
}

#[test]
fn words_end_at_their_place() {
    // Minus, two digits, degree, space, brackets, x: widths of Helvetica.
    let wide = width_of("\u{2212}10\u{b0} (x)");
    assert!((wide - (3.0 * 0.556 + 0.4 + 0.278 + 2.0 * 0.333 + 0.5)).abs() < 1e-12);
    let text: String = drawn().pdf().iter().map(|&byte| char::from(byte)).collect();
    let x = 50.0 - 11.0 * wide;
    assert!(
        text.contains(&format!("1 0 0 -1 {:.3}", x)[..12]),
        "{x} in {text}"
    );
}
