//! Refinement with its options: numbers that are locked stay, and the others do what they can; swiftness costs little.

use fluoropose::film::LineMemory;
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::mesh::Model;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::refine::{
    BorderPixel, CameraView, Effort, Locks, RefineError, RefineMemory, RefineOptions, Refined,
    places_needed, refine,
};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_tests::{TRUTH, camera, femur, mesh};

/// A little off in every number.
const START: EulerPose = EulerPose {
    x_mm: 7.5,
    y_mm: -12.5,
    z_mm: -1062.0,
    z_rot_deg: 36.5,
    x_rot_deg: 2.5,
    y_rot_deg: -5.5,
};

/// Refines `start` against the silhouette of the femur at [`TRUTH`].
fn refined(start: EulerPose, locks: Locks) -> Refined {
    let options = RefineOptions {
        locks,
        ..RefineOptions::default()
    };
    refined_with(start, options)
}

fn refined_with(start: EulerPose, options: RefineOptions) -> Refined {
    refined_in(16_384, start, options).expect("it is near")
}

/// Refined with room for so many border pixels.
fn refined_in(
    border: usize,
    start: EulerPose,
    options: RefineOptions,
) -> Result<Refined, RefineError> {
    let (camera, triangles) = (camera(), femur());
    let mesh: Model<'_> = mesh(&triangles);
    let (width, height) = (camera.width(), camera.height());
    let mut projected = vec![Projected::default(); scratch_needed(&mesh)];
    let mut words = vec![0; words_needed(width, height)];
    let mut mask = MaskMut::new(&mut words, width, height).expect("valid");
    render(
        &mesh,
        &camera,
        &Pose::from(TRUTH),
        &mut projected,
        &mut mask,
    )
    .expect("drawn");
    let mask = mask.into_mask();
    let mut memory = RefineMemory {
        projected: &mut projected,
        drawn: &mut vec![0; words_needed(width, height)],
        places: &mut vec![0; places_needed(height)],
        border: &mut vec![BorderPixel::default(); border],
        film: LineMemory::default(),
    };
    let view = CameraView::only(&camera, &mask);
    refine(&mesh, &[view], &Pose::from(start), options, &mut memory)
}

/// Less than the outline would begin with the top of the picture, whose best pose is another.
#[test]
fn a_border_without_room_for_the_outline_is_refused_with_the_length_that_is_needed() {
    let refined = |border, effort| {
        let options = RefineOptions {
            effort,
            ..RefineOptions::default()
        };
        refined_in(border, START, options)
    };
    for effort in [Effort::Full, Effort::Interactive] {
        let mut room = 0;
        let enough = loop {
            match refined(room, effort) {
                Ok(found) => break found,
                Err(RefineError::Memory(short)) => {
                    assert_eq!((short.what, short.given), ("border pixels", room));
                    assert!(short.needed > room, "{short}");
                    room = short.needed;
                }
                Err(other) => panic!("{other}"),
            }
        };
        println!("{effort:?}: {room} border pixels");
        let short = refined(room - 1, effort).expect_err("one is missing");
        assert!(matches!(short, RefineError::Memory(short) if short.needed == room));
        let plenty = refined(16_384, effort).expect("it is near");
        assert_eq!(enough.pose, plenty.pose);
    }
}

#[test]
fn numbers_that_are_locked_at_the_truth_stay_there_and_the_others_find_it() {
    let start = EulerPose {
        z_mm: TRUTH.z_mm,
        y_rot_deg: TRUTH.y_rot_deg,
        ..START
    };
    let locks = Locks {
        translation: [false, false, true],
        y_rot: true,
        ..Locks::default()
    };
    let found = EulerPose::from(refined(start, locks).pose);
    assert!((found.z_mm - TRUTH.z_mm).abs() < 1e-9);
    assert!((found.y_rot_deg - TRUTH.y_rot_deg).abs() < 1e-9);
    for (got, wanted) in [
        (found.x_mm, TRUTH.x_mm),
        (found.y_mm, TRUTH.y_mm),
        (found.z_rot_deg, TRUTH.z_rot_deg),
        (found.x_rot_deg, TRUTH.x_rot_deg),
    ] {
        assert!((got - wanted).abs() < 0.02, "{found:?}");
    }
}

#[test]
fn a_number_that_is_locked_off_the_truth_stays_off_and_costs_residual() {
    let locks = Locks {
        x_rot: true,
        ..Locks::default()
    };
    let held = refined(START, locks);
    let free = refined(START, Locks::default());
    let found = EulerPose::from(held.pose);
    assert!((found.x_rot_deg - START.x_rot_deg).abs() < 1e-9);
    assert!((EulerPose::from(free.pose).x_rot_deg - TRUTH.x_rot_deg).abs() < 0.02);
    assert!(
        held.residual_px > 2.0 * free.residual_px,
        "{held:?} {free:?}"
    );
    // The others went to where they fit best all the same.
    assert!(
        (found.x_mm - TRUTH.x_mm).abs() < 0.5 && (found.z_rot_deg - TRUTH.z_rot_deg).abs() < 0.5
    );
}

#[test]
fn with_everything_locked_nothing_moves() {
    let locks = Locks {
        translation: [true; 3],
        z_rot: true,
        x_rot: true,
        y_rot: true,
    };
    let found = EulerPose::from(refined(START, locks).pose);
    for (got, wanted) in [
        (found.x_mm, START.x_mm),
        (found.y_mm, START.y_mm),
        (found.z_mm, START.z_mm),
        (found.z_rot_deg, START.z_rot_deg),
        (found.x_rot_deg, START.x_rot_deg),
        (found.y_rot_deg, START.y_rot_deg),
    ] {
        assert!((got - wanted).abs() < 1e-9, "{found:?}");
    }
}

#[test]
fn an_interactive_refinement_is_near_the_thorough_one_and_draws_less() {
    let interactive = RefineOptions {
        effort: Effort::Interactive,
        ..RefineOptions::default()
    };
    let thorough = refined(START, Locks::default());
    let hurried = refined_with(START, interactive);
    let away = geodesic_deg(&hurried.pose.rotation, &thorough.pose.rotation);
    assert!(away < 0.1, "{away} degrees");
    assert!(
        hurried.renders < thorough.renders,
        "{hurried:?} {thorough:?}"
    );
}

#[test]
fn a_probe_tells_where_a_start_leads_and_draws_least() {
    let with = |effort| {
        let options = RefineOptions {
            effort,
            ..RefineOptions::default()
        };
        refined_with(START, options)
    };
    let (thorough, hurried, seen) = (
        with(Effort::Full),
        with(Effort::Interactive),
        with(Effort::Probe),
    );
    let away = geodesic_deg(&seen.pose.rotation, &thorough.pose.rotation);
    assert!(away < 0.3, "{away} degrees");
    assert!(seen.renders < hurried.renders, "{seen:?} {hurried:?}");
}
