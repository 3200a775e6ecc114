//! Two cameras see one implant: depth is known as well as what lies in the plane.

use fluoropose_laboratory::finding::{Method, ViewOptions};
use fluoropose_laboratory::noise::DisturbanceOptions;
use fluoropose_laboratory::verbs::synthetic::{Protocol, Variant, measure_as};
use fluoropose_tests::{camera, surface, tibia};

/// A tibia is the hard case: one camera leaves its depth the weakest number.
#[test]
fn depth_is_as_good_as_the_plane() {
    let protocol = Protocol {
        method: Method::Refined,
        distance: 1084.0,
        poses: 8,
        seed: 11,
        disturbance: DisturbanceOptions::default(),
    };
    let model = surface(tibia());
    let mesh = model.as_model();
    let measure = |biplane| {
        let variant = Variant {
            biplane,
            ..Variant::default()
        };
        let views = ViewOptions::window([0.0, 0.0]);
        measure_as(mesh, camera(), &views, &protocol, variant).expect("poses are found")
    };
    let (one, two) = (measure(None).median, measure(Some(70.0)).median);
    assert!(two.z_mm < 2.0 * two.x_mm.max(two.y_mm), "{two:?}");
    assert!(two.z_mm < one.z_mm / 5.0, "{two:?} against {one:?}");
}
