//! A library and its model with the working memory to find poses of silhouettes.

use anyhow::{Result, bail};
use fluoropose::camera::Camera;
use fluoropose::library::Library;
use fluoropose::locate::{Workspace, locate, workspace_needed};
use fluoropose::mask::Word;
use fluoropose::mesh::Mesh;
use fluoropose::raster::{Projected, scratch_needed};
use fluoropose::silhouette::Silhouette;
use fluoropose::verify::{Verified, verify};

use super::files::MaskBuffer;

/// Rival poses that are kept of one silhouette.
pub const RIVALS: usize = 4;

/// The poses that explain a silhouette, best first; at least one.
pub type Rivals = Vec<Verified>;

/// An opened library, its model, and memory lent to the core for each silhouette.
pub struct Locator<'l> {
    library: Library<'l>,
    mesh: Mesh<'l>,
    canonical: Vec<Word>,
    turned: Vec<Word>,
    scores: Vec<u32>,
    projected: Vec<Projected>,
}

impl<'l> Locator<'l> {
    /// Opens the bytes of a library of `mesh`.
    ///
    /// # Errors
    /// Those of [`Library::open`], and when the library was made from another model.
    pub fn open(bytes: &'l [u8], mesh: Mesh<'l>) -> Result<Self> {
        let library = Library::open(bytes)?;
        if library.info().model != mesh.digest() {
            bail!("the library was made from another model: build it again");
        }
        let (words, scores) = workspace_needed(&library);
        Ok(Self {
            library,
            mesh,
            canonical: vec![0; words],
            turned: vec![0; words],
            scores: vec![0; scores],
            projected: vec![Projected::default(); scratch_needed(&mesh)],
        })
    }

    /// The library.
    pub fn library(&self) -> &Library<'l> {
        &self.library
    }

    /// All poses that explain a silhouette, best first: local minima of the score surface, put in
    /// order by drawing the model at each.
    ///
    /// # Errors
    /// Those of [`locate`] and [`verify`].
    pub fn locate(&mut self, silhouette: &Silhouette<'_>, camera: &Camera) -> Result<Rivals> {
        let work = Workspace {
            canonical: &mut self.canonical,
            turned: &mut self.turned,
            scores: &mut self.scores,
        };
        let found = locate::<RIVALS>(silhouette.mask(), camera, &self.library, work)?;
        let mut drawn = MaskBuffer::new(camera.width(), camera.height())?;
        let rivals = drawn.draw(|drawn| {
            let scratch = &mut self.projected;
            verify::<RIVALS>(&found.poses, &self.mesh, camera, silhouette, scratch, drawn)
        })?;
        Ok(rivals.to_vec())
    }
}
