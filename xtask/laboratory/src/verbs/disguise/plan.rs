//! What is done to a film, its camera and its models, as a file states it.

use serde::{Deserialize, Serialize};

/// A disguise. What a file leaves out stays as it is in the study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Plan {
    /// Of the noise, and of what the models are turned by.
    pub seed: u64,
    /// Which frames, and what they are called.
    pub frames: Frames,
    /// How they lie.
    pub view: View,
    /// What they show for each intensity.
    pub tone: Tone,
    /// What else is in them.
    pub marks: Marks,
    /// How the models are written.
    pub models: Models,
}

/// Which frames there are, and what they are called.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Frames {
    /// The first that is taken, from 0.
    pub first: usize,
    /// Every so many are taken.
    pub every: usize,
    /// At most so many; 0 for all.
    pub count: usize,
    /// Whether the last is the first.
    pub backwards: bool,
    /// What stands before the number in their names.
    pub prefix: String,
    /// Digits of the number; 1 for as many as it needs.
    pub digits: usize,
    /// How they are written.
    pub kind: Kind,
}

/// How a frame is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// PNG, 8 bit.
    #[default]
    Png8,
    /// PNG, 16 bit.
    Png16,
    /// TIFF, 8 bit.
    Tiff8,
    /// TIFF, 12 bit in 16.
    Tiff12,
    /// JPEG of quality 85.
    Jpeg85,
    /// DICOM, 8 bit.
    Dicom8,
    /// DICOM, 12 bit in 16.
    Dicom12,
    /// DICOM, 16 bit.
    Dicom16,
    /// The same with 12, where white is 0.
    Dicom12Inverse,
}

/// How frames lie.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct View {
    /// Columns and rows; 0 for the film's own.
    pub size: [usize; 2],
    /// By how much the picture is turned, clockwise.
    pub turn_deg: f64,
    /// Whether left and right are changed, before it is turned.
    pub mirrored: bool,
    /// So many pixels where there was one.
    pub scale: f64,
    /// Height of a pixel over its width.
    pub aspect: f64,
    /// Where the middle of the components comes to lie, as parts of width and height; without it the film's middle stays in the middle.
    pub middle: Option<[f64; 2]>,
    /// Whether the calibration is a `JT_INTCALIB`, where pixels are square; else it is a camera matrix.
    pub principal_distance: bool,
}

/// Grey values for intensities of 0 to 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Tone {
    /// What they are of intensities.
    pub curve: Curve,
    /// Whether what was white is black.
    pub negative: bool,
    /// Contrast that is left of 1.
    pub contrast: f64,
    /// Standard deviation of the blur, pixels.
    pub blur_px: f64,
    /// Standard deviation of the noise, as a part of white.
    pub noise: f64,
    /// Grey levels that are told apart; 0 for all.
    pub levels: u32,
}

/// What grey values are of intensities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Curve {
    /// The intensities.
    #[default]
    Same,
    /// A power.
    Gamma(f64),
    /// `ln(1 + k v)`.
    Log(f64),
    /// Straight and steep: so much of the film's intensities is black, and white.
    Clipped([f64; 2]),
}

/// What is in frames that is no patient.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Marks {
    /// What of them is picture.
    pub field: Field,
    /// Whether what lies beyond field and film is white.
    pub white_surround: bool,
    /// Words and a ruler, burnt in.
    pub words: bool,
}

/// What of a frame is picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Field {
    /// All.
    #[default]
    Whole,
    /// A disc about the frame's middle: its radius in parts of the shorter side.
    Round(f64),
    /// Shutters on all sides: what they cover of each, in parts of width and height.
    Shutters(f64),
}

/// How models are written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Models {
    /// Whether their axes are others: any rotation about any origin.
    pub turned: bool,
    /// Millimetres of the file's unit.
    pub unit_mm: f64,
    /// Their format.
    pub mesh: Mesh,
    /// Whether triangles have vertices of their own.
    pub unwelded: bool,
    /// Part of the triangles whose winding is turned.
    pub flipped: f64,
    /// Part of the triangles that are there twice.
    pub doubled: f64,
    /// The only component that there is.
    pub only: Option<String>,
}

/// A format of models.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Mesh {
    /// Binary STL.
    #[default]
    Stl,
    /// OBJ.
    Obj,
    /// PLY, as text.
    Ply,
}

impl Default for Frames {
    fn default() -> Self {
        Self {
            first: 0,
            every: 1,
            count: 0,
            backwards: false,
            prefix: String::new(),
            digits: 4,
            kind: Kind::default(),
        }
    }
}

impl Default for View {
    fn default() -> Self {
        Self {
            size: [0, 0],
            turn_deg: 0.0,
            mirrored: false,
            scale: 1.0,
            aspect: 1.0,
            middle: None,
            principal_distance: false,
        }
    }
}

impl Default for Tone {
    fn default() -> Self {
        Self {
            curve: Curve::default(),
            negative: false,
            contrast: 1.0,
            blur_px: 0.0,
            noise: 0.0,
            levels: 0,
        }
    }
}

impl Default for Models {
    fn default() -> Self {
        Self {
            turned: false,
            unit_mm: 1.0,
            mesh: Mesh::default(),
            unwelded: false,
            flipped: 0.0,
            doubled: 0.0,
            only: None,
        }
    }
}
