//! A component's model: its projected silhouette, painted and as an outline.

use fluoropose::camera::Camera;
use fluoropose::image::border::follow_border;
use fluoropose::image::contour::{Contour, Point};
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::image::region::largest_region;
use fluoropose::mesh::{OwnedModel, SuspectedUnit, suspected_unit};
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};
use wasm_bindgen::prelude::*;
use web_sys::CanvasRenderingContext2d;

use crate::calibration::camera;
use crate::distortion::Undistorter;
use crate::error::sentence;
use crate::paint::{Rgba, opaque, put};
use crate::pose_numbers::from_numbers;

/// Corners of a silhouette's border that the page draws.
const BORDER_CORNERS: usize = 16_384;

/// A mesh with the working memory to draw it.
#[wasm_bindgen]
pub struct Model {
    owned: OwnedModel,
    projected: Vec<Projected>,
    /// Three masks of the frame's size: one is the silhouette, the others find its largest region.
    masks: [Vec<Word>; 3],
    border: Box<Contour<BORDER_CORNERS>>,
    /// The border's columns and rows by turns, for the page to read where they lie.
    corners: Vec<f64>,
    /// The border encloses all that is drawn and nothing else.
    whole: bool,
}

#[wasm_bindgen]
impl Model {
    /// Takes vertices (x, y, z by turns, mm) and triangles (three vertex indices each).
    ///
    /// # Errors
    /// The core's sentence about the vertex or triangle at fault.
    #[wasm_bindgen(constructor)]
    pub fn new(vertices: Vec<f32>, triangles: Vec<u32>) -> Result<Model, JsError> {
        let owned = OwnedModel::drawn(vertices, triangles).map_err(sentence)?;
        Ok(Self {
            projected: vec![Projected::default(); scratch_needed(&owned.as_model())],
            owned,
            masks: Default::default(),
            border: Box::default(),
            corners: Vec::new(),
            whole: false,
        })
    }

    /// Millimetres in a unit of the file, where its size is a knee component's in other units alone: one number for each of them.
    #[wasm_bindgen(getter, js_name = suspectedUnits)]
    pub fn suspected_units(&self) -> Vec<f64> {
        let unit = suspected_unit(&self.owned.as_model().bounds());
        unit.map_or(&[][..], SuspectedUnit::mm).to_vec()
    }

    /// Number of triangles.
    #[wasm_bindgen(getter, js_name = triangleCount)]
    pub fn triangle_count(&self) -> usize {
        self.owned.as_model().triangles().len()
    }

    /// Draws the silhouette at a pose (x, y, z in mm, z, x, y rotation in degrees) as `calibration` projects it; what is
    /// drawn stays until the next call, for `paint` and `followBorder`.
    ///
    /// # Errors
    /// The core's sentence: a bad calibration, or a pose behind the focus.
    pub fn project(
        &mut self,
        calibration: &str,
        width: u32,
        height: u32,
        pose: &[f64],
    ) -> Result<(), JsError> {
        let camera = camera(calibration, width, height)?;
        let pose = Pose::from(from_numbers(pose)?);
        self.render(&camera, &pose)
    }

    /// Paints the silhouette in one opaque colour (`0xRRGGBB`), one canvas pixel a pixel. The canvas is not cleared. Gives
    /// the smallest box round what was painted: column, row, width and height; empty where there is nothing.
    ///
    /// # Errors
    /// What the canvas throws.
    pub fn paint(
        &self,
        context: &CanvasRenderingContext2d,
        width: u32,
        height: u32,
        rgb: u32,
    ) -> Result<Vec<u32>, JsValue> {
        let Ok(mask) = Mask::new(&self.masks[0], width as usize, height as usize) else {
            return Ok(Vec::new());
        };
        let Some((column, row, box_width, rgba)) = cut_out(&mask, opaque(rgb)) else {
            return Ok(Vec::new());
        };
        put(context, &rgba, box_width, column, row)?;
        let sides = [column, row, box_width, rgba.len() / box_width];
        Ok(sides.map(|side| side as u32).to_vec())
    }

    /// Follows the border of the silhouette's largest region along the cracks between pixels. It has no corner when
    /// nothing of the model is in the frame.
    ///
    /// # Errors
    /// The core's sentence for a border with more corners than the page draws.
    #[wasm_bindgen(js_name = followBorder)]
    pub fn follow_border(&mut self, width: u32, height: u32) -> Result<(), JsError> {
        self.corners.clear();
        self.whole = false;
        if self.find_border(width as usize, height as usize)? {
            let points = self.border.iter();
            let numbers = points.flat_map(|&Point { column, row }| [column, row]);
            self.corners.extend(numbers);
        }
        Ok(())
    }

    /// Moves the corners of the border to where they lie on a frame as it was taken.
    #[wasm_bindgen(js_name = distortBorder)]
    pub fn distort_border(&mut self, undistorter: &Undistorter) {
        undistorter.distort(&mut self.corners);
    }

    /// Where columns and rows of the border's corners, by turns, begin in the module's memory, bytes.
    #[wasm_bindgen(getter, js_name = borderAddress)]
    pub fn border_address(&self) -> usize {
        self.corners.as_ptr() as usize
    }

    /// How many columns and rows there are.
    #[wasm_bindgen(getter, js_name = borderLength)]
    pub fn border_length(&self) -> usize {
        self.corners.len()
    }

    /// Does the last border enclose all that is drawn and nothing else? Then to fill it is to paint the silhouette.
    #[wasm_bindgen(getter, js_name = borderIsWhole)]
    pub fn border_is_whole(&self) -> bool {
        self.whole
    }
}

impl Model {
    /// Whether there is a border.
    fn find_border(&mut self, width: usize, height: usize) -> Result<bool, JsError> {
        let [drawn, rest, largest] = &mut self.masks;
        let Ok(drawn) = Mask::new(drawn, width, height) else {
            return Ok(false);
        };
        if drawn.area() == 0 {
            return Ok(false);
        }
        follow_border(&drawn, self.border.as_mut()).map_err(sentence)?;
        self.whole = bounds_all(&self.border, &drawn);
        if self.whole {
            return Ok(true);
        }
        let mut largest = MaskMut::new(largest, width, height).map_err(sentence)?;
        let mut rest = MaskMut::new(rest, width, height).map_err(sentence)?;
        largest_region(&drawn, &mut rest, &mut largest).map_err(sentence)?;
        follow_border(&largest.as_mask(), self.border.as_mut()).map_err(sentence)?;
        Ok(true)
    }

    fn render(&mut self, camera: &Camera, pose: &Pose) -> Result<(), JsError> {
        let words = words_needed(camera.width(), camera.height());
        for mask in &mut self.masks {
            mask.resize(words, 0);
        }
        let model = self.owned.as_model();
        let mut mask =
            MaskMut::new(&mut self.masks[0], camera.width(), camera.height()).map_err(sentence)?;
        render(&model, camera, pose, &mut self.projected, &mut mask).map_err(sentence)
    }
}

/// The smallest box round the mask's pixels: its first column and row, its width, and its pixels, transparent where the
/// mask is not set. Nothing for an empty mask.
fn cut_out(mask: &Mask<'_>, colour: Rgba) -> Option<(usize, usize, usize, Vec<Rgba>)> {
    let rows = 0..mask.height();
    let runs = || {
        rows.clone()
            .flat_map(|row| mask.runs(row).map(move |run| (row, run)))
    };
    let left = runs().map(|(_, run)| run.start).min()?;
    let right = runs().map(|(_, run)| run.end).max()?;
    let top = runs().next()?.0;
    let bottom = runs().last()?.0;
    let width = right - left;
    let mut rgba = vec![Rgba::default(); width * (bottom - top + 1)];
    for (row, run) in runs() {
        let start = (row - top) * width;
        rgba[start + run.start - left..start + run.end - left].fill(colour);
    }
    Some((left, top, width, rgba))
}

/// Is the border of one region all that bounds the mask? Every run of pixels has a crack at its left end and one at its
/// right; holes and other regions have some that the border does not go along.
fn bounds_all(border: &[Point], mask: &Mask<'_>) -> bool {
    let next = border.iter().cycle().skip(1);
    let upright: f64 = border
        .iter()
        .zip(next)
        .map(|(a, b)| (a.row - b.row).abs())
        .sum();
    let runs: usize = (0..mask.height()).map(|row| mask.runs(row).count()).sum();
    upright == 2.0 * runs as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distortion::beads_of;
    use fluoropose_distortion::correction::fit;

    /// A square plate of two triangles at 200 mm from the focus, with others of the same size beside or behind it.
    fn plates(offsets: &[[f32; 3]]) -> Model {
        let corners = [[-10.0, -10.0], [10.0, -10.0], [10.0, 10.0], [-10.0, 10.0]];
        let vertices = offsets
            .iter()
            .flat_map(|[x, y, z]| corners.map(|[right, up]| [right + x, up + y, *z]).concat());
        let triangles = (0..offsets.len() as u32)
            .flat_map(|plate| [0, 1, 2, 0, 2, 3].map(|corner| 4 * plate + corner));
        Model::new(vertices.collect(), triangles.collect()).unwrap()
    }

    const RED: Rgba = [255, 0, 0, 255];
    const CALIBRATION: &str = "JT_INTCALIB\n1000\n0\n0\n1\n";

    #[test]
    fn one_plate_is_whole_and_two_beside_each_other_are_not() {
        let pose = [0.0, 0.0, -200.0, 0.0, 0.0, 0.0];
        for (offsets, whole) in [
            (&[[0.0; 3]][..], true),
            (&[[0.0; 3], [2.0, 0.0, -5.0]], true),
            (&[[-15.0, 0.0, 0.0], [15.0, 0.0, 0.0]], false),
        ] {
            let mut model = plates(offsets);
            model.project(CALIBRATION, 256, 256, &pose).unwrap();
            model.follow_border(256, 256).unwrap();
            assert!(model.border_length() > 0);
            assert_eq!(model.border_is_whole(), whole, "{offsets:?}");
        }
    }

    /// Bends what lies off the middle of a frame of 256 x 256 outwards.
    fn pin_cushion() -> Undistorter {
        let beads = (0..11 * 11).flat_map(|bead| {
            let place = [bead % 11, bead / 11].map(|at| f64::from(at - 5));
            let stretch = 22.0 * (1.0 + 0.001 * (place[0].powi(2) + place[1].powi(2)));
            let [column, row] = place.map(|at| 128.0 + stretch * at);
            [column, row, place[0], place[1]]
        });
        let mut beads = beads_of(&beads.collect::<Vec<_>>());
        let corrected = fit(&mut beads, (256, 256)).unwrap();
        Undistorter::new(&corrected.distortion.numbers()).unwrap()
    }

    #[test]
    fn a_border_is_distorted_where_it_lies_as_any_points_are() {
        let mut model = plates(&[[0.0; 3]]);
        let pose = [10.0, 0.0, -200.0, 0.0, 0.0, 0.0];
        model.project(CALIBRATION, 256, 256, &pose).unwrap();
        model.follow_border(256, 256).unwrap();
        let (straight, address) = (model.corners.clone(), model.border_address());
        model.distort_border(&pin_cushion());
        assert_eq!(model.border_address(), address);
        assert_eq!(model.corners, pin_cushion().distorted(straight.clone()));
        let mut moved = model.corners.iter().zip(&straight);
        assert!(moved.any(|(distorted, undistorted)| distorted - undistorted > 1.0));
    }

    #[test]
    fn a_cut_out_is_the_smallest_box_round_the_mask() {
        let mut words = vec![0; words_needed(100, 8)];
        let mut mask = MaskMut::new(&mut words, 100, 8).unwrap();
        mask.set(70, 2, true);
        mask.set(72, 5, true);
        let (column, row, width, rgba) = cut_out(&mask.as_mask(), RED).unwrap();
        assert_eq!((column, row, width, rgba.len()), (70, 2, 3, 12));
        assert_eq!((rgba[0], rgba[11]), (RED, RED));
        assert_eq!(rgba.iter().filter(|&&pixel| pixel == RED).count(), 2);
    }

    #[test]
    fn an_empty_mask_has_no_cut_out() {
        let words = vec![0; words_needed(10, 10)];
        assert!(cut_out(&Mask::new(&words, 10, 10).unwrap(), RED).is_none());
    }
}
