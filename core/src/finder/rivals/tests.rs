use super::*;
use crate::finder::fake::{SIDE, camera, crank, drawn, grey, located, placed};
use crate::image::frame::Frame;
use crate::image::mask::Mask;
use crate::image::silhouette::Silhouette;
use crate::mesh::OwnedModel;
use crate::refine::{ImageTarget, RefineBuffers};

/// A look at something turned by so many degrees about the vertical, where so much remains.
fn at(deg: f64, loss: f64) -> Refined {
    Refined {
        loss,
        ..Refined::at(placed([0.0, deg, 0.0], [0.0; 3]))
    }
}

/// What is done next, and whether all looks led back, once a look or a refinement has ended there; the best pose lies at 0 degrees.
fn taken(round: Round, doing: Doing, ended: Result<Refined, RefineError>) -> Rivals {
    let mut rivals = Rivals::new();
    rivals.tried = RefinedRival::at(placed([0.0, 7.0, 0.0], [0.0; 3]), 3, false);
    let mut best = RefinedRival {
        refined: at(0.0, 1.0),
        ..RefinedRival::at(Pose::IDENTITY, 0, false)
    };
    // Looks end within half a degree of it.
    best.refined.robust_sigma_px = 0.2;
    let poses = &mut rivals.poses;
    (poses.round, poses.doing, poses.best) = (round, doing, best);
    (poses.is_outline, poses.all_back) = (true, true);
    let _ = poses.answers.push(best);
    if let Ok(refined) = ended {
        rivals.refinement.state = refined;
    }
    rivals.take(ended.map(|_| ()));
    rivals
}

#[test]
fn a_look_that_leads_on_is_refined_from_there_and_is_no_answer_yet() {
    for round in [Round::Beside, Round::Around, Round::Mirrors] {
        let on = taken(round, Doing::Looking, Ok(at(20.0, 1.1)));
        assert!(on.poses.doing == Doing::Refining && on.poses.all_back);
        assert_eq!(on.poses.answers.len(), 1);
        // A mirror image comes from where it was mirrored to.
        let from = match round {
            Round::Mirrors => 7.0,
            _ => 20.0,
        };
        assert_eq!(on.tried.from, at(from, 0.0).pose);
        let worse = taken(round, Doing::Looking, Ok(at(20.0, 9.0)));
        assert!(worse.poses.doing == Doing::Choosing && !worse.poses.all_back);
        let back = taken(round, Doing::Looking, Ok(at(0.01, 1.0)));
        assert!(back.poses.doing == Doing::Choosing);
        assert_eq!((worse.answers().len(), back.answers().len()), (1, 1));
    }
    let back = taken(Round::Beside, Doing::Looking, Ok(at(0.09, 1.0)));
    assert!(back.poses.all_back);
}

#[test]
fn what_is_refined_is_an_answer_where_it_was_not_known() {
    let new = taken(Round::Rest, Doing::Refining, Ok(at(20.0, 0.7)));
    let answers: std::vec::Vec<(usize, f64)> = (new.answers().iter())
        .map(|answer| (answer.start, answer.refined.loss))
        .collect();
    assert_eq!(answers, [(3, 0.7), (0, 1.0)]);
    assert!(new.poses.doing == Doing::Choosing && !new.poses.all_back);
    let known = taken(Round::Rest, Doing::Refining, Ok(at(0.01, 0.7)));
    assert_eq!(known.answers().len(), 1);
    assert!(known.poses.doing == Doing::Choosing && known.poses.all_back);
}

#[test]
fn what_failed_is_no_answer_and_leads_nowhere() {
    for doing in [Doing::Looking, Doing::Refining] {
        let failed = taken(Round::Beside, doing, Err(RefineError::TooFar));
        assert_eq!(failed.failure, Some(RefineError::TooFar));
        assert_eq!(failed.answers().len(), 1);
        assert!(failed.poses.doing == Doing::Choosing && !failed.poses.all_back);
    }
}

/// Whether the crank at `mirrored` is near what it casts at `seen`, where `own` is the pose that it is the mirror image of.
fn near(model: &OwnedModel, seen: &Pose, [mirrored, own]: [&Pose; 2]) -> bool {
    let camera = camera();
    let words = drawn(model, &camera, seen);
    let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
    // In another frame than the camera's, which makes no difference.
    let placement = placed([10.0, -5.0, 20.0], [3.0, -4.0, 1000.0]);
    let view = CameraView {
        placement,
        ..CameraView::only(&camera, Silhouette::from(&mask))
    };
    let [mirrored, own] = [mirrored, own].map(|pose| placement.inverse().compose(pose));
    let mut buffers = RefineBuffers::default();
    let mut memory = buffers.borrow(&model.as_model(), &camera);
    is_near(&model.as_model(), &view, &mirrored, &own, &mut memory)
}

#[test]
fn a_mirror_image_is_tried_where_it_covers_the_mask_well_or_nearly_as_well_as_the_pose() {
    let model = crank();
    let own = placed([20.0, 30.0, 0.0], [0.0; 3]);
    let beside = placed([20.0, 30.0, 1.0], [0.3, 0.0, 0.0]);
    let turned = placed([20.0, 30.0, 90.0], [0.0; 3]);
    let away = placed([20.0, 30.0, 90.0], [25.0, 0.0, 0.0]);
    // By itself, where nothing is left at the pose itself.
    assert!(near(&model, &own, [&beside, &own]));
    assert!(!near(&model, &own, [&turned, &own]));
    // As badly as the pose, and by far worse.
    assert!(near(&model, &own, [&turned, &turned]));
    assert!(near(&model, &own, [&turned, &away]));
    assert!(!near(&model, &own, [&away, &beside]));
    // Where it cannot be drawn it is none.
    assert!(!near(
        &model,
        &own,
        [&placed([0.0; 3], [0.0, 0.0, 1000.0]), &own]
    ));
}

#[test]
fn of_a_grey_frame_it_is_not_known_what_a_mirror_image_covers() {
    let (model, camera) = (crank(), camera());
    let pose = placed([20.0, 30.0, 0.0], [0.0; 3]);
    let pixels = grey(&model, &camera, &pose);
    let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
    let image = ImageTarget::dark(&frame);
    let view = CameraView::only(&camera, image);
    let turned = placed([20.0, 30.0, 90.0], [0.0; 3]);
    let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
    let mut memory = buffers.borrow(&model, &camera);
    assert!(is_near(&model, &view, &turned, &pose, &mut memory));
}

#[test]
fn rivals_are_worth_refining_up_to_four_times_what_the_best_leaves() {
    let worth = |unmatched: &[u64]| {
        let rivals: std::vec::Vec<Reranked> =
            unmatched.iter().map(|&count| located(count)).collect();
        worth_refining(&rivals).len()
    };
    assert_eq!(worth(&[10, 20, 40, 41, 42]), 3);
    assert_eq!(worth(&[0, 0, 1]), 2);
    assert_eq!(worth(&[10; STARTS + 2]), STARTS);
    assert_eq!(worth(&[]), 0);
}
