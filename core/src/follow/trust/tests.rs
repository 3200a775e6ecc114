use super::*;
use crate::follow::fake::turned;
use crate::follow::sides::Rival;

/// Whether the third of five frames is doubtful, 10 mm off the way between those beside it, and the other component so far.
fn jumps(other_mm: Option<[f64; 2]>) -> Option<&'static str> {
    let moved = |k: usize, [right, up]: [f64; 2]| {
        let off = if k == 2 { 1.0 } else { 0.0 };
        [k as f64 + off * right, off * up, -1000.0]
    };
    let film: [FrameEvidence; 5] = core::array::from_fn(|k| {
        let mut found = turned(0.0, 0.1);
        found.pose.translation = moved(k, [10.0, 0.0]);
        FrameEvidence {
            found: Some(found),
            other_middle: other_mm.map(|mm| moved(k, mm)),
            ..FrameEvidence::default()
        }
    });
    let (mut sorted, mut trusts) = ([0.0; 5], [Trust::default(); 5]);
    // Of five frames three jump as far as they can beside that one; a film has more.
    let limits = TrustLimits {
        jump_times: 0.0,
        ..TrustLimits::USUAL
    };
    judge_film(&film, &limits, &[0.0; 3], &mut sorted, &mut trusts);
    trusts[2].distrust.map(|why| why.word())
}

#[test]
fn what_both_components_do_is_no_jump() {
    assert_eq!(jumps(None), Some("jump"));
    assert_eq!(jumps(Some([9.0, 1.0])), None);
    assert_eq!(jumps(Some([-10.0, 0.0])), Some("jump"));
    assert_eq!(jumps(Some([0.0, 10.0])), Some("jump"));
    assert_eq!(jumps(Some([0.0, 0.0])), Some("jump"));
}

/// Of an outline that determines nothing there is no covariance, and of one that hardly determines it a variance may come out below 0.
#[test]
fn what_no_outline_determines_is_doubtful() {
    let told = |change: fn(&mut FramePose)| {
        let mut found = turned(0.0, 0.1);
        change(&mut found);
        let mut trust = Trust::default();
        trust.weigh_fit(&found, &TrustLimits::USUAL, &Usual::default());
        trust.distrust
    };
    assert_eq!(told(|_| {}), None);
    let all = Some(Distrust::Undetermined(ALL_DEG));
    assert_eq!(told(|found| found.covariance = None), all);
    for k in 0..6 {
        let mut found = turned(0.0, 0.1);
        let covariance = found.covariance.as_mut().expect("it has one");
        covariance.matrix[k][k] = -1e-4;
        assert_eq!(open_deg(found.covariance.as_ref()), ALL_DEG, "{k}");
    }
}

#[test]
fn what_lies_behind_the_detector_is_doubtful_before_all_else() {
    let told = |behind_mm: f64| {
        let mut found = turned(0.0, 0.1);
        (found.fit.behind_mm, found.fit.met) = (behind_mm, 0.5);
        let mut trust = Trust::default();
        trust.weigh_fit(&found, &TrustLimits::USUAL, &Usual::default());
        trust.distrust
    };
    assert_eq!(told(0.0), Some(Distrust::Unmet(0.5)));
    assert_eq!(told(980.0), Some(Distrust::Behind(980.0)));
}

#[test]
fn poses_of_a_model_of_no_knees_size_are_doubtful_for_that_before_all_else() {
    let mut found = turned(0.0, 0.1);
    (found.fit.behind_mm, found.fit.implausible_width_mm) = (300.0, 7.9);
    let mut trust = Trust::default();
    trust.weigh_fit(&found, &TrustLimits::USUAL, &Usual::default());
    assert_eq!(trust.distrust, Some(Distrust::ImplausibleSize(7.9)));
}

#[test]
fn what_a_person_fixed_beside_the_edges_is_doubtful_and_a_hands_jitter_is_not() {
    let judged = |misfit_px: f64| {
        let film = [FrameEvidence {
            found: Some(turned(0.0, misfit_px)),
            fixed: true,
            ..FrameEvidence::default()
        }];
        let (mut sorted, mut trusts) = ([0.0], [Trust::default()]);
        let usual = &TrustLimits::USUAL;
        judge_film(&film, usual, &[0.0; 3], &mut sorted, &mut trusts);
        trusts[0].distrust.map(|why| why.word())
    };
    assert_eq!([1.4, 2.9].map(judged), [None, Some("residual")]);
}

#[test]
fn what_leaves_far_more_than_the_better_frames_is_doubtful_though_most_do() {
    let judged = |misfits: &[f64]| -> std::vec::Vec<bool> {
        let seen = |(k, px): (usize, &f64)| FrameEvidence {
            found: Some(turned(k as f64, *px)),
            ..FrameEvidence::default()
        };
        let film: std::vec::Vec<FrameEvidence> = misfits.iter().enumerate().map(seen).collect();
        let count = film.len();
        let (mut sorted, mut trusts) = (std::vec![0.0; count], std::vec![Trust::default(); count]);
        let usual = &TrustLimits::USUAL;
        judge_film(&film, usual, &[0.0; 3], &mut sorted, &mut trusts);
        trusts
            .iter()
            .map(|trust| trust.distrust.is_some())
            .collect()
    };
    let blurred = judged(&[0.2, 0.25, 0.25, 0.7, 0.7, 0.7, 0.7, 0.7]);
    assert_eq!(blurred, [false, false, false, true, true, true, true, true]);
    // Two frames do not tell what is usual.
    assert_eq!(judged(&[0.2, 0.7]), [false, false]);
    assert_eq!(judged(&[0.4, 0.5, 0.6, 0.8]), [false; 4]);
}

#[test]
fn a_pose_between_two_that_may_be_others_is_as_doubtful() {
    let judged = |others: [f64; 3]| {
        let seen = |(k, off): (usize, &f64)| FrameEvidence {
            found: Some(turned(k as f64, 0.1)),
            other_way: (*off != 0.0).then(|| turned(k as f64 + off, 0.1).pose),
            ..FrameEvidence::default()
        };
        let film: std::vec::Vec<FrameEvidence> = others.iter().enumerate().map(seen).collect();
        let (mut sorted, mut trusts) = ([0.0; 3], [Trust::default(); 3]);
        let middle = [0.0; 3];
        judge_film(
            &film,
            &TrustLimits::USUAL,
            &middle,
            &mut sorted,
            &mut trusts,
        );
        trusts.map(|trust| (trust.distrust.map(|why| why.word()), trust.badness))
    };
    let [before, own, after] = judged([8.0, 0.0, 6.0]);
    assert_eq!(
        [before.0, own.0, after.0],
        [Some("two ways"), Some("neighbours"), Some("two ways")]
    );
    assert!(
        own.1 > 1.0 && own.1 == after.1 && after.1 < before.1,
        "{own:?}"
    );
    assert_eq!(judged([8.0, 0.0, 0.0])[1].0, None);
    let [first, ..] = judged([0.0, 8.0, 0.0]);
    assert_eq!(first.0, Some("neighbours"), "it has one beside it");
}

/// How bad the pose of a frame by itself is where 0.4 px and full strength are usual, and why.
fn weighed(change: impl FnOnce(&mut FramePose)) -> (f64, Option<Distrust>) {
    let mut found = turned(0.0, 0.1);
    change(&mut found);
    let usual = Usual {
        misfit_px: 0.4,
        strength: 0.9,
        ..Usual::default()
    };
    let mut trust = Trust::default();
    trust.weigh_fit(&found, &TrustLimits::USUAL, &usual);
    (trust.badness, trust.distrust)
}

fn assert_bad(found: (f64, Option<Distrust>), badness: f64, distrust: Option<Distrust>) {
    assert!((found.0 - badness).abs() < 1e-9, "{found:?}: {badness}");
    assert_eq!(found.1, distrust);
}

/// What is weighed is how many times a limit is passed: at the limit itself a pose is as bad as it may be.
#[test]
fn a_frame_by_itself_is_as_bad_as_what_it_says_in_limits() {
    let strength = |part: f64| weighed(|found| found.contrast.strength = part * 0.9);
    assert_bad(strength(0.75), 0.8, None);
    assert_bad(strength(0.5), 1.2, Some(Distrust::Faint(0.5)));
    // Nothing at all is a hundred times too faint.
    assert_bad(strength(0.0), 60.0, Some(Distrust::Faint(0.0)));
    // 2.3 times what is usual, 0.9 px in any case.
    let misfit = |px: f64| weighed(|found| found.misfit_px = px);
    assert_bad(misfit(0.81), 0.9, None);
    assert_bad(misfit(0.9), 1.0, None);
    assert_bad(misfit(1.8), 2.0, Some(Distrust::Apart(1.8, 0.4)));
    let met = |met: f64| weighed(|found| found.fit.met = met);
    assert_bad(met(0.88), 0.8, None);
    assert_bad(met(0.7), 2.0, Some(Distrust::Unmet(0.7)));
    let known = |known: f64| weighed(|found| found.fit.known = known);
    assert_bad(known(0.75), 0.8, None);
    assert_bad(known(0.5), 1.2, Some(Distrust::Cut(0.5)));
    assert_bad(known(0.0), 60.0, Some(Distrust::Cut(0.0)));
}

#[test]
fn a_misfit_counts_in_what_the_better_frames_leave_or_in_the_least_that_says_something() {
    let apart = |usual_px: f64, px: f64| {
        let usual = Usual {
            misfit_px: usual_px,
            strength: 1.0,
            ..Usual::default()
        };
        let mut trust = Trust::default();
        trust.weigh_fit(&turned(0.0, px), &TrustLimits::USUAL, &usual);
        (trust.badness, trust.distrust)
    };
    assert_bad(apart(0.3, 0.3 * 2.3 * 0.9), 0.9, None);
    assert_bad(
        apart(0.3, 0.3 * 2.3 * 1.2),
        1.2,
        Some(Distrust::Apart(0.3 * 2.3 * 1.2, 0.3)),
    );
    for usual_px in [0.2, 0.1, 0.0] {
        let px = 0.2 * 2.3 * 1.5;
        assert_bad(
            apart(usual_px, px),
            1.5,
            Some(Distrust::Apart(px, usual_px)),
        );
    }
}

/// A film at rest whose other component lies so far behind this one, mm, the middle of the three frames apart.
fn beside(usual_mm: f64, middle_mm: f64, has_other: bool) -> [Trust; 3] {
    let film = [usual_mm, middle_mm, usual_mm].map(|mm| {
        let found = turned(0.0, 0.1);
        let [x, y, z] = found.pose.transform(&[1.0, 2.0, 3.0]);
        FrameEvidence {
            found: Some(found),
            other_middle: has_other.then_some([x, y, z + mm]),
            ..FrameEvidence::default()
        }
    });
    let (mut sorted, mut trusts) = ([0.0; 3], [Trust::default(); 3]);
    let usual = &TrustLimits::USUAL;
    judge_film(&film, usual, &[1.0, 2.0, 3.0], &mut sorted, &mut trusts);
    trusts
}

#[test]
fn components_of_a_joint_lie_at_like_depths_and_as_far_from_each_other_as_is_usual() {
    let told = |usual_mm: f64, middle_mm: f64| {
        let [_, trust, _] = beside(usual_mm, middle_mm, true);
        trust.distrust.map(|why| match why {
            Distrust::Depths(mm) => ("depths", libm::round(mm)),
            Distrust::Joint(mm) => ("joint", libm::round(mm)),
            _ => ("other", 0.0),
        })
    };
    for sign in [1.0, -1.0] {
        assert_eq!(told(sign * 15.0, sign * 54.0), None);
        assert_eq!(
            told(sign * 10.0, sign * 51.0),
            Some(("depths", sign * 41.0))
        );
        assert_eq!(
            told(sign * 10.0, sign * -31.0),
            Some(("depths", sign * -41.0))
        );
        // Whatever is usual.
        assert_eq!(told(sign * 61.0, sign * 61.0), Some(("joint", sign * 61.0)));
        assert_eq!(told(sign * 59.0, sign * 59.0), None);
        let [_, trust, _] = beside(sign * 10.0, sign * 70.0, true);
        assert!((trust.badness - 1.5).abs() < 1e-9, "{trust:?}");
    }
    let [_, trust, _] = beside(0.0, 500.0, false);
    assert_eq!(trust.distrust, None);
    assert!(trust.is_between);
}

/// Both the ways to a frame and its mirror image are weighed in their limits, and the worse is told.
#[test]
fn of_all_that_is_doubtful_the_worst_is_told() {
    let judged = |ways_deg: f64, margin: f64, misfit_px: f64| {
        let film = [FrameEvidence {
            found: Some(turned(0.0, misfit_px)),
            other_way: Some(turned(ways_deg, 0.1).pose),
            side_margin: Some(SideMargin {
                rival: Rival::Mirrored,
                margin,
                apart_deg: 20.0,
            }),
            ..FrameEvidence::default()
        }];
        let (mut sorted, mut trusts) = ([0.0], [Trust::default()]);
        judge_film(
            &film,
            &TrustLimits::USUAL,
            &[0.0; 3],
            &mut sorted,
            &mut trusts,
        );
        let [trust] = trusts;
        (
            trust.distrust.map(|why| why.word()),
            trust.badness,
            trust.by_itself,
        )
    };
    let near =
        |found: (Option<&'static str>, f64, f64), word: Option<&'static str>, badness: f64| {
            assert!(
                found.0 == word && (found.1 - badness).abs() < 1e-6,
                "{found:?}"
            );
        };
    near(judged(1.2, 1.5, 0.1), None, 0.8);
    near(judged(1.8, 1.5, 0.1), Some("two ways"), 1.2);
    near(judged(1.8, 0.5, 0.1), Some("ambiguous"), 1.5);
    near(judged(3.0, 0.5, 0.1), Some("two ways"), 2.0);
    near(judged(3.0, 0.5, 2.7), Some("residual"), 3.0);
    let (.., by_itself) = judged(9.0, 0.0, 0.45);
    assert!(
        (by_itself - 0.5).abs() < 0.3 && by_itself < 1.0,
        "{by_itself}"
    );
}

#[test]
fn a_frame_without_a_pose_is_neither_good_nor_bad() {
    let film = [FrameEvidence::default(); 2];
    let (mut sorted, mut trusts) = (
        [0.0; 2],
        [Trust {
            badness: 9.0,
            ..Trust::default()
        }; 3],
    );
    judge_film(
        &film,
        &TrustLimits::USUAL,
        &[0.0; 3],
        &mut sorted,
        &mut trusts,
    );
    assert_eq!(trusts[..2], [Trust::default(); 2]);
    assert_eq!(trusts[2].badness, 9.0, "beyond the film");
}

/// What leaves too much is no other pose: it says of those beside it nothing.
#[test]
fn a_pose_between_two_that_are_doubtful_for_themselves_is_not() {
    let film = [2.7, 0.1, 2.7].map(|misfit_px| FrameEvidence {
        found: Some(turned(0.0, misfit_px)),
        ..FrameEvidence::default()
    });
    let (mut sorted, mut trusts) = ([0.0; 3], [Trust::default(); 3]);
    judge_film(
        &film,
        &TrustLimits::USUAL,
        &[0.0; 3],
        &mut sorted,
        &mut trusts,
    );
    let words = trusts.map(|trust| trust.distrust.map(|why| why.word()));
    assert_eq!(words, [Some("residual"), None, Some("residual")]);
}

/// However many poses a person gave, and however much those leave: a hand does not see a pixel.
#[test]
fn what_hands_leave_is_not_what_is_usual() {
    let doubtful = |hands: usize, hand_px: f64| {
        let one = |misfit_px: f64, fixed: bool| FrameEvidence {
            found: Some(turned(0.0, misfit_px)),
            fixed,
            ..FrameEvidence::default()
        };
        let mut film = std::vec![one(hand_px, true); hands];
        film.extend([0.3, 0.3, 0.3, 0.85].map(|px| one(px, false)));
        let (mut sorted, mut trusts) = (
            std::vec![0.0; film.len()],
            std::vec![Trust::default(); film.len()],
        );
        judge_film(
            &film,
            &TrustLimits::USUAL,
            &[0.0; 3],
            &mut sorted,
            &mut trusts,
        );
        let is_doubtful = |trust: &Trust| trust.distrust.is_some();
        trusts.iter().map(is_doubtful).collect::<std::vec::Vec<_>>()
    };
    for (hands, hand_px) in [(0, 0.0), (1, 1.9), (8, 1.9), (8, 0.05)] {
        let mut wanted = std::vec![false; hands + 4];
        wanted[hands + 3] = true;
        assert_eq!(doubtful(hands, hand_px), wanted, "{hands} {hand_px}");
    }
}

/// The one lies as much farther away than the other as the other lies nearer: what is usual of it is the same seen from either.
#[test]
fn how_far_both_components_lie_apart_is_doubted_of_both_alike() {
    let doubtful = |apart: &[f64], from_other: bool| {
        let one = |&mm: &f64| {
            let (own, other) = if from_other { (-mm, 0.0) } else { (0.0, -mm) };
            let mut found = turned(0.0, 0.1);
            found.pose.translation = [0.0, 0.0, own - 900.0];
            FrameEvidence {
                found: Some(found),
                other_middle: Some([0.0, 0.0, other - 900.0]),
                ..FrameEvidence::default()
            }
        };
        let film: std::vec::Vec<FrameEvidence> = apart.iter().map(one).collect();
        let count = film.len();
        let (mut sorted, mut trusts) = (std::vec![0.0; count], std::vec![Trust::default(); count]);
        let usual = &TrustLimits::USUAL;
        judge_film(&film, usual, &[0.0; 3], &mut sorted, &mut trusts);
        let word = |trust: &Trust| trust.distrust.map(|why| why.word());
        trusts.iter().map(word).collect::<std::vec::Vec<_>>()
    };
    for apart in [
        &[0.0, 50.0][..],
        &[-25.0, 25.0],
        &[30.0, -55.0],
        &[3.0],
        &[4.0, 5.0, 50.0, 55.0],
        &[4.0, 5.0, 6.0, 50.0],
    ] {
        assert_eq!(doubtful(apart, true), doubtful(apart, false), "{apart:?}");
    }
    // Of two nobody tells which is usual.
    assert_eq!(doubtful(&[0.0, 50.0], true), [None; 2]);
    assert_eq!(doubtful(&[-58.0, 58.0], true), [Some("depths"); 2]);
}
