//! Names that OpenCV, ROS and MATLAB, and those who work with them, give to what a camera is told by.

/// What a key is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meaning {
    /// Nine numbers by rows; MATLAB's own by columns.
    Matrix {
        is_matlab: bool,
    },
    /// Two numbers.
    Focal,
    Point,
    /// Both sides, the height first where MATLAB says it.
    Size,
    Width,
    Height,
    /// What has to be 0.
    Distortion,
    /// Where a frame lies within what the camera sees.
    Region,
    /// Pixels of the camera in a pixel of the frame; 0 where nothing is said.
    Binning,
    Skew,
    /// Within a matrix: words of its form, its sides, and then its numbers.
    Form,
    Sides,
    Data,
    Other,
}

/// By a key's letters, small and without marks.
const MEANINGS: [(&[&str], Meaning); 13] = [
    (
        &[
            "cameramatrix",
            "cameramatrix1",
            "cameramatrix2",
            "intrinsics",
            "intrinsic",
            "k",
            "k1",
            "k2",
            "m1",
            "m2",
            "mtx",
            "intrinsicmatrix",
            "intrinsicparameters",
        ],
        Meaning::Matrix { is_matlab: false },
    ),
    (&["fc"], Meaning::Focal),
    (&["cc"], Meaning::Point),
    (&["imagesize", "imgsize"], Meaning::Size),
    (&["imagewidth", "imgwidth", "width", "nx"], Meaning::Width),
    (
        &["imageheight", "imgheight", "height", "ny"],
        Meaning::Height,
    ),
    (
        &[
            "dist", "d", "d1", "d2", "kc", "p1", "p2", "k3", "k4", "k5", "k6",
        ],
        Meaning::Distortion,
    ),
    (&["skew", "alphac"], Meaning::Skew),
    (&["xoffset", "yoffset"], Meaning::Region),
    (&["binningx", "binningy"], Meaning::Binning),
    (&["dt", "typeid"], Meaning::Form),
    (&["rows", "cols"], Meaning::Sides),
    (&["data"], Meaning::Data),
];

/// Parts of names of distortions' coefficients.
const OF_DISTORTION: [&str; 6] = [
    "distort",
    "distco",
    "distparam",
    "distvec",
    "radial",
    "tangential",
];

/// What the key of a name is of.
pub(super) fn meaning(key: &str) -> Meaning {
    let mut letters = [0; 32];
    let plain = key.bytes().filter(u8::is_ascii_alphanumeric);
    let mut length = 0;
    for (place, letter) in letters.iter_mut().zip(plain) {
        *place = letter.to_ascii_lowercase();
        length += 1;
    }
    let name = core::str::from_utf8(&letters[..length]).unwrap_or_default();
    // A count of coefficients, and whether they were looked for, are none.
    let is_of_distortion = OF_DISTORTION.iter().any(|word| name.contains(word));
    let is_told = name.starts_with("num") || name.starts_with("estimate");
    match key {
        "IntrinsicMatrix" => Meaning::Matrix { is_matlab: true },
        "FocalLength" => Meaning::Focal,
        "PrincipalPoint" => Meaning::Point,
        _ if is_of_distortion && !is_told => Meaning::Distortion,
        _ => {
            let known = MEANINGS.iter().find(|(names, _)| names.contains(&name));
            known.map_or(Meaning::Other, |&(_, meaning)| meaning)
        }
    }
}

/// MATLAB alone has these names.
pub(super) fn is_of_matlab(key: &str) -> bool {
    [
        "IntrinsicMatrix",
        "FocalLength",
        "PrincipalPoint",
        "RadialDistortion",
    ]
    .contains(&key)
}
