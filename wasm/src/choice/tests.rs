use super::*;
use fluoropose::pose::EulerPose;
use fluoropose::pose::covariance::PoseCovariance;

fn turned(x_rot_deg: f64) -> RivalPose {
    let pose = EulerPose {
        x_mm: 0.0,
        y_mm: 0.0,
        z_mm: -1000.0,
        z_rot_deg: 0.0,
        x_rot_deg,
        y_rot_deg: 0.0,
    };
    RivalPose {
        pose: pose.into(),
        residual_px: 0.3,
    }
}

#[test]
fn two_equal_poses_are_undecided_until_a_neighbour_is_known() {
    let both = [turned(4.0), turned(-4.0)];
    let mut around = Surroundings::default();
    let chosen = Chosen::among(&both, &around, |_, _| true).unwrap();
    assert!(
        !chosen.decided()
            && chosen
                .sentence
                .starts_with("Not decided: the residuals are 0.30")
    );
    let doubt = chosen.doubt().unwrap();
    assert!(
        doubt.starts_with("another pose, 8 degrees away, fits as well (0.30 px)"),
        "{doubt}"
    );
    around.neighbours.push(turned(-3.5).pose);
    let chosen = Chosen::among(&both, &around, |_, _| true).unwrap();
    assert_eq!((chosen.index(), chosen.decided()), (1, true));
    assert_eq!(chosen.doubt(), None);
    assert_eq!(
        chosen.sentence,
        "It goes with the neighbouring frames: turned 0.5° from them, the other pose 7.5°."
    );
}

#[test]
fn what_the_plus_minus_holds_is_no_doubt_wherever_the_file_has_its_origin() {
    let origin = [900.0, 0.0, 0.0];
    let told = |apart_deg: f64, farther_mm: f64, middle: &[f64]| {
        let moved = [turned(0.0), turned(apart_deg)];
        let mut numbers = Vec::new();
        for (at, one) in moved.iter().enumerate() {
            let mut pose = one.pose;
            pose.translation = [0.0, 0.0, -1000.0 - farther_mm * at as f64];
            // The model's middle lies there.
            let arm = pose.transform(&origin);
            let shift = fluoropose::math::subtract(&arm, &pose.translation);
            pose.translation = fluoropose::math::subtract(&pose.translation, &shift);
            numbers.extend(fluoropose_page::pose_numbers::to_numbers(&pose.into()));
        }
        let mut matrix = [[0.0; 6]; 6];
        (0..3).for_each(|k| matrix[k][k] = 0.6f64.to_radians().powi(2));
        matrix[5][5] = 9.0;
        let of = PoseCovariance { matrix };
        let one = crate::uncertainty::uncertainty(&of, &[[0.0; 6]; 2], &moved[0].pose, &origin);
        let all = [one, [f64::NAN; 39]].concat();
        let around = Surroundings::default();
        let chosen = choose_pose(&numbers, &[0.3, 0.31], &all, middle, &around);
        chosen.unwrap().unwrap().doubt()
    };
    assert_eq!(told(2.0, 5.9, &origin), None);
    assert!(told(2.2, 0.0, &origin).is_some() && told(0.1, 6.1, &origin).is_some());
    // Without the model nobody knows how far its middle moved.
    assert!(told(0.1, 0.1, &[]).is_some());
}

#[test]
fn what_had_been_found_speaks_against_a_hand_unless_it_is_ruled_out() {
    let with = |residual_px, x_rot_deg| RivalPose {
        residual_px,
        ..turned(x_rot_deg)
    };
    let mut around = Surroundings::default();
    assert_eq!(around.against(&[turned(6.0)]), None);
    let alike = around
        .against(&[turned(6.0), with(0.31, 0.0)])
        .expect("open");
    assert!(
        alike.contains("6 degrees away, fits as well (0.31 px)"),
        "{alike}"
    );
    // Which of both left a little less says nothing.
    let alike = around
        .against(&[turned(6.0), with(0.29, 0.0)])
        .expect("open");
    assert!(alike.contains("fits as well (0.29 px)"), "{alike}");
    let likelier = around
        .against(&[turned(6.0), with(0.1, 0.0)])
        .expect("likelier");
    assert!(
        likelier.contains("6 degrees away, is likelier (It fits best: residual 0.10 px"),
        "{likelier}"
    );
    assert_eq!(around.against(&[turned(6.0), with(0.9, 0.0)]), None);
    // A hand that is where the frames beside it are is right, and one that is not is not.
    around.neighbours.push(turned(5.5).pose);
    assert_eq!(around.against(&[turned(6.0), with(0.31, 0.0)]), None);
    let likelier = around
        .against(&[turned(0.0), with(0.31, 6.0)])
        .expect("likelier");
    assert!(
        likelier.contains("It goes with the neighbouring frames"),
        "{likelier}"
    );
}

#[test]
fn the_counterpart_decides_by_tilt_and_is_named() {
    let both = [turned(4.0), turned(-1.0)];
    let around = Surroundings {
        counterpart: Some(Counterpart::Femur(turned(4.0).pose)),
        ..Surroundings::default()
    };
    let chosen = Chosen::among(&both, &around, |_, _| true).unwrap();
    assert_eq!(chosen.index(), 0);
    assert!(
        chosen
            .sentence
            .starts_with("It goes with the femur: its coronal tilt against it is 0.0°")
    );
}

/// Models whose files have other axes than the field's: the tilt is the same once the axes are told.
#[test]
fn the_tilt_is_taken_in_anatomical_axes() {
    let axes = [0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0];
    let other_file = |x_rot_deg: f64| {
        let field_from_model = axes_from(&axes).ok().unwrap().inverse();
        RivalPose {
            pose: turned(x_rot_deg).pose.compose(&field_from_model),
            ..turned(x_rot_deg)
        }
    };
    let both = [other_file(-1.0), other_file(4.0)];
    let mut around = Surroundings {
        counterpart: Some(Counterpart::Femur(turned(4.0).pose)),
        ..Surroundings::default()
    };
    around.set_axes(&axes).ok().unwrap();
    let chosen = Chosen::among(&both, &around, |_, _| true).unwrap();
    assert_eq!(chosen.index(), 1);
    let tilt = "It goes with the femur: its coronal tilt against it is 0.0°";
    assert!(chosen.sentence.starts_with(tilt), "{}", chosen.sentence);
}
