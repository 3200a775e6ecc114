//! Frames a second.

use fluoropose_decode::FrameFile;

use super::{join, nested};
use crate::samples::dicom::{Builder, EXPLICIT};

/// Of what a file says of times the most exact counts, and uneven ones are no rate.
#[test]
fn frames_a_second_come_from_times_or_rate() {
    let rate = |stated: &[(u32, &[u8; 2], &str)]| {
        let mut file = Builder::new(EXPLICIT);
        for &(tag, kind, value) in stated {
            file.text(tag, kind, value);
        }
        let image = Builder::image(EXPLICIT, 1, 1, 8, 4);
        let bytes = join(file, image).octets(&[1, 2, 3, 4]);
        FrameFile::open(bytes, "a.dcm").unwrap().frames_per_s()
    };
    let cine = (0x0018_0040, b"IS", "25");
    let time = |ms| (0x0018_1063, b"DS", ms);
    let times = |ms| (0x0018_1065, b"DS", ms);
    let recommended = (0x0008_2144, b"IS", "12");
    assert_eq!(rate(&[]), None);
    assert_eq!(rate(&[recommended]), Some(12.0));
    assert_eq!(rate(&[recommended, cine]), Some(25.0));
    assert_eq!(rate(&[cine]), Some(25.0));
    assert_eq!(rate(&[cine, time("66.67")]), Some(15.0));
    let ntsc = rate(&[time("33.367")]).unwrap();
    assert!((ntsc - 29.97).abs() < 1e-3, "{ntsc}");
    assert_eq!(rate(&[cine, time("0")]), Some(25.0));
    assert_eq!(rate(&[time("40"), times("0\\133\\134\\133")]), Some(7.5));
    assert_eq!(rate(&[cine, times("0\\33\\66\\33")]), None);
    assert_eq!(rate(&[cine, times("0")]), Some(25.0));
    // Of a long film.
    let long = ["0"]
        .into_iter()
        .chain(vec!["33.333"; 3000])
        .collect::<Vec<_>>();
    assert_eq!(rate(&[times(&long.join("\\"))]), Some(30.0));
}

/// Enhanced objects say of each frame when it was taken.
#[test]
fn frames_a_second_come_from_when_each_was_taken() {
    let rate = |moments: &[&str]| {
        let item = |moment: &&str| {
            let mut content = Builder::new(EXPLICIT);
            content.text(0x0018_9074, b"DT", moment);
            nested(EXPLICIT, 0x0020_9111, true, &[content.into_data_set()])
        };
        let items: Vec<_> = moments.iter().map(item).collect();
        let mut file = Builder::image(EXPLICIT, 1, 1, 8, moments.len());
        file.verbatim(&nested(EXPLICIT, 0x5200_9230, true, &items));
        let bytes = file.octets(&vec![1; moments.len()]);
        FrameFile::open(bytes, "a.dcm").unwrap().frames_per_s()
    };
    let even = [
        "20240229235959.800",
        "20240229235959.933333",
        "20240229235960.066667",
    ];
    assert_eq!(rate(&even), Some(7.5));
    assert_eq!(
        rate(&["20240101120000.1+0100", "20240101120000.2+0100"]),
        Some(10.0)
    );
    assert_eq!(
        rate(&["20240101120000.1", "20240101120000.2", "20240101120000.9"]),
        None
    );
    assert_eq!(rate(&["20240101120000.1", "2024"]), None);
    assert_eq!(rate(&["20240101120000.1"]), None);
}
