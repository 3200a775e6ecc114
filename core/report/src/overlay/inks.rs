//! Colours of what stands beside the frame: the page's on dark.

use crate::drawing::Colour;

pub(super) const GROUND: Colour = Colour([0x16, 0x18, 0x1a]);
pub(super) const TEXT: Colour = Colour([0xe4, 0xe7, 0xea]);
pub(super) const QUIET: Colour = Colour([0x9a, 0xa1, 0xa8]);
