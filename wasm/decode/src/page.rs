//! What a page's worker calls. A file is moved into the module once, and what is decoded is moved out once. Errors arrive
//! as a JavaScript `Error` whose message is the sentence.

use js_sys::{Error, Float32Array, Uint8Array, Uint16Array, Uint32Array};
use wasm_bindgen::prelude::*;

use crate::{
    DecodeError, FrameFile, GreyFrame, MaskImage, MaskRule, Model, Pixels, SpacingCalibration,
};

fn thrown(error: DecodeError) -> Error {
    Error::new(&error.to_string())
}

/// What a file is, by its beginning ([`SNIFFED`](crate::SNIFFED) bytes, or all of a shorter file) and its length in
/// bytes: one of `png`, `jpeg`, `jpeg2000`, `tiff`, `bmp`, `dicom`, `numpy`, `stl`, `obj`, `ply`, `other-model`, `jts`, `calibration`,
/// `mayacam`, `library`, `session`, `outlines`, `coco`, `labelme`, `imagej`, `distortion`, `study`, `video`, `unknown`.
#[wasm_bindgen]
pub fn sniff(head: &[u8], length: usize, name: &str) -> String {
    crate::sniff_head(head, length, name).word().to_owned()
}

/// What is missing among files that are numbered, a sentence without its full stop; names in their order.
#[wasm_bindgen(js_name = gapsAmong)]
pub fn gaps_among(names: Vec<String>) -> Option<String> {
    crate::gaps_among(&names)
}

/// A file of frames, kept in the module's memory until it is freed.
#[wasm_bindgen(js_name = FrameFile)]
pub struct PageFrameFile(FrameFile<'static>);

#[wasm_bindgen(js_class = FrameFile)]
impl PageFrameFile {
    /// Opens a file from its bytes.
    ///
    /// # Errors
    /// Throws if the file is not one of frames or is damaged.
    #[wasm_bindgen(constructor)]
    pub fn new(bytes: Vec<u8>, name: &str) -> Result<PageFrameFile, Error> {
        FrameFile::open(bytes, name).map(Self).map_err(thrown)
    }

    /// How many frames there are.
    #[wasm_bindgen(getter)]
    pub fn count(&self) -> usize {
        self.0.count()
    }

    /// The format: `png`, `jpeg`, `jpeg2000`, `tiff`, `bmp`, `dicom` or `numpy`.
    #[wasm_bindgen(getter)]
    pub fn kind(&self) -> String {
        self.0.kind().word().to_owned()
    }

    /// Frames a second, if stated.
    #[wasm_bindgen(getter, js_name = framesPerSecond)]
    pub fn frames_per_s(&self) -> Option<f64> {
        self.0.frames_per_s()
    }

    /// The place of the file among those of its series, if stated.
    #[wasm_bindgen(getter, js_name = instanceNumber)]
    pub fn instance_number(&self) -> Option<f64> {
        self.0.instance_number()
    }

    /// From which value on a pixel is inside, where these are the masks of a film whose values are graded; nothing where they are labels.
    ///
    /// # Errors
    /// Throws if the pixels of a frame are damaged.
    #[wasm_bindgen(js_name = gradedFrom)]
    pub fn graded_from(&self) -> Result<Option<u16>, Error> {
        let rule = crate::mask_rule(&self.0).map_err(thrown)?;
        Ok(match rule {
            MaskRule::AtLeast(least) => Some(least),
            MaskRule::NonZero => None,
        })
    }

    /// Decodes frame `index`, counted from 0.
    ///
    /// # Errors
    /// Throws if there is no such frame or its pixels are damaged.
    pub fn frame(&self, index: usize) -> Result<PageFrame, Error> {
        self.0.frame(index).map(PageFrame).map_err(thrown)
    }
}

fn pair(spacing: Option<[f64; 2]>) -> Vec<f64> {
    spacing.map(|pair| pair.to_vec()).unwrap_or_default()
}

/// One decoded frame.
#[wasm_bindgen(js_name = DecodedFrame)]
pub struct PageFrame(GreyFrame);

#[wasm_bindgen(js_class = DecodedFrame)]
impl PageFrame {
    /// Pixels in a row.
    #[wasm_bindgen(getter)]
    pub fn width(&self) -> u32 {
        self.0.width
    }

    /// Rows.
    #[wasm_bindgen(getter)]
    pub fn height(&self) -> u32 {
        self.0.height
    }

    /// Significant bits of a pixel: up to 8 for bytes, 9 to 16 for words.
    #[wasm_bindgen(getter)]
    pub fn bits(&self) -> u8 {
        self.0.bits
    }

    /// Continues the picture behind the file's shutter, where nobody should look, so that no edge is there, and tells which pixels
    /// that are, numbered row by row: of each run the first one, and the one after its last. None where there is no shutter.
    pub fn cover(&mut self) -> Vec<u32> {
        let GreyFrame { width, height, .. } = self.0;
        let Some(shutter) = self.0.shutter.take() else {
            return Vec::new();
        };
        match &mut self.0.pixels {
            Pixels::U8(pixels) => shutter.continue_behind(pixels, width),
            Pixels::U16(pixels) => shutter.continue_behind(pixels, width),
        }
        shutter.covered(width, height)
    }

    /// A copy of the pixels, row by row: `Uint8Array` up to 8 bits, `Uint16Array` above.
    #[wasm_bindgen(getter, unchecked_return_type = "Uint8Array | Uint16Array")]
    pub fn pixels(&self) -> JsValue {
        match &self.0.pixels {
            Pixels::U8(pixels) => Uint8Array::from(pixels.as_slice()).into(),
            Pixels::U16(pixels) => Uint16Array::from(pixels.as_slice()).into(),
        }
    }

    /// Middle of the range that is shown, pixel values, if the file states one.
    #[wasm_bindgen(getter, js_name = windowCentre)]
    pub fn window_centre(&self) -> Option<f64> {
        self.0.window.map(|window| window.centre)
    }

    /// Extent of the range that is shown, pixel values, if the file states one.
    #[wasm_bindgen(getter, js_name = windowWidth)]
    pub fn window_width(&self) -> Option<f64> {
        self.0.window.map(|window| window.width)
    }

    /// Distance between pixels along a row at the detector, mm, if stated.
    #[wasm_bindgen(getter, js_name = columnSpacingMm)]
    pub fn column_spacing_mm(&self) -> Option<f64> {
        self.0
            .geometry
            .detector_spacing_mm
            .map(|[column, _]| column)
    }

    /// Distance between rows at the detector, mm, if stated.
    #[wasm_bindgen(getter, js_name = rowSpacingMm)]
    pub fn row_spacing_mm(&self) -> Option<f64> {
        self.0.geometry.detector_spacing_mm.map(|[_, row]| row)
    }

    /// Distance from the X-ray focus to the detector, mm, if stated.
    #[wasm_bindgen(getter, js_name = sourceToDetectorMm)]
    pub fn source_to_detector_mm(&self) -> Option<f64> {
        self.0.geometry.source_to_detector_mm
    }

    /// Distance from the X-ray focus to the patient, mm, if stated.
    #[wasm_bindgen(getter, js_name = sourceToPatientMm)]
    pub fn source_to_patient_mm(&self) -> Option<f64> {
        self.0.geometry.source_to_patient_mm
    }

    /// Distance from the X-ray focus to the stand's centre of rotation, mm, if stated.
    #[wasm_bindgen(getter, js_name = sourceToIsocentreMm)]
    pub fn source_to_isocentre_mm(&self) -> Option<f64> {
        self.0.geometry.source_to_isocentre_mm
    }

    /// Estimated magnification of the object, if stated.
    #[wasm_bindgen(getter)]
    pub fn magnification(&self) -> Option<f64> {
        self.0.geometry.magnification
    }

    /// Pixel spacing along a row and from row to row, mm; empty where it is not stated.
    #[wasm_bindgen(getter, js_name = pixelSpacingMm)]
    pub fn pixel_spacing_mm(&self) -> Vec<f64> {
        pair(self.0.geometry.pixel_spacing_mm)
    }

    /// How the pixel spacing was determined, if stated: `geometry` or `fiducial`.
    #[wasm_bindgen(getter, js_name = pixelSpacingCalibration)]
    pub fn pixel_spacing_calibration(&self) -> Option<String> {
        let word = match self.0.geometry.pixel_spacing_calibration? {
            SpacingCalibration::Geometry => "geometry",
            SpacingCalibration::Fiducial => "fiducial",
        };
        Some(word.to_owned())
    }

    /// Spacing on a digitised film along a row and from row to row, mm; empty where it is not stated.
    #[wasm_bindgen(getter, js_name = scannedSpacingMm)]
    pub fn scanned_spacing_mm(&self) -> Vec<f64> {
        pair(self.0.geometry.scanned_spacing_mm)
    }

    /// Height of a pixel over its width, if stated.
    #[wasm_bindgen(getter, js_name = pixelAspect)]
    pub fn pixel_aspect(&self) -> Option<f64> {
        self.0.geometry.pixel_aspect
    }

    /// The mask of graded values that it seems to be, 1 inside; nothing where it seems to be a picture, or a mask of few values.
    #[wasm_bindgen(js_name = gradedMask)]
    pub fn graded_mask(&self) -> Option<PageFrame> {
        Some(self.masked(crate::graded_mask(&self.0)?))
    }

    /// The mask of what is at least `least`, 1 inside.
    #[wasm_bindgen(js_name = maskFrom)]
    pub fn mask_from(&self, least: u16) -> PageFrame {
        self.masked(crate::mask_of(&self.0, MaskRule::AtLeast(least)))
    }

    /// What was done to the pixels, a sentence each.
    #[wasm_bindgen(getter)]
    pub fn notes(&self) -> Vec<String> {
        self.0.notes.clone()
    }
}

impl PageFrame {
    fn masked(&self, mask: MaskImage) -> Self {
        Self(GreyFrame {
            pixels: Pixels::U8(mask.pixels),
            bits: 1,
            ..self.0.clone()
        })
    }
}

/// A PNG of a mask: 255 where `inside` is not 0.
///
/// # Errors
/// Throws if the number of pixels is not that of the size.
#[wasm_bindgen(js_name = encodeMask)]
pub fn page_encode_mask(inside: Vec<u8>, width: u32, height: u32) -> Result<Vec<u8>, Error> {
    crate::encode_mask(inside, width, height).map_err(thrown)
}

/// A decoded model.
#[wasm_bindgen(js_name = ModelData)]
pub struct PageModel(Model);

#[wasm_bindgen(js_class = ModelData)]
impl PageModel {
    /// A copy of the coordinates, x, y, z of each vertex.
    #[wasm_bindgen(getter)]
    pub fn vertices(&self) -> Float32Array {
        Float32Array::from(self.0.vertices.as_flattened())
    }

    /// What was left out of the file, a sentence each.
    #[wasm_bindgen(getter)]
    pub fn notes(&self) -> Vec<String> {
        self.0.notes.clone()
    }

    /// A copy of the vertex indices, three of each triangle.
    #[wasm_bindgen(getter)]
    pub fn triangles(&self) -> Uint32Array {
        Uint32Array::from(self.0.triangles.as_flattened())
    }
}

/// Decodes a model file.
///
/// # Errors
/// Throws if the file is not a model or is damaged.
#[wasm_bindgen]
pub fn decode_model(bytes: Vec<u8>, name: &str) -> Result<PageModel, Error> {
    crate::decode_model(bytes, name)
        .map(PageModel)
        .map_err(thrown)
}
