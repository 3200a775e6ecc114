//! The order of settling, with made-up frames.

use super::*;
use crate::follow::fake::{looked, turned};
use crate::follow::look::Missing;
use crate::pose::geodesic_deg;

const FRAMES: usize = 9;

fn film() -> Vec<Cell> {
    let seen = |frame: usize| Cell::on_the_way(looked(Ok(turned(frame as f64, 0.2))));
    (0..FRAMES).map(seen).collect()
}

/// The words of the steps, with a film in which every other pose leaves so many times as much.
fn order(times: f64) -> Vec<&'static str> {
    let mut cells = film();
    let mut settling = Settling::new([0.0; 3], 0..FRAMES);
    let mut words = Vec::new();
    while let Some(step) = settling.next(&mut cells) {
        words.push(match step {
            SettlingStep::Cross(_) => "cross",
            SettlingStep::See(rival, frames) => {
                for frame in frames {
                    let own = *cells[frame].found().expect("it was seen");
                    settling.saw(SideSample {
                        frame,
                        own,
                        rival,
                        other: Some(turned(frame as f64 + 20.0, times * own.misfit_px)),
                        fixed: false,
                    });
                }
                match rival {
                    Rival::Mirrored => "sides",
                    Rival::Elsewhere => "elsewhere",
                }
            }
            SettlingStep::Choose => {
                settling.choose(None);
                "choose"
            }
            SettlingStep::GoOver(runs) => {
                for (run, anchor) in runs {
                    let there = turned(anchor.frame as f64 + 20.0, 0.0).pose;
                    let off = geodesic_deg(&there.rotation, &anchor.found.pose.rotation);
                    assert!(off < 1e-6, "{off}");
                    for frame in run {
                        assert!(cells[frame].found().is_none(), "it is cleared");
                        let found = turned(frame as f64 + 20.0, times * 0.2);
                        cells[frame] = Cell::on_the_way(looked(Ok(found)));
                    }
                }
                "go over"
            }
            SettlingStep::LookAgain(_) => "again",
        });
        assert!(words.len() < 40, "it ends: {words:?}");
    }
    words
}

/// A way on the other side that leads back, or nowhere.
#[test]
fn frames_stay_on_the_side_that_was_chosen() {
    let mut cells = film();
    let mut settling = Settling::new([0.0; 3], 0..FRAMES);
    let SettlingStep::See(..) = settling.next(&mut cells).expect("sides") else {
        panic!("both sides are seen first");
    };
    let other = |frame: usize| turned(frame as f64 + 20.0, 0.05);
    for (frame, cell) in cells.iter().enumerate() {
        settling.saw(SideSample {
            frame,
            own: *cell.found().expect("it was seen"),
            rival: Rival::Mirrored,
            other: Some(other(frame)),
            fixed: false,
        });
    }
    settling.next(&mut cells);
    settling.choose(None);
    settling.next(&mut cells);
    cells = film();
    for cell in &mut cells[..4] {
        *cell = Cell::default();
    }
    settling.next(&mut cells);
    for (frame, cell) in cells.iter().enumerate() {
        assert_eq!(cell.found(), Some(&other(frame)));
    }
}

/// Nothing is seen on the other side there, and the frames beside it leave less on it.
#[test]
fn a_frame_that_is_lost_on_the_way_over_has_the_pose_that_it_had() {
    let mut cells = film();
    let mut settling = Settling::new([0.0; 3], 0..FRAMES);
    let runs = loop {
        match settling.next(&mut cells).expect("the other side") {
            SettlingStep::See(rival, frames) => {
                for frame in frames {
                    let other = turned(frame as f64 + 20.0, 0.05);
                    settling.saw(SideSample {
                        frame,
                        own: *cells[frame].found().expect("it was seen"),
                        rival,
                        other: Some(other).filter(|_| frame != 3),
                        fixed: false,
                    });
                }
            }
            SettlingStep::Choose => settling.choose(None),
            SettlingStep::GoOver(runs) => break runs,
            _ => panic!("sides come first"),
        }
    };
    for frame in runs.into_iter().flat_map(|(run, _)| run) {
        let found = turned(frame as f64 + 20.0, 0.05);
        let found = (frame != 3).then_some(found).ok_or(Missing::Hidden);
        cells[frame] = Cell::on_the_way(looked(found));
    }
    settling.next(&mut cells);
    let turns = cells.iter().map(|cell| {
        let pose = cell.found().expect("none is lost").pose;
        libm::round(geodesic_deg(
            &pose.rotation,
            &turned(0.0, 0.0).pose.rotation,
        ))
    });
    assert_eq!(
        turns.collect::<Vec<_>>(),
        [20.0, 21.0, 22.0, 3.0, 24.0, 25.0, 26.0, 27.0, 28.0]
    );
}

/// Seen are frames 2, 6, 10 and so on; then the way comes to another pose in frame 12.
#[test]
fn a_way_that_rocks_after_sides_were_chosen_is_seen_from_both_sides_there() {
    let mut cells: Vec<Cell> = (0..24)
        .map(|_| Cell::on_the_way(looked(Ok(turned(0.0, 0.2)))))
        .collect();
    let mut settling = Settling::new([0.0; 3], 0..24);
    let see = |settling: &mut Settling, cells: &mut [Cell]| {
        let Some(SettlingStep::See(Rival::Mirrored, frames)) = settling.next(cells) else {
            return Vec::new();
        };
        for &frame in &frames {
            let own = *cells[frame].found().expect("it was seen");
            let (rival, other) = (Rival::Mirrored, Some(turned(7.0, 0.4)));
            settling.saw(SideSample {
                frame,
                own,
                rival,
                other,
                fixed: false,
            });
        }
        frames
    };
    assert_eq!(see(&mut settling, &mut cells), [2, 6, 10, 14, 18, 22]);
    settling.next(&mut cells);
    settling.choose(None);
    cells[12] = Cell::on_the_way(looked(Ok(turned(6.0, 0.2))));
    assert_eq!(see(&mut settling, &mut cells), [11, 12, 13]);
    settling.next(&mut cells);
    settling.choose(None);
    assert_eq!(see(&mut settling, &mut cells), [], "each is seen once");
}

/// Frames 4, 20 and 36 of 48 are seen first; what lies behind the last is not between two.
#[test]
fn frames_between_two_that_tell_are_not_seen() {
    let seen = |apart_deg: f64, times: f64, left_px: f64| {
        let mut cells: Vec<Cell> = (0..48)
            .map(|_| Cell::on_the_way(looked(Ok(turned(0.0, 0.2)))))
            .collect();
        cells[11] = Cell::on_the_way(looked(Ok(turned(0.0, left_px))));
        let mut settling = Settling::new([0.0; 3], 0..48);
        let mut all = Vec::new();
        loop {
            match settling.next(&mut cells) {
                Some(SettlingStep::See(Rival::Mirrored, frames)) => {
                    for &frame in &frames {
                        let own = *cells[frame].found().expect("it was seen");
                        settling.saw(SideSample {
                            frame,
                            own,
                            rival: Rival::Mirrored,
                            other: Some(turned(apart_deg, times * own.misfit_px)),
                            fixed: false,
                        });
                    }
                    all.extend(frames);
                }
                Some(SettlingStep::Choose) => settling.choose(None),
                _ => break,
            }
        }
        all.sort_unstable();
        all
    };
    let every = [4, 12, 20, 28, 36, 44];
    assert_eq!(seen(40.0, 2.0, 0.2), [4, 20, 36, 44]);
    assert_eq!(seen(40.0, 2.0, 0.3), [4, 12, 20, 36, 44], "one leaves more");
    assert_eq!(seen(40.0, 1.05, 0.2), every, "nothing tells");
    assert_eq!(
        seen(10.0, 2.0, 0.2),
        every,
        "both sides are near each other"
    );
    assert_eq!(seen(40.0, 0.3, 0.2), every, "the other side is right");
}

/// A frame that leaves more than the others, and less where they lead.
#[test]
fn what_was_mended_is_seen_from_all_sides_again() {
    let words = |is_mended: bool| {
        let mut cells = film();
        cells[4] = Cell::on_the_way(looked(Ok(turned(4.0, 0.8))));
        let mut settling = Settling::new([0.0; 3], 0..FRAMES);
        let mut words = Vec::new();
        while let Some(step) = settling.next(&mut cells) {
            match step {
                SettlingStep::See(rival, frames) => {
                    if rival == Rival::Mirrored {
                        words.push("sides");
                    }
                    for frame in frames {
                        let own = *cells[frame].found().expect("it was seen");
                        let (other, fixed) = (None, false);
                        settling.saw(SideSample {
                            frame,
                            own,
                            rival,
                            other,
                            fixed,
                        });
                    }
                }
                SettlingStep::LookAgain(looks) => {
                    assert_eq!(looks.len(), 1);
                    words.push("again");
                    if is_mended {
                        cells[4].improve(turned(4.0, 0.2));
                    }
                }
                SettlingStep::Choose => settling.choose(None),
                _ => {}
            }
        }
        words
    };
    assert_eq!(words(true), ["sides", "again", "sides"]);
    assert_eq!(words(false), ["sides", "again"]);
}

#[test]
fn what_is_right_is_seen_from_both_sides_and_from_elsewhere_once() {
    assert_eq!(order(5.0), ["sides", "choose", "elsewhere"]);
}

#[test]
fn what_leaves_less_is_gone_over_to_and_seen_anew() {
    let words = order(0.2);
    assert_eq!(
        words[..4],
        ["sides", "choose", "go over", "elsewhere"],
        "{words:?}"
    );
    let rounds = words.iter().filter(|&&word| word == "sides").count();
    assert!(rounds <= 1 + ROUNDS, "{words:?}");
}

#[test]
fn a_frame_over_a_jump_is_looked_at_once_by_each_trail() {
    let mut settling = Settling::new([0.0; 3], 0..FRAMES);
    let usual = |px: f64| super::super::trail::Usual::of(&turned(0.0, px));
    let trail = |deg: f64| Trail::begin(3, &turned(deg, 0.2).pose, usual(0.2));
    let mut looks = 0;
    let mut over = |frame: usize, deg: f64| {
        let seen = looked(Ok(turned(deg + frame as f64, 0.2)));
        let mut see = || {
            looks += 1;
            Ok::<_, core::convert::Infallible>(seen)
        };
        let Ok(looked) = settling.over_jump((frame, &trail(deg)), &mut see);
        assert_eq!(looked, seen);
        looks
    };
    assert_eq!(
        [over(4, 0.0), over(4, 0.0), over(5, 0.0), over(4, 9.0)],
        [1, 1, 2, 3]
    );
    assert_eq!([over(5, 0.0), over(4, 9.0), over(5, 9.0)], [3, 3, 4]);
}

#[test]
fn both_sides_are_those_of_the_very_frame() {
    let mut settling = Settling::new([0.0; 3], 0..FRAMES);
    let sample = |frame: usize, rival| SideSample {
        frame,
        own: turned(frame as f64, 0.2),
        rival,
        other: None,
        fixed: false,
    };
    for frame in [2, 5] {
        settling.saw(sample(frame, Rival::Mirrored));
    }
    settling.saw(sample(3, Rival::Elsewhere));
    let seen = |frame| settling.both_sides_of(frame).map(|sample| sample.frame);
    assert_eq!([2, 3, 4, 5].map(seen), [Some(2), None, None, Some(5)]);
}

/// What was looked at once more and changed is settled anew, a few times at most.
#[test]
fn a_film_that_was_mended_is_settled_again_until_it_is_tired_of_that() {
    let (mut settling, cells) = (Settling::new([0.0; 3], 0..FRAMES), film());
    let look = |misfit_px: f64| SecondLook {
        frame: 4,
        own: turned(4.0, misfit_px),
        expected: turned(4.0, 0.2).pose,
        usual: super::super::trail::Usual::of(&turned(4.0, 0.2)),
    };
    let times = settling.mendings;
    assert!(times > 0);
    settling.looked_again = vec![look(0.2)];
    assert!(
        matches!(settling.after_mending(&cells), Phase::Over),
        "as it was"
    );
    for left in (0..times).rev() {
        settling.looked_again = vec![look(0.2), look(0.9)];
        assert!(matches!(settling.after_mending(&cells), Phase::Sides));
        assert!(settling.mendings == left && settling.looked_again.is_empty());
    }
    settling.looked_again = vec![look(0.9)];
    assert!(matches!(settling.after_mending(&cells), Phase::Over));
}
