//! What is tried next, and from where.

use super::super::tests::{Bench, Lent, SIDE, camera, component, pose, seen, silhouette};
use super::*;
use crate::one_click::Support;
use fluoropose::image::contour::Point;
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::Mask;
use fluoropose::library::Library;
use fluoropose::pose::geodesic_deg;
use fluoropose::refine::{Polarity, Refined};
use std::vec::Vec;

const CLICK: Prompt = Prompt::Click(Point {
    column: 200.0,
    row: 180.0,
});

fn work(prompt: Prompt) -> OneClick {
    OneClick::new(prompt, &camera(), None).expect("inside")
}

fn answer(score: f64, x_mm: f64) -> Answer {
    let mut pose = pose();
    pose.translation[0] += x_mm;
    Answer {
        refined: Refined::at(pose),
        start: pose,
        support: Support::default(),
        mirrored: false,
        score,
    }
}

/// The stages from round to round; `best` is the answer that each round leaves.
fn rounds(best: &[Option<Answer>]) -> Vec<Stage> {
    let mut work = work(CLICK);
    let next = best.iter().map(|best| {
        work.answers.clear();
        work.answers.extend(*best);
        work.next_round()
    });
    next.collect()
}

#[test]
fn rounds_end_where_an_answer_convinces_or_nothing_new_came() {
    let end = Stage::Beyond(0);
    let weak = |x_mm| Some(answer(0.59, x_mm));
    assert_eq!(rounds(&[Some(answer(0.6, 0.0))]), [end]);
    assert_eq!(rounds(&[None, None]), [Stage::Narrow, end]);
    // Around the same answer poses are scored once.
    assert_eq!(
        rounds(&[weak(0.0), weak(0.0), weak(0.0)]),
        [Stage::Narrow, Stage::Around(0), end]
    );
    assert_eq!(
        rounds(&[None, weak(0.0), weak(5.0), weak(9.0)]),
        [Stage::Narrow, Stage::Around(0), Stage::Around(0), end]
    );
}

#[test]
fn beside_the_other_component_less_convinces() {
    let after = |score| {
        let mut work = work(CLICK);
        work.answers.extend([answer(score, 0.0)]);
        work.round = 1;
        work.after_joint()
    };
    assert_eq!(after(0.45), Stage::Beyond(0));
    assert_eq!(after(0.44), Stage::Narrow);
}

#[test]
fn poses_around_an_answer_are_each_turned_and_moved_otherwise() {
    let bench = Bench::new();
    let (model, library) = (bench.model(), Library::open(&bench.library).expect("valid"));
    let component = component(&library, &model);
    let mut work = work(CLICK);
    assert!(work.rotated(0, &component).is_none());
    work.answers.extend([answer(0.5, 0.0)]);
    let found = (0..).map_while(|at| work.rotated(at, &component));
    let found: Vec<Pose> = found.map(|located| located.pose).collect();
    assert_eq!(found.len(), 75);
    let middle = model.bounds().centre;
    let there = pose().transform(&middle);
    for (at, found) in found.iter().enumerate() {
        let times = [1.0, 0.96, 1.04][at / 25];
        let [x, y] = [at % 25 % 5, at % 25 / 5].map(|steps| 7.0 * (steps as f64 - 2.0));
        // The middle stays on its ray.
        let moved = found.transform(&middle);
        for k in 0..3 {
            assert!((moved[k] - times * there[k]).abs() < 1e-9, "{at}");
        }
        let turn = geodesic_deg(&found.rotation, &pose().rotation);
        assert!((turn - x.hypot(y)).abs() < 1e-6, "{at}: {turn} deg");
        let turned = multiply(
            &rotation_by(&[x.to_radians(), y.to_radians(), 0.0]),
            &pose().rotation,
        );
        assert!(geodesic_deg(&found.rotation, &turned) < 1e-5, "{at}");
    }
}

/// The window after it was narrowed to what is known.
fn narrowed(mut work: OneClick) -> OneClick {
    let bench = Bench::new();
    let (model, library) = (bench.model(), Library::open(&bench.library).expect("valid"));
    let component = component(&library, &model);
    let (pixels, camera) = (std::vec![0u16; SIDE * SIDE], camera());
    let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
    let observation = seen(&frame, &camera, Polarity::DarkImplant);
    work.seeds.extend([7]);
    let mut lent = Lent::new(&work.needs(&camera), &library, &bench, 0);
    work.narrow(&observation, &component, &mut lent.borrow());
    work
}

#[test]
fn the_window_is_narrowed_to_a_box_around_the_answer() {
    let mut wide = work(CLICK);
    wide.answers.extend([answer(0.5, 0.0)]);
    let narrow = narrowed(wide);
    let bench = Bench::new();
    let words = silhouette(&bench.model(), &pose());
    let (columns, rows) = Mask::new(&words, SIDE, SIDE).expect("fits").bounds();
    let margin = (columns.len().max(rows.len())) as f64 / 10.0;
    let sides =
        |range: &core::ops::Range<usize>| (range.start as f64 - margin, range.end as f64 + margin);
    let ((left, right), (top, bottom)) = (sides(&columns), sides(&rows));
    let around = Prompt::Box(Point::new(left, top), Point::new(right, bottom));
    assert_eq!(narrow.narrowed, Some(around));
    assert_eq!(
        narrow.window,
        around.window(&camera(), 0.0).expect("large enough")
    );
    assert!(narrow.seeds.is_empty());
}

#[test]
fn without_an_answer_it_is_one_around_the_click_and_a_box_stays() {
    let mut wide = work(CLICK);
    wide.expected.extent = 60.0;
    let around = Prompt::Box(Point::new(170.0, 150.0), Point::new(230.0, 210.0));
    assert_eq!(narrowed(wide).narrowed, Some(around));
    let drawn = Prompt::Box(Point::new(100.0, 100.0), Point::new(300.0, 280.0));
    let (before, after) = (work(drawn).window, narrowed(work(drawn)));
    assert_eq!((after.window, after.narrowed), (before, None));
    assert_eq!(after.seeds.as_slice(), [7]);
}
