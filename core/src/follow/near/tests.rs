use super::*;
use crate::image::frame::Frame;
use proptest::prelude::*;
use std::vec::Vec as Many;
#[cfg(feature = "alloc")]
use {
    crate::camera::Camera, crate::finder::fake, crate::math::subtract, crate::pose::geodesic_deg,
    crate::refine::RefineBuffers,
};

const SIDE: usize = 160;
const MIDDLE: f64 = 80.0;
/// Half of the sides of a plate that is hardly thicker than a step.
const HALF: [f64; 2] = [40.0, 5.0];

/// A dark plate about a place, turned counter-clockwise on the screen.
fn plate([right, down]: [f64; 2], turn_deg: f64) -> Many<u8> {
    let (sin, cos) = sin_cos(radians(turn_deg));
    let grey = |k: usize| {
        let x = (k % SIDE) as f64 + 0.5 - MIDDLE - right;
        let y = (k / SIDE) as f64 + 0.5 - MIDDLE - down;
        let (along, across) = (x * cos - y * sin, x * sin + y * cos);
        let is_metal = along.abs() < HALF[0] && across.abs() < HALF[1];
        if is_metal { 40 } else { 200 }
    };
    (0..SIDE * SIDE).map(grey).collect()
}

fn outline() -> Outline {
    let mut samples = Vec::new();
    for k in 0..40 {
        let at = 2.0 * f64::from(k) - HALF[0] + 1.0;
        for side in [-1.0, 1.0] {
            let _ = samples.push([at, side * HALF[1], 0.0, side]);
        }
    }
    for k in 0..5 {
        let at = 2.0 * f64::from(k) - HALF[1] + 1.0;
        for side in [-1.0, 1.0] {
            let _ = samples.push([side * HALF[0], at, side, 0.0]);
        }
    }
    Outline {
        samples,
        middle: [MIDDLE; 2],
        aspect: 1.0,
    }
}

/// How far a sample on a long side lies across from that side of the plate, pixels.
fn across_from_plate(sample: &[f64; 4], settled: &Place, shift: [f64; 2], turn_deg: f64) -> f64 {
    let place = [0, 1].map(|k| sample[k] + settled.shift[k] - shift[k]);
    let (sin, cos) = sin_cos(radians(turn_deg));
    let (across, side) = (place[0] * sin + place[1] * cos, sample[3]);
    (across.abs() - HALF[1])
        .abs()
        .max(if across * side < 0.0 { HALF[1] } else { 0.0 })
}

properties! {
    #[test]
    fn a_place_within_a_step_of_a_plate_settles_on_its_edges(
        shift in proptest::array::uniform2(-3.0..3.0f64), turn_deg in -1.5..1.5f64,
    ) {
        let pixels = plate(shift, turn_deg);
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
        let image = ImageTarget::dark(&frame);
        let outline = outline();
        let sliding = Sliding { outline: &outline, image: &image, step: 160.0 };
        let start = Place { score: f64::MIN, out: [0.0; 2], turn_deg: 0.0, shift: [0.0; 2] };
        let settled = sliding.settled(start);
        prop_assert!(settled.score > 0.9, "{settled:?}");
        // Readings lie four pixels to each side: nearer than that no place is better than another.
        let turned = outline.turned(radians(settled.turn_deg));
        for sample in turned.iter().take(80) {
            let px = across_from_plate(sample, &settled, shift, turn_deg);
            prop_assert!(px < HALF_PX + 0.5, "{px} px: {settled:?}");
        }
    }

    /// The naive way is to ask every sample.
    #[test]
    fn what_is_given_up_early_would_not_have_been_more(
        plate_at in proptest::array::uniform2(-30.0..30.0f64), plate_deg in -40.0..40.0f64,
        shift in proptest::array::uniform2(-70.0..70.0f64), turn_deg in -40.0..40.0f64, least in -0.3..1.1f64,
    ) {
        let pixels = plate(plate_at, plate_deg);
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
        let image = ImageTarget::dark(&frame);
        let outline = outline();
        let sliding = Sliding { outline: &outline, image: &image, step: 160.0 };
        let turned = outline.turned(radians(turn_deg));
        let [naive, early] = [f64::MIN, least].map(|least| sliding.score_above(least, &turned, shift));
        match early {
            Some(_) => prop_assert_eq!(early, naive),
            None => prop_assert!(naive.is_none_or(|naive| naive <= least + 1e-9), "{naive:?}"),
        }
    }
}

fn place(score: f64, shift: [f64; 2], turn_deg: f64, out: [f64; 2]) -> Place {
    Place {
        score,
        out,
        turn_deg,
        shift,
    }
}

#[test]
fn places_are_one_that_lie_within_ten_pixels_and_six_degrees_of_each_other() {
    let from = place(0.5, [3.0, -4.0], 2.0, [5.0, 0.0]);
    for sign in [1.0, -1.0] {
        let is = |right: f64, down: f64, turn: f64| {
            let other = place(
                0.1,
                [3.0 + sign * right, -4.0 + sign * down],
                2.0 + sign * turn,
                from.out,
            );
            assert_eq!(from.is(&other), other.is(&from));
            from.is(&other)
        };
        assert!(is(9.9, 9.9, 5.9) && is(9.9, -9.9, 5.9));
        assert!(!is(10.0, 0.0, 0.0) && !is(0.0, 10.0, 0.0) && !is(0.0, 0.0, 6.0));
    }
    assert!(!from.is(&place(0.5, from.shift, 2.0, [0.0, 5.0])));
    let both = from.both();
    assert_eq!(both.map(|one| one.out), [[0.0; 2], from.out]);
    assert!(
        both.iter()
            .all(|one| one.shift == from.shift && one.turn_deg == 2.0 && one.score == 0.5)
    );
}

properties! {
    #[test]
    fn of_places_that_are_one_the_best_is_kept_and_the_best_of_all_comes_first(
        all in proptest::collection::vec((0u8..20, -3i8..3, -3i8..3, -2i8..2), 1..40),
    ) {
        let mut best: Vec<Place, NEAR> = Vec::new();
        let mut most = 0.0;
        for &(score, right, down, turn) in &all {
            let shift = [right, down].map(|k| 6.0 * f64::from(k));
            let new = place(f64::from(score), shift, 3.0 * f64::from(turn), [0.0; 2]);
            let before = best.clone();
            insert(&mut best, new);
            most = new.score.max(most);
            prop_assert_eq!(best[0].score, most);
            prop_assert!(best.windows(2).all(|pair| pair[0].score >= pair[1].score));
            for (k, one) in best.iter().enumerate() {
                prop_assert!(!best[..k].iter().any(|other| other.is(one)));
            }
            // It is there unless one of those before is the same and as good, or all are better than it.
            let same = |one: &Place| (one.score, one.shift, one.turn_deg) == (new.score, new.shift, new.turn_deg);
            let is_there = best.iter().any(same);
            let stands = |one: &Place| one.is(&new) && one.score >= new.score;
            let is_full = before.is_full() && before.iter().all(|one| one.score >= new.score);
            prop_assert_eq!(is_there, before.iter().any(same) || !(before.iter().any(stands) || is_full));
            // Of the others none goes that is another place, unless it is the worst.
            let lost = before.iter().filter(|one| !one.is(&new) && !best.iter().any(|other| other.shift == one.shift && other.turn_deg == one.turn_deg));
            let lost: Many<f64> = lost.map(|one| one.score).collect();
            prop_assert!(lost.len() <= 1 && lost.iter().all(|&score| score <= best[best.len() - 1].score));
        }
    }
}

properties! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    /// What is shifted with its frame settles where it does, shifted; and where it begins, whole pixels and degrees off, tells the same place.
    #[test]
    fn a_place_settles_on_its_plate_wherever_that_lies(right in -4i8..4, down in -4i8..4) {
        let by = [right, down].map(|k| 6.0 * f64::from(k));
        let settled = |shift: [f64; 2], turn_deg: f64| {
            let pixels = plate([shift[0] + 1.4, shift[1] - 1.1], turn_deg + 1.0);
            let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
            let image = ImageTarget::dark(&frame);
            let outline = outline();
            let sliding = Sliding { outline: &outline, image: &image, step: 160.0 };
            sliding.settled(place(f64::MIN, shift, turn_deg, [0.0; 2]))
        };
        let (still, moved) = (settled([0.0; 2], 0.0), settled(by, 0.0));
        prop_assert!((moved.score - still.score).abs() < 1e-9);
        prop_assert!((0..2).all(|k| (moved.shift[k] - still.shift[k] - by[k]).abs() < 1e-9), "{moved:?} {still:?}");
        prop_assert_eq!(moved.turn_deg, still.turn_deg);
        // Turned as much as the plate is.
        let turned = settled(by, 33.0);
        prop_assert!(turned.score > 0.9 && (turned.turn_deg - 34.0).abs() < 2.5, "{turned:?}");
    }
}

/// The outline of the crank at a pose, with what is asked of a place of it.
#[cfg(feature = "alloc")]
fn with_crank<T>(camera: &Camera, act: impl FnOnce(&Subject<'_>, &mut RefineMemory<'_>) -> T) -> T {
    let model = fake::crank();
    let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
    let subject = Subject::new(&model, &[], camera);
    act(&subject, &mut buffers.borrow(&model, camera))
}

/// The model drawn at the pose of a place has the outline of that place, but for perspective; in pixels that are higher than wide, or wider than
/// high, too.
#[cfg(feature = "alloc")]
#[test]
fn a_place_of_an_outline_is_the_pose_whose_outline_lies_there() {
    assert_lies_there(&fake::camera());
    for focal in [[1000.0, 700.0], [720.0, 1000.0]] {
        assert_lies_there(&Camera::new(SIDE, SIDE, focal, [81.0, 78.5]).expect("valid"));
    }
}

#[cfg(feature = "alloc")]
fn assert_lies_there(camera: &Camera) {
    let expected = fake::placed([15.0, -20.0, 8.0], [4.0, 3.0, 0.0]);
    for (shift, turn_deg, out) in [
        ([12.0, -9.0], 0.0, [0.0; 2]),
        ([0.0, 0.0], 12.0, [0.0; 2]),
        ([-6.0, 15.0], -9.0, [0.0, 5.0]),
        ([9.0, 3.0], 6.0, [-5.0, 0.0]),
    ] {
        let place = place(0.0, shift, turn_deg, out);
        let (moved, drawn) = with_crank(camera, |subject, memory| {
            let middle = subject.model.bounds().centre;
            let pose = about(&middle, &expected, &turn_out(out), [0.0; 3]);
            let outline = Outline::of(subject, &pose, memory).expect("in front");
            let turned = outline.turned(radians(turn_deg));
            let moved = turned.iter().map(|&[column, row, right, down]| {
                let at = |k: usize| [column, row][k] + outline.middle[k] + shift[k];
                [at(0), at(1), right, down]
            });
            let mut drawn: Many<[f64; 4]> = Many::new();
            let there = place.pose(subject, &expected);
            let (model, camera) = (subject.model, subject.camera);
            outline_samples(model, camera, &there, memory, |sample| {
                let [right, down] = sample.normal;
                drawn.push([sample.column, sample.row, right, down]);
            })
            .expect("in front");
            (moved.collect::<Many<_>>(), drawn)
        });
        assert!(moved.len() > SAMPLES / 2);
        let mut alike = 0;
        for one in &moved {
            let px = |other: &&[f64; 4]| libm::hypot(other[0] - one[0], other[1] - one[1]);
            let nearest = drawn
                .iter()
                .min_by(|a, b| px(a).total_cmp(&px(b)))
                .expect("some");
            assert!(px(&nearest) < 1.5, "{place:?}: {one:?} {nearest:?}");
            alike += usize::from(nearest[2] * one[2] + nearest[3] * one[3] > 0.8);
        }
        // At corners the nearest may be of the other side.
        assert!(10 * alike > 9 * moved.len(), "{alike} of {}", moved.len());
    }
}

#[cfg(feature = "alloc")]
#[test]
fn the_best_place_near_an_expected_pose_is_where_the_part_is_seen() {
    let expected = fake::placed([15.0, -20.0, 8.0], [4.0, 3.0, 0.0]);
    let seen = place(0.0, [12.0, -17.0], 6.0, [0.0; 2]);
    with_crank(&fake::camera(), |subject, memory| {
        let right = seen.pose(subject, &expected);
        let pixels = fake::grey(&fake::crank(), subject.camera, &right);
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
        let image = ImageTarget::dark(&frame);
        // What a pose beside all edges has for a step is none, or of the wrong sign.
        for step in [160.0, 0.0, -160.0, f64::NAN] {
            let found =
                near_poses(subject, &image, &expected, 18.0, step, memory).expect("in front");
            assert!(!found.is_empty() && found[0].0 > 0.9, "{step}: {found:?}");
            let middle = subject.model.bounds().centre;
            let off = subtract(&found[0].1.transform(&middle), &right.transform(&middle));
            let deg = geodesic_deg(&found[0].1.rotation, &right.rotation);
            // Within a step: readings lie four pixels to each side.
            assert!(
                norm(&off) < 2.5 && deg < 1.1 * IN_PLANE_DEG,
                "{step}: {off:?} {deg}"
            );
        }
    });
}

#[test]
fn a_turn_out_of_the_plane_is_one_about_x_and_y() {
    let turn = turn_out([5.0, -3.0]).map(crate::math::degrees);
    assert!((turn[0] - 5.0).abs() < 1e-12 && (turn[1] + 3.0).abs() < 1e-12 && turn[2] == 0.0);
}

/// Of an outline of which less than two fifths lie in the frame nothing is told.
#[test]
fn too_little_of_an_outline_has_no_score() {
    let pixels = plate([0.0; 2], 0.0);
    let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
    let image = ImageTarget::dark(&frame);
    let outline = outline();
    let sliding = Sliding {
        outline: &outline,
        image: &image,
        step: 160.0,
    };
    let score = |right: f64| sliding.score(&outline.samples, [right, 0.0]);
    assert!(score(0.0).is_some_and(|score| score > 0.9));
    // It is 80 pixels long and its middle lies 80 from the side.
    assert!(score(80.0).is_some() && score(-80.0).is_some());
    assert_eq!([95.0, -95.0, 200.0, 1000.0].map(score), [None; 4]);
    assert_eq!(sliding.score(&[], [0.0; 2]), None);
    // In steps that are twice as large all is half as strong.
    let faint = Sliding {
        step: 320.0,
        ..sliding
    };
    let half = faint
        .score(&outline.samples, [0.0; 2])
        .expect("in the frame");
    assert!((half - 0.5).abs() < 0.03, "{half}");
}
