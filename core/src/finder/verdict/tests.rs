use super::*;
use crate::finder::choice::Reason;
use crate::math::{radians, rotation_by};
use crate::pose::covariance::PoseCovariance;
use crate::refine::Refined;
use std::format;
use std::string::ToString;

#[test]
fn one_degree_is_not_several_and_none_is_told_as_a_shift() {
    for (turn_deg, words) in [(0.4, "12 mm away"), (1.2, "1 degree "), (1.6, "2 degrees")] {
        let doubt = Doubt::Open {
            turn_deg,
            shift_mm: 12.0,
            other_px: 0.3,
        };
        assert!(doubt.to_string().contains(words), "{doubt}");
    }
}
#[test]
fn what_has_few_pixels_is_no_good_fit() {
    let judged = |size_px: f64| {
        let fit = Fit {
            size_px,
            met: 1.0,
            known: 1.0,
            ..Fit::default()
        };
        judge_fit(&fit, true, &Limits::USUAL)
    };
    assert_eq!(judged(150.0), Verdict::Good);
    assert_eq!(judged(7.0), Verdict::Doubtful(Doubt::Small { px: 7.0 }));
}

#[test]
fn what_is_asked_is_asked_in_the_squares_that_the_frame_was_looked_at_in() {
    let fit = |misfit_px, size_px| Fit {
        misfit_px,
        size_px,
        met: 1.0,
        known: 1.0,
        square_px: 1,
        ..Fit::default()
    };
    let judged = |fit: Fit, side| judge_fit(&fit.in_pixels(side), true, &Limits::USUAL);
    for side in [1, 2, 4] {
        assert_eq!(judged(fit(1.9, 150.0), side), Verdict::Good);
        let [px, limit_px] = [2.1, 2.0].map(|px| side as f64 * px);
        let apart = Doubt::Apart { px, limit_px };
        assert_eq!(judged(fit(2.1, 150.0), side), Verdict::Doubtful(apart));
        let unmet = Fit {
            met: 0.8,
            ..fit(0.1, 150.0)
        };
        let within = format!("within {} px", 3 * side);
        assert!(judged(unmet, side).to_string().contains(&within));
        let small = Doubt::Small {
            px: side as f64 * 19.0,
        };
        assert_eq!(judged(fit(0.1, 19.0), side), Verdict::Doubtful(small));
    }
}

#[test]
fn a_model_of_no_knees_size_is_never_good() {
    let judged = |implausible_width_mm: f64| {
        let fit = Fit {
            size_px: 150.0,
            met: 1.0,
            known: 1.0,
            behind_mm: 20.0,
            implausible_width_mm,
            ..Fit::default()
        };
        judge_fit(&fit, true, &Limits::USUAL).to_string()
    };
    assert!(judged(0.0).contains("behind the detector"));
    assert!(judged(7.93).contains("7.93 mm across"), "{}", judged(7.93));
}

#[test]
fn what_lies_beyond_the_frame_is_not_known() {
    let judged = |beyond: f64| {
        let fit = Fit {
            size_px: 150.0,
            met: 1.0,
            known: 0.8,
            beyond,
            ..Fit::default()
        };
        judge_fit(&fit, true, &Limits::USUAL)
    };
    assert_eq!(judged(0.2), Verdict::Good);
    assert!(matches!(judged(0.5), Verdict::Doubtful(Doubt::Unknown { known }) if known == 0.4));
}

/// A covariance may say that next to nothing is known: of a round part it always is there, with any turn about the axis.
#[test]
fn a_pose_is_determined_where_its_rotation_is_known() {
    let known = |deg: f64| {
        let mut matrix = [[0.0; 6]; 6];
        (0..6).for_each(|k| matrix[k][k] = 1e-6);
        matrix[1][1] = crate::math::radians(deg) * crate::math::radians(deg);
        is_determined(Some(&PoseCovariance { matrix }))
    };
    assert!(known(0.5) && known(3.9));
    assert!(!known(4.1) && !known(104.0) && !known(f64::NAN) && !known(f64::INFINITY));
    assert!(!is_determined(None));
}

fn candidate(misfit_px: f64, met: f64) -> Candidate {
    let pose = crate::pose::Pose::IDENTITY;
    let mut refined = crate::refine::Refined::at(pose);
    refined.loss = misfit_px * misfit_px / 2.0;
    Candidate {
        pose,
        start: pose,
        located: None,
        refined: Some(refined),
        covariance: None,
        fit: Fit {
            size_px: 150.0,
            met,
            known: 1.0,
            misfit_px,
            ..Fit::default()
        },
    }
}

/// Gives a pose a covariance that determines it.
fn known(one: &mut Candidate) {
    let mut information = [[0.0; 6]; 6];
    (0..6).for_each(|k| information[k][k] = 1e6);
    one.covariance = PoseCovariance::from_information(&information);
}

/// Twice the standard deviations of the chosen pose hold what is no other pose; depth is known by one view alone.
#[test]
fn what_the_plus_minus_holds_is_no_other_pose() {
    let judged = |(turn_deg, farther_mm): (f64, f64), depth_mm: f64| {
        let mut all = [candidate(0.1, 1.0), candidate(0.1, 1.0)];
        let mut matrix = [[0.0; 6]; 6];
        (0..3).for_each(|k| matrix[k][k] = radians(0.6) * radians(0.6));
        matrix[5][5] = 9.0;
        all[0].covariance = Some(PoseCovariance { matrix });
        let turn = crate::math::rotation_by(&[0.0, radians(turn_deg), 0.0]);
        all[1].pose.rotation = turn;
        all[0].fit.depth_mm = depth_mm;
        all[1].fit.depth_mm = depth_mm + farther_mm;
        let open = Some(OpenRival {
            index: 1,
            chosen_px: 0.1,
            other_px: 0.1,
        });
        let reason = super::super::choice::Reason::Only;
        let choice = Choice {
            index: 0,
            reason,
            open,
            no_knee_deg: None,
        };
        judge(&all, &choice, &Limits::USUAL) == Some(Verdict::Good)
    };
    // 0.6 degrees about each of three axes are 1.04 as a whole.
    assert!(judged((2.0, 5.9), 1000.0) && judged((2.0, -5.9), 1000.0));
    assert!(!judged((2.1, 0.0), 1000.0));
    assert!(!judged((0.0, 6.1), 1000.0) && !judged((0.0, -6.1), 1000.0));
    assert!(!judged((1.0, 0.0), 0.0));
}

#[test]
fn a_refined_pose_without_a_covariance_is_undetermined_and_another_that_fits_leaves_it_open() {
    let judged = |change: fn(&mut Candidate), open: Option<usize>| {
        let mut all = [candidate(0.1, 1.0), candidate(0.2, 1.0)];
        change(&mut all[0]);
        all[1].pose.rotation = crate::math::rotation_by(&[0.0, crate::math::radians(9.0), 0.0]);
        let open = open.map(|index| OpenRival {
            index,
            chosen_px: 0.1,
            other_px: 0.2,
        });
        let reason = super::super::choice::Reason::Only;
        let choice = Choice {
            index: 0,
            reason,
            open,
            no_knee_deg: None,
        };
        judge(&all, &choice, &Limits::USUAL).map(|verdict| match verdict {
            Verdict::Doubtful(Doubt::Open {
                turn_deg, other_px, ..
            }) => (libm::round(turn_deg), other_px > 0.19),
            Verdict::Doubtful(Doubt::Undetermined) => (-1.0, false),
            Verdict::Good => (0.0, false),
            other => panic!("{other}"),
        })
    };
    let open_by_a_turn = |one: &mut Candidate| {
        let mut matrix = [[0.0; 6]; 6];
        matrix[1][1] = radians(OTHER_DEG + 0.1) * radians(OTHER_DEG + 0.1);
        one.covariance = Some(PoseCovariance { matrix });
    };
    assert_eq!(judged(|_| {}, None), Some((-1.0, false)));
    assert_eq!(judged(open_by_a_turn, None), Some((-1.0, false)));
    assert_eq!(judged(known, None), Some((0.0, false)));
    assert_eq!(judged(|one| one.refined = None, None), Some((0.0, false)));
    assert_eq!(judged(known, Some(1)), Some((9.0, true)));
    assert_eq!(judged(known, Some(7)), Some((0.0, false)));
}

#[test]
fn what_was_not_found_has_no_verdict_and_what_is_no_knee_is_told() {
    let none = Choice {
        index: 3,
        reason: super::super::choice::Reason::Only,
        open: None,
        no_knee_deg: None,
    };
    assert_eq!(judge(&[candidate(0.1, 1.0)], &none, &Limits::USUAL), None);
    let no_knee = Choice {
        index: 0,
        no_knee_deg: Some(79.4),
        ..none
    };
    let mut all = [candidate(0.1, 1.0)];
    known(&mut all[0]);
    let verdict = judge(&all, &no_knee, &Limits::USUAL).expect("one");
    assert!(
        verdict.to_string().contains("79\u{b0} from the other"),
        "{verdict}"
    );
}

#[test]
fn what_does_not_fit_at_all_is_no_rival_while_another_does() {
    let misfits = |mets: [f64; 2]| {
        let all = mets.map(|met| candidate(0.5, met));
        let rivals = contenders(&all);
        [0, 1].map(|k| rivals[k].residual_px.is_finite())
    };
    let least = Limits::USUAL.least_met;
    assert_eq!(misfits([least, least]), [true; 2]);
    assert_eq!(misfits([least, least - 0.01]), [true, false]);
    assert_eq!(misfits([least - 0.01, least]), [false, true]);
    assert_eq!(misfits([least - 0.01, least - 0.02]), [true; 2]);
}

#[test]
fn parts_of_an_outline_are_told_in_percent() {
    let unknown = Doubt::Unknown { known: 0.4 }.to_string();
    assert!(unknown.contains("only 40 % of"), "{unknown}");
    let refused = Refusal::NoFit {
        misfit_px: 3.21,
        met: 0.25,
    };
    let refused = refused.to_string();
    assert!(refused.contains("3.2 px, and 25 % of"), "{refused}");
}

/// Another pose turned by so many degrees, which leaves so many times as much, beside one of which a part lies beyond the frame and that the joint or the
/// film chose.
fn judged_beside(beyond: f64, deg: f64, times: f64) -> Verdict {
    let candidate = |deg: f64, misfit_px: f64| {
        let rotation = rotation_by(&[0.0, radians(deg), 0.0]);
        let pose = Pose {
            rotation,
            ..Pose::IDENTITY
        };
        Candidate {
            pose,
            start: pose,
            located: None,
            refined: Some(Refined {
                loss: misfit_px * misfit_px / 2.0,
                ..Refined::at(pose)
            }),
            covariance: Some(PoseCovariance {
                matrix: [[0.0; 6]; 6],
            }),
            fit: Fit {
                size_px: 150.0,
                met: 1.0,
                known: 1.0,
                misfit_px,
                beyond,
                ..Fit::default()
            },
        }
    };
    let candidates = [candidate(0.0, 0.5), candidate(deg, 0.5 * times)];
    let choice = Choice {
        index: 0,
        reason: Reason::Film { saved_deg: 40.0 },
        open: None,
        no_knee_deg: None,
    };
    let verdict = judge(&candidates, &choice, &Limits::USUAL).expect("some");
    // Whoever chooses anew among them later has that of each.
    assert_eq!(judge_one(&candidates, 0, &Limits::USUAL), Some(verdict));
    verdict
}

#[test]
fn where_an_end_is_cut_off_joint_and_film_alone_make_nothing_good() {
    for (beyond, deg, times, is_good) in [
        (0.21, 10.0, 1.29, false),
        (0.21, -10.0, 0.8, false),
        (0.21, 49.9, 1.0, false),
        // A whole outline, one pose as noise has it, one that no knee allows, one that the residual rules out.
        (0.2, 10.0, 1.29, true),
        (0.21, 3.9, 1.0, true),
        (0.21, 50.1, 1.0, true),
        (0.21, 10.0, 1.31, true),
    ] {
        let verdict = judged_beside(beyond, deg, times);
        assert_eq!(verdict == Verdict::Good, is_good, "{beyond} {deg} {times}");
        if !is_good {
            assert!(verdict.to_string().contains("0 degrees away"), "{verdict}");
        }
    }
    // Of less than six tenths nothing is good, whatever fits.
    assert!(matches!(
        judged_beside(0.41, 10.0, 9.0),
        Verdict::Doubtful(Doubt::Unknown { .. })
    ));
    assert_eq!(judged_beside(0.39, 10.0, 9.0), Verdict::Good);
}
