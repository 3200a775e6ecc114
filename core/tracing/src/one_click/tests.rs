mod bench;

use super::*;
pub(crate) use bench::*;
use fluoropose::image::contour::Point;
use fluoropose::image::mask::Word;
use fluoropose::library::Library;
use fluoropose::pose::geodesic_deg;
use fluoropose::refine::{Polarity, RefineError};
use std::vec::Vec;

fn overlap(a: &[Word], b: &[Word]) -> f64 {
    let count = |rule: fn(Word, Word) -> Word| -> u32 {
        a.iter()
            .zip(b)
            .map(|(&a, &b)| rule(a, b).count_ones())
            .sum()
    };
    f64::from(count(|a, b| a & b)) / f64::from(count(|a, b| a | b))
}

#[test]
fn a_click_or_a_box_leads_to_outline_and_pose() {
    let bench = Bench::new();
    let model = bench.model();
    let truth = silhouette(&model, &pose());
    for cluttered in [false, true] {
        let pixels = drawn(&model, cluttered);
        for prompt in prompts() {
            let found = bench.work(&pixels, prompt, Polarity::DarkImplant, true);
            let (work, _) = found.expect("an answer");
            let best = &work.answers()[0];
            let turn = geodesic_deg(&best.refined.pose.rotation, &pose().rotation);
            let iou = overlap(&silhouette(&model, &best.refined.pose), &truth);
            let what = std::format!("{prompt:?}, cluttered {cluttered}");
            assert!(turn < 0.7 && iou > 0.97, "{what}: {turn} deg, {iou}");
            assert!(best.support.fraction > 0.8, "{what}: {:?}", best.support);
        }
    }
}

/// Poses whose outlines are shorter than the right one's would be left over, and the best of these taken.
#[test]
fn with_too_little_memory_for_an_outline_nothing_is_found_and_the_memory_is_named() {
    let mut bench = Bench::new();
    let pixels = drawn(&bench.model(), false);
    let polarity = Polarity::DarkImplant;
    let mut refused = 0;
    let (plenty, _) = bench
        .work(&pixels, prompts()[0], polarity, true)
        .expect("an answer");
    for border in (400..900).step_by(50) {
        bench.border = border;
        match bench.work(&pixels, prompts()[0], polarity, true) {
            Ok((found, _)) => {
                let poses = |work: &OneClick| {
                    work.answers()
                        .iter()
                        .map(|answer| answer.refined.pose)
                        .collect::<Vec<_>>()
                };
                assert_eq!(poses(&found), poses(&plenty), "{border}");
            }
            Err(OneClickError::Refine(RefineError::Memory(short))) => {
                assert_eq!((short.what, short.given), ("border pixels", border));
                refused += 1;
            }
            Err(other) => panic!("{border}: {other}"),
        }
    }
    assert!((1..10).contains(&refused), "{refused} refused");
}

/// The wall of a tray lets light through: what is dark has a sharp edge of its own, and the model fits inside of it, farther
/// away and tilted. This wall is so faint that the frame's edges do not hold the model on it; its pose is the first rival.
#[test]
fn a_wall_that_lets_light_through_is_a_rival_at_least() {
    let bench = Bench::new();
    let model = bench.model();
    let truth = silhouette(&model, &pose());
    let pixels = drawn_with_wall(&model, false, 7.0);
    for prompt in [prompts()[0], prompts()[2]] {
        let found = bench.work(&pixels, prompt, Polarity::DarkImplant, true);
        let (work, _) = found.expect("an answer");
        let rivals = work.answers().iter().take(2).map(|answer| {
            let found = &answer.refined.pose;
            let turn = geodesic_deg(&found.rotation, &pose().rotation);
            (turn, overlap(&silhouette(&model, found), &truth))
        });
        let rivals: Vec<(f64, f64)> = rivals.collect();
        let right = |&(turn, iou): &(f64, f64)| turn < 6.0 && iou > 0.92;
        assert!(rivals.iter().any(right), "{prompt:?}: {rivals:?}");
    }
}

#[test]
fn a_frame_with_inverted_greys_gives_the_same() {
    let bench = Bench::new();
    let model = bench.model();
    let bright: Vec<u16> = drawn(&model, true).iter().map(|grey| 4095 - grey).collect();
    let found = bench.work(&bright, prompts()[1], Polarity::BrightImplant, true);
    let (work, _) = found.expect("an answer");
    let rotation = &work.answers()[0].refined.pose.rotation;
    assert!(geodesic_deg(rotation, &pose().rotation) < 0.7);
}

#[test]
fn without_a_component_the_region_is_the_outline() {
    let bench = Bench::new();
    let model = bench.model();
    let pixels = drawn(&model, false);
    for prompt in prompts() {
        let found = bench.work(&pixels, prompt, Polarity::DarkImplant, false);
        let (work, region) = found.expect("a region");
        assert!(work.answers().is_empty());
        let iou = overlap(&region, &silhouette(&model, &pose()));
        assert!(iou > 0.95, "{prompt:?}: {iou}");
    }
}

#[test]
fn longer_memory_gives_the_same() {
    let bench = Bench::new();
    let pixels = drawn(&bench.model(), true);
    for (prompt, with_component) in [(prompts()[0], true), (prompts()[2], false)] {
        let [exact, longer] = [0, 1000].map(|reserve| {
            let polarity = Polarity::DarkImplant;
            bench.work_with_reserve(&pixels, prompt, polarity, with_component, reserve)
        });
        let [(a, region), (b, other)] = [exact.expect("done"), longer.expect("done")];
        assert_eq!((a.answers(), a.starts()), (b.answers(), b.starts()));
        assert_eq!(region, other);
    }
}

/// The implant lies 1.6 times as far away as its library.
#[test]
fn what_nothing_near_explains_is_looked_for_farther_away() {
    let mut bench = Bench::with_library_at(650.0);
    let pixels = drawn(&bench.model(), false);
    for prompt in [prompts()[0], prompts()[2]] {
        bench.farther = false;
        let near = bench.work(&pixels, prompt, Polarity::DarkImplant, true);
        let wrong = |(work, _): (OneClick, Vec<Word>)| {
            let found = work.answers()[0].refined.pose;
            geodesic_deg(&found.rotation, &pose().rotation) > 2.0
        };
        assert!(near.map_or(true, wrong), "{prompt:?}");
        bench.farther = true;
        let found = bench.work(&pixels, prompt, Polarity::DarkImplant, true);
        let (work, _) = found.expect("an answer");
        let turn = geodesic_deg(&work.answers()[0].refined.pose.rotation, &pose().rotation);
        assert!(turn < 0.7, "{prompt:?}: {turn} deg");
    }
    let flat = std::vec![700u16; SIDE * SIDE];
    let error = bench.work(&flat, prompts()[0], Polarity::DarkImplant, true);
    assert_eq!(error.err(), Some(OneClickError::Blank));
}

#[test]
fn where_there_is_no_implant_a_sentence_says_so() {
    let bench = Bench::new();
    let pixels = drawn(&bench.model(), true);
    let click = |column, row| {
        let prompt = Prompt::Click(Point::new(column, row));
        bench
            .work(&pixels, prompt, Polarity::DarkImplant, true)
            .err()
    };
    assert_eq!(click(-3.0, 10.0), Some(OneClickError::Outside));
    let nothing = [Some(OneClickError::NoRegion), Some(OneClickError::NoFit)];
    assert!(nothing.contains(&click(40.0, 340.0)));
    let flat = std::vec![700u16; SIDE * SIDE];
    let prompt = Prompt::Click(Point::new(200.0, 200.0));
    let error = bench.work(&flat, prompt, Polarity::DarkImplant, true).err();
    assert_eq!(error, Some(OneClickError::Blank));
    let noise: Vec<u16> = (0..SIDE * SIDE).map(|at| (at * 7919 % 3) as u16).collect();
    let error = bench
        .work(&noise, prompt, Polarity::DarkImplant, true)
        .err();
    assert_eq!(error, Some(OneClickError::Blank));
    let slope: Vec<u16> = (0..SIDE * SIDE).map(|at| (at % SIDE) as u16).collect();
    let error = bench
        .work(&slope, prompt, Polarity::DarkImplant, true)
        .err();
    assert!(nothing.contains(&error));
}

#[test]
fn the_window_holds_the_component_and_no_more() {
    let bench = Bench::new();
    let (model, camera) = (bench.model(), camera());
    let needs = OneClick::new(prompts()[0], &camera, None)
        .expect("inside")
        .needs(&camera);
    assert_eq!(needs.pixels, SIDE * SIDE);
    let library = Library::open(&bench.library).expect("valid");
    let component = component(&library, &model);
    // The window around a click holds the component at its nearest, and no more.
    let click = Prompt::Click(Point::new(0.0, 0.0));
    let needs = OneClick::new(click, &camera, Some(&component))
        .expect("inside")
        .needs(&camera);
    let extent = 2.0 * model.bounds().radius * 1800.0 / 700.0;
    assert_eq!(needs.pixels, (extent as usize + 1).pow(2).min(SIDE * SIDE));
}
