//! A library and its model with the working memory to find poses of silhouettes.

use anyhow::{Result, bail};
use fluoropose::camera::Camera;
use fluoropose::library::Library;
use fluoropose::locate::{Workspace, locate, workspace_needed};
use fluoropose::mask::Word;
use fluoropose::mesh::Mesh;
use fluoropose::partial::{
    Hypothesis, OutlinePoint, PartialMemory, PartialNeeds, Side, known_share, locate_partial,
    partial_needed,
};
use fluoropose::raster::{Projected, scratch_needed};
use fluoropose::silhouette::Silhouette;
use fluoropose::verify::{Verified, verify};

use crate::files::MaskBuffer;

/// Rival poses that are kept of one silhouette.
pub(super) const RIVALS: usize = 6;

/// Beyond this part of the silhouette unmatched, something may hide a part of it.
const DOUBTFUL_SHARE: f64 = 0.06;

/// The poses that explain a silhouette, best first; at least one.
pub(super) type Rivals = Vec<Verified>;

/// An opened library, its model, and memory lent to the core for each silhouette.
pub struct Locator<'l> {
    library: Library<'l>,
    mesh: Mesh<'l>,
    canonical: Vec<Word>,
    turned: Vec<Word>,
    scores: Vec<u32>,
    bytes: Vec<u8>,
    projected: Vec<Projected>,
    partial: PartialBuffers,
}

impl<'l> Locator<'l> {
    /// Opens the bytes of a library of `mesh` for frames of `camera`.
    ///
    /// # Errors
    /// Those of [`Library::open`], and when the library was made from another model.
    pub fn open(bytes: &'l [u8], mesh: Mesh<'l>, camera: &Camera) -> Result<Self> {
        let library = Library::open(bytes)?;
        if library.info().model != mesh.digest() {
            bail!("the library was made from another model: build it again");
        }
        let needs = workspace_needed(&library);
        Ok(Self {
            partial: PartialBuffers::new(&partial_needed(&library, camera, &mesh)),
            library,
            mesh,
            canonical: vec![0; needs.words],
            turned: vec![0; needs.words],
            scores: vec![0; needs.scores],
            bytes: vec![0; needs.bytes],
            projected: vec![Projected::default(); scratch_needed(&mesh)],
        })
    }

    /// The library.
    pub fn library(&self) -> &Library<'l> {
        &self.library
    }

    /// All poses that explain a silhouette, best first: local minima of the score surface, put in
    /// order by drawing the model at each. Where a part of the silhouette is unknown or cut off,
    /// and where the poses found leave much of it unmatched, as when something hides a part of it
    /// and nobody said so, pieces of its outline lead to further poses.
    ///
    /// # Errors
    /// Those of [`locate`], [`verify`] and [`locate_partial`].
    pub fn locate(&mut self, silhouette: &Silhouette<'_>, camera: &Camera) -> Result<Rivals> {
        if known_share(silhouette).is_partial() {
            return self.locate_partial(silhouette, camera);
        }
        let mut rivals = self.locate_whole(silhouette, camera)?;
        let limit = DOUBTFUL_SHARE * silhouette.mask().area() as f64;
        if rivals
            .first()
            .is_none_or(|best| best.unmatched as f64 > limit)
        {
            rivals.extend(self.locate_partial(silhouette, camera)?);
            rivals.sort_by_key(|rival| rival.unmatched);
        }
        Ok(rivals)
    }

    fn locate_whole(&mut self, silhouette: &Silhouette<'_>, camera: &Camera) -> Result<Rivals> {
        let work = Workspace {
            canonical: &mut self.canonical,
            turned: &mut self.turned,
            scores: &mut self.scores,
            bytes: &mut self.bytes,
            kernels: fluoropose_kernels::fastest(),
        };
        let found = locate::<RIVALS>(silhouette.mask(), camera, &self.library, work)?;
        let mut drawn = MaskBuffer::new(camera.width(), camera.height())?;
        let rivals = drawn.draw(|drawn| {
            let scratch = &mut self.projected;
            verify::<RIVALS>(&found.poses, &self.mesh, camera, silhouette, scratch, drawn)
        })?;
        Ok(rivals.to_vec())
    }

    fn locate_partial(&mut self, silhouette: &Silhouette<'_>, camera: &Camera) -> Result<Rivals> {
        let memory = self.partial.lend();
        let found =
            locate_partial::<RIVALS>(silhouette, camera, &self.library, &self.mesh, memory)?;
        Ok(found.to_vec())
    }
}

/// Memory for the search by pieces of an outline.
struct PartialBuffers {
    words: Vec<Word>,
    sides: Vec<Side>,
    points: Vec<OutlinePoint>,
    cells: Vec<u16>,
    numbers: Vec<f32>,
    hypotheses: Vec<Hypothesis>,
    projected: Vec<Projected>,
}

impl PartialBuffers {
    fn new(needs: &PartialNeeds) -> Self {
        Self {
            words: vec![0; needs.words],
            sides: vec![Side::default(); needs.sides],
            points: vec![OutlinePoint::default(); needs.points],
            cells: vec![0; needs.cells],
            numbers: vec![0.0; needs.numbers],
            hypotheses: vec![Hypothesis::default(); needs.hypotheses],
            projected: vec![Projected::default(); needs.projected],
        }
    }

    fn lend(&mut self) -> PartialMemory<'_> {
        PartialMemory {
            words: &mut self.words,
            sides: &mut self.sides,
            points: &mut self.points,
            cells: &mut self.cells,
            numbers: &mut self.numbers,
            hypotheses: &mut self.hypotheses,
            projected: &mut self.projected,
        }
    }
}
