//! How well a pose can be known at all: the bound of Cramer and Rao for a noisy outline.
//!
//! A trace says of each piece `i` of the model's outline how far it is displaced along its normal,
//! `x = J p + e`, with `p` the error of the pose, `J` the outline's Jacobian and `e` the noise of
//! the covariance `C`. For Gaussian noise
//!
//! - **the bound** on the covariance of any unbiased estimator of `p` is the inverse of Fisher's
//!   information `J' C^-1 J` (S. M. Kay, *Fundamentals of Statistical Signal Processing: Estimation
//!   Theory*, 1993, sections 3.7 to 3.9). Only an estimator that knows the noise's spectrum and weighs by it
//!   reaches it (ibid., section 4.5).
//! - **plain least squares**, which weighs by length alone, reaches
//!   `(J' J)^-1 J' C J (J' J)^-1`. What does not know the spectrum cannot be expected to
//!   do better. The two are one where the noise is white.
//!
//! The noise: a mask rounds its outline to whole pixels, an error with the variance of a uniform
//! number, 1/12 square pixel for each pixel of outline, independent from pixel to pixel (W. R.
//! Bennett, Bell Syst. Tech. J. 27, 1948); and a hand's jitter, of the covariance
//! `s^2 exp(-d^2 / (2 l^2))` of the way `d` along the outline.
//!
//! **Rounding alone is no Gaussian noise.** Each pixel of a mask that was drawn from the model
//! rules out every pose that would have drawn it otherwise, so an estimator that makes use of that
//! comes nearer than this bound; for masks without other noise it is a yardstick and no limit.

mod cholesky;
mod limits;
mod sites;

pub use limits::{Limits, limits};
pub use sites::Site;

#[cfg(test)]
mod tests;
