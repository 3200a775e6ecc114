//! Rendering a library into borrowed bytes, view by view.

use super::assemble::{Assembly, write_bits, write_plain};
use super::error::BuildError;
use super::info::{LibraryInfo, ViewGrid, ViewRecord};
use super::open::{check_info, library_bytes};
use super::pack::{pack, packed_most};
use crate::camera::Camera;
use crate::canonical::{CanonicalSpec, canonicalise};
use crate::image::mask::{Mask, MaskMut, Word, words_needed};
use crate::math::{apply, scale, sqrt};
use crate::memory::{TooLittleMemory, first};
use crate::mesh::Model;
use crate::pose::{Pose, rotation_zxy};
use crate::render::{Projected, render, scratch_needed};

/// What [`ViewScratch::canonical`] holds.
const WORDS: &str = "words of canonical mask";

/// Working memory for one view; each thread has its own.
#[derive(Debug)]
pub struct ViewScratch<'a> {
    /// [`Builder::projected_needed`] vertices.
    pub projected: &'a mut [Projected],
    /// [`Builder::render_words_needed`] words.
    pub render: &'a mut [Word],
    /// [`CanonicalSpec::words_needed`] words.
    pub canonical: &'a mut [Word],
}

/// A plan of a library that renders its views in any order.
#[derive(Clone, Copy, Debug)]
pub struct Builder<'m> {
    model: Model<'m>,
    info: LibraryInfo,
    view_camera: Camera,
}

/// Side of a view before canonical form, in eighths of the canonical frame's: somewhat finer,
/// so that sampling adds little to the error of the silhouette itself. Twice as fine took twice
/// as long and gave poses of the built-in femur no better, of its tibia 0.15 mm better in z.
const VIEW_SIDE_EIGHTHS: usize = 10;

impl<'m> Builder<'m> {
    /// A plan for the views of `model` with its centre `distance` mm from the focus. `camera` is recorded; the
    /// views themselves are drawn by a camera of their own whose frame just holds the model.
    ///
    /// # Errors
    /// [`BuildError`] for an impossible grid, distance or camera.
    pub fn new(
        model: Model<'m>,
        camera: Camera,
        canonical: CanonicalSpec,
        grid: ViewGrid,
        distance: f64,
    ) -> Result<Self, BuildError> {
        let bounds = model.bounds();
        let radius = bounds.radius;
        if distance.is_nan() || distance <= 1.01 * radius {
            return Err(BuildError::TooNear { distance, radius });
        }
        // A sphere at `distance` on the axis has an image of radius f r / sqrt(d^2 - r^2).
        let side = VIEW_SIDE_EIGHTHS * canonical.size() / 8;
        let room = side as f64 / 2.0 - 2.0;
        let focal = room * sqrt(distance * distance - radius * radius) / radius;
        let info = LibraryInfo {
            canonical,
            grid,
            distance,
            reference: bounds.centre,
            focal,
            camera,
            model: model.digest(),
        };
        Self::standing_for(info, model)
    }

    /// Millimetres of the model that a pixel of a view covers: a coarser level of a model that is no coarser than this
    /// (`mesh::coarser`) has the same views but for a pixel of their outlines.
    #[must_use]
    pub fn detail_mm(&self) -> f64 {
        self.info.distance / self.info.focal
    }

    /// A plan for the library that `info` describes, drawn from `model`: the model itself or a coarser level of it.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn standing_for(info: LibraryInfo, model: Model<'m>) -> Result<Self, BuildError> {
        check_info(&info).map_err(BuildError::Parameter)?;
        let side = VIEW_SIDE_EIGHTHS * info.canonical.size() / 8;
        let middle = side as f64 / 2.0;
        Ok(Self {
            model,
            info,
            view_camera: Camera::new(side, side, [info.focal; 2], [middle; 2])?,
        })
    }

    /// What the library will record of itself: grid, distance, camera, model.
    #[must_use]
    pub fn info(&self) -> &LibraryInfo {
        &self.info
    }

    /// Number of views to render.
    #[must_use]
    pub fn views(&self) -> usize {
        self.info.grid.views()
    }

    /// Bytes of the finished library in the plain layout.
    #[must_use]
    pub fn bytes_needed(&self) -> usize {
        // The counts were checked: 4096 x 4096 views at most, which fits where memory does.
        library_bytes(&self.info.canonical, &self.info.grid).unwrap_or(usize::MAX)
    }

    /// Projected vertices of a [`ViewScratch`].
    #[must_use]
    pub fn projected_needed(&self) -> usize {
        scratch_needed(&self.model)
    }

    /// Words of the rendering in a [`ViewScratch`].
    #[must_use]
    pub fn render_words_needed(&self) -> usize {
        words_needed(self.view_camera.width(), self.view_camera.height())
    }

    /// Most bytes of a packed view. Those of an implant take a fiftieth of this.
    #[must_use]
    pub fn packed_most(&self) -> usize {
        packed_most(&self.info.canonical)
    }

    /// Draws one view, packs it into `out` for [`Self::assemble`], and returns the number of bytes that it takes. Views
    /// may be packed in any order and by any thread or process. A packed view is not a file format: do not store it.
    ///
    /// # Errors
    /// [`BuildError`] for working memory of the wrong length or a view that cannot be drawn.
    pub fn pack_view(
        &self,
        view: usize,
        scratch: &mut ViewScratch<'_>,
        out: &mut [u8],
    ) -> Result<usize, BuildError> {
        let record = self.draw_view(view, scratch)?;
        let size = self.info.canonical.size();
        let words = first(WORDS, self.info.canonical.words_needed(), scratch.canonical)?;
        let canonical = Mask::new(words, size, size)?;
        let short = TooLittleMemory {
            what: "bytes for a packed view",
            needed: self.packed_most(),
            given: out.len(),
        };
        pack(&record, &canonical, out).ok_or(BuildError::Memory(short))
    }

    /// The library of all packed views, in view order: [`Assembly::bytes_needed`] says how long the file is,
    /// [`Assembly::write`] writes it.
    ///
    /// # Errors
    /// [`BuildError`] where the number of packed views is not that of the grid, [`BuildError::Packed`] where one of them
    /// is not a packed view.
    pub fn assemble<'p>(&self, packed: &'p [&'p [u8]]) -> Result<Assembly<'p>, BuildError> {
        Assembly::new(&self.info, packed)
    }

    /// Draws one view and returns its record; its canonical silhouette is left in the working memory.
    fn draw_view(
        &self,
        view: usize,
        scratch: &mut ViewScratch<'_>,
    ) -> Result<ViewRecord, BuildError> {
        let [x_deg, y_deg] = self.info.grid.rotations(view);
        let side = self.view_camera.width();
        let mut mask = MaskMut::new(scratch.render, side, side)?;
        let pose = self.view_pose(x_deg, y_deg);
        render(
            &self.model,
            &self.view_camera,
            &pose,
            scratch.projected,
            &mut mask,
        )?;
        let canonical = &self.info.canonical;
        let form = canonicalise(&mask.into_mask(), canonical, 1.0, scratch.canonical)?;
        let middle = side as f64 / 2.0;
        Ok(ViewRecord {
            x_deg,
            y_deg,
            scale: form.scale,
            angle: form.angle,
            offset: [form.centroid.column - middle, middle - form.centroid.row],
            area: form.area_px as u32,
            elongation: form.elongation as f32,
        })
    }

    /// The pose of a view: the reference point on the optical axis, the model rotated by `Rx * Ry`.
    fn view_pose(&self, x_deg: f64, y_deg: f64) -> Pose {
        let rotation = rotation_zxy(0.0, x_deg, y_deg);
        let mut translation = scale(&apply(&rotation, &self.info.reference), -1.0);
        translation[2] -= self.info.distance;
        Pose {
            rotation,
            translation,
        }
    }

    /// Builds the whole library, in the plain layout, with one thread's working memory.
    ///
    /// # Errors
    /// [`BuildError::Memory`] unless `bytes` has [`Self::bytes_needed`] bytes, and as [`Self::pack_view`].
    pub fn build(&self, bytes: &mut [u8], scratch: &mut ViewScratch<'_>) -> Result<(), BuildError> {
        write_plain(&self.info, bytes, |view, bits| {
            let record = self.draw_view(view, scratch)?;
            let words = self.info.canonical.words_needed();
            write_bits(first(WORDS, words, scratch.canonical)?, bits);
            Ok(record)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::ViewAxis;

    const VERTICES: [[f32; 3]; 4] = [
        [-30.0, 10.0, 5.0],
        [30.0, 10.0, 5.0],
        [0.0, -20.0, 5.0],
        [0.0, 40.0, 45.0],
    ];
    const TRIANGLES: [[u32; 3]; 4] = [[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]];

    fn builder(distance: f64) -> Result<Builder<'static>, BuildError> {
        let model = Model::from_triangles(&VERTICES, &TRIANGLES).expect("valid");
        let camera = Camera::new(640, 480, [900.0; 2], [320.0, 240.0]).expect("valid");
        let axis = ViewAxis {
            first: -40.0,
            step: 20.0,
            count: 5,
        };
        let grid = ViewGrid { x: axis, y: axis };
        Builder::new(model, camera, CanonicalSpec::COARSE, grid, distance)
    }

    #[test]
    fn a_view_just_holds_the_sphere_around_the_model() {
        for distance in [60.0, 100.0, 1000.0, 50_000.0] {
            let builder = builder(distance).expect("possible");
            let radius = builder.model.bounds().radius;
            // The outermost ray touches the sphere; of 80 pixels, two to each side are left.
            let tangent = libm::tan(libm::asin(radius / distance));
            let reach = builder.info.focal * tangent;
            assert!((reach - 38.0).abs() < 1e-6, "{distance}: {reach}");
            assert_eq!(builder.view_camera.width(), 80);
            assert_eq!(builder.view_camera.principal_point(), [40.0; 2]);
            // Seen at that distance, a pixel is so wide.
            assert!((builder.detail_mm() * builder.info.focal - distance).abs() < 1e-9);
        }
    }

    #[test]
    fn a_model_that_reaches_the_focus_has_no_views() {
        let radius = builder(1000.0).expect("possible").model.bounds().radius;
        for distance in [f64::NAN, 0.0, -1000.0, radius, 1.01 * radius] {
            assert!(matches!(
                builder(distance),
                Err(BuildError::TooNear { radius: told, .. }) if told == radius
            ));
        }
        assert!(builder((1.01 * radius).next_up()).is_ok());
    }

    #[test]
    fn in_every_view_the_reference_point_stands_on_the_axis() {
        let builder = builder(500.0).expect("possible");
        for view in 0..builder.views() {
            let [x_deg, y_deg] = builder.info.grid.rotations(view);
            let pose = builder.view_pose(x_deg, y_deg);
            let place = pose.transform(&builder.info.reference);
            let off = [place[0], place[1], place[2] + 500.0];
            assert!(off.iter().all(|off| off.abs() < 1e-9), "{place:?}");
            assert_eq!(pose.rotation, rotation_zxy(0.0, x_deg, y_deg));
        }
    }
}
