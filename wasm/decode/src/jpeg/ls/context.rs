//! Samples of a JPEG-LS scan from their codes: prediction, contexts and runs (T.87 annex A).

use super::parameters::Parameters;
use crate::error::Problem;
use crate::jpeg::markers::cut;

/// Contexts of single samples: gradients quantised to 9 steps each, those of opposite sign being one.
const REGULAR: usize = 365;

/// Most bits of an error that are coded as they are: there are no longer errors.
const MOST_PLAIN_BITS: u32 = 17;

/// Bits that tell how long a run is, growing with the runs before (J).
const RUN_BITS: [u32; 32] = [
    0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 9, 10, 11, 12, 13,
    14, 15,
];

/// What is known of samples with like neighbours.
#[derive(Clone, Copy)]
struct Context {
    /// Sum of the sizes of errors (A); a file may ask for 65 535 of them before any is forgotten.
    size: i64,
    /// Sum of errors (B); of the ends of runs, the number of negative ones (Nn).
    sum: i32,
    /// What predictions are corrected by (C).
    correction: i32,
    /// How many samples there were (N).
    count: i32,
}

pub(super) struct Contexts {
    regular: Vec<Context>,
    /// Ends of runs: where the sample above differs from that before, and where it does not.
    ends: [Context; 2],
}

impl Contexts {
    pub(super) fn new(parameters: &Parameters) -> Self {
        let first = Context {
            size: i64::from(((parameters.range + 32) / 64).max(2)),
            sum: 0,
            correction: 0,
            count: 1,
        };
        Self {
            regular: vec![first; REGULAR],
            ends: [first; 2],
        }
    }
}

impl Context {
    /// Bits of an error that are coded as they are (k).
    fn plain_bits(size: i64, count: i32) -> u32 {
        let enough = |&bits: &u32| i64::from(count) << bits >= size;
        (0..MOST_PLAIN_BITS).find(enough).unwrap_or(MOST_PLAIN_BITS)
    }

    fn forget_half(&mut self, reset: i32) {
        if self.count == reset {
            self.size >>= 1;
            self.sum >>= 1;
            self.count >>= 1;
        }
    }

    /// Learns an error of a single sample (A.6).
    fn learn(&mut self, error: i32, parameters: &Parameters) {
        self.sum += error * (2 * parameters.near + 1);
        self.size += i64::from(error.abs());
        self.forget_half(parameters.reset);
        self.count += 1;
        if self.sum <= -self.count {
            self.correction = (self.correction - 1).max(-128);
            self.sum = (self.sum + self.count).max(1 - self.count);
        } else if self.sum > 0 {
            self.correction = (self.correction + 1).min(127);
            self.sum = (self.sum - self.count).min(0);
        }
    }
}

/// Decodes lines. A line has a sample more on either side.
pub(super) struct LineDecoder<'a> {
    bits: Bits<'a>,
    parameters: Parameters,
    /// How long runs of each component were of late (RUNindex).
    runs: Vec<usize>,
}

/// The samples around one: before it, above, before that, and after that (a, b, c, d).
#[derive(Clone, Copy)]
struct Neighbours([i32; 4]);

impl Neighbours {
    fn of(above: &[i32], line: &[i32], at: usize) -> Self {
        Self([line[at - 1], above[at], above[at - 1], above[at + 1]])
    }

    /// Whether a run may begin here.
    fn are_alike(self, near: i32) -> bool {
        let Self([a, b, c, d]) = self;
        (d - b).abs() <= near && (b - c).abs() <= near && (c - a).abs() <= near
    }
}

impl<'a> LineDecoder<'a> {
    pub(super) fn new(coded: &'a [u8], parameters: Parameters, components: usize) -> Self {
        Self {
            bits: Bits {
                coded,
                at: 0,
                held: 0,
                count: 0,
            },
            parameters,
            runs: vec![0; components],
        }
    }

    /// The next line of one component.
    pub(super) fn line(
        &mut self,
        contexts: &mut Contexts,
        component: usize,
        above: &[i32],
        line: &mut [i32],
    ) -> Result<(), Problem> {
        let width = line.len() - 2;
        let mut at = 1;
        while at <= width {
            let around = Neighbours::of(above, line, at);
            if !around.are_alike(self.parameters.near) {
                line[at] = self.sample(contexts, around)?;
                at += 1;
                continue;
            }
            let length = self.run(component, width + 1 - at)?;
            line[at..at + length].fill(around.0[0]);
            at += length;
            if at <= width {
                let alike = (line[at - 1] - above[at]).abs() <= self.parameters.near;
                line[at] = self.end(contexts, component, alike, line[at - 1], above[at])?;
                self.runs[component] = self.runs[component].saturating_sub(1);
                at += 1;
            }
        }
        Ok(())
    }

    /// The next line of all components, a sample of each by turns. They run together.
    pub(super) fn samples(
        &mut self,
        contexts: &mut Contexts,
        above: &[Vec<i32>],
        lines: &mut [Vec<i32>],
    ) -> Result<(), Problem> {
        let width = lines.first().map_or(0, |line| line.len() - 2);
        let near = self.parameters.near;
        let mut at = 1;
        while at <= width {
            let mut pairs = lines.iter().zip(above);
            if !pairs.all(|(line, above)| Neighbours::of(above, line, at).are_alike(near)) {
                for (line, above) in lines.iter_mut().zip(above) {
                    line[at] = self.sample(contexts, Neighbours::of(above, line, at))?;
                }
                at += 1;
                continue;
            }
            let length = self.run(0, width + 1 - at)?;
            for line in lines.iter_mut() {
                let value = line[at - 1];
                line[at..at + length].fill(value);
            }
            at += length;
            if at <= width {
                for (line, above) in lines.iter_mut().zip(above) {
                    line[at] = self.end(contexts, 0, false, line[at - 1], above[at])?;
                }
                self.runs[0] = self.runs[0].saturating_sub(1);
                at += 1;
            }
        }
        Ok(())
    }

    /// A single sample (A.4 to A.5).
    fn sample(&mut self, contexts: &mut Contexts, around: Neighbours) -> Result<i32, Problem> {
        let Neighbours([a, b, c, d]) = around;
        let steps = [d - b, b - c, c - a].map(|gradient| self.step(gradient));
        let index = 81 * steps[0] + 9 * steps[1] + steps[2];
        let sign = if index < 0 { -1 } else { 1 };
        let context = &mut contexts.regular[index.unsigned_abs() as usize];
        let (low, high) = (a.min(b), a.max(b));
        // The sum of a and b without c, held between them.
        let predicted = (a + b - c).clamp(low, high) + sign * context.correction;
        let predicted = predicted.clamp(0, self.parameters.most);

        let plain = Context::plain_bits(context.size, context.count);
        let coded = self
            .bits
            .error(plain, self.parameters.longest, &self.parameters)?;
        let turned = self.parameters.near == 0 && plain == 0 && 2 * context.sum <= -context.count;
        // Even codes are not negative and odd ones negative; the other way where errors are mostly negative.
        let error = match (coded % 2 == 0) != turned {
            true => coded / 2,
            false => -(coded / 2) - 1,
        };
        context.learn(error, &self.parameters);
        Ok(self.reconstructed(predicted, sign * error))
    }

    /// A gradient in nine steps.
    fn step(&self, gradient: i32) -> i32 {
        let [first, second, third] = self.parameters.thresholds;
        let size = gradient.abs();
        let step = match size {
            _ if size <= self.parameters.near => 0,
            _ if size < first => 1,
            _ if size < second => 2,
            _ if size < third => 3,
            _ => 4,
        };
        step * gradient.signum()
    }

    /// How many samples repeat the one before, at most `left` (A.7.1).
    fn run(&mut self, component: usize, left: usize) -> Result<usize, Problem> {
        let mut length = 0;
        while self.bits.take(1)? == 1 {
            let step = 1 << RUN_BITS[self.runs[component]];
            if length + step <= left {
                length += step;
                self.runs[component] = (self.runs[component] + 1).min(RUN_BITS.len() - 1);
            } else {
                length = left;
            }
            if length == left {
                return Ok(length);
            }
        }
        length += self.bits.take(RUN_BITS[self.runs[component]])? as usize;
        match length < left {
            true => Ok(length),
            false => Err(cut("a run of pixels is longer than its row")),
        }
    }

    /// The sample that ends a run (A.7.2).
    fn end(
        &mut self,
        contexts: &mut Contexts,
        component: usize,
        alike: bool,
        before: i32,
        above: i32,
    ) -> Result<i32, Problem> {
        let context = &mut contexts.ends[usize::from(alike)];
        let grown = i64::from(if alike { context.count >> 1 } else { 0 });
        let plain = Context::plain_bits(context.size + grown, context.count);
        let longest = self.parameters.longest - RUN_BITS[self.runs[component]] - 1;
        let coded = self.bits.error(plain, longest, &self.parameters)?;
        let doubled = coded + i32::from(alike);
        let size = (doubled + 1) / 2;
        let mostly_negative = plain != 0 || 2 * context.sum >= context.count;
        let error = if mostly_negative == (doubled % 2 == 1) {
            -size
        } else {
            size
        };
        context.sum += i32::from(error < 0);
        context.size += i64::from((coded + 1 - i32::from(alike)) >> 1);
        context.forget_half(self.parameters.reset);
        context.count += 1;
        Ok(match alike {
            true => self.reconstructed(before, error),
            false => self.reconstructed(above, if before > above { -error } else { error }),
        })
    }

    /// A prediction and its error, modulo the range (A.4.5).
    fn reconstructed(&self, predicted: i32, error: i32) -> i32 {
        let Parameters {
            most, near, range, ..
        } = self.parameters;
        let step = 2 * near + 1;
        let value = predicted + error * step;
        let whole = if value < -near {
            value + range * step
        } else if value > most + near {
            value - range * step
        } else {
            value
        };
        whole.clamp(0, most)
    }
}

/// Bits of coded bytes, without the zero bit after each 0xFF.
struct Bits<'a> {
    coded: &'a [u8],
    at: usize,
    held: u64,
    count: u32,
}

impl Bits<'_> {
    /// Holds at least 32 bits where there are so many.
    fn fill(&mut self) {
        while self.count <= 48 {
            let Some(&byte) = self.coded.get(self.at) else {
                return;
            };
            let stuffed = self.at > 0 && self.coded[self.at - 1] == 0xFF;
            let new = if stuffed { 7 } else { 8 };
            self.held = self.held << new | u64::from(byte);
            self.count += new;
            self.at += 1;
        }
    }

    /// The next bits, at most 32.
    fn take(&mut self, length: u32) -> Result<u32, Problem> {
        if self.count < length {
            self.fill();
        }
        if self.count < length {
            return Err(cut("its pixels end too early"));
        }
        self.count -= length;
        Ok((self.held >> self.count & ((1 << length) - 1)) as u32)
    }

    /// An error in a Golomb code of limited length (A.5.3): zeros count its upper part, a one ends them.
    fn error(&mut self, plain: u32, longest: u32, all: &Parameters) -> Result<i32, Problem> {
        let escape = longest.saturating_sub(all.error_bits + 1);
        let mut upper = 0;
        while self.take(1)? == 0 {
            upper += 1;
            if upper > escape {
                return Err(cut("a pixel's code is longer than any can be"));
            }
        }
        let value = match upper < escape {
            true => u64::from(upper) << plain | u64::from(self.take(plain)?),
            false => u64::from(self.take(all.error_bits)?) + 1,
        };
        i32::try_from(value)
            .ok()
            .filter(|&value| value <= 2 * all.range)
            .ok_or_else(|| cut("a pixel's code stands for more than any can be"))
    }
}
