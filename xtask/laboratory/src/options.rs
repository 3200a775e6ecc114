//! Numbers as the command line writes them.

use std::str::FromStr;

use anyhow::{Context, Result, bail};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use fluoropose::library::ViewAxis;
use fluoropose_phantom::implant::Side;

/// A range of rotations, `first:last:step` in degrees.
#[derive(Clone, Copy, Debug)]
pub struct Range(pub ViewAxis);

impl FromStr for Range {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let numbers: Result<Vec<f64>, _> = text.split(':').map(str::parse).collect();
        let numbers = numbers.with_context(|| format!("'{text}' is not first:last:step"))?;
        let &[first, last, step] = numbers.as_slice() else {
            bail!("'{text}' is not first:last:step");
        };
        let steps = (last - first) / step;
        if !(step > 0.0 && (0.0..4096.0).contains(&steps)) {
            bail!("'{text}': the step must be positive and lead from first to last");
        }
        Ok(Self(ViewAxis {
            first,
            step,
            count: (steps + 1e-9) as usize + 1,
        }))
    }
}

/// A pair of numbers, `x,y`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pair(pub [f64; 2]);

impl FromStr for Pair {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        match numbers
            .with_context(|| format!("'{text}' is not x,y"))?
            .as_slice()
        {
            &[x, y] => Ok(Self([x, y])),
            _ => bail!("'{text}' is not x,y"),
        }
    }
}

/// Reads `left` or `right`.
pub fn sides() -> impl TypedValueParser<Value = Side> {
    PossibleValuesParser::new(["left", "right"]).try_map(|side| side.parse::<Side>())
}
