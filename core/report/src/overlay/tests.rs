use fluoropose::Side;
use fluoropose::joint::JointFrame;
use fluoropose::joint::numbers::{NUMBERS, place};
use fluoropose::joint::shared::ERRORS;

use super::*;
use crate::film::JointRow;

const FRAMES: usize = 11;
const GAP: usize = 4;

/// Flexion runs from 0 to 100; one frame has no joint, one is doubtful.
fn film() -> JointFilm {
    let row = |index: usize| {
        let mut numbers = [0.0; NUMBERS];
        numbers[place::FLEXION] = 10.0 * index as f64;
        let joint = JointFrame {
            numbers,
            deviations: None,
            shared: [[0.0; NUMBERS]; ERRORS],
        };
        let doubt = (index == 7).then(|| "a rim, perhaps".to_owned());
        JointRow::new(index + 1, (index != GAP).then_some(joint), doubt)
    };
    JointFilm {
        name: "knee".to_owned(),
        side: Side::Left,
        plate_depth_mm: 50.0,
        plate_width_mm: 70.0,
        plate_outline: Vec::new(),
        frames_per_s: Some(10.0),
        cutoff_hz: None,
        remarks: Vec::new(),
        has_verdicts: true,
        rows: (0..FRAMES).map(row).collect(),
    }
}

fn pixel(picture: &Picture, x: f64, y: f64) -> [u8; 3] {
    picture.pixels()[y as usize * picture.size()[0] + x as usize]
}

#[test]
fn frames_outlines_and_curves_are_where_they_belong() {
    let film = film();
    let overlay = Overlay::new(&film, [60, 40]);
    // Twelve times as large, so that a film can be looked at.
    let grey: Vec<u8> = (0..2400)
        .map(|k| if k % 60 < 30 { 40 } else { 200 })
        .collect();
    let square = [[10.0, 10.0], [20.0, 10.0], [20.0, 20.0], [10.0, 20.0]];
    let shown = Shown {
        grey: &grey,
        outlines: [Some(&square), None],
    };
    let picture = overlay.picture(5, &shown);
    assert_eq!(picture.size(), [720 + 268, 480]);
    assert_eq!(pixel(&picture, 60.0, 60.0), [40; 3]);
    assert_eq!(pixel(&picture, 600.0, 470.0), [200; 3]);
    for at in [
        [180.0, 120.0],
        [240.0, 180.0],
        [180.0, 240.0],
        [120.0, 180.0],
    ] {
        let found = pixel(&picture, at[0] - 0.5, at[1] - 0.5);
        let off = found
            .iter()
            .zip(COMPONENTS[0].0)
            .map(|(a, b)| a.abs_diff(b))
            .max();
        // A line of 1.8 px covers nine tenths of a pixel beside its middle.
        assert!(off < Some(25), "{found:?} at {at:?}");
    }
    assert_eq!(pixel(&picture, 180.0, 180.0), [40; 3]);
    let flexion = &overlay.curves[0];
    let dot = |index: usize| {
        [
            flexion.x.at(index as f64),
            flexion.y.at(10.0 * index as f64),
        ]
    };
    let [x, y] = dot(5);
    let only = [0xd8, 0xdb, 0xde];
    assert_eq!(pixel(&picture, x, y), only);
    // The film is elsewhere then: the line is there, and nothing but it where its values end.
    let other = overlay.picture(GAP, &shown);
    assert!(other.pixels() != picture.pixels());
    let [x, y] = dot(GAP);
    assert_ne!(pixel(&other, x, y), only, "no number, no dot");
    // A line of little more than a pixel may cover two of them in part: together they have its light.
    let [x, y] = dot(9);
    let ground = i32::from(pixel(&other, x, y - 6.0)[0]);
    assert!(ground < 60, "{ground}");
    let rows = [y - 1.0, y, y + 1.0].map(|y| i32::from(pixel(&other, x, y)[0]) - ground);
    assert!(rows.iter().sum::<i32>() > 180, "{rows:?}");
}

#[test]
fn frames_that_are_large_become_smaller_and_sides_are_even() {
    let film = film();
    let overlay = Overlay::new(&film, [1501, 2001]);
    assert_eq!(overlay.still.size(), [810 + 604, 1080]);
    let grey = vec![123; 1501 * 2001];
    let picture = overlay.picture(
        0,
        &Shown {
            grey: &grey,
            outlines: [None; 2],
        },
    );
    assert_eq!(pixel(&picture, 809.0, 1079.0), [123; 3]);
    // Too few pixels are none, and frames that the film does not have are no harm.
    let empty = overlay.picture(
        999,
        &Shown {
            grey: &[],
            outlines: [None; 2],
        },
    );
    assert_eq!(pixel(&empty, 809.0, 1079.0), GROUND.0);
}

#[test]
fn words_that_are_too_long_are_cut() {
    assert_eq!(cut("knee", 10.0), "knee");
    let short = cut("a name that is much too long for its place", 10.0);
    assert!(
        short.ends_with('\u{2026}') && short.starts_with("a name"),
        "{short}"
    );
    assert!(Font::of(false).unwrap().width(&short) <= 10.0);
    assert_eq!(cut("knee", 0.1), "");
}

#[test]
fn reasons_stand_whole_on_several_lines() {
    let reason = "doubtful: femur doubtful: jump: it lies 1.9 degrees and 1.0 mm off the way between the frames beside it; \
        tibia doubtful: mirror: the other side fits as well";
    // The width beside a frame, in the words' size.
    let wide = (BESIDE - 0.06) * 100.0 / NOTE;
    let lines = broken(reason, wide);
    assert!((2..=NOTES).contains(&lines.len()), "{lines:?}");
    assert_eq!(lines.join(" "), reason);
    let font = Font::of(false).unwrap();
    assert!(
        lines.iter().all(|line| font.width(line) <= wide),
        "{lines:?}"
    );
    assert_eq!(most(lines.clone(), NOTES), lines);
    assert_eq!(most(broken("a b c", 0.1), 2), ["a", "b\u{2026}"]);
    assert!(broken(" ", 1.0).is_empty());
}
