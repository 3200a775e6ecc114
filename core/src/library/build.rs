//! Rendering a library into bytes that the caller lends, view by view.

use thiserror::Error;

use super::compact::compact;
use super::open::{check_info, library_bytes, view_bytes};
use super::wire::{
    Body, HEADER_BYTES, PLAIN_VERSION, RECORD_BYTES, checksum, write_header, write_record,
};
use super::{Grid, Library, LibraryError, LibraryInfo, ViewRecord};
use crate::camera::{Camera, CameraError};
use crate::canonical::{CanonicalError, CanonicalSpec, canonicalise};
use crate::mask::{MaskError, MaskMut, Word, words_needed};
use crate::math::{apply, scale, sqrt};
use crate::mesh::Mesh;
use crate::pose::{Pose, rotation_zxy};
use crate::raster::{Projected, RenderError, render, scratch_needed};

/// Why a library cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum BuildError {
    /// A parameter is impossible.
    #[error("{0}")]
    Parameter(LibraryError),
    /// The model would touch the focus.
    #[error(
        "the distance of {distance} mm is shorter than the model's radius of {radius:.1} mm; are the model's lengths in mm?"
    )]
    TooNear {
        /// Distance asked for, mm.
        distance: f64,
        /// Of the model, mm.
        radius: f64,
    },
    /// Lent bytes or words have the wrong length.
    #[error("building needs {needed} {what} but {given} were lent")]
    Memory {
        /// Which memory.
        what: &'static str,
        /// Length needed.
        needed: usize,
        /// Length lent.
        given: usize,
    },
    /// A view has no canonical form.
    #[error(transparent)]
    Canonical(#[from] CanonicalError),
    /// A mask could not be made.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// A view could not be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The views' camera is impossible.
    #[error(transparent)]
    Camera(#[from] CameraError),
}

/// Working memory for one view; each thread lends its own.
#[derive(Debug)]
pub struct ViewScratch<'a> {
    /// [`Builder::projected_needed`] vertices.
    pub projected: &'a mut [Projected],
    /// [`Builder::render_words_needed`] words.
    pub render: &'a mut [Word],
    /// [`CanonicalSpec::words_needed`] words.
    pub canonical: &'a mut [Word],
}

/// A library being built: a plan that renders any view into its place, in any order.
#[derive(Clone, Copy, Debug)]
pub struct Builder<'m> {
    mesh: Mesh<'m>,
    info: LibraryInfo,
    view_camera: Camera,
}

/// Side of a view before canonical form, in eighths of the canonical frame's: somewhat finer,
/// so that sampling adds little to the error of the silhouette itself. Twice as fine took twice
/// as long and gave poses of the built-in femur no better, of its tibia 0.15 mm better in z.
const VIEW_SIDE_EIGHTHS: usize = 10;

impl<'m> Builder<'m> {
    /// A plan for the views of `mesh` at `distance` mm. `camera` is recorded; the views
    /// themselves are drawn by a camera of their own that just holds the model.
    ///
    /// # Errors
    /// [`BuildError`] for an impossible grid, distance or camera.
    pub fn new(
        mesh: Mesh<'m>,
        camera: Camera,
        canonical: CanonicalSpec,
        grid: Grid,
        distance: f64,
    ) -> Result<Self, BuildError> {
        let bounds = mesh.bounds();
        let radius = bounds.radius;
        if distance.is_nan() || distance <= 1.01 * radius {
            return Err(BuildError::TooNear { distance, radius });
        }
        // A sphere at `distance` on the axis has an image of radius f r / sqrt(d^2 - r^2).
        let side = VIEW_SIDE_EIGHTHS * canonical.size() / 8;
        let room = side as f64 / 2.0 - 2.0;
        let focal = room * sqrt(distance * distance - radius * radius) / radius;
        let middle = side as f64 / 2.0;
        let info = LibraryInfo {
            canonical,
            grid,
            distance,
            reference: bounds.centre,
            focal,
            camera,
            model: mesh.digest(),
        };
        check_info(&info).map_err(BuildError::Parameter)?;
        Ok(Self {
            mesh,
            info,
            view_camera: Camera::new(side, side, [focal; 2], [middle; 2])?,
        })
    }

    /// What the library will say of itself.
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
        scratch_needed(&self.mesh)
    }

    /// Words of the rendering in a [`ViewScratch`].
    #[must_use]
    pub fn render_words_needed(&self) -> usize {
        words_needed(self.view_camera.width(), self.view_camera.height())
    }

    /// Splits the lent bytes into the places of records and of bits, one chunk a view, for
    /// [`Self::render_view`]: `(record, bits)` in order.
    ///
    /// # Errors
    /// [`BuildError::Memory`] unless `bytes` has exactly [`Self::bytes_needed`] bytes.
    pub fn places<'b>(
        &self,
        bytes: &'b mut [u8],
    ) -> Result<
        core::iter::Zip<core::slice::ChunksExactMut<'b, u8>, core::slice::ChunksExactMut<'b, u8>>,
        BuildError,
    > {
        self.check_length(bytes.len())?;
        let (_, body) = bytes.split_at_mut(HEADER_BYTES);
        let (records, bits) = body.split_at_mut(self.views() * RECORD_BYTES);
        let bits = bits.chunks_exact_mut(view_bytes(&self.info.canonical));
        Ok(records.chunks_exact_mut(RECORD_BYTES).zip(bits))
    }

    fn check_length(&self, given: usize) -> Result<(), BuildError> {
        let needed = self.bytes_needed();
        if given == needed {
            return Ok(());
        }
        Err(BuildError::Memory {
            what: "bytes",
            needed,
            given,
        })
    }

    /// Renders one view into its place: `record` and `bits` from [`Self::places`].
    ///
    /// # Errors
    /// [`BuildError`] for working memory of the wrong length or a view that cannot be drawn.
    pub fn render_view(
        &self,
        view: usize,
        scratch: &mut ViewScratch<'_>,
        record: &mut [u8],
        bits: &mut [u8],
    ) -> Result<(), BuildError> {
        let (x, y) = self.info.grid.place(view);
        let x_deg = self.info.grid.x.at(x as f64);
        let y_deg = self.info.grid.y.at(y as f64);
        let side = self.view_camera.width();
        let mut mask = MaskMut::new(scratch.render, side, side)?;
        let pose = self.view_pose(x_deg, y_deg);
        render(
            &self.mesh,
            &self.view_camera,
            &pose,
            scratch.projected,
            &mut mask,
        )?;
        let canonical = &self.info.canonical;
        let form = canonicalise(&mask.into_mask(), canonical, 1.0, scratch.canonical)?;
        let middle = side as f64 / 2.0;
        let offset = [form.centroid.column - middle, middle - form.centroid.row];
        let values = ViewRecord {
            x_deg,
            y_deg,
            scale: form.scale,
            angle: form.angle,
            offset,
            area: form.area_px as u32,
            elongation: form.elongation as f32,
        };
        write_record(record, &values);
        for (four, word) in bits.chunks_exact_mut(4).zip(&*scratch.canonical) {
            four.copy_from_slice(&word.to_le_bytes());
        }
        Ok(())
    }

    /// The reference point on the optical axis, turned by `Rx * Ry`.
    fn view_pose(&self, x_deg: f64, y_deg: f64) -> Pose {
        let rotation = rotation_zxy(0.0, x_deg, y_deg);
        let mut translation = scale(&apply(&rotation, &self.info.reference), -1.0);
        translation[2] -= self.info.distance;
        Pose {
            rotation,
            translation,
        }
    }

    /// Writes the header of a plain library, once all views are in their places.
    ///
    /// # Errors
    /// [`BuildError::Memory`] unless `bytes` has exactly [`Self::bytes_needed`] bytes.
    pub fn finish(&self, bytes: &mut [u8]) -> Result<(), BuildError> {
        let (needed, given) = (self.bytes_needed(), bytes.len());
        self.check_length(given)?;
        let memory = BuildError::Memory {
            what: "bytes",
            needed,
            given,
        };
        let (header, body) = bytes.split_first_chunk_mut().ok_or(memory)?;
        let body = Body {
            version: PLAIN_VERSION,
            blocks: 0,
            bytes: body.len() as u64,
            crc: checksum([&*body]),
        };
        write_header(header, &self.info, &body);
        Ok(())
    }

    /// The library as drawn so far, once all views are in their places: what
    /// [`super::compact()`] makes a file of, so that [`Self::finish`] and opening are not needed.
    ///
    /// # Errors
    /// [`BuildError::Memory`] unless `bytes` has exactly [`Self::bytes_needed`] bytes.
    pub fn drawn<'b>(&self, bytes: &'b [u8]) -> Result<Library<'b>, BuildError> {
        self.check_length(bytes.len())?;
        Ok(Library::plain(self.info, &bytes[HEADER_BYTES..]))
    }

    /// The file to keep, once all views are in their places in `bytes`: in the compact layout, or
    /// in the plain one where that is not larger. `words` is working memory for one view
    /// ([`CanonicalSpec::words_needed`]), `out` has [`Self::bytes_needed`] bytes like `bytes`.
    ///
    /// # Errors
    /// [`BuildError::Memory`] or [`BuildError::Mask`] for lent memory of a wrong length.
    pub fn finish_smaller<'b>(
        &self,
        bytes: &'b mut [u8],
        words: &mut [Word],
        out: &'b mut [u8],
    ) -> Result<&'b [u8], BuildError> {
        self.check_length(out.len())?;
        match compact(&self.drawn(bytes)?, words, out) {
            Ok(length) => Ok(&out[..length]),
            Err(BuildError::Memory { .. }) => {
                self.finish(bytes)?;
                Ok(bytes)
            }
            Err(other) => Err(other),
        }
    }

    /// Builds the whole library, in the plain layout, with one thread's working memory.
    ///
    /// # Errors
    /// As [`Self::render_view`] and [`Self::places`].
    pub fn build(&self, bytes: &mut [u8], scratch: &mut ViewScratch<'_>) -> Result<(), BuildError> {
        for (view, (record, bits)) in self.places(bytes)?.enumerate() {
            self.render_view(view, scratch, record, bits)?;
        }
        self.finish(bytes)
    }
}
