//! A library built some views at a time, by any number of workers.

use fluoropose::canonical::CanonicalSpec;
use fluoropose::image::mask::Word;
use fluoropose::library::{Builder, ViewAxis, ViewGrid, ViewScratch};
use fluoropose::mesh::{OwnedModel, coarser};
use fluoropose::render::Projected;
use js_sys::Uint8Array;
use wasm_bindgen::prelude::*;

use fluoropose_page::calibration::calibration_of;
use fluoropose_page::error::sentence;

self_cell::self_cell!(
    /// A builder with the mesh that it draws.
    struct Plan {
        owner: OwnedModel,
        #[covariant]
        dependent: Builder,
    }
);

/// Which views a library holds.
#[wasm_bindgen]
pub struct LibraryViews {
    grid: ViewGrid,
    canonical: CanonicalSpec,
    distance: Option<f64>,
}

#[wasm_bindgen]
impl LibraryViews {
    /// Rotations about x and y as `[from, to, step]` round the nominal view `[x, y]`, degrees; the distance from the focus
    /// in mm, where it is known; the canonical area in pixels.
    ///
    /// # Errors
    /// A sentence when a step is not positive or a range runs backwards.
    #[wasm_bindgen(constructor)]
    pub fn new(
        nominal: &[f64],
        x: &[f64],
        y: &[f64],
        distance: Option<f64>,
        area: u32,
    ) -> Result<LibraryViews, JsError> {
        let &[nominal_x, nominal_y] = nominal else {
            return Err(JsError::new("A nominal view is two rotations"));
        };
        let size = CanonicalSpec::default().size();
        Ok(Self {
            grid: ViewGrid {
                x: axis("x", x)?.shifted(nominal_x),
                y: axis("y", y)?.shifted(nominal_y),
            },
            canonical: CanonicalSpec::new(size, area).map_err(sentence)?,
            distance,
        })
    }

    /// All directions, so that no nominal view is needed; the distance from the focus in mm, where it is known.
    pub fn everywhere(distance: Option<f64>) -> LibraryViews {
        Self {
            grid: ViewGrid::everywhere(),
            canonical: CanonicalSpec::COARSE,
            distance,
        }
    }
}

/// A library has no more rotations about an axis.
const MOST_STEPS: f64 = 4096.0;

fn axis(name: &str, range: &[f64]) -> Result<ViewAxis, JsError> {
    match *range {
        [first, last, step]
            if step > 0.0 && last >= first && (last - first) / step >= MOST_STEPS =>
        {
            Err(JsError::new(&format!(
                "The library's {name} rotations from {first} to {last} degrees are more than {MOST_STEPS} steps of {step}; give a larger step or a narrower range"
            )))
        }
        [first, last, step] if step > 0.0 && last >= first => {
            // Half a thousandth of a step forgives the rounding of typed decimals.
            let count = ((last - first) / step + 5e-4).floor() as usize + 1;
            Ok(ViewAxis { first, step, count })
        }
        _ => Err(JsError::new(&format!(
            "The library's {name} rotations need a first value, a last one that is not smaller, and a positive step"
        ))),
    }
}

/// A library being built: views packed here or by other builders of the same plan, and put together by one.
#[wasm_bindgen]
pub struct LibraryBuilder {
    plan: Plan,
    projected: Vec<Projected>,
    render: Vec<Word>,
    canonical: Vec<Word>,
    /// One view.
    packed: Vec<u8>,
    /// Views in their order, as [`LibraryBuilder::pack`] gave them.
    parts: Vec<Vec<u8>>,
}

#[wasm_bindgen]
impl LibraryBuilder {
    /// Plans the views of a model (x, y, z by turns in mm; three vertex indices a triangle) for the camera of a
    /// calibration text and frames of `width` x `height` pixels.
    ///
    /// # Errors
    /// The core's sentence about the model, the calibration or the views.
    #[wasm_bindgen(constructor)]
    pub fn new(
        vertices: Vec<f32>,
        triangles: Vec<u32>,
        calibration: &str,
        width: u32,
        height: u32,
        views: &LibraryViews,
    ) -> Result<LibraryBuilder, JsError> {
        let (calibration, camera) = calibration_of(calibration, width, height)?;
        let LibraryViews {
            grid, canonical, ..
        } = *views;
        let distance = views
            .distance
            .unwrap_or_else(|| calibration.expected_distance());
        let owned = OwnedModel::new(vertices, triangles).map_err(sentence)?;
        let plan = |model| Builder::new(model, camera, canonical, grid, distance);
        let fine = plan(owned.as_model()).map_err(sentence)?;
        let (info, coarse) = (*fine.info(), coarser(&owned.as_model(), fine.detail_mm()));
        let plan = Plan::try_new(coarse.unwrap_or(owned), |drawn| {
            Builder::standing_for(info, drawn.as_model()).map_err(sentence)
        })?;
        let builder = plan.borrow_dependent();
        Ok(Self {
            projected: vec![Projected::default(); builder.projected_needed()],
            render: vec![0; builder.render_words_needed()],
            canonical: vec![0; canonical.words_needed()],
            packed: vec![0; builder.packed_most()],
            parts: Vec::new(),
            plan,
        })
    }

    /// Number of views.
    #[wasm_bindgen(getter)]
    pub fn views(&self) -> usize {
        self.plan.borrow_dependent().views()
    }

    /// Draws and packs `count` views from number `first` on, or as many as there are.
    ///
    /// # Errors
    /// The core's sentence about a view that cannot be drawn.
    pub fn pack(&mut self, first: usize, count: usize) -> Result<Uint8Array, JsError> {
        let builder = self.plan.borrow_dependent();
        let mut scratch = ViewScratch {
            projected: &mut self.projected,
            render: &mut self.render,
            canonical: &mut self.canonical,
        };
        let mut part = Vec::new();
        for view in first..first.saturating_add(count).min(builder.views()) {
            let packed = builder.pack_view(view, &mut scratch, &mut self.packed);
            let length = packed.map_err(sentence)?;
            part.extend((length as u32).to_le_bytes());
            part.extend_from_slice(&self.packed[..length]);
        }
        Ok(Uint8Array::from(part.as_slice()))
    }

    /// Takes the views that follow those taken before, as `pack` gave them.
    pub fn add(&mut self, part: Vec<u8>) {
        self.parts.push(part);
    }

    /// The finished library; to be called once, when all views have been added.
    ///
    /// # Errors
    /// A sentence when views are missing.
    pub fn finish(mut self) -> Result<Uint8Array, JsError> {
        let packed: Vec<&[u8]> = self.parts.iter().flat_map(|part| views_of(part)).collect();
        let builder = self.plan.borrow_dependent();
        let assembly = builder.assemble(&packed).map_err(sentence)?;
        let mut bytes = vec![0; assembly.bytes_needed()];
        let written = assembly.write(&mut self.canonical, &mut bytes);
        written.map_err(sentence)?;
        Ok(Uint8Array::from(bytes.as_slice()))
    }
}

/// The packed views of a part, each after its length.
fn views_of(mut part: &[u8]) -> impl Iterator<Item = &[u8]> {
    core::iter::from_fn(move || {
        let (length, rest) = part.split_first_chunk()?;
        let (view, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        part = rest;
        Some(view)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_counts_both_ends_in_spite_of_decimal_steps() {
        let axis = axis("x", &[-0.3, 0.3, 0.1]).ok().unwrap();
        assert_eq!((axis.count, axis.first, axis.step), (7, -0.3, 0.1));
    }

    #[test]
    fn parts_hold_views_one_after_another() {
        let part = [2, 0, 0, 0, 7, 8, 0, 0, 0, 0, 1, 0, 0, 0, 9];
        let views: Vec<&[u8]> = views_of(&part).collect();
        assert_eq!(views, [&[7, 8][..], &[], &[9]]);
        assert_eq!(views_of(&part[..14]).count(), 2);
    }
}
