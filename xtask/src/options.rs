//! What verbs read from the command line alike.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use fluoropose_phantom::implant::Side;

/// Reads `left` or `right`.
pub(crate) fn sides() -> impl TypedValueParser<Value = Side> {
    PossibleValuesParser::new(["left", "right"]).try_map(|side| side.parse::<Side>())
}
