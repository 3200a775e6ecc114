//! A search from C that begins near the pose of the frame before.

use std::ptr::null;

use fluoropose::Mask;
use fluoropose_embedded::exports::*;
use fluoropose_embedded::{CameraNumbers, CandidateNumbers, Status};

use super::{ROOM, opened};
use crate::made_implant::{drawn, made_femur, poses};

#[test]
fn near_the_frame_before_c_finds_the_same_in_fewer_slices() {
    let (own, bytes) = made_femur();
    let c = opened(bytes.bytes(), &ROOM);
    let words = drawn(&own, poses().nth(2).expect("some"));
    let mask = Mask::new(&words, 512, 512).expect("valid");
    // SAFETY: an open session; what is not null leads to what is said.
    unsafe {
        let slices = |begin: &dyn Fn()| {
            c.rows(&mask);
            begin();
            (1..).find(|_| fluoropose_go_on(c.finder, 1) != Status::More)
        };
        let whole = slices(&|| ()).expect("it ends");
        let first = c.candidate(c.found().chosen);
        let near = |before: &CandidateNumbers| fluoropose_near(c.finder, before);
        let nearer = slices(&|| assert_eq!(near(&first), Status::Ok)).expect("it ends");
        assert!(nearer < 2 * whole / 3, "{nearer} slices, {whole}");
        assert_eq!(c.found().verdict, 1);
        let again = c.candidate(c.found().chosen);
        for (own, other) in again.translation_mm.iter().zip(first.translation_mm) {
            assert!((own - other).abs() < 0.05, "{own} {other}");
        }
        // A pose that cannot be, or before there is anything to look for: the search that follows is the whole one.
        let mut none = first;
        none.rotation[1] = none.rotation[0];
        let refused = slices(&|| {
            assert_eq!(near(&none), Status::Near);
            assert!(c.sentence().contains("no pose"), "{}", c.sentence());
        });
        assert_eq!(refused, Some(whole));
        let (mut unknown, mut negative) = (first, first);
        (unknown.translation_mm[2], negative.misfit_px) = (f64::NAN, -1.0);
        c.rows(&mask);
        assert_eq!([near(&unknown), near(&negative)], [Status::Near; 2]);
        assert_eq!(fluoropose_near(c.finder, null()), Status::Pointer);
        let mut camera = CameraNumbers::default();
        assert_eq!(fluoropose_camera_of(c.finder, &mut camera), Status::Ok);
        assert_eq!(fluoropose_set_camera(c.finder, &camera), Status::Ok);
        assert_eq!(near(&first), Status::Order);
        // Said before another silhouette, it is forgotten with the one it was said of.
        let forgotten = slices(&|| {
            assert_eq!(near(&first), Status::Ok);
            c.rows(&mask);
        });
        assert_eq!(forgotten, Some(whole));
    }
}
