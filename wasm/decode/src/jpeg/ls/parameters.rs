//! What all samples of a JPEG-LS scan have in common (T.87 A.2 and C.2.4).

use crate::error::Problem;
use crate::jpeg::markers::{FORMAT, REMEDY, cut};

/// Parameters that a file states; 0 stands for the standard's own.
#[derive(Clone, Copy, Default)]
pub(super) struct Preset {
    most: u16,
    thresholds: [u16; 3],
    reset: u16,
}

/// The parameters of a scan.
#[derive(Clone, Copy)]
pub(super) struct Parameters {
    /// Greatest sample (MAXVAL).
    pub most: i32,
    /// How much a sample may differ from what was coded (NEAR).
    pub near: i32,
    /// How many errors of prediction there can be (RANGE).
    pub range: i32,
    /// Bits of such an error (qbpp).
    pub error_bits: u32,
    /// Longest code, bits (LIMIT).
    pub longest: u32,
    /// Gradients from which a context is another (T1, T2, T3).
    pub thresholds: [i32; 3],
    /// After so many samples a context forgets half (RESET).
    pub reset: i32,
}

impl Preset {
    /// Reads a segment of parameters.
    pub(super) fn read(body: &[u8]) -> Result<Self, Problem> {
        let [1, values @ ..] = body else {
            let what = "JPEG-LS with tables of values or sides above 65535";
            return Err(Problem::unsupported(FORMAT, what, REMEDY));
        };
        let words = values
            .as_chunks::<2>()
            .0
            .iter()
            .map(|&word| u16::from_be_bytes(word));
        match words.collect::<Vec<_>>().as_slice() {
            &[most, a, b, c, reset] => Ok(Self {
                most,
                thresholds: [a, b, c],
                reset,
            }),
            _ => Err(cut("its parameters are cut short")),
        }
    }

    /// The parameters of a scan whose samples have `precision` bits, 2 to 16.
    pub(super) fn parameters(self, precision: u8, near: u8) -> Result<Parameters, Problem> {
        let full = i32::from(u16::MAX >> (16 - precision));
        let stated = |value: u16, standard: i32| if value == 0 { standard } else { value.into() };
        let most = stated(self.most, full);
        let near = i32::from(near);
        let [a, b, c] = self.thresholds;
        let standard = standard_thresholds(most, near);
        let thresholds = [
            stated(a, standard[0]),
            stated(b, standard[1]),
            stated(c, standard[2]),
        ];
        let sound = (1..=full).contains(&most)
            && near <= (most / 2).min(255)
            && near < thresholds[0]
            && thresholds.is_sorted()
            && thresholds[2] <= most;
        if !sound {
            return Err(cut("its parameters contradict each other"));
        }
        let range = (most + 2 * near) / (2 * near + 1) + 1;
        let bits = bits_of(most + 1).max(2);
        Ok(Parameters {
            most,
            near,
            range,
            error_bits: bits_of(range),
            longest: 2 * (bits + bits.max(8)),
            thresholds,
            reset: stated(self.reset, 64),
        })
    }
}

/// The fewest bits that tell so many values apart.
fn bits_of(values: i32) -> u32 {
    32 - (values - 1).leading_zeros()
}

/// The thresholds that hold where a file states none (C.2.4.1.1).
fn standard_thresholds(most: i32, near: i32) -> [i32; 3] {
    let clamped = |value: i32, least: i32| {
        if (least..=most).contains(&value) {
            value
        } else {
            least
        }
    };
    let value = |standard: i32, least: i32, step: i32| match most {
        128.. => {
            let factor = (most.min(4095) + 128) / 256;
            factor * (standard - least) + least + step * near
        }
        _ => least.max(standard / (256 / (most + 1)) + step * near),
    };
    let first = clamped(value(3, 2, 3), near + 1);
    let second = clamped(value(7, 3, 5), first);
    [first, second, clamped(value(21, 4, 7), second)]
}
