use super::*;
use crate::math::rotation_by;
use proptest::prelude::*;

/// Turned by so many degrees about the camera's y; what remains there.
fn refined(deg: f64, loss: f64) -> Refined {
    let mut at = Refined::at(Pose {
        rotation: rotation_by(&[0.0, radians(deg), 0.0]),
        translation: [0.0, 0.0, -1000.0],
    });
    at.loss = loss;
    at
}

fn rival(deg: f64, loss: f64) -> RefinedRival {
    RefinedRival {
        refined: refined(deg, loss),
        ..RefinedRival::at(Pose::IDENTITY, 0, false)
    }
}

/// In a round of quick looks at what is beside the first of these answers.
fn looking(round: Round, answers: &[RefinedRival], back_deg: f64) -> Poses {
    let mut poses = Poses::new();
    poses.answers = first_of(answers.iter().copied());
    poses.best = answers[0];
    (poses.round, poses.doing, poses.back_deg) = (round, Doing::Looking, back_deg);
    poses
}

fn word(led: Led) -> &'static str {
    match led {
        Led::Back => "back",
        Led::Nowhere => "nowhere",
        Led::On => "on",
    }
}

#[test]
fn a_look_beside_leads_back_to_the_best_pose_or_on_to_one_that_is_hardly_worse() {
    for round in [Round::Beside, Round::Around] {
        let poses = looking(round, &[rival(0.0, 0.8)], 0.4);
        let led = |deg: f64, loss: f64| word(poses.led(&refined(deg, loss)));
        // Near to it nothing else counts, a worse loss or a better one.
        assert_eq!(
            [led(0.0, 9.0), led(0.39, 9.0), led(-0.39, 0.1)],
            ["back"; 3]
        );
        assert_eq!([led(0.41, 0.99), led(-20.0, 0.99)], ["on"; 2]);
        assert_eq!([led(0.41, 1.01), led(-20.0, 1.01)], ["nowhere"; 2]);
    }
}

#[test]
fn a_mirror_image_leads_on_where_it_may_be_the_best_and_was_not_found_before() {
    // Noise of 0.2 px blurs half a degree; of any, no more than a whole one.
    let noisy = |deg: f64, loss: f64, sigma_px: f64| {
        let mut noisy = rival(deg, loss);
        noisy.refined.robust_sigma_px = sigma_px;
        noisy
    };
    let answers = [noisy(0.0, 0.5, 0.2), noisy(30.0, 1.0, 3.0)];
    let poses = looking(Round::Mirrors, &answers, 0.1);
    let led = |deg: f64, loss: f64| word(poses.led(&refined(deg, loss)));
    assert_eq!([led(90.0, 0.1), led(90.0, 2.0)], ["on"; 2]);
    assert_eq!(led(90.0, 2.001), "nowhere", "far worse than the best");
    for deg in [0.49, -0.49, 29.01, 30.99] {
        assert_eq!(led(deg, 1.5), "nowhere", "{deg}");
    }
    assert_eq!(
        [led(0.51, 1.5), led(28.99, 1.5), led(31.01, 1.5)],
        ["on"; 3]
    );
    // What leaves less by far was not found before, however near it is.
    assert_eq!([led(0.0, 0.39), led(30.0, 0.79)], ["on"; 2]);
    assert_eq!([led(0.0, 0.41), led(30.0, 0.81)], ["nowhere"; 2]);
    // Of outlines that fit exactly the least loss is rounding.
    let exact = looking(Round::Mirrors, &[rival(0.0, 0.001)], 0.1);
    let led = |loss: f64| word(exact.led(&refined(90.0, loss)));
    assert_eq!([led(0.5), led(0.501)], ["on", "nowhere"]);
}

#[test]
fn what_is_halfway_to_a_known_pose_is_known() {
    let mut noisy = rival(0.0, 0.5);
    noisy.refined.robust_sigma_px = 0.2;
    let far = rival(50.0, 0.7);
    let mut poses = looking(Round::Beside, &[noisy, far], 0.8);
    let known =
        |poses: &Poses, degs: [f64; 2]| degs.map(|deg| poses.is_known(&refined(deg, 9.0).pose));
    // Beside the best one alone counts.
    assert_eq!(known(&poses, [0.39, 0.41]), [true, false]);
    assert_eq!(known(&poses, [50.0, -0.39]), [false, true]);
    poses.round = Round::Mirrors;
    assert_eq!(known(&poses, [0.24, 0.26]), [true, false]);
    poses.doing = Doing::Refining;
    for (round, half_deg) in [
        (Round::First, 0.5),
        (Round::Rest, 0.05),
        (Round::Mirrors, 0.05),
    ] {
        poses.round = round;
        poses.is_outline = true;
        let [within, beyond] = [0.98, 1.02].map(|part| part * half_deg);
        assert_eq!(known(&poses, [within, beyond]), [true, false]);
        assert_eq!(known(&poses, [50.0 - within, 50.0 + beyond]), [true, false]);
        // On a frame all that was begun is brought to the end.
        poses.is_outline = false;
        assert_eq!(known(&poses, [0.0, 50.0]), [round == Round::First; 2]);
    }
}

#[test]
fn an_outline_is_split_where_what_is_left_is_more_than_noise_or_rounding() {
    let split = |residual_px: f64, robust_sigma_px: f64| {
        is_split(&Refined {
            residual_px,
            robust_sigma_px,
            ..refined(0.0, 0.0)
        })
    };
    // Three times the noise, and a tenth of a pixel at least.
    assert!(split(0.31, 0.1) && !split(0.29, 0.1) && !split(0.31, 0.11));
    assert!(split(0.151, 0.05) && !split(0.149, 0.05));
    assert!(!split(0.099, 0.047) && !split(0.099, 0.0461) && split(0.1001, 0.0));
    // Of an outline without noise less than that tells it.
    assert!(split(0.031, 0.045) && !split(0.029, 0.045) && !split(0.031, 0.0465));
    assert!(!split(0.0, 0.0) && !split(0.029, 0.001));
}

#[test]
fn all_poses_are_mirrored_once_each_whatever_led_to_them() {
    let mut poses = looking(
        Round::Starts,
        &[rival(0.0, 0.1), rival(0.4, 0.2), rival(0.6, 0.3)],
        0.1,
    );
    poses.answers[2].start = 4;
    poses.mirror_all();
    let open = poses.open.iter().map(|open| (open.start, open.from));
    let of = |deg: f64| refined(deg, 0.0).pose;
    assert!(open.eq([(0, of(0.0)), (4, of(0.6))]));
    assert!(poses.round == Round::Mirrors);
}

properties! {
    /// What is left are the poses that none of those left before is near to, of those within the limit.
    #[test]
    fn of_poses_near_each_other_the_best_alone_stays_open(
        all in proptest::collection::vec((-9i8..9, 0u8..12), 0..ANSWERS), limit in 0u8..12,
    ) {
        // Two degrees apart, or three: the limit lies between.
        let mut all: std::vec::Vec<_> = all.iter().map(|&(deg, loss)| (f64::from(deg), f64::from(loss))).collect();
        all.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut rivals: Vec<RefinedRival, ANSWERS> = first_of(all.iter().map(|&(deg, loss)| rival(deg, loss)));
        keep_open(&mut rivals, f64::from(limit), |a, b| is_within(a, b, 2.5));
        let mut left: std::vec::Vec<(f64, f64)> = std::vec![];
        for &(deg, loss) in all.iter().filter(|one| one.1 <= f64::from(limit)) {
            if left.iter().all(|other| (other.0 - deg).abs() > 2.5) {
                left.push((deg, loss));
            }
        }
        let found = rivals.iter().map(|one| (one.refined.pose, one.refined.loss));
        prop_assert!(found.eq(left.iter().map(|&(deg, loss)| (refined(deg, loss).pose, loss))), "{left:?}");
    }
}

/// An inner rim is met by a pose that is turned as the outer's and lies farther.
#[test]
fn poses_that_are_turned_alike_and_lie_apart_are_two_at_the_end() {
    let mut poses = Poses::new();
    let farther = |mm: f64, loss: f64| {
        let mut farther = rival(0.3, loss);
        farther.refined.pose.translation[2] -= mm;
        farther
    };
    poses.answers = first_of([rival(0.0, 0.1), farther(4.0, 0.11), farther(40.0, 0.12)]);
    poses.end();
    let left = poses.answers.iter().map(|one| one.refined.loss);
    assert!(left.eq([0.1, 0.12]), "{:?}", poses.answers);
}

#[cfg(feature = "alloc")]
#[test]
fn what_was_seen_is_an_outline_where_no_view_is_a_grey_frame() {
    use crate::finder::fake::{SIDE, camera, crank, drawn, grey, placed};
    use crate::image::frame::Frame;
    use crate::image::mask::Mask;
    use crate::image::silhouette::Silhouette;
    use crate::refine::ImageTarget;
    let (model, camera, pose) = (crank(), camera(), placed([0.0; 3], [0.0; 3]));
    let (words, pixels) = (drawn(&model, &camera, &pose), grey(&model, &camera, &pose));
    let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
    let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
    let outline = CameraView::only(&camera, Silhouette::from(&mask));
    let image = CameraView::only(&camera, ImageTarget::dark(&frame));
    assert!(is_outline(&[outline]) && is_outline(&[outline; 2]));
    assert!(
        !is_outline(&[image]) && !is_outline(&[outline, image]) && !is_outline(&[image, outline])
    );
    // Of several starts the first stage tells of an outline where each leads.
    let begun = |starts: usize, view: CameraView<'_>| {
        let mut poses = Poses::new();
        poses.begin((0..starts).map(|_| pose), &[view]);
        poses.round == Round::First
    };
    assert_eq!(
        [1, 2, 6].map(|starts| begun(starts, outline)),
        [false, true, true]
    );
    assert!(!begun(2, image));
}

#[test]
fn of_what_the_first_stage_led_to_all_that_may_be_the_best_goes_on() {
    let begun = |losses: &[f64]| {
        let rivals: std::vec::Vec<_> = (0..)
            .zip(losses)
            .map(|(k, &loss)| rival(5.0 * f64::from(k), loss))
            .collect();
        let mut poses = looking(Round::First, &rivals, 0.1);
        poses.go_on_with_begun();
        assert!(poses.answers.is_empty() && poses.round == Round::Rest);
        poses.open.len()
    };
    // Four times the least, or half a square pixel.
    assert_eq!(begun(&[0.3, 1.2, 1.201]), 2);
    assert_eq!(begun(&[0.01, 0.5, 0.501]), 2);
    assert_eq!(begun(&[0.01, 0.02]), 2);
    let mut near = looking(
        Round::First,
        &[rival(0.0, 0.1), rival(0.9, 0.2), rival(1.1, 0.3)],
        0.1,
    );
    near.go_on_with_begun();
    assert!(near.open.iter().map(|one| one.refined.loss).eq([0.1, 0.3]));
}

/// The round that follows one, and how many poses it has, where the best outline fits exactly but for so many pixels.
#[cfg(feature = "alloc")]
fn after(
    round: Round,
    planes: usize,
    residual_px: f64,
    all_back: bool,
) -> Option<(&'static str, usize)> {
    use crate::finder::fake::{SIDE, camera, crank, drawn, placed};
    use crate::image::mask::Mask;
    use crate::image::silhouette::Silhouette;
    let (model, camera, pose) = (crank(), camera(), placed([20.0, 30.0, 0.0], [0.0; 3]));
    let words = drawn(&model, &camera, &pose);
    let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
    let views = [CameraView::only(&camera, Silhouette::from(&mask))];
    let plane = SymmetryPlane {
        point: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        deviation_mm: 0.0,
    };
    let mut best = rival(0.0, 0.01);
    (best.refined.pose, best.refined.residual_px) = (pose, residual_px);
    let mut poses = looking(round, &[best], 0.1);
    (poses.is_outline, poses.all_back) = (true, all_back);
    let mut buffers = crate::refine::RefineBuffers::default();
    let model = model.as_model();
    let subject = Subject {
        model: &model,
        views: &views,
        planes: &[plane; 3][..planes],
        options: RefineOptions::default(),
    };
    let _ = poses.next_round(&subject, &mut buffers.borrow(&model, &camera));
    let word = match poses.round {
        Round::Mirrors => "mirrors",
        Round::Beside => "beside",
        Round::Around => "around",
        _ => "other",
    };
    let off = |open: &RefinedRival| geodesic_deg(&open.from.rotation, &pose.rotation);
    match poses.round {
        Round::Beside => assert!(
            poses
                .open
                .iter()
                .all(|open| (off(open) - BESIDE_DEG).abs() < 1e-9)
        ),
        Round::Around => assert!(poses.open.iter().all(|open| off(open) > CLOSE_DEG / 2.0)),
        _ => {}
    }
    (poses.doing != Doing::Nothing).then_some((word, poses.open.len()))
}

#[cfg(feature = "alloc")]
#[test]
fn symmetric_parts_are_looked_at_from_beside_and_split_outlines_from_all_around() {
    let (whole, split) = (0.01, 0.2);
    for round in [Round::Rest, Round::Starts] {
        assert_eq!(after(round, 0, split, true), Some(("mirrors", 1)));
    }
    assert_eq!(after(Round::Mirrors, 1, whole, true), Some(("beside", 4)));
    assert_eq!(after(Round::Mirrors, 3, split, true), Some(("beside", 4)));
    assert_eq!(after(Round::Mirrors, 0, whole, true), None);
    let around = after(Round::Mirrors, 0, split, true).expect("it is split");
    assert!(around.0 == "around" && around.1 > 1, "{around:?}");
    assert_eq!(after(Round::Beside, 1, split, false), Some(around));
    assert_eq!(after(Round::Beside, 1, split, true), None);
    assert_eq!(after(Round::Beside, 1, whole, false), None);
    assert_eq!(after(Round::Around, 1, split, false), None);
}
