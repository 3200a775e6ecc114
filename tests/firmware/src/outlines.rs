//! Random polygons in place of the outline, one after another: none ends the program, all of them lead to the host's answers, and none
//! takes more stack than is told.

use core::fmt;

use fluoropose::Point;

use crate::failure::Failure;
use crate::program::Memory;
use crate::program::way::{opened, pose_of};
use crate::writing::{Write, digits, whole, words};

/// How many; `FLUOROPOSE_OUTLINES` when it is built.
const COUNT: u64 = match option_env!("FLUOROPOSE_OUTLINES") {
    Some(count) => match u64::from_str_radix(count, 10) {
        Ok(count) => count,
        Err(_) => panic!("FLUOROPOSE_OUTLINES is no number"),
    },
    None => 100,
};
/// Most corners of one.
const CORNERS: usize = 40;
/// Width and height of the frame, pixels.
const FRAME: f64 = 512.0;

/// Goes from each outline to an answer; `out` gets how many had poses, and a sum of all that was said of them.
///
/// # Errors
/// A [`Failure`] where what is in flash cannot be opened.
pub fn prove(
    memory: &mut Memory,
    out: &mut dyn Write,
    stage: &mut dyn FnMut(&str),
) -> Result<(), Failure> {
    let known = opened(stage)?;
    let (mut random, mut said, mut poses) = (Random(7), Sum(0xcbf2_9ce4_8422_2325), 0);
    for _ in 0..COUNT {
        let mut points = [Point::new(0.0, 0.0); CORNERS];
        let corners = polygon(&mut random, &mut points);
        match pose_of(&known, corners, memory, &mut said, &mut |_| ()) {
            Ok(()) => poses += 1,
            Err(failure) => words(&mut said, &[failure.word()])?,
        }
    }
    stage("outlines");
    whole(out, COUNT)?;
    words(out, &[" outlines, "])?;
    whole(out, poses)?;
    words(out, &[" poses, sum "])?;
    digits(out, said.0, 16, 16)?;
    words(out, &["\n"])?;
    Ok(())
}

/// Knuth's generator (MMIX).
struct Random(u64);

impl Random {
    /// From 0 to 1.
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / 16_777_216.0
    }
}

/// Corners anywhere, of which most polygons cross themselves; or around a middle by rising angles, as blobs and stars have them.
fn polygon<'p>(random: &mut Random, points: &'p mut [Point; CORNERS]) -> &'p [Point] {
    let count = 3 + (random.part() * (CORNERS - 3) as f64) as usize;
    let is_anywhere = random.part() < 0.1;
    let size = random.part() * 160.0;
    let middle = [100.0 + random.part() * 312.0, 100.0 + random.part() * 312.0];
    let least = random.part();
    for (number, point) in points.iter_mut().take(count).enumerate() {
        let [right, down] = if is_anywhere {
            [random.part() - 0.5, random.part() - 0.5]
        } else {
            let (sin, cos) = fluoropose::math::sin_cos(6.2 * number as f64 / count as f64);
            let radius = least + (1.0 - least) * random.part();
            [radius * cos, 0.7 * radius * sin]
        };
        let within = |at: f64| at.clamp(0.0, FRAME);
        *point = Point::new(
            within(middle[0] + size * right),
            within(middle[1] + size * down),
        );
    }
    // One in twenty has a corner that is no number.
    if random.part() < 0.05 {
        points[0].row = f64::NAN;
    }
    &points[..count]
}

/// A sum of all bytes that are written (Fowler, Noll and Vo).
struct Sum(u64);

impl Write for Sum {
    fn write_str(&mut self, words: &str) -> fmt::Result {
        for byte in words.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        Ok(())
    }
}
