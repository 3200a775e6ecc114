//! A library with the working memory to match silhouettes against it.

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::library::Library;
use fluoropose::locate::{Found, LocateError, Workspace, locate, workspace_needed};
use fluoropose::mask::{Mask, Word};
use fluoropose::pose::Pose;

/// Rival poses that are kept of one silhouette.
pub const RIVALS: usize = 4;

/// An opened library and memory lent to the core for each silhouette.
pub struct Locator<'l> {
    library: Library<'l>,
    canonical: Vec<Word>,
    turned: Vec<Word>,
    scores: Vec<u32>,
}

impl<'l> Locator<'l> {
    /// Opens the bytes of a library.
    ///
    /// # Errors
    /// Those of [`Library::open`].
    pub fn open(bytes: &'l [u8]) -> Result<Self> {
        let library = Library::open(bytes)?;
        let (words, scores) = workspace_needed(&library);
        Ok(Self {
            library,
            canonical: vec![0; words],
            turned: vec![0; words],
            scores: vec![0; scores],
        })
    }

    /// The library.
    pub fn library(&self) -> &Library<'l> {
        &self.library
    }

    /// All poses that explain a mask, best first.
    ///
    /// # Errors
    /// Those of [`locate`].
    pub fn locate(
        &mut self,
        mask: &Mask<'_>,
        camera: &Camera,
    ) -> Result<Found<'_, RIVALS>, LocateError> {
        let work = Workspace {
            canonical: &mut self.canonical,
            turned: &mut self.turned,
            scores: &mut self.scores,
        };
        locate(mask, camera, &self.library, work)
    }

    /// The best pose of a mask.
    ///
    /// # Errors
    /// Those of [`locate`].
    pub fn pose(&mut self, mask: &Mask<'_>, camera: &Camera) -> Result<Pose> {
        let found = self.locate(mask, camera)?;
        // A score surface always has a lowest point.
        Ok(found
            .poses
            .first()
            .map(|located| located.pose)
            .expect("a library has at least one view"))
    }
}
