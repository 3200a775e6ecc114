//! Finding and refining in slices: the answer is that of all at once, to the last bit.

use std::pin::pin;
use std::task::Poll;

use fluoropose::finder::choice::ChoiceContext;
use fluoropose::finder::first_poses;
use fluoropose::finder::{
    FinderBuffers, FirstPoses, Found, FrameSearch, Goal, Wanted, find_into, find_paced,
};
use fluoropose::image::mask::words_needed;
use fluoropose::implant::ImplantFile;
use fluoropose::pace::{Pace, go_on};
use fluoropose::refine::{RefineError, refine_paced};
use fluoropose::search::kernels::Kernels;
use fluoropose::{CameraView, Mask, RefineOptions, Silhouette, refine};

use crate::made_implant::{camera, drawn, made_femur, made_tibia, poses};

/// What comes of work, so many slices at a time, and how often it went on.
fn sliced<T>(work: impl Future<Output = T>, pace: &Pace, slices: u32) -> (T, usize) {
    let mut work = pin!(work);
    for calls in 1.. {
        if let Poll::Ready(done) = go_on(work.as_mut(), pace, slices) {
            return (done, calls);
        }
    }
    unreachable!("it ends")
}

/// A silhouette of which a strip is hidden, as if nobody had marked it.
fn with_a_strip_hidden(words: &[u32]) -> Vec<u32> {
    let mask = Mask::new(words, 512, 512).expect("valid");
    let (_, rows) = mask.bounds();
    let hidden = rows.start..rows.start + rows.len() / 5;
    let mut words = words.to_vec();
    let row = words_needed(512, 1);
    words[hidden.start * row..hidden.end * row].fill(0);
    words
}

#[test]
fn in_slices_the_same_is_found_to_the_last_bit() {
    let mut mirrored = 0;
    for (own, bytes) in [made_femur(), made_tibia()] {
        let file = ImplantFile::open(bytes.bytes()).expect("whole");
        let (camera, component) = (camera(), file.component());
        let mut buffers = FinderBuffers::default();
        for (number, euler) in poses().step_by(8).enumerate() {
            let mut words = drawn(&own, euler);
            if number == 1 {
                words = with_a_strip_hidden(&words);
            }
            let mask = Mask::new(&words, 512, 512).expect("valid");
            let silhouette = Silhouette::from(&mask);
            for goal in [Goal::Outline, Goal::Library] {
                let options = RefineOptions::default();
                let mut at_once = Found::NOTHING;
                let mut memory = buffers.borrow(&component, &camera, Kernels::PORTABLE);
                find_into(
                    &component,
                    &camera,
                    &silhouette,
                    goal,
                    options,
                    &mut memory,
                    &mut at_once,
                )
                .expect("found");
                let wanted = Wanted {
                    component: &component,
                    camera: &camera,
                    silhouette: &silhouette,
                    goal,
                    options,
                };
                let drawings = at_once.candidates.iter().filter_map(|one| one.refined);
                let drawings: usize = drawings.map(|refined| refined.renders).max().unwrap_or(0);
                for slices in [1, 7] {
                    let (mut found, pace) = (Found::NOTHING, Pace::new());
                    let work = find_paced(&wanted, &mut memory, &mut found, &pace);
                    let (done, calls) = sliced(work, &pace, slices);
                    done.expect("found");
                    assert!(
                        calls > drawings / slices as usize,
                        "{calls} calls, {drawings} drawings"
                    );
                    assert_eq!(found.candidates, at_once.candidates, "{euler:?}");
                    assert_eq!(
                        (found.clipped, found.partial),
                        (at_once.clipped, at_once.partial)
                    );
                }
                let context = ChoiceContext::default();
                assert!(at_once.decide(&context).is_some());
                mirrored += usize::from(at_once.candidates.len() > 1);
            }
        }
    }
    assert!(mirrored > 0, "no rival was refined");
}

#[test]
fn one_search_serves_frame_after_frame() {
    let (own, bytes) = made_tibia();
    let file = ImplantFile::open(bytes.bytes()).expect("whole");
    let (camera, component) = (camera(), file.component());
    let mut buffers = FinderBuffers::default();
    let mut memory = buffers.borrow(&component, &camera, Kernels::PORTABLE);
    let mut search = FrameSearch::new();
    for euler in poses().step_by(8) {
        let words = drawn(&own, euler);
        let mask = Mask::new(&words, 512, 512).expect("valid");
        for goal in [Goal::Outline, Goal::Library] {
            let wanted = Wanted {
                component: &component,
                camera: &camera,
                silhouette: &Silhouette::from(&mask),
                goal,
                options: RefineOptions::default(),
            };
            // Given up on its way, and begun anew.
            let mut found = Found::NOTHING;
            for _ in 0..3 {
                assert!(search.go_on(&wanted, &mut memory, &mut found).is_pending());
            }
            search.restart();
            let mut go_on = || search.go_on(&wanted, &mut memory, &mut found);
            let mut slices = core::iter::repeat_with(&mut go_on).skip_while(Poll::is_pending);
            assert_eq!(slices.next(), Some(Poll::Ready(Ok(()))));
            // What comes after the end is the first slice again.
            assert_eq!(slices.next(), Some(Poll::Pending));
            search.restart();
            let (mut alone, pace) = (Found::NOTHING, Pace::new());
            let work = find_paced(&wanted, &mut memory, &mut alone, &pace);
            assert_eq!(sliced(work, &pace, 7).0, Ok(()));
            assert_eq!(found.candidates, alone.candidates, "{euler:?}");
            let parts = |found: &Found| (found.clipped, found.partial);
            assert_eq!(parts(&found), parts(&alone));
        }
    }
}

#[test]
fn in_slices_a_start_is_refined_to_the_last_bit() {
    let (own, bytes) = made_femur();
    let file = ImplantFile::open(bytes.bytes()).expect("whole");
    let (camera, component) = (camera(), file.component());
    let mut buffers = FinderBuffers::default();
    let mut memory = buffers.borrow(&component, &camera, Kernels::PORTABLE);
    let words = drawn(&own, poses().next().expect("some"));
    let mask = Mask::new(&words, 512, 512).expect("valid");
    let silhouette = Silhouette::from(&mask);
    let first: FirstPoses =
        first_poses(&component, &camera, &silhouette, &mut memory).expect("some");
    let start = first.poses[0].located.pose;
    for edge_offset in [false, true] {
        let options = RefineOptions {
            edge_offset,
            ..RefineOptions::default()
        };
        let views = [CameraView::only(&camera, silhouette)];
        let model = component.model;
        let at_once = refine(model, &views, &start, options, &mut memory.refine).expect("near");
        let pace = Pace::new();
        let work = refine_paced(model, &views, &start, options, &mut memory.refine, &pace);
        let (refined, calls) = sliced(work, &pace, 1);
        assert_eq!(refined, Ok(at_once));
        // Each call but the first and the last draws once; the last look at an offset is no slice of its own.
        let own = calls - 1;
        assert!(
            (own..=own + 1).contains(&at_once.renders),
            "{own} slices, {} drawings",
            at_once.renders
        );
    }
    // An error comes as it comes at once.
    let pace = Pace::new();
    let work = refine_paced(
        component.model,
        &[],
        &start,
        RefineOptions::default(),
        &mut memory.refine,
        &pace,
    );
    assert_eq!(sliced(work, &pace, 1).0, Err(RefineError::NoView));
}
