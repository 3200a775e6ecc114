use super::*;
use crate::joint::fake::{Parts, femur, pose, tray};
use crate::math::{add, dot, norm, scale, subtract};

/// The looks at a film of so many frames, femur and tibia, whose fits have the gains of their components.
fn looked(frames: usize, gains: [f64; 2]) -> (Vec<(KneeComponent, usize)>, usize) {
    let mut looks = FlippedLooks::new(&alloc::vec![0.0; frames]);
    let mut seen = Vec::new();
    while let Some(&(component, frame)) = looks.wanted().first() {
        seen.push((component, frame));
        let gain = gains[usize::from(component == KneeComponent::Tibia)];
        looks.take(Some(FlippedFit {
            pose: Pose::IDENTITY,
            gain,
        }));
    }
    let fits = looks.fits();
    (seen, fits.iter().flatten().count())
}

#[test]
fn the_femur_may_tell_that_nothing_is_flipped_and_both_tell_that_something_is() {
    let (seen, fits) = looked(30, [0.1, 1.0]);
    assert_eq!((seen.len(), fits), (2, 0));
    let (seen, fits) = looked(30, [1.5, 1.5]);
    assert_eq!((seen.len(), fits), (6, 3));
    let of_tibia = |&&(component, _): &&(KneeComponent, usize)| component == KneeComponent::Tibia;
    assert_eq!(seen.iter().filter(of_tibia).count(), 3);
}

#[test]
fn short_films_and_single_frames_are_looked_at_as_far_as_they_go() {
    assert_eq!(looked(0, [1.5; 2]), (Vec::new(), 0));
    for frames in [1, 2] {
        let (seen, fits) = looked(frames, [1.5; 2]);
        assert_eq!((seen.len(), fits), (2 * frames, frames), "{frames}");
    }
    let known = FlippedLooks::new(&[f64::NAN, 3.0, f64::NAN]);
    assert_eq!(known.wanted(), [(KneeComponent::Femur, 1)]);
    assert_eq!(known.fits(), [None]);
}

fn owned(parts: &Parts) -> OwnedModel {
    let (vertices, triangles) = (
        parts.vertices.as_flattened(),
        parts.triangles.as_flattened(),
    );
    OwnedModel::new(vertices.to_vec(), triangles.to_vec()).expect("valid")
}

fn flipped_knee(axes: &Pose) -> FlippedKnee {
    let [femur, tray] = [femur(), tray()].map(|parts| owned(&parts.in_axes(axes)));
    let knee = FlippedKnee::new((&femur.as_model(), axes), (&tray.as_model(), axes));
    knee.expect("a plate")
}

/// Six times the volume within a surface: negative where its triangles look inwards.
fn volume(model: &Model<'_>) -> f64 {
    let corner = |k: u32| model.vertices()[k as usize].map(f64::from);
    let each = model.triangles().iter().map(|&[a, b, c]| {
        let [a, b, c] = [a, b, c].map(corner);
        dot(&a, &crate::math::cross(&b, &c))
    });
    each.sum()
}

#[test]
fn a_mirrored_model_is_the_model_in_a_mirror_across_the_knee_through_its_middle() {
    // A tray is its own mirror image; one with a block at one corner is not.
    let axes = pose([30.0, -5.0, 12.0], [20.0, -35.0, 50.0]);
    let mut parts = tray();
    parts.add_box([10.0, -9.0, 12.0], [20.0, -2.0, 30.0]);
    let model = owned(&parts.in_axes(&axes));
    let (model, across) = (model.as_model(), axes.rotation.map(|row| row[2]));
    let mirrored = Mirrored::of((&model, &axes)).expect("valid");
    let other = mirrored.model.as_model();
    assert_eq!(other.vertices().len(), model.vertices().len());
    for (own, other) in model.vertices().iter().zip(other.vertices()) {
        let [own, other] = [own, other].map(|vertex| vertex.map(f64::from));
        // What joins the two lies across the knee, and its middle in the plane through the model's middle.
        let apart = subtract(&other, &own);
        let aside = subtract(&apart, &scale(&across, dot(&across, &apart)));
        let midway = scale(&add(&own, &other), 0.5);
        let off_mm = dot(&across, &subtract(&midway, &model.centre()));
        assert!(
            norm(&aside) < 1e-3 && off_mm.abs() < 1e-3,
            "{apart:?} {off_mm}"
        );
    }
    let (own, other) = (volume(&model), volume(&other));
    assert!(
        own > 0.0 && (other / own - 1.0).abs() < 1e-3,
        "{own} {other}"
    );
    let turned = mirror_pose(&axes, &mirrored.plane);
    assert!(turned.is_rigid(1e-9));
}

/// What is told of a film of which nothing was told before, and of one of which something was: how far its components lie beside each other,
/// flipped or not, mm, and how both fit.
fn judged(apart: &[f64], flipped_mm: f64, gains: &[[f64; 2]]) -> [Vec<Option<Beside>>; 2] {
    let knee = flipped_knee(&Pose::IDENTITY);
    let far = pose([5.0, -8.0, -900.0], [10.0, 20.0, 30.0]);
    let aside = far.compose(&pose([0.0, -30.0, flipped_mm], [0.0; 3]));
    let fit = |&[femur, tibia]: &[f64; 2]| {
        let fit = |pose, gain| FlippedFit { pose, gain };
        Some([fit(far, femur), fit(aside, tibia)])
    };
    let fits: Vec<_> = gains.iter().map(fit).collect();
    let before = Beside {
        mm: 30.0,
        most_mm: 12.0,
        of_film: false,
        flipped: None,
    };
    [None, Some(before)].map(|before| {
        let mut told = alloc::vec![before; apart.len()];
        knee.judge(&mut told, apart, &fits);
        told
    })
}

#[test]
fn a_film_that_fits_better_flipped_is_told_in_every_frame_that_is_known() {
    let most_mm = flipped_knee(&Pose::IDENTITY).middles.most_mm();
    let gains = [[1.3, 2.6], [1.3, 2.6], [9.0, 0.1]];
    let [new, known] = judged(&[-3.0, f64::NAN, 1.0, 2.0], 4.0, &gains);
    let told = new[0].expect("told");
    assert!(new[1].is_none() && new[2] == new[0] && new[3] == new[0]);
    // The median of the film, and of both components' fits.
    assert_eq!((told.mm, told.most_mm, told.of_film), (2.0, most_mm, true));
    let flipped = told.flipped.expect("it is so");
    assert!((flipped.mm - 4.0).abs() < 1e-4, "{flipped:?}");
    assert!((flipped.times - sqrt(1.3 * 2.6)).abs() < 1e-12);
    // What was told stays, with that.
    for one in known {
        let one = one.expect("told before");
        assert_eq!(
            (one.mm, one.of_film, one.flipped),
            (30.0, false, Some(flipped))
        );
    }
    let [one, _] = judged(&[-3.0], 4.0, &[[1.3, 1.3]]);
    assert!(one[0].is_some_and(|told| !told.of_film && told.mm == 3.0));
}

#[test]
fn nothing_is_told_of_pictures_that_flipped_are_no_knee_or_fit_badly() {
    let most_mm = flipped_knee(&Pose::IDENTITY).middles.most_mm();
    let told = |flipped_mm: f64, gains: &[[f64; 2]]| {
        let [new, known] = judged(&[20.0; 2], flipped_mm, gains);
        let is_flipped = |told: &Option<Beside>| told.is_some_and(|told| told.flipped.is_some());
        [new, known].map(|told| told.iter().all(is_flipped))
    };
    for sign in [1.0, -1.0] {
        assert_eq!(told(sign * (most_mm - 0.01), &[[1.4; 2]]), [true; 2]);
        assert_eq!(told(sign * (most_mm + 0.01), &[[1.4; 2]]), [false; 2]);
    }
    // As well flipped, but not better.
    assert_eq!(told(0.0, &[[1.29; 2]]), [false, true]);
    assert_eq!(told(0.0, &[[0.78, 1.0]]), [false, true]);
    // One of them badly.
    assert_eq!(told(0.0, &[[0.76, 9.0]]), [false; 2]);
    assert_eq!(told(0.0, &[[9.0, 0.76]]), [false; 2]);
    assert_eq!(told(0.0, &[]), [false; 2]);
}

#[test]
fn a_fit_is_poor_where_the_model_itself_leaves_less_by_what_decides() {
    let is_poor = |gain: f64| {
        let pose = Pose::IDENTITY;
        FlippedFit { pose, gain }.is_poor()
    };
    assert_eq!(
        [0.1, 0.769, 0.77, 1.0, 5.0].map(is_poor),
        [true, true, false, false, false]
    );
}
