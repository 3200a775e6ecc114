//! Why bytes are no implant file.

use thiserror::Error;

use super::wire::VERSION;
use crate::library::LibraryError;
use crate::mesh::MeshError;

/// Why bytes are no implant file, or none can be written.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ImplantError {
    /// The first bytes are not those of an implant file.
    #[error("this is not an implant file: it does not begin with FLUOROIM")]
    Magic,
    /// The layout is unknown.
    #[error(
        "the implant file has version {0}; this program reads versions 0 to {VERSION}. Make it again, or read it with a newer program"
    )]
    Version(u16),
    /// The bytes do not begin at a multiple of four, or numbers run the other way on this machine.
    #[error(
        "an implant file is read in place: it must begin at an address that is a multiple of 4, on a little-endian machine"
    )]
    Place,
    /// The file is shorter or longer than its header says.
    #[error("the implant file has {given} bytes but should have {needed}: it is cut or padded")]
    Length {
        /// Bytes by the header.
        needed: u64,
        /// Bytes that were given.
        given: u64,
    },
    /// A checksum is wrong.
    #[error("the implant file's {0} is damaged: its checksum does not fit. Make or fetch it again")]
    Checksum(&'static str),
    /// A number in it is impossible although the checksum fits.
    #[error("the implant file's {0} is not possible; it was written wrongly. Make it again")]
    Value(&'static str),
    /// Its library is none.
    #[error(transparent)]
    Library(#[from] LibraryError),
    /// Its surface is none.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Surface and library are not of one model.
    #[error("the library was made from another model than the surface: build it again")]
    OtherModel,
    /// To be written: a model without edges, or with more than 65 536 vertices.
    #[error("the model has no edges, or more than 65 536 vertices")]
    Edges,
}
