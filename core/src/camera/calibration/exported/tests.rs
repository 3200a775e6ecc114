use crate::camera::calibration::Calibration;
use crate::camera::calibration::tests::lens;
use std::format;
use std::string::{String, ToString};

/// What OpenCV's calibration sample writes.
const OPENCV: &str = "%YAML:1.0\n---\ncalibration_time: \"Mon Jan  1 10:00:00 2018\"\nimage_width: 1024\nimage_height: 768\nboard_width: 9\n\
    camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 3.2e+03, 0., 510.5, 0.,\n       3180., 380., 0., 0., 1. ]\n\
    distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   data: [ 0., 0., 0., 0., 0. ]\navg_reprojection_error: 0.21\n";

const XML: &str = "<?xml version=\"1.0\"?>\n<opencv_storage>\n<!-- room 2: <K>1</K> -->\n<imageSize>\n  1024 768</imageSize>\n<cameraMatrix type_id=\"opencv-matrix\">\n  <rows>3</rows>\n  \
    <cols>3</cols>\n  <dt>d</dt>\n  <data>\n    3200. 0. 510.5 0. 3180. 380. 0. 0. 1.</data></cameraMatrix>\n<distCoeffs type_id=\"opencv-matrix\">\n  \
    <rows>1</rows>\n  <cols>4</cols>\n  <dt>d</dt>\n  <data>\n    0. 0. 0. 0.</data></distCoeffs>\n</opencv_storage>\n";

/// The same camera in forms that other programs and hands write.
const OTHERS: [&str; 8] = [
    // ROS, a file and a message.
    "image_width: 1024\nimage_height: 768\ncamera_name: knee\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [3200, 0, 510.5, 0, 3180, 380, 0, 0, 1]\n\
     distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0, 0, 0, 0, 0]\nrectification_matrix:\n  rows: 3\n  cols: 3\n  \
     data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nprojection_matrix:\n  rows: 3\n  cols: 4\n  data: [3200, 0, 510.5, 0, 0, 3180, 380, 0, 0, 0, 1, 0]\n",
    "height: 768\nwidth: 1024\ndistortion_model: ''\nD: []\nK:\n- 3200.0\n- 0.0\n- 510.5\n- 0.0\n- 3180.0\n- 380.0\n- 0.0\n- 0.0\n- 1.0\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n\
     binning_x: 0\nbinning_y: 0\nroi:\n  x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0\n",
    // Python's JSON, on one line, with a number sign in a text.
    "{\"note\": \"run #3\", \"camera_matrix\": [[3200.0, 0.0, 510.5], [0.0, 3180.0, 380.0], [0.0, 0.0, 1.0]], \"dist_coeffs\": [[0.0, 0.0]], \"image_width\": 1024, \"image_height\": 768}",
    // Python's YAML.
    "K:\n- - 3200.0\n  - 0.0\n  - 510.5\n- - 0.0\n  - 3180.0\n  - 380.0\n- - 0.0\n  - 0.0\n  - 1.0\nimage_size: [1024, 768]\n",
    // MATLAB, by columns, pixels from 1, height first.
    "{\"RadialDistortion\":[0,0],\"TangentialDistortion\":[0,0],\"ImageSize\":[768,1024],\"EstimateTangentialDistortion\":false,\"NumRadialDistortionCoefficients\":2,\
     \"IntrinsicMatrix\":[[3200,0,0],[0,3180,0],[511.5,381,1]],\"K\":[[3200,0,511.5],[0,3180,381],[0,0,1]]}",
    "  cameraIntrinsics with properties:\n\n             FocalLength: [3200 3180]\n          PrincipalPoint: [511.5000 381]\n               ImageSize: [768 1024]\n        \
     RadialDistortion: [0 0]\n    TangentialDistortion: [0 0]\n                    Skew: 0\n                       K: [3\u{d7}3 double]\n",
    // The toolbox that MATLAB had before, pixels from 0.
    "% Intrinsic and Extrinsic Camera Parameters\n\nfc = [ 3200.000 ; 3180.000 ];\ncc = [ 510.500 ; 380.000 ];\nalpha_c = 0.000;\nkc = [ 0.0 ; 0.0 ; 0.0 ; 0.0 ; 0.0 ];\n\
     fc_error = [ 1.1 ; 1.2 ];\nnx = 1024;\nny = 768;\nomc_1 = [ 1 ; 2 ; 3 ];\n",
    "# by hand\r\ncamera_matrix = [3200 0 510.5; 0 3180 380; 0 0 1]\r\nimage_width = 1024\r\nimage_height = 768\r\n",
];

fn told(text: &str) -> String {
    let read = Calibration::parse(text);
    read.expect_err(text).to_string()
}

#[test]
fn one_camera_is_the_same_whoever_wrote_it() {
    let same = "image size\n1024,768\ncamera matrix\n3200,0,510.5\n0,3180,380\n0,0,1\n";
    let same = Calibration::parse(same);
    assert!(same.is_ok());
    let written = same.expect("valid").to_string();
    assert_eq!(Calibration::parse_own(&written), same.map(Some));
    for text in OTHERS.into_iter().chain([OPENCV, XML]) {
        assert_eq!(Calibration::parse(text), same, "{text}");
        assert_eq!(Calibration::parse_own(text), Ok(None), "{text}");
        let with_mark = format!("\u{feff}{}", text.replace('\n', "\r\n"));
        assert_eq!(Calibration::parse(&with_mark), same, "{text}");
    }
}

/// What another picture of the implant would come from, or no camera: changes of the file, and words of why it is refused.
const CHANGED: [(&str, &str, &str); 15] = [
    (
        "0., 0., 0., 0., 0. ]",
        "-0.21, 0., 0., 0., 0. ]",
        "a distortion (-0.21 among",
    ),
    (
        "0., 0., 0., 0., 0. ]",
        ".Nan, 0., 0., 0., 0. ]",
        "a distortion (NaN among",
    ),
    ("image_width: 1024\n", "", "not the size of the frames"),
    (
        "image_width: 1024\n",
        "image_width: 1024.5\n",
        "not one whole number",
    ),
    ("board_width: 9\n", "width: 512\n", "not one whole number"),
    (
        "board_width: 9\n",
        "roi: { x_offset: 128 }\n",
        "a region or a binning of the frames (128 pixels)",
    ),
    (
        "board_width: 9\n",
        "binning_x: 2\n",
        "a region or a binning of the frames (2 pixels)",
    ),
    (
        "board_width: 9\n",
        "M2: [ 1, 0, 2, 0, 1, 2, 0, 0, 1 ]\n",
        "several camera matrices",
    ),
    ("board_width: 9\n", "k1: 0.3\n", "a distortion (0.3 among"),
    ("board_width: 9\n", "skew: 0.1\n", "skewed pixels"),
    ("3.2e+03, 0., 510.5", "3.2e+03, 2., 510.5", "skewed pixels"),
    (
        "3.2e+03, 0., 510.5, 0.,",
        "3.2e+03, 0., 510.5,",
        "has 8 numbers, and nine",
    ),
    ("3.2e+03", ".inf", "horizontal focal length"),
    (
        "3.2e+03, 0., 510.5, 0.,\n       3180.",
        "3.2, 0., 510.5, 0.,\n       3.18",
        "at least a tenth",
    ),
    (
        "510.5, 0.,\n       3180., 380., 0., 0., 1.",
        "0., 0.,\n       3180., 0., 510.5, 380., 1.",
        "the camera matrix is transposed, its principal point 510.5,380",
    ),
];

/// Nothing that would make another picture of the implant is left out.
#[test]
fn what_is_not_taken_into_account_is_refused() {
    for (from, to, words) in CHANGED {
        let text = OPENCV.replace(from, to);
        assert_ne!(text, OPENCV, "{to}");
        let told = told(&text);
        assert!(told.contains(words), "{to}: {told}");
    }
    let by_rows = OTHERS[4].replace(
        "[[3200,0,0],[0,3180,0],[511.5,381,1]]",
        "[[3200,0,511.5],[0,3180,381],[0,0,1]]",
    );
    assert!(told(&by_rows).contains("IntrinsicMatrix is by rows"));
    let transposed = OTHERS[3]
        .replace("  - 510.5\n", "  - 0\n")
        .replace("  - 380.0\n", "  - 0\n")
        .replace("- - 0.0\n  - 0.0\n  - 1.0", "- - 510.5\n  - 380\n  - 1.0");
    assert!(told(&transposed).contains("is transposed"));
}

#[test]
fn numbers_alone_are_told_for_what_they_are() {
    // As `numpy.savetxt` writes three rows of three.
    let nine = "3.200000000000000000e+03 0.000000000000000000e+00 5.105e+02\n0 3180 380\n0 0 1\n";
    assert!(told(nine).contains("nine numbers of a camera matrix alone"));
    let five = "12.1,-30,400\n10,20,30\n0,0,-100\n512,512,0\n1,0,0\n";
    assert!(told(five).contains("export the camera as MayaCam 2.0"));
    assert!(told("1 2 3\n4 5 6\n").contains("this is not a calibration"));
    assert!(told("name: knee\nside: left\n").contains("this is not a calibration"));
}

#[test]
fn a_file_cut_anywhere_is_refused_or_of_the_same_camera() {
    for text in OTHERS.into_iter().chain([OPENCV, XML]) {
        let whole = Calibration::parse(text).expect("valid");
        for length in (0..text.len()).filter(|&length| text.is_char_boundary(length)) {
            // A size's last digits may be gone: it is held against the frames'.
            if let Ok(left) = Calibration::parse(&text[..length]) {
                assert_eq!(lens(&left), lens(&whole), "{length} of {text}");
            }
        }
    }
}
