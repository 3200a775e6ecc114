//! Butterworth's filter without lag, for numbers and for poses.
//!
//! A second-order filter forwards and backwards, which is of fourth order and has no lag; its own cutoff is corrected so that
//! the two passes together halve the power at the cutoff that was asked for (Winter, *Biomechanics and Motor Control of Human
//! Movement*, section 3.4). Every unbroken run of frames is filtered by itself, continued at its ends by its own point
//! reflection, as `scipy.signal.filtfilt` does. Of one that is shorter than the filter remembers the line through both ends stays as it is: it
//! is not drawn towards either.

use thiserror::Error;

use crate::math::{
    Vector3, apply, multiply, rotation_by, rotation_vector, sin_cos, sqrt, subtract, transpose,
};
use crate::memory::{TooLittleMemory, check_length};
use crate::pose::{Pose, Quaternion};

/// `(sqrt(2) - 1)^(1/4)`: a second-order filter that halves its power at the cutoff divided by this keeps the root of one half
/// at the cutoff, so that two passes halve it there.
const TWO_PASSES: f64 = 0.802_243_070_117_472_1;
/// A run is continued at each end by so many periods of the cutoff, as far as it is that long: what the filter does not know
/// of the time before is forgotten then.
const BEYOND: f64 = 3.0;

/// Why there is no such filter.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CutoffError {
    /// The rate or the cutoff is no positive number.
    #[error("a cutoff of {cutoff_hz} Hz at {frames_per_s} frames a second: both must be positive")]
    NotPositive {
        /// What was asked for.
        cutoff_hz: f64,
        /// Frames a second.
        frames_per_s: f64,
    },
    /// Frames at this rate do not hold what the filter should keep.
    #[error(
        "a cutoff of {cutoff_hz} Hz is not below half of {frames_per_s} frames a second: such a film holds nothing faster, and nothing would be filtered"
    )]
    TooHigh {
        /// What was asked for.
        cutoff_hz: f64,
        /// Frames a second.
        frames_per_s: f64,
    },
}

/// A filter for frames at one rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowPass {
    /// Cutoff, Hz.
    pub cutoff_hz: f64,
    /// Frames a second.
    pub frames_per_s: f64,
    /// Of the input.
    forward: [f64; 3],
    /// Of the output before; the first is 1.
    back: [f64; 2],
}

impl LowPass {
    /// A filter that halves the power at `cutoff_hz` of a film of `frames_per_s`.
    ///
    /// # Errors
    /// [`CutoffError`].
    pub fn new(cutoff_hz: f64, frames_per_s: f64) -> Result<Self, CutoffError> {
        let known = |x: f64| x.is_finite() && x > 0.0;
        if !known(cutoff_hz) || !known(frames_per_s) {
            return Err(CutoffError::NotPositive {
                cutoff_hz,
                frames_per_s,
            });
        }
        if cutoff_hz >= frames_per_s / 2.0 {
            return Err(CutoffError::TooHigh {
                cutoff_hz,
                frames_per_s,
            });
        }
        // The bilinear transform of 1 / (s^2 + sqrt(2) s + 1).
        let (sine, cosine) = sin_cos(core::f64::consts::PI * cutoff_hz / frames_per_s);
        let k = sine / cosine / TWO_PASSES;
        let all = 1.0 + core::f64::consts::SQRT_2 * k + k * k;
        let gain = k * k / all;
        Ok(Self {
            cutoff_hz,
            frames_per_s,
            forward: [gain, 2.0 * gain, gain],
            back: [
                2.0 * (k * k - 1.0) / all,
                (1.0 - core::f64::consts::SQRT_2 * k + k * k) / all,
            ],
        })
    }

    /// Numbers of working memory for [`Self::smooth`] of a number of frames.
    #[must_use]
    pub const fn memory_needed(frames: usize) -> usize {
        3 * frames
    }

    /// Filters each unbroken run of numbers; NaN stays NaN.
    ///
    /// # Errors
    /// [`TooLittleMemory`] for fewer than [`Self::memory_needed`].
    pub fn smooth(&self, values: &mut [f64], memory: &mut [f64]) -> Result<(), TooLittleMemory> {
        let needed = Self::memory_needed(values.len());
        check_length("numbers", needed, memory.len())?;
        for run in values.split_mut(|value| value.is_nan()) {
            self.smooth_run(run, memory);
        }
        Ok(())
    }

    fn smooth_run(&self, run: &mut [f64], memory: &mut [f64]) {
        let Some((&first, &last)) = run.first().zip(run.last()) else {
            return;
        };
        let periods = BEYOND * self.frames_per_s / self.cutoff_hz;
        let wanted = periods as usize;
        let beyond = wanted.min(run.len() - 1);
        let whole = &mut memory[..run.len() + 2 * beyond];
        // The line through both ends passes any filter without lag as it is; in a run that is shorter than the filter remembers it
        // would not, since what is put before it and behind it is only as long as the run.
        let slope = match beyond < wanted {
            true => (last - first) / (run.len() - 1).max(1) as f64,
            false => 0.0,
        };
        let line = |at: usize| first + slope * at as f64;
        for (at, value) in run.iter().enumerate() {
            whole[beyond + at] = value - line(at);
        }
        let end = beyond + run.len() - 1;
        for k in 0..beyond {
            whole[k] = 2.0 * whole[beyond] - whole[2 * beyond - k];
            whole[end + 1 + k] = 2.0 * whole[end] - whole[end - 1 - k];
        }
        self.pass(whole.iter_mut());
        self.pass(whole.iter_mut().rev());
        for (at, value) in run.iter_mut().enumerate() {
            *value = whole[beyond + at] + line(at);
        }
    }

    /// One pass, as if all before the first number had been as it is.
    fn pass<'v>(&self, values: impl Iterator<Item = &'v mut f64>) {
        let [b0, b1, b2] = self.forward;
        let [a1, a2] = self.back;
        // Transposed direct form 2; the state in which a constant stays what it is.
        let steady = [1.0 - b0, b2 - a2];
        let mut state = None;
        for value in values {
            let x = *value;
            let [s0, s1] = state.unwrap_or(steady.map(|s| s * x));
            let y = b0 * x + s0;
            state = Some([b1 * x - a1 * y + s1, b2 * x - a2 * y]);
            *value = y;
        }
    }

    /// Numbers of working memory for [`Self::smooth_poses`] of a number of frames.
    #[must_use]
    pub const fn pose_memory_needed(frames: usize) -> usize {
        6 * frames + Self::memory_needed(frames)
    }

    /// Filters each unbroken run of poses; frames without one stay without.
    ///
    /// Of translations those of `middle` are filtered, a point of the part that moves: that of an origin which lies far off the part is an arc,
    /// which a filter draws inwards while it leaves the turn that makes it. Rotations are filtered as rotation vectors from the mean of the
    /// run, in its own axes: the result is the same in whatever axes and from whatever origin camera and model are given, and is that of filtering
    /// the angle where all turn about one axis. Euler angles would have neither. Poses of a run must lie within half a turn of their mean.
    ///
    /// # Errors
    /// [`TooLittleMemory`] for fewer than [`Self::pose_memory_needed`].
    pub fn smooth_poses(
        &self,
        poses: &mut [Option<Pose>],
        middle: &Vector3,
        memory: &mut [f64],
    ) -> Result<(), TooLittleMemory> {
        let needed = Self::pose_memory_needed(poses.len());
        check_length("numbers", needed, memory.len())?;
        for run in poses.split_mut(Option::is_none) {
            self.smooth_pose_run(run, middle, memory);
        }
        Ok(())
    }

    fn smooth_pose_run(&self, run: &mut [Option<Pose>], middle: &Vector3, memory: &mut [f64]) {
        let mean = mean_rotation(run.iter().flatten());
        let (numbers, memory) = memory.split_at_mut(6 * run.len());
        let frames = run.len();
        for (at, pose) in run.iter().flatten().enumerate() {
            let turn = rotation_vector(&multiply(&transpose(&mean), &pose.rotation));
            let place = pose.transform(middle);
            for (k, value) in turn.into_iter().chain(place).enumerate() {
                numbers[k * frames + at] = value;
            }
        }
        for row in numbers.chunks_exact_mut(frames.max(1)) {
            self.smooth_run(row, memory);
        }
        for (at, pose) in run.iter_mut().flatten().enumerate() {
            let three = |from: usize| core::array::from_fn(|k| numbers[(from + k) * frames + at]);
            pose.rotation = multiply(&mean, &rotation_by(&three(0)));
            pose.translation = subtract(&three(3), &apply(&pose.rotation, middle));
        }
    }
}

/// The mean of rotations: of their quaternions, each with the sign that is nearer to the first.
fn mean_rotation<'p>(poses: impl Iterator<Item = &'p Pose>) -> crate::math::Matrix3 {
    let mut sum = [0.0; 4];
    for pose in poses {
        let Quaternion { w, x, y, z } = Quaternion::from(pose.rotation);
        let next = [w, x, y, z];
        let alike: f64 = sum.iter().zip(next).map(|(a, b)| a * b).sum();
        let sign = if alike < 0.0 { -1.0 } else { 1.0 };
        sum = core::array::from_fn(|k| sum[k] + sign * next[k]);
    }
    let length = sqrt(sum.iter().map(|x| x * x).sum());
    let [w, x, y, z] = sum.map(|x| x / length);
    Quaternion { w, x, y, z }.into()
}

#[cfg(test)]
mod tests;
