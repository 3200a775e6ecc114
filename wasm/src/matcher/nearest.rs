//! The view of a library that is nearest to an outline, and nothing more.

use fluoropose::canonical::{canonicalise, reverse};
use fluoropose::image::mask::Word;
use fluoropose::search::kernels::Kernels;
use fluoropose::search::{Directions, Query, ViewSearch, ViewSearchMemory, query_bytes_needed};
use wasm_bindgen::prelude::*;

use super::Matcher;
use fluoropose_page::error::sentence;
use fluoropose_page::traced::Traced;

/// An outline's silhouette in the canonical form of a library.
#[wasm_bindgen]
pub struct Canonical {
    straight: Vec<Word>,
    turned: Vec<Word>,
}

/// The view with the fewest unmatched pixels.
#[wasm_bindgen]
#[derive(Clone, Copy)]
pub struct NearestView {
    /// Its number: x rotations run fastest.
    pub view: u32,
    /// Pixels that are set in one of both and not in the other.
    pub unmatched: u32,
}

#[wasm_bindgen]
impl Matcher {
    /// Brings an outline to the canonical form of this library.
    ///
    /// # Errors
    /// The core's sentence about the silhouette.
    pub fn canonical(&self, traced: &Traced) -> Result<Canonical, JsError> {
        let spec = self.library.borrow_dependent().info().canonical;
        let mut straight = vec![0; spec.words_needed()];
        let mut turned = straight.clone();
        let aspect = traced.camera().aspect();
        traced.look(|silhouette| {
            canonicalise(silhouette.mask(), &spec, aspect, &mut straight).map_err(sentence)
        })?;
        reverse(&straight, &mut turned);
        Ok(Canonical { straight, turned })
    }

    /// The nearest view, in the direction that the silhouette has: exact, though most views are never looked at.
    ///
    /// # Errors
    /// A sentence where the silhouette has the canonical form of another library.
    #[wasm_bindgen(js_name = nearestView)]
    pub fn nearest_view(&mut self, canonical: &Canonical) -> Result<NearestView, JsError> {
        let (library, buffers) = self.buffers();
        let work = buffers.workspace(library, Kernels::PORTABLE);
        let spec = &library.info().canonical;
        let (prepared, sketches) = work.bytes.split_at_mut(query_bytes_needed(spec));
        let (straight, turned) = (&canonical.straight, &canonical.turned);
        let query = Query::new(spec, straight, turned, prepared).map_err(sentence)?;
        let memory = ViewSearchMemory {
            bounds: work.scores,
            sketches,
        };
        let search = ViewSearch::new(library, &query, &work.kernels, memory);
        let best = search.map_err(sentence)?.best::<1>(Directions::Straight);
        let best = best
            .first()
            .ok_or_else(|| JsError::new("The library has no view."))?;
        Ok(NearestView {
            view: best.view as u32,
            unmatched: best.unmatched,
        })
    }
}
