//! The C interface: its answers are the finder's, and no pointer ends the program.
#![expect(unsafe_code, reason = "functions for C are called as C calls them")]

mod header;
mod near;
mod opening;
mod room;

use std::collections::BTreeMap;
use std::ptr::{null, null_mut};

use fluoropose::finder::{FinderBuffers, Found, Goal, find};
use fluoropose::image::crop::Crop;
use fluoropose::implant::ImplantFile;
use fluoropose::search::kernels::Kernels;
use fluoropose::{Mask, Point, RefineOptions, Silhouette};
use fluoropose_embedded::exports::*;
use fluoropose_embedded::{
    CalibrationNumbers, CameraNumbers, CandidateNumbers, FoundNumbers, Room, Status,
};

use crate::made_implant::{camera, drawn, is_cut_off, made_femur, made_tibia, poses};

const ROOM: Room = Room {
    columns: 512,
    rows: 512,
    border: 3000,
    runs: 2000,
};

/// A session as C has it.
struct Opened {
    finder: *mut fluoropose_embedded::exports::Opened,
    memory: Vec<u64>,
}

fn opened(implant: &[u8], room: &Room) -> Opened {
    let (bytes, length) = (implant.as_ptr(), implant.len());
    let mut finder = null_mut();
    // SAFETY: all pointers lead to what is said with them; memory and implant outlive the session.
    unsafe {
        let needed = fluoropose_bytes_needed(bytes, length, room);
        assert!(needed > 0 && needed.is_multiple_of(8));
        let mut memory = vec![0u64; needed / 8];
        let place = memory.as_mut_ptr().cast();
        for short in [0, 7, 8, needed / 2, needed - 8] {
            let status = fluoropose_open(&mut finder, bytes, length, 1, room, place, short);
            assert_eq!(
                (status, finder.is_null()),
                (Status::Memory, true),
                "{short} of {needed}"
            );
        }
        let status = fluoropose_open(&mut finder, bytes, length, 0, room, place, needed);
        assert_eq!((status, finder.is_null()), (Status::Ok, false));
        Opened { finder, memory }
    }
}

impl Opened {
    fn rows(&self, mask: &Mask<'_>) {
        // SAFETY: an open session; rows are as long as is said.
        unsafe {
            assert_eq!(fluoropose_begin_rows(self.finder), Status::Ok);
            for row in 0..mask.height() {
                let pixels = (0..mask.width()).map(|column| u8::from(mask.get(column, row)));
                let pixels: Vec<u8> = pixels.collect();
                let status = fluoropose_row(self.finder, row as u32, pixels.as_ptr(), pixels.len());
                assert_eq!(status, Status::Ok);
            }
        }
    }

    fn found(&self) -> FoundNumbers {
        let mut found = FoundNumbers::default();
        // SAFETY: an open session, and room for it.
        assert_eq!(
            unsafe { fluoropose_found_of(self.finder, &mut found) },
            Status::Ok
        );
        found
    }

    fn candidate(&self, number: u32) -> CandidateNumbers {
        let mut candidate = CandidateNumbers::default();
        // SAFETY: an open session, and room for it.
        let status = unsafe { fluoropose_candidate_of(self.finder, number, &mut candidate) };
        assert_eq!(status, Status::Ok);
        candidate
    }

    fn sentence(&self) -> String {
        let mut text = [1i8; 300];
        // SAFETY: an open session, and as much room as is said.
        let length = unsafe { fluoropose_sentence(self.finder, text.as_mut_ptr().cast(), 300) };
        assert_eq!(text[length], 0);
        text[..length]
            .iter()
            .map(|&byte| char::from(byte as u8))
            .collect()
    }
}

#[test]
fn c_finds_what_the_finder_finds_and_so_in_slices() {
    for (own, bytes) in [made_femur(), made_tibia()] {
        let c = opened(bytes.bytes(), &ROOM);
        let file = ImplantFile::open(bytes.bytes()).expect("whole");
        let component = file.component();
        for euler in poses().skip(2).step_by(6) {
            let words = drawn(&own, euler);
            let mask = Mask::new(&words, 512, 512).expect("valid");
            if is_cut_off(&mask) {
                continue;
            }
            let (columns, rows) = mask.bounds();
            let crop = Crop::around(columns, rows, Crop::MARGIN, [512; 2]).expect("some");
            let part = cut_out(&mask, &crop);
            let silhouette = Silhouette::from(&part).in_crop(&crop).expect("inside");
            let camera = camera().cropped(&crop).expect("a part");
            let mut buffers = FinderBuffers::default();
            let mut memory = buffers.borrow(&component, &camera, Kernels::PORTABLE);
            memory.partial = Default::default();
            let options = RefineOptions::default();
            let own = find(
                &component,
                &camera,
                &silhouette,
                Goal::Outline,
                options,
                &mut memory,
            );
            let own = own.expect("found");
            for slices in [u32::MAX, 1] {
                c.rows(&mask);
                // SAFETY: an open session.
                let more = || unsafe { fluoropose_go_on(c.finder, slices) };
                let calls = (1..).find(|_| more() != Status::More).expect("it ends");
                assert!(calls > 10 || slices > 1, "{calls} calls");
                let sides = [crop.width() as u32, crop.height() as u32];
                assert_eq!(c.found().part[2..], sides);
                assert_finds(&c, &own);
            }
        }
    }
}

fn cut_out(mask: &Mask<'_>, crop: &Crop) -> Mask<'static> {
    let words = vec![0; crop.words_needed()].leak();
    let mut part = crop.mask(words).expect("fits");
    for row in crop.rows() {
        for column in crop.columns() {
            let at = (column - crop.columns().start, row - crop.rows().start);
            part.set(at.0, at.1, mask.get(column, row));
        }
    }
    part.into_mask()
}

/// A session has found the same, to the bit.
fn assert_finds(c: &Opened, own: &Found) {
    let decision = own.decide(&Default::default()).expect("some");
    let found = c.found();
    assert_eq!(found.candidates as usize, own.candidates.len());
    assert_eq!(found.chosen as usize, decision.choice.index);
    assert_eq!(c.sentence(), decision.verdict.to_string());
    for (number, own) in own.candidates.iter().enumerate() {
        let there = c.candidate(number as u32);
        assert_eq!(
            (there.rotation, there.translation_mm),
            (own.pose.rotation, own.pose.translation)
        );
        let covariance = own.covariance.map(|own| own.matrix);
        assert_eq!(
            (there.has_covariance > 0).then_some(there.covariance),
            covariance
        );
        assert_eq!((there.misfit_px, there.met), (own.misfit(), own.fit.met));
    }
}

#[test]
fn what_comes_in_a_wrong_order_is_refused() {
    let (own, bytes) = made_femur();
    let c = opened(bytes.bytes(), &ROOM);
    let words = drawn(&own, poses().nth(2).expect("some"));
    let mask = Mask::new(&words, 512, 512).expect("valid");
    let (mut found, mut candidate) = (FoundNumbers::default(), CandidateNumbers::default());
    // SAFETY: an open session; what is not null leads to what is said.
    unsafe {
        assert_eq!(fluoropose_row(c.finder, 0, [1].as_ptr(), 1), Status::Order);
        assert_eq!(fluoropose_find(c.finder), Status::Order);
        assert_eq!(fluoropose_found_of(c.finder, &mut found), Status::Order);
        assert!(c.sentence().starts_with("a silhouette comes first"));
        c.rows(&mask);
        assert_eq!(fluoropose_go_on(c.finder, 3), Status::More);
        // While it works nothing that was found is told; what begins anew gives it up.
        assert_eq!(fluoropose_found_of(c.finder, &mut found), Status::Order);
        assert_eq!(
            fluoropose_candidate_of(c.finder, 0, &mut candidate),
            Status::Order
        );
        let mut camera = CameraNumbers::default();
        assert_eq!(fluoropose_begin_rows(c.finder), Status::Ok);
        assert_eq!(fluoropose_camera_of(c.finder, &mut camera), Status::Ok);
        assert_eq!((camera.width, camera.height), (512, 512));
        assert_eq!(fluoropose_find(c.finder), Status::Silhouette);
        // Nothing that was found is nothing good, and why stays to be told.
        let mut found = FoundNumbers::default();
        let asked = fluoropose_found_of(c.finder, &mut found);
        assert_eq!((asked, found.verdict), (Status::Order, 0));
        assert!(c.sentence().contains("empty"), "{}", c.sentence());
        let row = [1; 512];
        c.rows(&mask);
        assert_eq!(fluoropose_row(c.finder, 5, row.as_ptr(), 512), Status::Rows);
        assert_eq!(fluoropose_find(c.finder), Status::Order);
        // A part of a row would be looked for in another place.
        c.rows(&mask);
        assert_eq!(
            fluoropose_row(c.finder, 511, row.as_ptr(), 500),
            Status::Rows
        );
        assert!(c.sentence().contains("500 pixels"), "{}", c.sentence());
        assert_eq!(fluoropose_find(c.finder), Status::Order);
        c.rows(&mask);
        assert_eq!(fluoropose_find(c.finder), Status::Ok);
        assert_eq!(c.found().verdict, 1);
        assert_eq!(
            fluoropose_candidate_of(c.finder, 99, &mut candidate),
            Status::Order
        );
    }
}

#[test]
fn another_camera_gives_up_what_was_found() {
    let (own, bytes) = made_femur();
    let c = opened(bytes.bytes(), &ROOM);
    let words = drawn(&own, poses().nth(2).expect("some"));
    let mask = Mask::new(&words, 512, 512).expect("valid");
    let (mut found, mut camera) = (FoundNumbers::default(), CameraNumbers::default());
    // SAFETY: an open session; what is not null leads to what is said.
    unsafe {
        c.rows(&mask);
        assert_eq!(fluoropose_find(c.finder), Status::Ok);
        assert_eq!(c.found().verdict, 1);
        assert_eq!(fluoropose_camera_of(c.finder, &mut camera), Status::Ok);
        // Another camera: nothing is left of what was found, and impossible ones are refused.
        camera.fx = f64::NAN;
        assert_eq!(fluoropose_set_camera(c.finder, &camera), Status::Camera);
        camera.fx = camera.fy;
        assert_eq!(fluoropose_set_camera(c.finder, &camera), Status::Ok);
        assert_eq!(fluoropose_found_of(c.finder, &mut found), Status::Order);
        // That of the library, with a detector in front of the implant: what was good is doubtful.
        let mut calibration = CalibrationNumbers {
            width: 512,
            height: 512,
            distance_mm: 600.0,
            pitch_mm: 0.36,
            right_mm: 1.8,
            up_mm: -1.2,
        };
        let set = fluoropose_set_calibration(c.finder, &calibration);
        assert_eq!(set, Status::Ok);
        c.rows(&mask);
        assert_eq!(fluoropose_find(c.finder), Status::Ok);
        assert_eq!(c.found().verdict, 2);
        assert!(
            c.sentence().contains("behind the detector"),
            "{}",
            c.sentence()
        );
        calibration.pitch_mm = 0.0;
        let set = fluoropose_set_calibration(c.finder, &calibration);
        assert_eq!(set, Status::Camera);
    }
}

#[test]
fn pointers_that_lead_nowhere_give_an_error_in_a_session() {
    let (own, bytes) = made_femur();
    let words = drawn(&own, poses().nth(2).expect("some"));
    let mask = Mask::new(&words, 512, 512).expect("valid");
    let c = opened(bytes.bytes(), &ROOM);
    c.rows(&mask);
    let mut memory = vec![0u64; 64];
    let place: *mut u8 = memory.as_mut_ptr().cast();
    let finder = c.finder;
    // SAFETY: an open session; what is not null leads to as much as is said.
    unsafe {
        let odd = place.add(1);
        assert_eq!(fluoropose_outline(finder, null(), 5), Status::Pointer);
        assert_eq!(fluoropose_outline(finder, null(), 0), Status::Outline);
        assert_eq!(fluoropose_outline(finder, odd.cast(), 3), Status::Pointer);
        assert_eq!(
            fluoropose_outline(finder, place.cast(), usize::MAX),
            Status::Pointer
        );
        c.rows(&mask);
        assert_eq!(fluoropose_row(finder, 511, null(), 5), Status::Pointer);
        assert_eq!(fluoropose_row(finder, 511, null(), 0), Status::Rows);
        c.rows(&mask);
        assert_eq!(fluoropose_find(finder), Status::Ok);
        assert_eq!(fluoropose_set_camera(finder, null()), Status::Pointer);
        assert_eq!(fluoropose_camera_of(finder, null_mut()), Status::Pointer);
        assert_eq!(fluoropose_found_of(finder, null_mut()), Status::Pointer);
        assert_eq!(
            fluoropose_candidate_of(finder, 0, odd.cast()),
            Status::Pointer
        );
        // A sentence is cut off, and ends where there is room for its end.
        let whole = c.sentence();
        let (mut text, length) = ([1u8; 6], whole.len());
        let mut sentence = |room| fluoropose_sentence(finder, text.as_mut_ptr().cast(), room);
        assert_eq!([sentence(5), sentence(0)], [length; 2]);
        assert_eq!(
            (&text[..4], &text[4..]),
            (&whole.as_bytes()[..4], &[0, 1][..])
        );
        assert_eq!(fluoropose_sentence(finder, null_mut(), 5), length);
    }
}

#[test]
fn a_pointer_to_nothing_is_told_in_place_of_what_was_told_before() {
    let (_, bytes) = made_femur();
    let c = opened(bytes.bytes(), &ROOM);
    // SAFETY: an open session; no pointer leads to what is not there.
    unsafe {
        assert_eq!(fluoropose_find(c.finder), Status::Order);
        let told_in_order = c.sentence();
        assert_eq!(fluoropose_outline(c.finder, null(), 4), Status::Pointer);
        let told = c.sentence();
        assert!(told.contains("pointer") && told != told_in_order, "{told}");
        assert_eq!(fluoropose_camera_of(c.finder, null_mut()), Status::Pointer);
        assert_eq!(c.sentence(), told);
    }
}

#[test]
fn no_outline_ends_the_program() {
    let (_, bytes) = made_femur();
    let c = opened(
        bytes.bytes(),
        &Room {
            columns: 250,
            rows: 250,
            ..ROOM
        },
    );
    let mut state = 7u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    let mut reached = BTreeMap::new();
    for _ in 0..100 {
        let corners = 3 + (random() * 6.0) as usize;
        let size = random() * 450.0;
        let [left, top] = [(); 2].map(|()| 100.0 + random() * 312.0);
        let mut points: Vec<Point> = (0..corners)
            .map(|_| {
                Point::new(
                    left + size * (random() - 0.5),
                    top + size * (random() - 0.5),
                )
            })
            .collect();
        if random() < 0.05 {
            points[0].row = f64::NAN;
        }
        // SAFETY: an open session; as many points as are said.
        let status = unsafe {
            match fluoropose_outline(c.finder, points.as_ptr(), points.len()) {
                Status::Ok => fluoropose_find(c.finder),
                status => status,
            }
        };
        *reached.entry(format!("{status:?}")).or_insert(0) += 1;
        if status == Status::Ok {
            assert!(c.found().candidates > 0);
        } else {
            assert!(!c.sentence().is_empty());
        }
    }
    for status in ["Ok", "Outline", "Silhouette"] {
        assert!(reached.contains_key(status), "{reached:?}");
    }
}
