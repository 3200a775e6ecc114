//! A library and its model with the working memory to find poses of silhouettes.

use anyhow::{Result, bail};
use fluoropose::camera::Camera;
use fluoropose::image::mask::Word;
use fluoropose::image::silhouette::Silhouette;
use fluoropose::library::Library;
use fluoropose::locate::partial::{PartialBuffers, known_fraction, locate_partial};
use fluoropose::locate::rerank::{Reranked, rerank};
use fluoropose::locate::{Workspace, locate, workspace_needed};
use fluoropose::mesh::Model;
use fluoropose::render::{Projected, scratch_needed};

use crate::files::MaskBuffer;

/// Rival poses that are kept of one silhouette.
pub(super) const RIVALS: usize = 12;
/// The same of a library that covers a window of views: fewer come near the best.
const IN_A_WINDOW: usize = 6;

/// Beyond this part of the silhouette unmatched, something may hide a part of it.
const DOUBTFUL_SHARE: f64 = 0.06;

/// The poses that explain a silhouette, best first; at least one.
pub(super) type Rivals = Vec<Reranked>;

/// An opened library, its model, and memory lent to the core for each silhouette.
pub struct Locator<'l> {
    library: Library<'l>,
    mesh: Model<'l>,
    canonical: Vec<Word>,
    turned: Vec<Word>,
    scores: Vec<u32>,
    bytes: Vec<u8>,
    projected: Vec<Projected>,
    partial: PartialBuffers,
}

impl<'l> Locator<'l> {
    /// Opens the bytes of a library of `mesh`.
    ///
    /// # Errors
    /// Those of [`Library::open`], and when the library was made from another model.
    pub fn open(bytes: &'l [u8], mesh: Model<'l>) -> Result<Self> {
        let library = Library::open(bytes)?;
        if library.info().model != mesh.digest() {
            bail!("the library was made from another model: build it again");
        }
        let needs = workspace_needed(&library);
        Ok(Self {
            partial: PartialBuffers::default(),
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
    /// Those of [`locate`], [`rerank`] and [`locate_partial`].
    pub fn locate(&mut self, silhouette: &Silhouette<'_>, camera: &Camera) -> Result<Rivals> {
        if known_fraction(silhouette).is_partial() {
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
            rotated: &mut self.turned,
            scores: &mut self.scores,
            bytes: &mut self.bytes,
            kernels: fluoropose_kernels::fastest(),
        };
        let mut found = locate::<RIVALS>(silhouette.mask(), camera, &self.library, work)?;
        if !self.library.info().grid.is_around() {
            found.poses.truncate(IN_A_WINDOW);
        }
        let mut drawn = MaskBuffer::new(camera.width(), camera.height())?;
        let rivals = drawn.draw(|drawn| {
            let scratch = &mut self.projected;
            rerank::<RIVALS>(&found.poses, &self.mesh, camera, silhouette, scratch, drawn)
        })?;
        Ok(rivals.to_vec())
    }

    fn locate_partial(&mut self, silhouette: &Silhouette<'_>, camera: &Camera) -> Result<Rivals> {
        let memory = self.partial.borrow(&self.library, camera, &self.mesh);
        let found =
            locate_partial::<RIVALS>(silhouette, camera, &self.library, &self.mesh, memory)?;
        let kept = match self.library.info().grid.is_around() {
            true => RIVALS,
            false => IN_A_WINDOW,
        };
        Ok(found.iter().take(kept).copied().collect())
    }
}
