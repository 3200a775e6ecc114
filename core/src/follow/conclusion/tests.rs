use super::*;
use crate::mesh::anatomy::KneeComponent;

#[test]
fn distances_in_squares_are_told_in_pixels() {
    let one = |why| Conclusion {
        state: State::Doubtful,
        pose: None,
        why,
        badness: 1.5,
    };
    let apart = |px, usual_px| one(Why::Distrusted(Distrust::Apart(px, usual_px)));
    assert_eq!(apart(0.6, 0.25).in_pixels(4), apart(2.4, 1.0));
    assert_eq!(apart(0.6, 0.25).in_pixels(0), apart(0.6, 0.25));
    let other = one(Why::Distrusted(Distrust::Jump(3.0, 2.0)));
    assert_eq!(other.in_pixels(2), other);
}

#[test]
fn few_good_poses_among_many_doubtful_ones_are_doubtful_and_what_a_person_fixed_is_not() {
    let judged = |good: usize, doubtful: usize| {
        let one = |state, why| Conclusion {
            state,
            pose: None,
            why,
            badness: 0.5,
        };
        let doubt = Why::Distrusted(Distrust::Unmet(0.5));
        let mut film = std::vec![one(State::Followed, Why::Agrees); good];
        film.extend(std::vec![one(State::Doubtful, doubt); doubtful]);
        film.push(one(State::Fixed, Why::GivenByPerson));
        film.push(one(State::Untrackable, Why::Hidden));
        doubt_few(&mut film);
        assert!(film.iter().take(good).all(Conclusion::stands_by_itself));
        assert_eq!(film[good + doubtful].why, Why::GivenByPerson);
        film.iter().filter(|one| one.is_trusted()).count() - 1
    };
    assert_eq!(judged(2, 10), 0);
    assert_eq!(judged(3, 9), 3);
    assert_eq!(judged(1, 3), 1);
    assert_eq!(judged(1, 4), 0);
    assert_eq!(judged(5, 0), 5);
    assert_eq!(judged(0, 0), 0);
}

#[test]
fn a_pose_between_two_doubtful_ones_is_doubtful_where_either_may_be_another_pose() {
    let ways = Why::Distrusted(Distrust::Ways(12.0));
    let unmet = Why::Distrusted(Distrust::Unmet(0.5));
    let judged = |whys: &[Why]| {
        let one = |&why: &Why| Conclusion {
            state: match why {
                Why::Distrusted(_) => State::Doubtful,
                Why::GivenByPerson => State::Fixed,
                Why::Hidden => State::Untrackable,
                _ => State::Followed,
            },
            pose: None,
            why,
            badness: 0.5,
        };
        let mut film: std::vec::Vec<_> = whys.iter().map(one).collect();
        doubt_between_doubts(&mut film);
        let trusted = film.iter().map(Conclusion::is_trusted);
        trusted.collect::<std::vec::Vec<_>>()
    };
    let (agrees, given) = (Why::Agrees, Why::GivenByPerson);
    assert_eq!(judged(&[ways, agrees, unmet]), [false; 3]);
    assert_eq!(judged(&[unmet, agrees, ways]), [false; 3]);
    // Neither is another pose; one of them is good; a person gave it; it agrees with nobody.
    assert!(judged(&[unmet, agrees, unmet])[1]);
    assert_eq!(judged(&[ways, agrees, agrees, ways])[1..3], [true; 2]);
    assert!(judged(&[ways, given, ways])[1]);
    assert_eq!(
        judged(&[Why::AgreesAlone, ways, agrees]),
        [true, false, true]
    );
    assert!(judged(&[ways, agrees, Why::Hidden])[1]);
    // Each by itself.
    assert_eq!(judged(&[ways, agrees, ways, agrees, ways]), [false; 5]);
    assert!(judged(&[]).is_empty());
}

#[test]
fn what_a_person_gave_and_what_is_not_there_cannot_become_doubtful() {
    let shape = Distrust::Shape(KneeComponent::Femur);
    let after = |state, why| {
        let mut one = Conclusion {
            state,
            pose: None,
            why,
            badness: 0.5,
        };
        one.distrust(shape);
        (one.state, one.why)
    };
    let agrees = Why::Agrees;
    let doubtful = (State::Doubtful, Why::Distrusted(shape));
    assert_eq!(after(State::Followed, agrees), doubtful);
    assert_eq!(after(State::Interpolated, Why::Hidden), doubtful);
    let known = Why::Distrusted(Distrust::Unmet(0.5));
    assert_eq!(after(State::Doubtful, known), (State::Doubtful, known));
    let given = Why::GivenByPerson;
    assert_eq!(after(State::Fixed, given), (State::Fixed, given));
    let outside = Why::Outside(0.1);
    assert_eq!(
        after(State::Untrackable, outside),
        (State::Untrackable, outside)
    );
}

#[test]
fn a_reason_is_a_sentence_with_its_figure() {
    let words = |why: Why| std::format!("{why}");
    assert_eq!(
        words(Why::Outside(0.25)),
        "only 25 % of the component would be in the frame"
    );
    let unmet = words(Why::Distrusted(Distrust::Unmet(0.5)));
    assert_eq!(unmet, "residual: only 50 % of the outline is met by edges");
    let all = [
        Why::NeverReached,
        Why::GivenByPerson,
        Why::Agrees,
        Why::AgreesAlone,
        Why::Hidden,
        Why::Blank,
    ]
    .map(words);
    for (k, one) in all.iter().enumerate() {
        assert!(
            !one.is_empty() && !one.ends_with('.') && !all[..k].contains(one),
            "{one}"
        );
    }
    let mut one = Conclusion {
        state: State::Interpolated,
        pose: None,
        why: Why::Hidden,
        badness: 0.0,
    };
    assert_eq!(
        std::format!("{one}"),
        std::format!("taken from the frames on both sides; {}", all[4])
    );
    one.state = State::Untrackable;
    assert_eq!(std::format!("{one}"), all[4]);
}

#[test]
fn a_frame_comes_to_what_was_found_and_how_far_that_is_to_be_trusted() {
    use crate::follow::fake::{looked, turned};
    let found = turned(3.0, 0.3);
    let doubt = Distrust::Unmet(0.5);
    let missing = |why| Cell::on_the_way(looked(Err(why)));
    let seen = Cell::on_the_way(looked(Ok(found)));
    let fixed = Cell {
        fixed: true,
        ..seen
    };
    let trust = |distrust, is_between| Trust {
        distrust,
        is_between,
        badness: 0.7,
        by_itself: 0.2,
    };
    for is_between in [true, false] {
        let agrees = if is_between {
            Why::Agrees
        } else {
            Why::AgreesAlone
        };
        for (cell, distrust, state, why) in [
            (seen, None, State::Followed, agrees),
            (seen, Some(doubt), State::Doubtful, Why::Distrusted(doubt)),
            (fixed, None, State::Fixed, Why::GivenByPerson),
            (fixed, Some(doubt), State::Fixed, Why::Distrusted(doubt)),
            (Cell::default(), None, State::Unsolved, Why::NeverReached),
            (
                missing(Missing::Outside),
                None,
                State::Untrackable,
                Why::Outside(1.0),
            ),
            (
                missing(Missing::Hidden),
                None,
                State::Untrackable,
                Why::Hidden,
            ),
            (
                missing(Missing::Blank),
                None,
                State::Untrackable,
                Why::Blank,
            ),
        ] {
            let one = Conclusion::of(&cell, &trust(distrust, is_between));
            assert_eq!((one.state, one.why, one.badness), (state, why, 0.7));
            assert_eq!(one.pose, cell.found().map(|found| found.pose));
            let is_good = matches!(state, State::Followed | State::Fixed) && distrust.is_none();
            assert_eq!(
                (one.is_trusted(), one.stands_by_itself()),
                (is_good, is_good)
            );
        }
    }
}

#[test]
fn a_reason_that_explains_all_doubts_takes_the_place_of_any() {
    let (first, before_all) = (Distrust::Unmet(0.5), Distrust::Shape(KneeComponent::Tibia));
    let after = |state, why, badness| {
        let mut one = Conclusion {
            state,
            pose: None,
            why,
            badness,
        };
        one.distrust_before_all(before_all);
        (one.state, one.why, one.badness)
    };
    let told = Why::Distrusted(before_all);
    let doubt = Why::Distrusted(first);
    assert_eq!(
        after(State::Doubtful, doubt, 1.5),
        (State::Doubtful, told, 1.5)
    );
    assert_eq!(
        after(State::Followed, Why::Agrees, 0.5),
        (State::Doubtful, told, 2.0)
    );
    assert_eq!(
        after(State::Interpolated, Why::Hidden, 3.0),
        (State::Doubtful, told, 3.0)
    );
    assert_eq!(after(State::Fixed, doubt, 1.5), (State::Fixed, doubt, 1.5));
    let hidden = (State::Untrackable, Why::Hidden, 0.0);
    assert_eq!(after(hidden.0, hidden.1, hidden.2), hidden);
}

/// Frames 0, 4 and 9 have poses, each turned and shifted by as much as its number says.
#[test]
fn short_gaps_between_poses_to_be_trusted_are_filled_evenly() {
    let posed = |frame: usize| crate::follow::fake::turned(frame as f64, 0.1).pose;
    let film = |distrusted: Option<usize>, longest: usize| {
        let one = |frame: usize| {
            let known = [0, 4, 9].contains(&frame);
            let agrees = distrusted != Some(frame);
            Conclusion {
                state: if known {
                    State::Followed
                } else {
                    State::Untrackable
                },
                pose: known.then(|| posed(frame)),
                why: match (known, agrees) {
                    (true, true) => Why::Agrees,
                    (true, false) => Why::Distrusted(Distrust::Unmet(0.5)),
                    _ => Why::Hidden,
                },
                badness: 0.0,
            }
        };
        let mut film: std::vec::Vec<Conclusion> = (0..12).map(one).collect();
        fill_gaps(&mut film, longest, &[1.0, 2.0, 3.0]);
        film
    };
    let filled = |distrusted, longest| -> std::vec::Vec<usize> {
        let film = film(distrusted, longest);
        let is_filled = |frame: &usize| film[*frame].state == State::Interpolated;
        (0..12).filter(is_filled).collect()
    };
    assert_eq!(filled(None, 4), [1, 2, 3, 5, 6, 7, 8]);
    assert_eq!(filled(None, 3), [1, 2, 3]);
    assert!(filled(None, 2).is_empty() && filled(Some(4), 9).is_empty());
    assert_eq!(filled(Some(0), 9), [5, 6, 7, 8]);
    for (frame, one) in film(None, 9).iter().enumerate().take(10) {
        let pose = one.pose.expect("all of them");
        let off = crate::pose::geodesic_deg(&pose.rotation, &posed(frame).rotation);
        assert!(off < 1e-6, "{frame}: {off}");
    }
}
