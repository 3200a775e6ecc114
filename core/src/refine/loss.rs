//! How the pull of a residual fades with its size, in 32 bits: residuals are no finer.

use crate::math::ln_1p_single;

/// How the pull of a residual fades with its size. Both are scaled in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) enum Loss {
    /// `c^2 / 2 ln(1 + (r / c)^2)`
    Cauchy(f32),
    /// `c^2 / 6 (1 - (1 - (r / c)^2)^3)`, constant beyond `c` (Beaton and Tukey, Technometrics
    /// 16, 1974)
    Tukey(f32),
}

impl Loss {
    /// Loss (square pixels) and weight of a residual: the weight is that of the least squares
    /// that the loss is to first order.
    pub(super) fn at(self, residual: f32) -> (f32, f32) {
        let (c, weight) = (self.scale(), self.weight(residual));
        let cost = match self {
            Self::Cauchy(_) => 0.5 * c * c * ln_1p_single((residual / c) * (residual / c)),
            Self::Tukey(_) => {
                // The weight is the square of this.
                let rest = (1.0 - (residual / c) * (residual / c)).max(0.0);
                c * c / 6.0 * (1.0 - weight * rest)
            }
        };
        (cost, weight)
    }
}

impl Loss {
    /// Derivative of the loss.
    pub(super) fn pull(self, residual: f32) -> f32 {
        residual * self.weight(residual)
    }

    fn weight(self, residual: f32) -> f32 {
        let ratio = residual / self.scale();
        match self {
            Self::Cauchy(_) => 1.0 / (1.0 + ratio * ratio),
            Self::Tukey(_) => {
                let rest = (1.0 - ratio * ratio).max(0.0);
                rest * rest
            }
        }
    }

    fn scale(self) -> f32 {
        let (Self::Cauchy(c) | Self::Tukey(c)) = self;
        c
    }

    /// Second derivative of the loss.
    pub(super) fn curvature(self, residual: f32) -> f32 {
        match self {
            Self::Cauchy(c) => {
                let ratio = (residual / c) * (residual / c);
                (1.0 - ratio) / ((1.0 + ratio) * (1.0 + ratio))
            }
            Self::Tukey(c) => {
                let ratio = (residual / c) * (residual / c);
                if ratio < 1.0 {
                    (1.0 - ratio) * (1.0 - 5.0 * ratio)
                } else {
                    0.0
                }
            }
        }
    }
}
