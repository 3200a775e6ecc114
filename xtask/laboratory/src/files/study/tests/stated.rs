use super::*;
use fluoropose::camera::calibration::Calibration;

/// What the page offers to take of DICOM frames is told here too, as a line to write.
#[test]
fn without_a_calibration_what_the_frames_state_is_told() {
    let folder = std::env::temp_dir().join(format!("fluoropose-stated-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("frames")).unwrap();
    let told = |dicom: &[u8]| {
        std::fs::write(folder.join("frames/1.dcm"), dicom).unwrap();
        let text = format!("name = 's'\nframes = 'frames'\n{FEMUR}");
        format!(
            "{:#}",
            Study::of(&text, &folder.join("s.toml")).unwrap_err()
        )
    };
    let whole = told(&dicom(Some("0.308\\0.308"), Some("1000")));
    let half = told(&dicom(None, Some("1000")));
    let oblong = told(&dicom(Some("0.3\\0.4"), Some("1000")));
    let nothing = told(&dicom(None, None));
    let as_file = {
        let path = folder.join("c.txt");
        std::fs::write(&path, dicom(Some("0.308"), Some("1000"))).unwrap();
        format!("{:#}", crate::files::read_calibration(&path).unwrap_err())
    };
    let calibration = Calibration::parse("JT_INTCALIB 1000 0 0 0.2").unwrap();
    let camera = calibration.camera(2, 2).unwrap();
    let other = |spacing: &str| {
        let bytes = dicom(Some(spacing), Some("1000"));
        let file = fluoropose_decode::FrameFile::open(bytes, "1.dcm").unwrap();
        crate::files::doubt_beside(&camera, &file.frame(0).unwrap())
    };
    let told = other("0.308\\0.308").unwrap();
    assert!(
        told.starts_with("camera: the focal length, 5000.0 pixels, is 1.54 times"),
        "{told}"
    );
    assert_eq!(other("0.2\\0.2"), None);
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(
        whole.contains("the key calibration is missing, as in"),
        "{whole}"
    );
    assert!(whole.contains("JT_INTCALIB 1000 0 0 0.308"), "{whole}");
    assert!(half.contains("but no Imager Pixel Spacing"), "{half}");
    assert!(oblong.contains("0.4 x 0.3 mm"), "{oblong}");
    assert!(
        nothing.ends_with("calibration = \"calibration.txt\""),
        "{nothing}"
    );
    assert!(as_file.contains("is a DICOM file"), "{as_file}");
}

/// The least DICOM image, explicit and little-endian, that states these (0018,1164) and (0018,1110).
fn dicom(spacing: Option<&str>, distance: Option<&str>) -> Vec<u8> {
    let mut bytes = vec![0; 128];
    bytes.extend(b"DICM");
    let mut element = |group: u16, number: u16, kind: &[u8; 2], value: &[u8]| {
        let padded = value.len() + value.len() % 2;
        bytes.extend(group.to_le_bytes());
        bytes.extend(number.to_le_bytes());
        bytes.extend(kind);
        match kind {
            b"OB" | b"OW" => {
                bytes.extend([0; 2]);
                bytes.extend((padded as u32).to_le_bytes());
            }
            _ => bytes.extend((padded as u16).to_le_bytes()),
        }
        bytes.extend(value);
        bytes.resize(bytes.len() + value.len() % 2, b' ');
    };
    element(2, 0x10, b"UI", b"1.2.840.10008.1.2.1\0");
    if let Some(distance) = distance {
        element(0x18, 0x1110, b"DS", distance.as_bytes());
    }
    if let Some(spacing) = spacing {
        element(0x18, 0x1164, b"DS", spacing.as_bytes());
    }
    element(0x28, 2, b"US", &1_u16.to_le_bytes());
    element(0x28, 4, b"CS", b"MONOCHROME2");
    for (number, value) in [
        (0x10, 2_u16),
        (0x11, 2),
        (0x100, 8),
        (0x101, 8),
        (0x102, 7),
        (0x103, 0),
    ] {
        element(0x28, number, b"US", &value.to_le_bytes());
    }
    element(0x7FE0, 0x10, b"OW", &[0; 4]);
    bytes
}
