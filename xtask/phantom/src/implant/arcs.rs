//! A plane curve of circular arcs that meet with a common tangent: the J-curve of a femoral component.

use libm::{cos, sin};

/// Arcs joined end to end, parameterised by the direction of the outward normal.
pub(super) struct ArcChain {
    spans: Vec<Span>,
}

struct Span {
    from_rad: f64,
    to_rad: f64,
    radius: f64,
    centre: [f64; 2],
}

impl ArcChain {
    /// Starts on a circle round the origin and appends arcs as `(end of the normal's direction in degrees, radius in mm)`;
    /// the first entry belongs to the circle round the origin. Directions rise.
    pub(super) fn from_origin_arc(start_deg: f64, arcs: &[(f64, f64)]) -> Self {
        let mut spans: Vec<Span> = Vec::with_capacity(arcs.len());
        let mut from_rad = start_deg.to_radians();
        for &(end_deg, radius) in arcs {
            let centre = match spans.last() {
                None => [0.0, 0.0],
                Some(previous) => centre_after(previous, radius),
            };
            let to_rad = end_deg.to_radians();
            spans.push(Span {
                from_rad,
                to_rad,
                radius,
                centre,
            });
            from_rad = to_rad;
        }
        Self { spans }
    }

    /// The point whose outward normal has this direction; both ends are continued.
    pub(super) fn point(&self, normal_rad: f64) -> [f64; 2] {
        let span = self
            .spans
            .iter()
            .find(|span| normal_rad < span.to_rad)
            .or(self.spans.last())
            .expect("a chain has at least one arc");
        [
            span.centre[0] + span.radius * cos(normal_rad),
            span.centre[1] + span.radius * sin(normal_rad),
        ]
    }

    /// The direction of the normal at which a given part of the length between two directions has passed.
    pub(super) fn direction_between(&self, from_rad: f64, to_rad: f64, part: f64) -> f64 {
        let (start, end) = (self.length_to(from_rad), self.length_to(to_rad));
        self.direction_at(start + (end - start) * part)
    }

    fn length_to(&self, normal_rad: f64) -> f64 {
        let first = self.spans[0].from_rad;
        self.spans
            .iter()
            .map(|span| {
                span.radius * (normal_rad.clamp(first, span.to_rad) - span.from_rad).max(0.0)
            })
            .sum()
    }

    fn direction_at(&self, length: f64) -> f64 {
        let mut left = length;
        for span in &self.spans {
            let whole = span.radius * (span.to_rad - span.from_rad);
            if left <= whole {
                return span.from_rad + left / span.radius;
            }
            left -= whole;
        }
        self.spans[self.spans.len() - 1].to_rad
    }
}

/// The centre that makes the next arc touch the end of the previous one.
fn centre_after(previous: &Span, radius: f64) -> [f64; 2] {
    let shift = previous.radius - radius;
    [
        previous.centre[0] + shift * cos(previous.to_rad),
        previous.centre[1] + shift * sin(previous.to_rad),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain() -> ArcChain {
        ArcChain::from_origin_arc(-215.0, &[(-135.0, 21.0), (-70.0, 31.0), (18.0, 40.0)])
    }

    #[test]
    fn arcs_meet_without_a_gap_and_with_one_tangent() {
        for deg in [-135.0_f64, -70.0] {
            let before = chain().point((deg - 1e-7).to_radians());
            let after = chain().point((deg + 1e-7).to_radians());
            assert!((before[0] - after[0]).abs() < 1e-6 && (before[1] - after[1]).abs() < 1e-6);
        }
    }

    #[test]
    fn half_the_length_is_half_the_length() {
        let chain = chain();
        let (from, to) = ((-200.0_f64).to_radians(), 10.0_f64.to_radians());
        let middle = chain.direction_between(from, to, 0.5);
        let first = chain.length_to(middle) - chain.length_to(from);
        let second = chain.length_to(to) - chain.length_to(middle);
        assert!((first - second).abs() < 1e-9);
    }
}
