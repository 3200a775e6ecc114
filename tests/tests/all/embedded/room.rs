//! What a session of the C interface has no room for is refused, and named.

use fluoropose::Mask;
use fluoropose_embedded::exports::*;
use fluoropose_embedded::{Room, Status};

use super::{ROOM, opened};
use crate::made_implant::{drawn, made_femur, made_tibia, poses};

#[test]
fn what_there_is_no_room_for_is_refused() {
    let (own, bytes) = made_femur();
    let words = drawn(&own, poses().nth(2).expect("some"));
    let mask = Mask::new(&words, 512, 512).expect("valid");
    let small = opened(
        bytes.bytes(),
        &Room {
            columns: 64,
            rows: 64,
            ..ROOM
        },
    );
    small.rows(&mask);
    // SAFETY: open sessions; rows are as long as is said.
    unsafe {
        assert_eq!(fluoropose_find(small.finder), Status::Silhouette);
        assert!(
            small
                .sentence()
                .ends_with("are needed; the session has room for 64"),
            "{}",
            small.sentence()
        );
        let short = opened(bytes.bytes(), &Room { border: 50, ..ROOM });
        short.rows(&mask);
        assert_eq!(fluoropose_find(short.finder), Status::Silhouette);
        assert!(
            short
                .sentence()
                .ends_with("pixels of border are needed; the session has room for 50"),
            "{}",
            short.sentence()
        );
        let few = opened(bytes.bytes(), &Room { runs: 1, ..ROOM });
        assert_eq!(fluoropose_begin_rows(few.finder), Status::Ok);
        assert_eq!(
            fluoropose_row(few.finder, 0, [1, 0, 1].as_ptr(), 3),
            Status::Rows
        );
        assert_eq!(fluoropose_begin_rows(few.finder), Status::Ok);
        assert_eq!(
            fluoropose_row(few.finder, 0, [1; 600].as_ptr(), 600),
            Status::Rows
        );
        assert_eq!(
            fluoropose_row(few.finder, 600, [1].as_ptr(), 1),
            Status::Order
        );
    }
}

/// A silhouette with its margin fits by columns and rows, not by words: 65 to 128 columns take as many.
#[test]
fn a_room_is_of_columns_and_rows_and_one_too_few_is_named() {
    let (own, bytes) = made_femur();
    let words = drawn(&own, poses().nth(2).expect("some"));
    let mask = Mask::new(&words, 512, 512).expect("valid");
    let (columns, rows) = mask.bounds();
    let [columns, rows] = [columns, rows].map(|side| side.len() as u32 + 48);
    let of = |columns, rows| Room {
        columns,
        rows,
        ..ROOM
    };
    for (room, lack) in [
        (of(columns, rows), None),
        (of(columns - 1, rows), Some(("columns", columns))),
        (of(2 * columns, rows - 1), Some(("rows", rows))),
    ] {
        let c = opened(bytes.bytes(), &room);
        c.rows(&mask);
        // SAFETY: an open session.
        let status = unsafe { fluoropose_find(c.finder) };
        let Some((what, needed)) = lack else {
            assert_eq!(status, Status::Ok, "{}", c.sentence());
            continue;
        };
        assert_eq!(status, Status::Silhouette);
        let sentence = format!(
            "{needed} {what} are needed; the session has room for {}",
            needed - 1
        );
        assert_eq!(c.sentence(), sentence);
    }
}

/// Poses whose outlines are shorter than the right one's would be left over, and the best of these taken: so it was of this tray with room for
/// 289 to 299 pixels, where the right pose takes 300.
#[test]
fn with_too_little_room_for_outlines_nothing_is_found_and_the_room_is_named() {
    let (own, bytes) = made_tibia();
    let words = drawn(&own, poses().nth(6).expect("some"));
    let mask = Mask::new(&words, 512, 512).expect("valid");
    let found = |border| {
        let c = opened(bytes.bytes(), &Room { border, ..ROOM });
        c.rows(&mask);
        // SAFETY: an open session.
        match unsafe { fluoropose_find(c.finder) } {
            Status::Ok => Ok(c.candidate(0).rotation),
            status => Err((status, c.sentence())),
        }
    };
    let plenty = found(ROOM.border).expect("found");
    let mut refused = 0;
    for border in 270..310 {
        match found(border) {
            Ok(rotation) => assert_eq!(rotation, plenty, "{border}"),
            Err((status, sentence)) => {
                assert_eq!(status, Status::Silhouette);
                assert!(
                    sentence.ends_with(&format!("room for {border}")),
                    "{sentence}"
                );
                refused += 1;
            }
        }
    }
    assert!((1..40).contains(&refused), "{refused} refused");
}
