//! Memory for the search by pieces of an outline.

use fluoropose::camera::Camera;
use fluoropose::image::mask::Word;
use fluoropose::image::silhouette::Silhouette;
use fluoropose::library::Library;
use fluoropose::locate::partial::{
    Hypothesis, OutlinePoint, PartialMemory, Side, locate_partial, partial_needed,
};
use fluoropose::locate::rerank::Verified;
use fluoropose::mesh::Mesh;
use fluoropose::render::Projected;
use wasm_bindgen::JsError;

use crate::error::sentence;

/// Poses that are looked for.
const FOUND: usize = 6;

/// What [`locate_partial`] wants lent. It grows with the first outline that needs it and stays.
#[derive(Default)]
pub(crate) struct Pieces {
    words: Vec<Word>,
    sides: Vec<Side>,
    points: Vec<OutlinePoint>,
    cells: Vec<u16>,
    numbers: Vec<f32>,
    hypotheses: Vec<Hypothesis>,
    projected: Vec<Projected>,
}

impl Pieces {
    /// Poses that explain what is known of a silhouette, best first.
    ///
    /// # Errors
    /// The core's sentence about the outline.
    pub(crate) fn locate(
        &mut self,
        silhouette: &Silhouette<'_>,
        camera: &Camera,
        library: &Library<'_>,
        mesh: &Mesh<'_>,
    ) -> Result<Vec<Verified>, JsError> {
        let needs = partial_needed(library, camera, mesh);
        self.words.resize(needs.words, 0);
        self.sides.resize(needs.sides, Side::default());
        self.points.resize(needs.points, OutlinePoint::default());
        self.cells.resize(needs.cells, 0);
        self.numbers.resize(needs.numbers, 0.0);
        self.hypotheses
            .resize(needs.hypotheses, Hypothesis::default());
        self.projected.resize(needs.projected, Projected::default());
        let memory = PartialMemory {
            words: &mut self.words,
            sides: &mut self.sides,
            points: &mut self.points,
            cells: &mut self.cells,
            numbers: &mut self.numbers,
            hypotheses: &mut self.hypotheses,
            projected: &mut self.projected,
        };
        let found = locate_partial::<FOUND>(silhouette, camera, library, mesh, memory);
        Ok(found.map_err(sentence)?.to_vec())
    }
}
