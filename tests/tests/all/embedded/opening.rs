//! What is opened in C, and what is told as no session.

use std::ptr::{null, null_mut};

use fluoropose::Point;
use fluoropose_embedded::exports::*;
use fluoropose_embedded::{
    CalibrationNumbers, CameraNumbers, CandidateNumbers, FoundNumbers, Room, Status,
};

use super::{ROOM, opened};
use crate::made_implant::made_femur;

#[test]
fn nothing_is_opened_by_pointers_that_lead_nowhere() {
    let (_, bytes) = made_femur();
    let (file, length) = (bytes.bytes().as_ptr(), bytes.bytes().len());
    let mut memory = vec![0u64; 64];
    let place: *mut u8 = memory.as_mut_ptr().cast();
    let room: *const Room = &ROOM;
    // SAFETY: what is not null leads to as much as is said.
    unsafe {
        let odd = place.add(1);
        for (status, file, length, room, place) in [
            (Status::Pointer, file, length, null(), place),
            (Status::Pointer, file, length, room, null_mut()),
            (Status::Pointer, file, length, room, odd),
            (Status::Pointer, file, length, odd.cast(), place),
            (Status::Pointer, null(), length, room, place),
            (Status::Implant, file.add(1), length - 1, room, place),
            (Status::Implant, file, 7, room, place),
            (Status::Pointer, file, usize::MAX, room, place),
            (Status::Implant, null(), 0, room, place),
        ] {
            for trusted in [0, 1] {
                let mut finder = place.cast();
                let opened = fluoropose_open(&mut finder, file, length, trusted, room, place, 504);
                assert_eq!((opened, finder.is_null()), (status, true));
            }
        }
        let opened = fluoropose_open(null_mut(), file, length, 1, &ROOM, place, 512);
        assert_eq!(opened, Status::Pointer);
        assert_eq!(fluoropose_bytes_needed(null(), length, &ROOM), 0);
        assert_eq!(fluoropose_bytes_needed(file, length, null()), 0);
    }
}

#[test]
fn nothing_is_opened_in_rooms_that_no_memory_has() {
    let (_, bytes) = made_femur();
    let (file, length) = (bytes.bytes().as_ptr(), bytes.bytes().len());
    let (mut finder, mut memory) = (null_mut(), vec![0u64; 64]);
    let place = memory.as_mut_ptr().cast();
    for [columns, rows] in [[0, 9], [9, 0], [u32::MAX; 2]] {
        let room = Room {
            columns,
            rows,
            ..ROOM
        };
        // SAFETY: the bytes are as many as is said.
        let needed = unsafe { fluoropose_bytes_needed(file, length, &room) };
        assert_eq!(needed, 0);
    }
    for border in [u32::MAX, 1 << 31] {
        // A list that no memory has on 32 bits; on 64, one that is longer than what is given.
        let room = Room {
            border,
            runs: border,
            ..ROOM
        };
        // SAFETY: bytes and memory are as long as is said.
        let opened = unsafe { fluoropose_open(&mut finder, file, length, 1, &room, place, 512) };
        assert_eq!(opened, Status::Memory);
    }
}

#[test]
fn what_is_no_session_is_refused_by_each_function() {
    let (_, bytes) = made_femur();
    let (file, length) = (bytes.bytes().as_ptr(), bytes.bytes().len());
    let (mut unopened, mut memory) = (null_mut(), vec![0u64; 64]);
    let place: *mut u8 = memory.as_mut_ptr().cast();
    let none = Status::Pointer;
    // SAFETY: what is not null leads to as much as is said.
    unsafe {
        let opened = fluoropose_open(&mut unopened, file, length, 1, &ROOM, place, 512);
        assert_eq!((opened, unopened.is_null()), (Status::Memory, true));
        // Null, at an odd place, one that could not be opened.
        for finder in [null_mut(), place.add(1).cast(), place.cast()] {
            let mut camera = CameraNumbers::default();
            assert_eq!(fluoropose_camera_of(finder, &mut camera), none);
            assert_eq!(fluoropose_set_camera(finder, &camera), none);
            let calibration = CalibrationNumbers::default();
            assert_eq!(fluoropose_set_calibration(finder, &calibration), none);
            let point = [Point::new(0.0, 0.0)];
            assert_eq!(fluoropose_outline(finder, point.as_ptr(), 1), none);
            assert_eq!(fluoropose_begin_rows(finder), none);
            assert_eq!(fluoropose_row(finder, 0, [1].as_ptr(), 1), none);
            assert_eq!(fluoropose_find(finder), none);
            assert_eq!(fluoropose_go_on(finder, 1), none);
            let before = CandidateNumbers::default();
            assert_eq!(fluoropose_near(finder, &before), none);
            let mut found = FoundNumbers::default();
            assert_eq!(fluoropose_found_of(finder, &mut found), none);
            let mut candidate = CandidateNumbers::default();
            assert_eq!(fluoropose_candidate_of(finder, 0, &mut candidate), none);
            assert_eq!(fluoropose_sentence(finder, null_mut(), 0), 0);
        }
        // Bytes are asked for themselves, where there is no session.
        let mut text = [0u8; 200];
        let out: *mut std::ffi::c_char = text.as_mut_ptr().cast();
        assert_eq!(fluoropose_implant_sentence(file, length, 0, out, 200), 0);
        let said = fluoropose_implant_sentence(file, length - 1, 0, out, 200);
        let said = String::from_utf8_lossy(&text[..said.min(199)]).into_owned();
        assert!(said.contains("cut or padded"), "{said}");
        assert!(fluoropose_implant_sentence(null(), 5, 1, null_mut(), 5) > 0);
    }
}

/// What tells a session is read before it is known that there is one: no more than its first bytes may be looked at.
#[test]
fn a_session_is_told_by_its_first_bytes_and_none_is_left_where_another_could_not_be_made() {
    let (_, bytes) = made_femur();
    let c = opened(bytes.bytes(), &ROOM);
    assert_eq!(c.memory[0].to_le_bytes()[..4], *b"FLPO");
    let (file, length) = (bytes.bytes().as_ptr(), bytes.bytes().len());
    let (mut again, mut memory) = (null_mut(), c.memory);
    let room: *const Room = &ROOM;
    // SAFETY: bytes and memory are as long as is said, and the first session is not gone on with where it is none.
    unsafe {
        let place = memory.as_mut_ptr().cast();
        let short = 8 * memory.len() - 8;
        let status = fluoropose_open(&mut again, file, length, 1, room, place, short);
        assert_eq!((status, again.is_null()), (Status::Memory, true));
        let before = place.cast();
        assert_eq!(fluoropose_begin_rows(before), Status::Pointer);
    }
}
