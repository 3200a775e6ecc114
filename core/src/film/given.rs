//! What a person states of a film, where the frames are not asked.

/// How a display shows intensities: by its curvature times the contrast of metal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayKind {
    /// Grey values in proportion to intensity, or nearly.
    Linear,
    /// Neither.
    Between,
    /// Grey values in proportion to the logarithm of the intensity.
    Logarithmic,
}

/// Curvature for each contrast from which on a display is between, and logarithmic.
const KINDS: [f64; 2] = [0.5, 1.0];
/// Curvatures that are looked at, for each contrast.
pub(super) const CURVATURES: [f64; 2] = [-1.0, 8.0];

impl DisplayKind {
    /// That of the word `linear`, `between` or `logarithmic`.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Self> {
        match word {
            "linear" => Some(Self::Linear),
            "between" => Some(Self::Between),
            "logarithmic" => Some(Self::Logarithmic),
            _ => None,
        }
    }

    /// That of a curvature for each contrast.
    pub(super) fn of(curved: f64) -> Self {
        match curved {
            _ if curved < KINDS[0] => Self::Linear,
            _ if curved < KINDS[1] => Self::Between,
            _ => Self::Logarithmic,
        }
    }

    /// The curvatures for each contrast that it may have. One that is stated to be linear is.
    fn range(self) -> [f64; 2] {
        match self {
            Self::Linear => [0.0, 0.0],
            // At its end it would be called logarithmic.
            Self::Between => [KINDS[0], 0.999 * KINDS[1]],
            Self::Logarithmic => [KINDS[1], CURVATURES[1]],
        }
    }
}

/// What is taken as it is stated; what is left out is estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GivenFilm {
    /// How intensities are shown. Where it curves, how much is estimated all the same.
    pub display: Option<DisplayKind>,
    /// Standard deviation of everything that blurs, pixels.
    pub blur_px: Option<f64>,
}

impl GivenFilm {
    /// The same where frames are read in squares with sides of so many pixels.
    #[cfg(feature = "alloc")]
    pub(super) fn in_squares(self, square_px: usize) -> Self {
        let side = square_px.max(1) as f64;
        let blur_px = self.blur_px.map(|blur_px| blur_px / side);
        Self { blur_px, ..self }
    }

    /// The curvatures for each contrast that it leaves open.
    pub(super) fn range(&self) -> [f64; 2] {
        self.display.map_or(CURVATURES, DisplayKind::range)
    }
}
