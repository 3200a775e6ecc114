use fluoropose_decode::{Kind, sniff, sniff_head};

use crate::samples::dicom::{Builder, EXPLICIT};
use crate::samples::models::{obj, ply_ascii, ply_little, stl_ascii, stl_binary};
use crate::samples::{bmp, jpeg, png, raw_tiff};

#[test]
fn the_beginning_and_the_length_tell_as_much_as_the_whole() {
    let stl = stl_binary("any header");
    assert_eq!(sniff_head(&stl[..84], stl.len(), ""), Kind::Stl);
    assert_eq!(sniff_head(&stl[..84], stl.len() + 1, ""), Kind::Unknown);
}

#[test]
fn an_array_is_told_by_its_mark() {
    assert_eq!(sniff(b"\x93NUMPY\x01\0", "mask.dat"), Kind::Numpy);
}

#[test]
fn outlines_of_other_programs_are_told_by_what_stands_in_them() {
    let labelme = "{\"version\": \"5.4.1\", \"shapes\": [], \"imagePath\": \"a.png\"}";
    assert_eq!(sniff(labelme.as_bytes(), "a.json"), Kind::Labelme);
    assert_eq!(sniff(b"{\"shapes\": []}", "a.json"), Kind::Unknown);
    assert_eq!(sniff(b"Iout\0\xE5\0\0", "a.roi"), Kind::Imagej);
    let zip = |name: &str| {
        let mut zip = b"PK\x03\x04".to_vec();
        zip.extend([0; 22]);
        zip.extend((name.len() as u16).to_le_bytes());
        zip.extend([0; 2]);
        zip.extend(name.bytes());
        zip
    };
    assert_eq!(sniff(&zip("0001-0020-0030.roi"), "a.zip"), Kind::Imagej);
    assert_eq!(sniff(&zip("notes.txt"), "a.zip"), Kind::Unknown);
    assert_eq!(sniff(&zip("a.roi")[..33], "a.zip"), Kind::Unknown);
}

#[test]
fn content_decides_whatever_the_name() {
    use png::{BitDepth::Eight, ColorType::Grayscale};
    let cases: Vec<(Vec<u8>, Kind)> = vec![
        (png(1, 1, Grayscale, Eight, &[1]), Kind::Png),
        (jpeg(8, 8, &[1; 64], false), Kind::Jpeg),
        (raw_tiff(&[], &[]), Kind::Tiff),
        (bmp::grey(2, 2, &[0; 4]), Kind::Bmp),
        (
            Builder::image(EXPLICIT, 1, 1, 8, 1).octets(&[1]),
            Kind::Dicom,
        ),
        (stl_binary("solid facet"), Kind::Stl),
        (stl_ascii().into_bytes(), Kind::Stl),
        (obj().into_bytes(), Kind::Obj),
        (ply_ascii().into_bytes(), Kind::Ply),
        (ply_little(), Kind::Ply),
        (b"JT_EULER_312\nx, y, z\n1 2 3 4 5 6\n".to_vec(), Kind::Jts),
        (b"JTA_EULER_KINEMATICS\nX_TRAN\n".to_vec(), Kind::Jts),
        (b"JTA_EULER_POSE\nX_TRAN\n".to_vec(), Kind::Jts),
        (
            b"\xEF\xBB\xBF JT_INTCALIB\r\n1198\r\n".to_vec(),
            Kind::Calibration,
        ),
        (b"Image Size\n1024,1024\n".to_vec(), Kind::Mayacam),
        (b"FLUOROPL\0\0\0\0".to_vec(), Kind::Library),
        (
            b"{ \"format\": \"fluoropose-session\" }".to_vec(),
            Kind::Session,
        ),
        (
            b"{\"kind\":\"fluoropose-outlines\",\"version\":1}".to_vec(),
            Kind::Outlines,
        ),
        (
            b"{\"info\": {}, \"images\": [], \"annotations\": []}".to_vec(),
            Kind::Coco,
        ),
        (
            b"{\"kind\":\"fluoropose-distortion\",\"version\":1}".to_vec(),
            Kind::Distortion,
        ),
        (b"side = 1\r\n[[component]]\r\n".to_vec(), Kind::Study),
        (b"\x1A\x45\xDF\xA3webm".to_vec(), Kind::Video),
        (b"\0\0\0\x20ftypisom\0\0".to_vec(), Kind::Video),
        (b"RIFF\0\0\0\0AVI LIST".to_vec(), Kind::Video),
        (b"ISO-10303-21;\nHEADER;\n".to_vec(), Kind::OtherModel),
        (b"\0\0\0\x20ftypheic\0\0".to_vec(), Kind::Unknown),
        (b"{ \"format\": \"another\" }".to_vec(), Kind::Unknown),
        (b"".to_vec(), Kind::Unknown),
        (b"once upon a time".to_vec(), Kind::Unknown),
    ];
    for (bytes, kind) in cases {
        for name in ["", "x.bin", "no extension"] {
            assert_eq!(sniff(&bytes, name), kind);
        }
        if kind != Kind::Unknown {
            assert_eq!(sniff(&bytes, "x.png"), kind);
        }
    }
}

/// Whether it says enough of a camera, its reader tells.
#[test]
fn calibrations_of_other_programs_are_recognised_and_programs_are_not() {
    for (text, kind) in [
        ("# room 2\nJT_INTCALIB 1198 0 0 0.373\n", Kind::Calibration),
        ("# left\nImage size:\n1024,1024\n", Kind::Mayacam),
        (
            "%YAML:1.0\n---\nM1: !!opencv-matrix\n   rows: 3\n",
            Kind::Mayacam,
        ),
        (
            "<?xml version=\"1.0\"?>\n<opencv_storage>\n<cameraMatrix type_id=\"opencv-matrix\">",
            Kind::Mayacam,
        ),
        (
            "image_width: 640\ncamera_matrix:\n  rows: 3\n",
            Kind::Mayacam,
        ),
        (
            "{\"ImageSize\":[768,1024],\"IntrinsicMatrix\":[[1]]}",
            Kind::Mayacam,
        ),
        (
            "% Intrinsic parameters\nfc = [ 1 ; 2 ];\ncc = [ 3 ; 4 ];\n",
            Kind::Mayacam,
        ),
        ("K:\n- 3200.0\nheight: 3\n", Kind::Mayacam),
        ("1e3 0 512\n0 1e3 512\n0 0 1\n", Kind::Mayacam),
        ("1,2,3\n1,2,3\n1,2,3\n1,2,3\n1,2,3\n", Kind::Mayacam),
        ("1 2 3\n4 5 6\n", Kind::Unknown),
        ("import cv2\ncamera_matrix = np.eye(3)\n", Kind::Unknown),
        ("# Notes\nThe camera_matrix is in K.\n", Kind::Unknown),
    ] {
        assert_eq!(sniff(text.as_bytes(), "x.txt"), kind, "{text}");
    }
}

#[test]
fn a_name_helps_where_content_cannot_tell() {
    assert_eq!(sniff(&[0; 50], "Knee.STL"), Kind::Stl);
    assert_eq!(sniff(&[0; 50], "run.dcm"), Kind::Dicom);
    assert_eq!(sniff(b"garbage", "x.png"), Kind::Png);
    assert_eq!(sniff(b"PK\x03\x04", "Tray.3MF"), Kind::OtherModel);
    assert_eq!(sniff(b"", "x.png"), Kind::Unknown);
}
