//! A library built view by view, so that a worker can report, and stop, between views.

use fluoropose::canonical::CanonicalSpec;
use fluoropose::library::{Builder, Grid, GridAxis, ViewScratch};
use fluoropose::mask::Word;
use fluoropose::raster::Projected;
use js_sys::Uint8Array;
use wasm_bindgen::prelude::*;

use crate::calibration::calibration_of;
use crate::error::sentence;
use crate::surface::Surface;

self_cell::self_cell!(
    /// A builder with the mesh that it draws.
    struct Plan {
        owner: Surface,
        #[covariant]
        dependent: Builder,
    }
);

/// Where a distance is not given, the object is taken to stand this share of the principal distance from the focus, as
/// knees do before a detector close behind them.
const USUAL_DISTANCE: f64 = 0.9;

/// Which views a library holds.
#[wasm_bindgen]
pub struct LibraryViews {
    x: GridAxis,
    y: GridAxis,
    distance: Option<f64>,
    area: u32,
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
        Ok(Self {
            x: axis("x", x)?.shifted(nominal_x),
            y: axis("y", y)?.shifted(nominal_y),
            distance,
            area,
        })
    }
}

fn axis(name: &str, range: &[f64]) -> Result<GridAxis, JsError> {
    match *range {
        [first, last, step] if step > 0.0 && last >= first && (last - first) / step < 4096.0 => {
            // Half a thousandth of a step forgives the rounding of typed decimals.
            let count = ((last - first) / step + 5e-4).floor() as usize + 1;
            Ok(GridAxis { first, step, count })
        }
        _ => Err(JsError::new(&format!(
            "The library's {name} rotations need a first value, a last one that is not smaller, and a positive step"
        ))),
    }
}

/// A library being built.
#[wasm_bindgen]
pub struct LibraryBuilder {
    plan: Plan,
    bytes: Vec<u8>,
    done: usize,
    projected: Vec<Projected>,
    render: Vec<Word>,
    canonical: Vec<Word>,
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
        let canonical =
            CanonicalSpec::new(CanonicalSpec::default().size(), views.area).map_err(sentence)?;
        let grid = Grid {
            x: views.x,
            y: views.y,
        };
        let usual = calibration
            .principal_distance()
            .map(|distance| distance * USUAL_DISTANCE);
        let distance = views.distance.or(usual).ok_or_else(|| {
            JsError::new("A camera matrix does not tell how far the object is: give the library's distance in mm")
        })?;
        let surface = Surface::new(vertices, triangles)?;
        let plan = Plan::try_new(surface, |surface| {
            Builder::new(surface.mesh()?, camera, canonical, grid, distance).map_err(sentence)
        })?;
        let builder = plan.borrow_dependent();
        Ok(Self {
            bytes: vec![0; builder.bytes_needed()],
            done: 0,
            projected: vec![Projected::default(); builder.projected_needed()],
            render: vec![0; builder.render_words_needed()],
            canonical: vec![0; canonical.words_needed()],
            plan,
        })
    }

    /// Number of views.
    #[wasm_bindgen(getter)]
    pub fn views(&self) -> usize {
        self.plan.borrow_dependent().views()
    }

    /// Renders up to `count` more views and returns how many are done.
    ///
    /// # Errors
    /// The core's sentence about a view that cannot be drawn.
    pub fn step(&mut self, count: usize) -> Result<usize, JsError> {
        let builder = self.plan.borrow_dependent();
        let places = builder.places(&mut self.bytes).map_err(sentence)?;
        let mut scratch = ViewScratch {
            projected: &mut self.projected,
            render: &mut self.render,
            canonical: &mut self.canonical,
        };
        for (record, bits) in places.skip(self.done).take(count) {
            builder
                .render_view(self.done, &mut scratch, record, bits)
                .map_err(sentence)?;
            self.done += 1;
        }
        Ok(self.done)
    }

    /// The finished library; to be called once, when all views are done.
    ///
    /// # Errors
    /// A sentence when views are missing.
    pub fn finish(mut self) -> Result<Uint8Array, JsError> {
        if self.done < self.views() {
            return Err(JsError::new("The library is not complete yet"));
        }
        let mut smaller = vec![0; self.bytes.len()];
        let builder = self.plan.borrow_dependent();
        let file = builder.finish_smaller(&mut self.bytes, &mut self.canonical, &mut smaller);
        Ok(Uint8Array::from(file.map_err(sentence)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_counts_both_ends_in_spite_of_decimal_steps() {
        let axis = axis("x", &[-0.3, 0.3, 0.1]).ok().unwrap();
        assert_eq!((axis.count, axis.first, axis.step), (7, -0.3, 0.1));
    }
}
