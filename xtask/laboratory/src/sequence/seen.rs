//! What is known of one frame.

use fluoropose::image::grey::Grey;
use fluoropose::image::silhouette::Silhouette;

/// What is known of one frame.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// The silhouette that was traced.
    pub silhouette: Silhouette<'a>,
    /// The frame, for the method `image`.
    pub frame: Option<&'a dyn Grey>,
}

impl<'a> From<Silhouette<'a>> for Seen<'a> {
    fn from(silhouette: Silhouette<'a>) -> Self {
        Self {
            silhouette,
            frame: None,
        }
    }
}
