use super::*;
use crate::joint::fake::{Normal, covariance, factor, femur, moved, pose, tray};
use crate::joint::kinematics::joint_axes;
use proptest::prelude::*;
use std::format;
use std::vec;
use std::vec::Vec;

/// A tray as the femoral component sees it: flexion, abduction, internal rotation, and how far across, mm.
fn knee([flexion, abduction, rotation]: [f64; 3], across_mm: f64) -> (Pose, Pose) {
    let femur = pose([10.0, 20.0, -1000.0], [0.0; 3]);
    // The plate 30 mm below the middle of the condyles, along its own normal.
    let turned = pose([2.0, -1.0, 0.0], [-flexion, abduction, rotation]);
    let below = pose([0.0, -34.0, 0.0], [0.0; 3]);
    let aside = pose([0.0, 0.0, across_mm], [0.0; 3]);
    (
        femur,
        femur.compose(&aside).compose(&turned).compose(&below),
    )
}

fn told(middles: &Middles, apart: &[f64]) -> Vec<Option<Beside>> {
    let mut told = vec![None; apart.len()];
    middles.judge(apart, &mut vec![0.0; apart.len()], &mut told);
    told
}

fn middles() -> (Middles, f64) {
    let own = Pose::IDENTITY;
    let middles = Middles::new((femur().mesh(), &own), (tray().mesh(), &own)).expect("a plate");
    (middles, middles.most_mm())
}

#[test]
fn what_a_knee_allows_follows_from_both_widths() {
    let (_, most_mm) = middles();
    // Balls of 20 mm at 24 mm; a plate of 76 mm.
    assert!((most_mm - (38.0 - 76.0 / 3.0)).abs() < 1e-4, "{most_mm}");
    // Larger than a subluxation of 8 mm.
    assert!(most_mm > 8.0);
}

/// Whatever the files' axes, the view, the side of the body and the ends of axes: what counts is how far the parts lie apart.
#[test]
fn axes_view_and_side_drop_out() {
    let (femur_parts, tray_parts) = (femur(), tray());
    let (plain, _) = middles();
    let mut normal = Normal(7);
    for round in 0..200 {
        let [a, b, c, d, e, f] = normal.some::<6>().map(|x| 60.0 * x);
        let axes = [
            pose([0.3 * a, b, c], [d, e, f]),
            pose([d, 0.2 * e, f], [c, a, b]),
        ];
        let [flexion, abduction, rotation, across] = normal.some::<4>();
        let angles = [60.0 + 30.0 * flexion, 4.0 * abduction, 10.0 * rotation];
        let (femur_pose, tibia_pose) = knee(angles, 10.0 * across);
        let wanted = plain.apart_mm(&femur_pose, &tibia_pose);
        let view = pose([a, b, -500.0], [c, d, e]);
        let (a, b) = (femur_parts.in_axes(&axes[0]), tray_parts.in_axes(&axes[1]));
        // The half turn about y that tells sides apart turns an axis around.
        let side = [Side::Left, Side::Right][round % 2];
        let told = axes.map(|axes| joint_axes(&axes, side));
        let middles = Middles::new((a.mesh(), &told[0]), (b.mesh(), &told[1])).expect("a plate");
        let placed = |pose: &Pose, axes: &Pose| view.compose(pose).compose(&axes.inverse());
        let found = middles.apart_mm(
            &placed(&femur_pose, &axes[0]),
            &placed(&tibia_pose, &axes[1]),
        );
        assert!(
            (found.abs() - wanted.abs()).abs() < 1e-3,
            "{found} {wanted}"
        );
        assert!((middles.most_mm() - plain.most_mm()).abs() < 1e-3);
    }
}

/// Flexion to 140 degrees, tilt and rotation of a lax knee, and a tray that slides 8 mm across, each pose off by what depth is not known to.
#[test]
fn a_lax_knee_is_not_taken_for_a_mirrored_one() {
    let (middles, _) = middles();
    let mut normal = Normal(11);
    let (mut frames, mut films) = (0, 0);
    for film in 0..400 {
        let slides = 8.0 * f64::from(film % 2);
        let apart: Vec<f64> = (0..15)
            .map(|frame| {
                let [abduction, rotation, femur_mm, tibia_mm] = normal.some::<4>();
                let angles = [10.0 * f64::from(frame), 2.0 * abduction, 8.0 * rotation];
                let (femur, tibia) = knee(angles, slides);
                let off =
                    |pose: &Pose, mm: f64| moved(pose, &[0.0; 3], &[0.0, 0.0, 0.0, 0.0, 0.0, mm]);
                middles.apart_mm(&off(&femur, femur_mm), &off(&tibia, 1.5 * tibia_mm))
            })
            .collect();
        let told = told(&middles, &apart);
        let of_film = told.iter().flatten().any(|told| told.of_film);
        films += usize::from(of_film);
        frames += told.iter().flatten().filter(|told| !told.of_film).count();
    }
    assert_eq!(films, 0);
    // Of 6000: those that slid and whose depth was off by three standard deviations.
    assert!(frames < 60, "{frames}");
}

#[test]
fn a_film_is_told_by_its_median_and_a_frame_by_itself() {
    let (middles, most) = middles();
    let mut apart = vec![most + 8.0; 5];
    // One that looks sound and one that is not known: mirrored films are mirrored as a whole.
    (apart[1], apart[3]) = (0.0, f64::NAN);
    let all = told(&middles, &apart);
    let known: Vec<bool> = all.iter().map(Option::is_some).collect();
    assert_eq!(known, [true; 5]);
    assert!(
        all.iter()
            .flatten()
            .all(|told| told.of_film && told.mm == most + 8.0)
    );
    // To the other side.
    assert!(
        told(&middles, &apart.iter().map(|mm| -mm).collect::<Vec<_>>())[0]
            .is_some_and(|told| told.mm == most + 8.0)
    );
    // One of three alone.
    let alone = told(&middles, &[0.0, -most - 5.0, 1.0]);
    let alone: Vec<bool> = alone.iter().map(Option::is_some).collect();
    assert_eq!(alone, [false, true, false]);
    // A frame by itself is no film.
    let one = told(&middles, &[most + 1.0]);
    assert!(one[0].is_some_and(|told| !told.of_film));
    assert_eq!(told(&middles, &[most - 0.1; 3]), [None; 3]);
    assert_eq!(told(&middles, &[f64::NAN; 2]), [None; 2]);
    assert_eq!(told(&middles, &[]), []);
}

/// A tray of which nobody knows how far away it is tells nothing where the knee is seen from the side, and all of it from the front.
#[cfg(feature = "alloc")]
#[test]
fn depths_that_are_not_known_tell_nothing() {
    let (middles, most) = middles();
    let (femur, tibia) = knee([60.0, 0.0, 0.0], most + 8.0);
    let told = |view: &Pose, depth_sd_mm: f64| {
        let lying = |pose: &Pose| Lying {
            pose: view.compose(pose),
            depth_sd_mm,
        };
        let all = middles.judge_poses(&[Some(lying(&femur)); 2], &[Some(lying(&tibia)); 2]);
        all.iter().flatten().count()
    };
    let front = pose([0.0; 3], [0.0, 0.0, 90.0]);
    assert_eq!(told(&Pose::IDENTITY, 0.5 * most), 2);
    assert_eq!(told(&Pose::IDENTITY, most), 0);
    assert_eq!(told(&front, 20.0 * most), 2);
}

#[test]
fn it_is_said_in_words_what_may_be_wrong_and_what_to_do() {
    let mut beside = Beside {
        mm: 22.6,
        most_mm: 14.9,
        of_film: true,
        flipped: None,
    };
    let words = format!("{beside}");
    for part in ["23 mm beside", "15 mm", "median", "mirrored", "other side"] {
        assert!(words.contains(part), "{words}");
    }
    beside.flipped = Some(Flipped {
        mm: 1.2,
        times: 1.84,
        is_better: true,
    });
    let words = format!("{beside}");
    assert!(
        words.contains("both fit (1.8 times as much remains without) and lie 1 mm"),
        "{words}"
    );
    // Where they fit alike either way the poses may be what is wrong.
    beside.flipped = Some(Flipped {
        mm: 1.2,
        times: 1.04,
        is_better: false,
    });
    let words = format!("{beside}");
    assert!(
        words.contains("poses of one component wrong")
            && words.contains("fit about as well and lie 1 mm")
            && words.ends_with("where they are not, look at the poses"),
        "{words}"
    );
    beside.of_film = false;
    assert!(format!("{beside}").contains("is one of the poses wrong?"));
    // The fit alone tells it.
    beside.mm = 3.0;
    let words = format!("{beside}");
    assert!(
        words.contains("both components fit better") && !words.contains("beside the femoral"),
        "{words}"
    );
}

#[test]
fn a_tray_farther_off_than_it_is_wide_is_no_mirrored_one() {
    let words = |mm: f64| {
        let beside = Beside {
            mm,
            most_mm: 12.7,
            of_film: true,
            flipped: None,
        };
        format!("{beside}")
    };
    let near = words(40.0);
    assert!(
        near.contains("are the pictures mirrored") && near.contains("one component wrong"),
        "{near}"
    );
    let far = words(295.0);
    assert!(
        far.contains("295 mm beside") && far.contains("another unit") && !far.contains("flip"),
        "{far}"
    );
}

properties! {
    /// The naive way takes the least and the greatest off until no more than two are left.
    #[test]
    fn the_median_lies_midway_between_what_is_left_in_the_middle(
        apart in proptest::collection::vec(proptest::option::weighted(0.8, -30i8..30), 0..9),
    ) {
        let apart: Vec<f64> = apart.iter().map(|mm| mm.map_or(f64::NAN, f64::from)).collect();
        let mut left: Vec<f64> = apart.iter().copied().filter(|mm| !mm.is_nan()).collect();
        let is_film = left.len() > 1;
        while left.len() > 2 {
            let least = (0..left.len()).min_by(|&a, &b| left[a].total_cmp(&left[b])).expect("some");
            left.swap_remove(least);
            let most = (0..left.len()).max_by(|&a, &b| left[a].total_cmp(&left[b])).expect("some");
            left.swap_remove(most);
        }
        let midway = is_film.then(|| left.iter().sum::<f64>() / left.len() as f64);
        prop_assert_eq!(median(&apart, &mut vec![0.0; apart.len()]), midway);
    }
}

/// What is known of a pose is its depth alone, the last of six, and a variance below 0 is none.
#[test]
fn a_depth_is_known_to_the_root_of_its_variance() {
    let sd_mm = |variance: f64| {
        let mut covariance = covariance(&factor(3.0));
        covariance.matrix[5][5] = variance;
        Lying::new(Pose::IDENTITY, Some(&covariance)).depth_sd_mm
    };
    assert_eq!([6.25, 0.0, -1.0].map(sd_mm), [2.5, 0.0, 0.0]);
    assert_eq!(Lying::new(Pose::IDENTITY, None).depth_sd_mm, 0.0);
}

/// Along the view nothing but depth tells how far the parts lie apart; both errors add up as independent ones do.
#[test]
fn both_depths_together_must_be_known_to_what_a_knee_allows() {
    let (middles, most) = middles();
    let (femur, tibia) = knee([30.0, 0.0, 0.0], 5.0);
    let known = |femur_mm: f64, tibia_mm: f64| {
        let lying = |pose: Pose, depth_sd_mm: f64| Lying { pose, depth_sd_mm };
        let mm = middles.known_mm(
            &lying(femur, femur_mm * most),
            &lying(tibia, tibia_mm * most),
        );
        mm.is_finite().then_some(mm)
    };
    assert_eq!(known(0.59, 0.8), Some(middles.apart_mm(&femur, &tibia)));
    assert_eq!([known(0.61, 0.8), known(0.8, 0.61)], [None; 2]);
    assert!(known(0.99, 0.0).is_some() && known(0.0, 1.01).is_none());
    // What is farther off than depth may be is told, however badly that is known.
    let off = |times: f64| {
        let (femur, tibia) = knee([30.0, 0.0, 0.0], times * most);
        let lying = |pose| Lying {
            pose,
            depth_sd_mm: 2.0 * most,
        };
        middles.known_mm(&lying(femur), &lying(tibia)).is_finite()
    };
    // Both together are known to 2.83 times what is allowed.
    assert_eq!(
        [off(12.3), off(-12.3), off(12.4), off(-12.4)],
        [false, false, true, true]
    );
}

#[test]
fn farther_off_than_a_mirror_leaves_it_the_pose_that_is_doubtful_by_itself_is_astray() {
    let (middles, most_mm) = middles();
    let both = [true, false].map(|own| [true, false].map(|other| (own, other)));
    let apart = [5.9, 6.1].map(|times| times * most_mm);
    let [near, far] = apart.map(|mm| told(&middles, &[mm])[0].expect("beside"));
    for (own, other) in both.concat() {
        assert_eq!(near.against(own, other), Some(near));
        let left = far.against(own, other);
        assert_eq!(left.is_none(), own && !other, "{own} {other}");
    }
    let flipped = Some(Flipped {
        mm: 1.0,
        times: 1.5,
        is_better: true,
    });
    let mirrored = Beside { flipped, ..far };
    assert_eq!(mirrored.against(true, false), Some(mirrored));
}
