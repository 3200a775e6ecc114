use super::*;
use crate::drawing::Colour;

/// The elements of a master, each with where it begins.
fn elements(bytes: &[u8]) -> Vec<(u32, usize, &[u8])> {
    let mut found = Vec::new();
    let mut place = 0;
    while place < bytes.len() {
        let long = bytes[place].leading_zeros() as usize + 1;
        let name = bytes[place..place + long].iter();
        let name = name.fold(0, |name, &byte| name << 8 | u32::from(byte));
        let inside = place + long + 8;
        let len = bytes[place + long + 1..inside].iter();
        let len = len.fold(0, |len, &byte| len << 8 | usize::from(byte));
        found.push((name, place, &bytes[inside..inside + len]));
        place = inside + len;
    }
    found
}

fn inside(bytes: &[u8], name: u32) -> &[u8] {
    let parts = elements(bytes);
    parts.iter().find(|part| part.0 == name).unwrap().2
}

fn whole(bytes: &[u8]) -> u64 {
    u64::from_be_bytes(bytes.try_into().unwrap())
}

#[test]
fn every_frame_is_found_at_its_time() {
    let frames: Vec<Vec<u8>> = (0..30).map(|k| vec![k; 1 + 40 * usize::from(k)]).collect();
    let film = webm(frames.clone(), [640, 480], 15.0);
    let segment = inside(&film, id::SEGMENT);
    let length = inside(inside(segment, id::INFO), id::DURATION);
    assert_eq!(f64::from_be_bytes(length.try_into().unwrap()), 2000.0);
    let track = inside(inside(segment, id::TRACKS), id::TRACK);
    assert_eq!(whole(inside(track, id::DEFAULT_DURATION)), 66_666_667);
    assert_eq!(
        whole(inside(inside(track, id::VIDEO), id::PIXEL_WIDTH)),
        640
    );
    let clusters = elements(segment);
    let clusters = clusters.iter().filter(|part| part.0 == id::CLUSTER);
    let cues = elements(inside(segment, id::CUES));
    assert_eq!((cues.len(), clusters.clone().count()), (30, 30));
    for (k, (cue, (_, place, cluster))) in cues.iter().zip(clusters).enumerate() {
        let told = inside(cue.2, id::CUE_POSITIONS);
        assert_eq!(whole(inside(told, id::CUE_CLUSTER_POSITION)), *place as u64);
        let time = (k as f64 * 1000.0 / 15.0).round() as u64;
        assert_eq!(whole(inside(cue.2, id::CUE_TIME)), time);
        assert_eq!(whole(inside(cluster, id::TIMESTAMP)), time);
        assert_eq!(inside(cluster, id::SIMPLE_BLOCK)[4..], frames[k]);
    }
}

#[test]
fn a_picture_is_a_key_frame_of_its_size() {
    let frame = Picture::plain([50, 34], Colour::grey(90)).coded().unwrap();
    assert_eq!(frame[0] & 1, 0);
    assert_eq!(frame[3..10], [0x9d, 0x01, 0x2a, 50, 0, 34, 0]);
    let error = Picture::plain([0, 0], Colour::grey(0)).coded().unwrap_err();
    assert!(error.to_string().contains("0 x 0"), "{error}");
}
