//! A search that begins near the pose of the frame before: right where that is near, and as if there had been none where it is not.

use std::task::Poll;

use fluoropose::finder::choice::ChoiceContext;
use fluoropose::finder::{FinderBuffers, Found, FrameSearch, Goal, Verdict, Wanted};
use fluoropose::image::mask::words_needed;
use fluoropose::implant::ImplantFile;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::search::kernels::Kernels;
use fluoropose::{Mask, RefineOptions, Silhouette};

use crate::made_implant::{camera, drawn, is_cut_off, made_femur, made_tibia, many_poses};

/// What a search finds, slice by slice, and how many of these there were.
fn searched(
    wanted: &Wanted<'_>,
    buffers: &mut FinderBuffers,
    near: Option<(&Pose, f64)>,
) -> (Found, usize) {
    let mut memory = buffers.borrow(wanted.component, wanted.camera, Kernels::PORTABLE);
    let (mut search, mut found) = (FrameSearch::new(), Found::NOTHING);
    if let Some((pose, misfit_px)) = near {
        search.restart_near(pose, misfit_px);
    }
    for slices in 1.. {
        if let Poll::Ready(done) = search.go_on(wanted, &mut memory, &mut found) {
            done.expect("found");
            return (found, slices);
        }
    }
    unreachable!("it ends")
}

/// The pose of a frame before: so many degrees about two axes, and millimetres, away.
fn before(own: EulerPose, deg: f64) -> Pose {
    Pose::from(EulerPose {
        x_mm: own.x_mm + 2.0,
        z_mm: own.z_mm - 8.0,
        x_rot_deg: own.x_rot_deg + deg,
        z_rot_deg: own.z_rot_deg - deg,
        ..own
    })
}

/// How far a pose is from the one that was drawn, degrees, and whether it is called good.
fn off(found: &Found, drawn: EulerPose) -> (f64, bool) {
    let decision = found.decide(&ChoiceContext::default()).expect("some");
    let chosen = &found.candidates[decision.choice.index].pose;
    let apart = geodesic_deg(&chosen.rotation, &Pose::from(drawn).rotation);
    (apart, decision.verdict == Verdict::Good)
}

#[test]
fn near_the_frame_before_it_is_found_sooner_and_far_from_it_all_the_same() {
    let (mut frames, mut sooner, mut anew, mut alike) = (0, 0, 0, 0);
    let (mut saved, mut all) = (0.0, 0.0);
    for (own, bytes) in [made_femur(), made_tibia()] {
        let file = ImplantFile::open(bytes.bytes()).expect("whole");
        let (camera, component) = (camera(), file.component());
        let mut buffers = FinderBuffers::default();
        for euler in many_poses().take(24) {
            let words = drawn(&own, euler);
            let mask = Mask::new(&words, 512, 512).expect("valid");
            if is_cut_off(&mask) {
                continue;
            }
            let wanted = Wanted {
                component: &component,
                camera: &camera,
                silhouette: &Silhouette::from(&mask),
                goal: Goal::Outline,
                options: RefineOptions::default(),
            };
            let (whole, slices) = searched(&wanted, &mut buffers, None);
            let misfit_px = whole.candidates[0].misfit();
            let is_good = off(&whole, euler).1;
            frames += 1;
            for deg in [3.0, 100.0] {
                let start = before(euler, deg);
                let (found, near_slices) =
                    searched(&wanted, &mut buffers, Some((&start, misfit_px)));
                let (apart, good) = off(&found, euler);
                assert!(apart < 0.3 || !good, "{euler:?} {deg}: {apart} deg, good");
                match found.candidates[0].located {
                    // The library was asked: all of it is the whole search's.
                    Some(_) => {
                        assert_eq!(found.candidates, whole.candidates);
                        anew += usize::from(deg > 50.0);
                    }
                    None => {
                        assert!(good || !is_good || deg > 50.0, "{euler:?} {deg}");
                        if deg < 50.0 {
                            sooner += 1;
                            saved += slices as f64 - near_slices as f64;
                            all += slices as f64;
                        }
                        alike += usize::from(found.candidates.len() > 1);
                    }
                }
            }
        }
    }
    let share = saved / all;
    println!(
        "{sooner} of {frames} sooner, by {share:.2}; {anew} anew; {alike} with their mirror images"
    );
    assert!(share > 0.2, "{share}");
    assert!(
        sooner > 15 && anew > 5 && alike > 0,
        "{sooner} {anew} {alike}"
    );
}

#[test]
fn what_is_left_may_not_grow_and_hidden_outlines_are_looked_for_everywhere() {
    let (own, bytes) = made_femur();
    let file = ImplantFile::open(bytes.bytes()).expect("whole");
    let (camera, component) = (camera(), file.component());
    let mut buffers = FinderBuffers::default();
    let euler = many_poses().nth(2).expect("some");
    let words = drawn(&own, euler);
    let mask = Mask::new(&words, 512, 512).expect("valid");
    // Rows are missing of it, as if a strip had been taken for background.
    let (_, rows) = mask.bounds();
    let mut cut = words.clone();
    let row = words_needed(512, 1);
    cut[rows.start * row..(rows.start + rows.len() / 12) * row].fill(0);
    let cut = Mask::new(&cut, 512, 512).expect("valid");
    let mut hidden = vec![0; words.len()];
    hidden[..(rows.start + rows.len() / 3) * row].fill(u32::MAX);
    let hidden = Mask::new(&hidden, 512, 512).expect("valid");
    for (silhouette, goal) in [
        (Silhouette::from(&cut), Goal::Outline),
        (Silhouette::from(&mask), Goal::Library),
        (
            Silhouette::new(&mask, &hidden).expect("alike"),
            Goal::Outline,
        ),
    ] {
        let wanted = Wanted {
            component: &component,
            camera: &camera,
            silhouette: &silhouette,
            goal,
            options: RefineOptions::default(),
        };
        let (whole, _) = searched(&wanted, &mut buffers, None);
        let start = before(euler, 2.0);
        let (found, _) = searched(&wanted, &mut buffers, Some((&start, 0.0)));
        assert_eq!(found.candidates, whole.candidates, "{goal:?}");
    }
}
