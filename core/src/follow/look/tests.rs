use super::*;
use crate::finder::fake::{SIDE, camera, crank, grey, placed};
use crate::follow::fake::turned;
use crate::image::frame::Frame;
use crate::math::{norm, subtract};
use crate::refine::RefineBuffers;
use std::vec;

/// What is usual where one is looked for.
const USUAL: Usual = Usual {
    misfit_px: 0.5,
    step: 100.0,
    strength: 0.8,
};

/// Asks a search for a part that is expected a metre away.
fn search<T>(act: impl FnOnce(&Search<'_>) -> T) -> T {
    let (model, camera, pixels) = (crank(), camera(), vec![0u8; SIDE * SIDE]);
    let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
    let image = ImageTarget::dark(&frame);
    let model = model.as_model();
    act(&Search {
        subject: &Subject::new(&model, &[], &camera),
        image: &image,
        expected: Expected {
            pose: turned(0.0, 0.0).pose,
            turn_deg: 5.0,
            shift_mm: 10.0,
            depth_mm: 20.0,
        },
        usual: &USUAL,
        middle: [0.0; 3],
    })
}

/// A pose as usual where it is expected, changed.
fn found(change: impl FnOnce(&mut FramePose)) -> FramePose {
    let mut found = turned(0.0, 0.5);
    (found.contrast.step, found.contrast.strength) = (100.0, 0.8);
    change(&mut found);
    found
}

fn off(deg: f64, [x, y, z]: [f64; 3]) -> FramePose {
    found(|found| {
        found.pose.rotation = turned(deg, 0.0).pose.rotation;
        found.pose.translation = [x, y, z - 1000.0];
    })
}

#[test]
fn a_pose_is_ordinary_as_near_to_what_was_expected_as_motion_may_take_it_and_no_farther() {
    search(|search| {
        let is = |found: FramePose| search.is_ordinary(&found);
        assert!(is(found(|_| {})));
        for sign in [1.0, -1.0] {
            assert!(is(off(sign * 4.99, [0.0; 3])) && !is(off(sign * 5.01, [0.0; 3])));
            for k in [0, 1] {
                let aside =
                    |mm: f64| core::array::from_fn(|at| if at == k { sign * mm } else { 0.0 });
                assert!(is(off(0.0, aside(9.99))) && !is(off(0.0, aside(10.01))));
            }
            assert!(
                is(off(0.0, [0.0, 0.0, sign * 19.99])) && !is(off(0.0, [0.0, 0.0, sign * 20.01]))
            );
        }
        assert!(!is(off(0.0, [7.1, 7.1, 0.0])));
    });
}

/// Each limit by itself, of poses that are ordinary and of those that are believed at all.
#[test]
fn a_pose_fits_that_leaves_little_and_has_most_of_the_usual_edge_in_the_frame() {
    search(|search| {
        let is = |found: FramePose| (search.is_ordinary(&found), search.is_believed(&found));
        let misfit = |px: f64| is(found(|found| found.misfit_px = px));
        assert_eq!(
            [0.679, 0.681, 1.299, 1.301].map(misfit),
            [(true, true), (false, true), (false, true), (false, false)]
        );
        let strength = |part: f64| is(found(|found| found.contrast.strength = 0.8 * part));
        assert_eq!(
            [0.851, 0.849, 0.601, 0.599].map(strength),
            [(true, true), (false, true), (false, true), (false, false)]
        );
        let step = |step: f64| is(found(|found| found.contrast.step = step));
        assert_eq!([10.1, 9.9].map(step), [(true, true), (false, false)]);
        let known = |part: f64| is(found(|found| found.fit.known = part));
        assert_eq!([0.51, 0.49].map(known), [(true, true), (false, false)]);
    });
}

#[test]
fn of_two_poses_the_one_more_as_usual_is_better_and_of_two_alike_the_nearer_one() {
    search(|search| {
        let usual = USUAL.cost(&found(|_| {}));
        assert!((search.cost(&off(0.0, [0.0; 3])) - usual).abs() < 1e-12);
        // As far as is in the ordinary costs a tenth of a usual misfit, each way.
        for (deg, mm) in [(5.0, 0.0), (0.0, 10.0), (2.5, 5.0), (20.0, 3.0)] {
            let cost = search.cost(&off(deg, [mm, 0.0, 0.0]));
            let wanted = usual + 0.1 * (deg / 5.0 + mm / 10.0);
            assert!((cost - wanted).abs() < 1e-9, "{cost} {wanted}");
        }
        let (near, far) = (off(1.0, [0.0; 3]), off(2.0, [0.0; 3]));
        let sharp = found(|found| found.misfit_px = 0.3);
        for (one, other, better) in [(near, far, near), (far, near, near), (near, sharp, sharp)] {
            assert_eq!(search.better(Some(one), Some(other)), Some(better));
        }
        assert_eq!(search.better(None, Some(far)), Some(far));
        assert_eq!(search.better(Some(far), None), Some(far));
        assert_eq!(search.better(None, None), None);
        // Of two that cost the same the first.
        let mirrored = off(-1.0, [0.0; 3]);
        assert!(search.cost(&mirrored) == search.cost(&near));
        assert_eq!(search.better(Some(near), Some(mirrored)), Some(near));
        // Nothing that leaves more than that is asked for.
        assert!((search.most_px(None) - 1.3).abs() < 1e-12);
        let most_px = search.most_px(Some(&near));
        let as_bad = found(|found| found.misfit_px = most_px);
        assert!((USUAL.cost(&as_bad) - search.cost(&near)).abs() < 1e-12);
        let worst = found(|found| found.misfit_px = 2.5);
        assert!((search.most_px(Some(&worst)) - 1.3).abs() < 1e-12);
    });
}

#[test]
fn it_is_searched_as_far_around_as_it_may_have_moved_and_farther_where_it_was_missed() {
    search(|search| {
        // 10 mm a metre away are 10 pixels.
        assert_eq!(
            [0, 1, 3, 8, 9, 99].map(|missed| search.reach_px(missed)),
            [24.0, 30.0, 42.0, 72.0, 72.0, 72.0]
        );
        let far = Search {
            expected: Expected {
                shift_mm: 40.0,
                ..search.expected
            },
            ..*search
        };
        assert_eq!(
            [0, 2, 6].map(|missed| far.reach_px(missed)),
            [40.0, 52.0, 72.0]
        );
        let nothing =
            [Missing::Outside, Missing::Hidden, Missing::Blank].map(|why| search.nothing(why, 0.3));
        assert_eq!(nothing.map(|looked| looked.searched), [false, true, true]);
        assert!(
            nothing
                .iter()
                .all(|looked| !looked.ordinary && looked.known == 0.3 && looked.found.is_err())
        );
    });
}

/// The model's middle stays where it is, or moves along the ray through it.
#[test]
fn beside_a_pose_lie_four_turned_out_of_the_plane_and_two_nearer_and_farther() {
    let pose = placed([30.0, -20.0, 50.0], [40.0, -25.0, 60.0]);
    let middle = [7.0, -4.0, 11.0];
    let centre = pose.transform(&middle);
    let all = super::beside(&pose, &middle, 0.02);
    let axes = all.map(|one| {
        let turn = crate::math::multiply(&one.rotation, &crate::math::transpose(&pose.rotation));
        crate::math::rotation_vector(&turn).map(|radians| crate::math::degrees(radians) / 2.5)
    });
    let wanted = [
        [1.0, 0.0],
        [-1.0, 0.0],
        [0.0, 1.0],
        [0.0, -1.0],
        [0.0; 2],
        [0.0; 2],
    ];
    let parts = [1.0, 1.0, 1.0, 1.0, 1.02, 0.98];
    for k in 0..6 {
        let [x, y] = wanted[k];
        assert!(
            norm(&subtract(&axes[k], &[x, y, 0.0])) < 1e-9,
            "{k}: {:?}",
            axes[k]
        );
        let moved = subtract(&all[k].transform(&middle), &scale(&centre, parts[k]));
        assert!(norm(&moved) < 1e-9, "{k}: {moved:?}");
    }
}

/// What comes of a frame that shows a part at one pose where it is expected at another.
fn seen(pixels: &[u8], expected: &Pose) -> Looked {
    let (model, camera) = (crank(), camera());
    let frame = Frame::new(pixels, SIDE, SIDE, SIDE).expect("valid");
    let image = ImageTarget::dark(&frame);
    let usual = Usual {
        misfit_px: 0.3,
        step: 160.0,
        strength: 1.0,
    };
    let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
    let trail = Trail::begin(3, expected, usual);
    let subject = Subject::new(&model, &[], &camera);
    look(
        &subject,
        &image,
        4,
        &trail,
        &mut buffers.borrow(&model, &camera),
    )
}

#[test]
fn a_part_near_where_it_is_expected_is_found_without_a_search_and_nothing_beyond_the_frame() {
    let right = placed([20.0, 30.0, 5.0], [2.0, -3.0, 0.0]);
    let pixels = grey(&crank(), &camera(), &right);
    let looked = seen(&pixels, &placed([21.0, 29.0, 4.0], [0.0; 3]));
    assert!(looked.ordinary && !looked.searched, "{looked:?}");
    let found = looked.found.expect("found");
    let [deg, mm] = apart(&right, &found.pose, &crank().as_model().bounds().centre);
    assert!(deg < 2.0 && mm < 0.5, "{deg} {mm}");
    let outside = seen(&pixels, &placed([20.0, 30.0, 5.0], [120.0, 0.0, 0.0]));
    assert_eq!(outside.found, Err(Missing::Outside));
    assert!(outside.known < LEAST_KNOWN && !outside.searched);
}
