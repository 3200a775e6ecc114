use super::*;
use crate::drawing::{BLACK, Drawing};

const GREEN: Colour = Colour([0, 0x75, 0x5e]);
/// Units across and down, and pixels of a unit.
const SIZE: usize = 40;
const SCALE: f64 = 8.0;

fn drawn(draw: impl FnOnce(&mut Drawing)) -> Picture {
    let mut drawing = Drawing::default();
    draw(&mut drawing);
    let side = SIZE * SCALE as usize;
    let mut picture = Picture::plain([side, side], WHITE);
    picture.draw(&drawing.marks, SCALE);
    picture
}

/// How much of the picture is covered, in square units, and the middle of it.
fn covered(picture: &Picture) -> (f64, [f64; 2]) {
    let (mut sum, mut middle) = (0.0, [0.0; 2]);
    for (at, pixel) in picture.pixels.iter().enumerate() {
        let part = 1.0 - f64::from(pixel[0]) / 255.0;
        let place = [at % picture.size[0], at / picture.size[0]];
        sum += part;
        (0..2).for_each(|k| middle[k] += part * (place[k] as f64 + 0.5));
    }
    (sum / SCALE / SCALE, middle.map(|x| x / sum / SCALE))
}

fn near(found: f64, wanted: f64, by: f64) {
    assert!((found - wanted).abs() < by, "{found}, not {wanted}");
}

#[test]
fn shapes_cover_their_area_at_their_place() {
    let triangle = [[10.0, 10.0], [30.0, 10.0], [10.0, 25.0]];
    let (area, middle) = covered(&drawn(|d| d.shape(&triangle, Dress::filled(BLACK))));
    // Black is a grey of 0x11.
    near(area / (1.0 - 17.0 / 255.0), 150.0, 0.5);
    near(middle[0], 50.0 / 3.0, 0.02);
    near(middle[1], 15.0, 0.02);
    let point = drawn(|d| d.point([20.3, 12.1], 5.0, Dress::filled(GREEN), ""));
    let (area, middle) = covered(&point);
    near(area, 25.0 * std::f64::consts::PI, 0.3);
    near(middle[0], 20.3, 0.02);
    near(middle[1], 12.1, 0.02);
    let square = drawn(|d| d.square([7.0, 9.0], 2.5, Dress::filled(GREEN)));
    near(covered(&square).0, 25.0, 0.05);
}

#[test]
fn lines_have_their_width_dashes_and_opacity() {
    let ends = [[5.0, 20.0], [35.0, 20.0]];
    let whole = Stroke::of(GREEN, 2.0);
    let of = |stroke: Stroke| covered(&drawn(|d| d.line(&ends, stroke))).0;
    near(of(whole), 60.0, 0.1);
    near(of(whole.dashed(&[5.0, 5.0])), 30.0, 0.1);
    near(of(whole.fainter(0.5)), 30.0, 0.3);
    let ring = Dress::filled(WHITE).within(Stroke::of(GREEN, 1.0));
    let (area, _) = covered(&drawn(|d| d.point([20.0, 20.0], 8.0, ring, "")));
    // A border's edges are chords: a hundredth of its width is less than any printer shows.
    near(area, 16.0 * std::f64::consts::PI, 0.6);
}

#[test]
fn words_stand_where_a_page_of_paper_has_them() {
    let of = |anchor, text: &str| covered(&drawn(|d| d.words([20.0, 20.0], anchor, 10.0, text)));
    let ((start, _), (middle, at), (_, end)) = (
        of(Anchor::Start, "\u{2212}1\u{b0}"),
        of(Anchor::Middle, "HH"),
        of(Anchor::End, "\u{2212}1\u{b0}"),
    );
    assert!(start > 3.0 && middle > 20.0, "{start} {middle}");
    // An H is as wide to either side, and 0.69 of the size high.
    near(at[0], 20.0, 0.1);
    near(at[1], 20.0 - 3.45, 0.3);
    assert!(end[0] < 20.0, "{end:?}");
    // What runs upwards lies to the left of its place.
    let (same, [x, y]) = covered(&drawn(|d| d.upwards([20.0, 20.0], 10.0, "HH")));
    near(same, middle, 0.2);
    near(x, 20.0 - 3.45, 0.3);
    near(y, 20.0, 0.1);
}

/// Oracle: the widths that PDF takes, from the metrics of Helvetica as they were published.
#[test]
fn letters_are_as_wide_as_those_of_pdf() {
    let text = "Tibial rotation (\u{b0}, internal +) \u{2212}0.5 \u{b1} 12 mm; AP 68 %";
    for bold in [false, true] {
        assert!(Font::of(bold).is_some());
    }
    let font = Font::of(false).unwrap();
    near(
        font.width(text),
        crate::pdf::width_of(text),
        0.02 * text.len() as f64 / 10.0,
    );
    // Letters that are not there are question marks; letters of names in Europe are there.
    near(font.width("\u{4e2d}"), font.width("?"), 1e-9);
    for letter in "\u{e9}\u{159}\u{142}\u{3c9}\u{df}".chars() {
        assert!(
            font.outlines(&letter.to_string()) != font.outlines("?"),
            "{letter}"
        );
    }
}

#[test]
fn what_lies_beside_the_picture_or_nowhere_is_not_drawn() {
    let far = [[-1e9, 20.0], [1e9, 20.0]];
    let stroke = Stroke::of(GREEN, 2.0);
    near(covered(&drawn(|d| d.line(&far, stroke))).0, 80.0, 0.5);
    let beside = drawn(|d| {
        d.line(&[[f64::NAN, 1.0], [f64::INFINITY, 2.0]], stroke);
        d.point([f64::NAN, 3.0], 2.0, Dress::filled(GREEN), "");
        d.point([400.0, 3.0], 2.0, Dress::filled(GREEN), "");
        d.words([-500.0, 3.0], Anchor::Start, 10.0, "H");
        d.words([3.0, 3.0], Anchor::Start, f64::NAN, "H");
    });
    assert!(beside.pixels.iter().all(|&pixel| pixel == [255; 3]));
    // Half of it lies within.
    let half = drawn(|d| d.point([0.0, 20.0], 5.0, Dress::filled(GREEN), ""));
    near(covered(&half).0, 12.5 * std::f64::consts::PI, 0.3);
}

#[test]
fn a_png_has_the_size_in_print() {
    let mut drawing = Drawing::default();
    drawing.shape(&[[0.0, 0.0], [10.0, 0.0], [0.0, 5.0]], Dress::filled(GREEN));
    let figure = drawing.finish([20.0, 10.0], 25.4, "one inch".to_owned());
    let png = figure.png();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&png))
        .read_info()
        .unwrap();
    let info = reader.info();
    assert_eq!((info.width, info.height), (600, 300));
    let dots = info.pixel_dims.unwrap();
    assert_eq!((dots.xppu, dots.unit), (23622, Unit::Meter));
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    assert_eq!(&pixels[..3], &GREEN.0);
    assert_eq!(&pixels[pixels.len() - 3..], &WHITE.0);
}
