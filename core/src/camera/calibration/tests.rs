use super::*;
use std::string::ToString;

const MATRIX: &str = "image size\r\n1024,768\r\n\r\ncamera matrix\r\n3200,0,510.5\r\n0,3180,380\r\n0,0,1\r\n\r\n\
    rotation\r\n0,-1,0\r\n1,0,0\r\n0,0,1\r\n\r\ntranslation\r\n1\r\n-2\r\n3.5\r\n";

/// The focal lengths and the principal point of a camera matrix.
pub(super) fn lens(calibration: &Calibration) -> [[f64; 2]; 2] {
    match *calibration {
        Calibration::CameraMatrix { focal, centre, .. } => [focal, centre],
        Calibration::PrincipalDistance { .. } => panic!("a camera matrix"),
    }
}

#[test]
fn jt_intcalib_is_read_and_written() {
    let text = "JT_INTCALIB\n1198\n0\n-1.5\n0.373\n";
    let calibration = Calibration::parse(text).expect("valid");
    assert_eq!(calibration.to_string(), text);
    assert_eq!(calibration.principal_distance(), Some(1198.0));
    let camera = calibration.camera(1024, 1024).expect("valid");
    assert_eq!(camera.focal(), [1198.0 / 0.373; 2]);
    assert_eq!(camera.principal_point(), [512.0, 512.0 + 1.5 / 0.373]);
    let spaced = "\u{feff}JT_INTCALIB \r\n\r\n 1198 \r\n0\r\n -1.5,\r\n.373";
    assert_eq!(Calibration::parse(spaced), Ok(calibration));
    let later = text.replace("JT_", "JTA_");
    assert_eq!(Calibration::parse(&later), Ok(calibration));
}

#[test]
fn below_the_pixel_pitch_stand_notes_and_no_number() {
    let text = "JT_INTCALIB\n1198\n0\n-1.5\n0.373\n";
    for below in [
        "\n \r\n",
        "# principal distance, x and y of the principal point, pitch\n",
        "taken 2019, room 2",
        // Where the source is, the normal of the detector and its upward direction.
        "\nexternal\n0 0 1198\n0 0 1\n0 1 0\n",
    ] {
        let told = Calibration::parse(&std::format!("{text}{below}"));
        assert_eq!(told, Calibration::parse(text), "{below:?}");
    }
    for (below, line) in [
        ("55", 6),
        ("\n# pitch\n0.373,\n", 8),
        ("1200\n0\n0\n0.4", 6),
    ] {
        let error = Calibration::parse(&std::format!("{text}{below}"));
        assert_eq!(error, Err(CalibrationError::OneMore { line }), "{below:?}");
        let error = error.expect_err("a number").to_string();
        let words = std::format!("line {line} of the calibration holds one more number");
        assert!(error.starts_with(&words), "{error}");
    }
}

/// As other laboratories have it; a decimal comma is no list.
#[test]
fn jt_intcalib_is_read_on_one_line_and_with_notes() {
    let same = Calibration::parse("JT_INTCALIB\n1198\n0\n-1.5\n0.373\n");
    assert!(same.is_ok());
    for text in [
        "JT_INTCALIB 1198 0 -1.5 0.373",
        "JT_INTCALIB,1198,0,-1.5,0.373\r\n",
        "JT_INTCALIB: 1198; 0; -1.5; 0.373",
        "JT_INTCALIB\n1198, 0, -1.5, 0.373\n",
        "JT_INTCALIB\r\n1198,0,-1.5,0.373\r\n",
        "JT_INTCALIB\r1198\r0\r-1.5\r0.373\r",
        "# room 2\nJT_INTCALIB v1\n1198 # distance\n0 // x\n\n% y\n-1.5\n0.373 % pitch\n",
    ] {
        assert_eq!(Calibration::parse(text), same, "{text:?}");
    }
    for (text, line) in [
        ("JT_INTCALIB\n1198\n0\n-1,5\n0.373\n", 4),
        ("JT_INTCALIB\n1198,0\n0\n0\n0,373\n", 2),
        ("JT_INTCALIB\n1198 0 0 0,373\n", 2),
        ("JT_INTCALIB 1198 0 0,373\n", 1),
    ] {
        let error = Calibration::parse(text);
        assert_eq!(
            error,
            Err(CalibrationError::DecimalComma { line }),
            "{text:?}"
        );
    }
    for text in [
        "JT_INTCALIB 1198 0 0",
        "JT_INTCALIB\n1198 0\n0 0.373",
        "JT_INTCALIB 1198 0 0 0.3 9",
    ] {
        let error = Calibration::parse(text).expect_err(text);
        assert!(
            matches!(error, CalibrationError::Number { .. }),
            "{text:?}: {error}"
        );
    }
    let more = Calibration::parse("JT_INTCALIB 1198 0 0 0.3\n1198\n");
    assert_eq!(more, Err(CalibrationError::OneMore { line: 2 }));
}

/// Of one program's manual the height stands first, of the other's the width.
#[test]
fn sides_the_other_way_round_are_told_as_such() {
    let matrix = Calibration::parse(MATRIX).expect("valid");
    let told = |width, height| {
        matrix
            .camera(width, height)
            .expect_err("another size")
            .to_string()
    };
    assert!(told(768, 1024).contains("the other way round"));
    assert!(told(512, 384).contains("neither scaled nor cut"));
    let noted = MATRIX.replace("image size\r\n", "# left camera\r\nImage size:\r\n");
    assert_eq!(Calibration::parse(&noted), Ok(matrix));
}

#[test]
fn a_part_at_a_distance_that_nobody_tells_is_looked_for_from_two() {
    let matrix = Calibration::parse(MATRIX).expect("valid");
    let usual = matrix.expected_distance();
    let [far, near] = [1.3 * usual, 0.75 * usual];
    assert_eq!(matrix.search_distances(None, None), [far, near]);
    // Beyond their middle in the logarithm the other one serves.
    let middle = libm::sqrt(far * near);
    let at = |depth| matrix.search_distances(None, Some(depth));
    assert_eq!(at(middle + 1.0), [far]);
    assert_eq!(at(middle - 1.0), [near]);
    assert_eq!(matrix.search_distances(Some(812.0), Some(9e3)), [812.0]);
    let stated = Calibration::parse("JT_INTCALIB\n1200\n0\n0\n0.3\n").expect("valid");
    assert_eq!(stated.search_distances(None, Some(500.0)), [1080.0]);
}

#[test]
fn nothing_is_filmed_behind_the_detector_or_within_the_tube() {
    let stated = Calibration::parse("JT_INTCALIB\n1200\n0\n0\n0.3\n").expect("valid");
    assert!(stated.may_hold(1199.0) && !stated.may_hold(1201.0));
    assert!(stated.may_hold(217.0) && !stated.may_hold(215.0));
    assert!(!stated.may_hold(-900.0) && !stated.may_hold(f64::NAN));
    // Where the detector is, a matrix of a camera does not say.
    let matrix = Calibration::parse(MATRIX).expect("valid");
    assert!(matrix.may_hold(5000.0) && !matrix.may_hold(199.0));
}

#[test]
fn a_camera_matrix_counts_from_pixel_centres() {
    let calibration = Calibration::parse(MATRIX).expect("valid");
    let camera = calibration.camera(1024, 768).expect("the file's own size");
    assert_eq!(camera.focal(), [3200.0, 3180.0]);
    assert_eq!(camera.principal_point(), [511.0, 380.5]);
    let again = Calibration::parse(&calibration.to_string());
    assert_eq!(again, Ok(calibration));
    let Calibration::CameraMatrix { laboratory, .. } = calibration else {
        panic!("a camera matrix")
    };
    let place = laboratory.map(|laboratory| laboratory.translation);
    assert_eq!(place, Some([1.0, -2.0, 3.5]));
    assert_eq!(
        calibration.camera(1024, 1024),
        Err(CalibrationError::FrameSize {
            calibration: (1024, 768),
            frame: (1024, 1024)
        })
    );
}

#[test]
fn a_matrix_without_a_laboratory_and_with_a_row_of_translation_is_read() {
    let bare = MATRIX.split("rotation").next().expect("text");
    let bare = Calibration::parse(bare).expect("valid");
    assert!(matches!(
        bare,
        Calibration::CameraMatrix {
            laboratory: None,
            ..
        }
    ));
    // It does not gain a place by being written.
    assert_eq!(Calibration::parse(&bare.to_string()), Ok(bare));
    let row = MATRIX.replace("1\r\n-2\r\n3.5\r\n", "1,-2,3.5");
    assert_eq!(Calibration::parse(&row), Calibration::parse(MATRIX));
}

/// The second camera's numbers may stand in one line, as the vectors of where a single one stands do.
#[test]
fn a_file_of_two_cameras_is_not_read_as_its_first() {
    let one = "JTA_INTCALIB\n1000\n0\n0\n0.3\n1100,0,0,0.3\n900,0,-200\n";
    assert!(Calibration::parse(one).is_ok());
    let two = one.replace("JTA_INTCALIB", "JTA_INTCALIB_BIPLANE");
    assert_eq!(Calibration::parse(&two), Err(CalibrationError::TwoCameras));
}

#[test]
fn where_the_camera_stands_is_not_lost_by_another_word() {
    for heading in ["Rotation:", "rotation matrix", "ROTATION MATRIX :"] {
        let text = MATRIX.replace("rotation", heading);
        assert_eq!(
            Calibration::parse(&text),
            Calibration::parse(MATRIX),
            "{heading}"
        );
    }
    for (from, to, words) in [
        (
            "rotation",
            "distortion\r\n0,0,0,0,0\r\n\r\nrotation",
            "is not the heading 'rotation'",
        ),
        ("translation", "origin", "is not the heading 'translation'"),
        ("3.5", "inf", "the translation, does not hold"),
        ("3.5", "nan", "the translation, does not hold"),
    ] {
        let error = Calibration::parse(&MATRIX.replace(from, to)).expect_err(to);
        assert!(std::format!("{error}").contains(words), "{error}");
    }
}

#[test]
fn faults_are_named() {
    let parse = |text: &str| {
        Calibration::parse(text)
            .map(|_| ())
            .map_err(|e| e.to_string())
    };
    for (text, words) in [
        ("", "neither with JT_INTCALIB"),
        ("JT_EULER_312\n1", "neither with JT_INTCALIB"),
        ("JT_INTCALIB\n1198\n0\n0\n", "ends before its pixel pitch"),
        (
            "JT_INTCALIB\n1198\nzero\n0\n0.3",
            "line 3 of the calibration, the principal point x",
        ),
        (
            "JT_INTCALIB\nNaN\n0\n0\n0.3",
            "line 2 of the calibration, the principal distance",
        ),
        ("JT_INTCALIB\n0\n0\n0\n0.3", "principal distance is 0"),
        (
            "JT_INTCALIB\n1198\n0\ninf\n0.3",
            "line 4 of the calibration, the principal point y",
        ),
        ("JT_INTCALIB\n1198\n0\n0\n-0.3", "pixel pitch is -0.3"),
        (
            "image size\n1024,1024\ncamera matrix\n1,2,3",
            "camera matrix",
        ),
    ] {
        let error = parse(text).expect_err(text);
        assert!(error.contains(words), "{text:?}: {error}");
    }
    let skewed = parse(&MATRIX.replace("0,3180", "2,3180")).expect_err("skewed");
    assert!(skewed.contains("skewed pixels"), "{skewed}");
    for row in ["0,0,2", "510.5,380,1"] {
        let error = parse(&MATRIX.replacen("0,0,1", row, 1)).expect_err(row);
        let words = std::format!("last row of the camera matrix is {row}, but");
        assert!(error.contains(&words), "{error}");
    }
    assert!(parse(&MATRIX.replace("3200", "nan")).is_err());
    let parts =
        parse(&MATRIX.replace("3200", "3.1").replace("3180", "3.1")).expect_err("not in pixels");
    assert!(
        parts.contains("is 3.1; it must be at least a tenth"),
        "{parts}"
    );
    for (focal, words) in [("3200", "x runs the other way"), ("3180", "y runs")] {
        let error = parse(&MATRIX.replace(focal, &std::format!("-{focal}"))).expect_err(focal);
        assert!(error.contains(words), "{error}");
        assert!(error.contains(&std::format!("-{focal}")), "{error}");
    }
    assert!(parse(&MATRIX.replace("0,-1,0", "0,1,0")).is_err());
}

#[test]
fn a_frame_has_whole_sides() {
    for size in [
        "1024.9,768",
        "1024,767.5",
        "nan,768",
        "-1024,768",
        "1024,inf",
        "1e30,768",
    ] {
        let error = Calibration::parse(&MATRIX.replace("1024,768", size)).expect_err(size);
        let told = std::format!("{error}");
        assert!(
            told.contains("line 2 of the calibration, the image size"),
            "{told}"
        );
    }
    assert!(Calibration::parse(&MATRIX.replace("1024,768", "1024.0,768")).is_ok());
}

#[test]
fn a_file_cut_anywhere_is_refused_or_still_the_same() {
    let whole = Calibration::parse(MATRIX).expect("valid");
    for length in 0..MATRIX.len() {
        // What is left may end within the last number, or before an optional part.
        if let Ok(left) = Calibration::parse(&MATRIX[..length]) {
            assert_eq!(lens(&left), lens(&whole), "{length}");
        }
    }
}
