//! Surfaces of an implant that a microcontroller holds: the model's, or the finest coarser one for which there is room.

use anyhow::{Result, bail};
use fluoropose::implant::write_implant;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::mesh::{Model, OwnedModel, clustered};

use super::deviation::deviation_mm;

/// Sides of the cubes within which vertices become one, as part of the model's radius: the finest, how many there are, and how much
/// larger each is than the one before. Each saves a tenth of the triangles or so: the finest that fits leaves little of the flash.
const FINEST: f64 = 0.002;
const CELLS: i32 = 64;
const LARGER: f64 = 1.06;

/// One of them, with what a file says of it.
pub(super) struct Surface {
    pub(super) model: OwnedModel,
    pub(super) planes: Vec<SymmetryPlane>,
    /// The model's vertices are at most so far off it.
    pub(super) deviation_mm: f64,
}

impl Surface {
    /// The model's own.
    pub(super) fn whole(model: &Model<'_>) -> Result<Self> {
        let vertices = model.vertices().iter().flatten().copied().collect();
        let triangles = model.triangles().iter().flatten().copied().collect();
        Ok(Self::of(OwnedModel::new(vertices, triangles)?))
    }

    /// The finest coarser one that fits, of those with so few triangles that they may.
    pub(super) fn finest_that_fits(
        model: &Model<'_>,
        may: impl Fn(usize) -> bool,
        fits: impl Fn(&Self) -> Result<bool>,
    ) -> Result<Self> {
        let mut last = model.triangles().len();
        for number in 0..CELLS {
            let cell_mm = FINEST * LARGER.powi(number) * model.bounds().radius;
            let Some(coarse) = clustered(model, cell_mm) else {
                continue;
            };
            let now = coarse.as_model().triangles().len();
            if now >= last || !may(now) {
                continue;
            }
            last = now;
            let mut surface = Self::of(coarse);
            if fits(&surface)? {
                surface.deviation_mm = deviation_mm(model, &surface.model.as_model());
                return Ok(surface);
            }
        }
        bail!(
            "no library fits into the flash with any surface of the model. Give more (--flash), or a narrower range of views (--x, --y)"
        )
    }

    fn of(model: OwnedModel) -> Self {
        let planes = symmetry_planes(model.as_model().mesh());
        Self {
            model,
            planes: planes.to_vec(),
            deviation_mm: 0.0,
        }
    }

    /// The implant file with one of its libraries.
    pub(super) fn file(&self, library: &[u8]) -> Result<Vec<u8>> {
        let model = self.model.as_model();
        Ok(write_implant(
            &model,
            library,
            &self.planes,
            self.deviation_mm,
        )?)
    }
}
