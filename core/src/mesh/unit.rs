//! Whether a surface has the size of a knee's component, and which unit it has it in.

use super::surface::Bounds;

/// A unit of length that a file may have been written in instead of millimetres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SuspectedUnit {
    /// Metres.
    Metres,
    /// Centimetres or inches: the size alone does not tell these two apart.
    CentimetresOrInches,
}

impl SuspectedUnit {
    /// Millimetres in one of it: of what the size leaves open there are two.
    #[must_use]
    pub const fn mm(self) -> &'static [f64] {
        match self {
            Self::Metres => &[1000.0],
            Self::CentimetresOrInches => &[10.0, 25.4],
        }
    }
}

/// Radii of the sphere round a component of a knee, mm, wide on both sides: trays of children and revision stems.
const RADII_MM: core::ops::Range<f64> = 15.0..250.0;

/// Whether a surface in millimetres has the size of a knee's component.
#[must_use]
pub fn has_knee_size(bounds: &Bounds) -> bool {
    RADII_MM.contains(&bounds.radius)
}

/// The unit that a component's size speaks for; `None` where it is that of a knee's in millimetres, or of none.
#[must_use]
pub fn suspected_unit(bounds: &Bounds) -> Option<SuspectedUnit> {
    if has_knee_size(bounds) {
        return None;
    }
    let is_knee = |&mm: &f64| RADII_MM.contains(&(bounds.radius * mm));
    let units = [SuspectedUnit::Metres, SuspectedUnit::CentimetresOrInches];
    units.into_iter().find(|unit| unit.mm().iter().any(is_knee))
}
