//! Where a line cuts a triangle.

use super::course::POINTS;

/// The corners of a triangle as a line sees them: how far beside it, and how far along it from its first place; in places. They lie on
/// both sides.
pub(super) struct Seen {
    pub(super) across: [f32; 3],
    pub(super) along: [f32; 3],
}

/// Where a line cuts an edge of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Cut {
    /// How far along the line, in places.
    pub(super) along: f32,
    /// The corners on this side of the line and beyond, in this order whichever of its triangles asks.
    near: usize,
    far: usize,
    /// Which part of the way from the first to the second.
    part: f32,
}

impl Seen {
    /// Both cuts, the nearer first. The line cuts both edges of the corner that is alone on its side.
    #[inline(always)]
    pub(super) fn cuts(&self) -> [Cut; 2] {
        let [a, b, c] = self.across.map(|across| across > 0.0);
        let alone = if b == c { 0 } else { 1 + usize::from(a == b) };
        let cuts = [(alone + 1) % 3, (alone + 2) % 3].map(|other| Cut::between(alone, other, self));
        match cuts[0].along > cuts[1].along {
            true => [cuts[1], cuts[0]],
            false => cuts,
        }
    }
}

impl Cut {
    /// Between a corner and one on the other side of the line.
    #[inline(always)]
    fn between(one: usize, other: usize, Seen { across, along }: &Seen) -> Self {
        let (near, far) = match across[one] > 0.0 {
            true => (other, one),
            false => (one, other),
        };
        let part = across[near] / (across[near] - across[far]);
        let along = between(along[near], along[far], part);
        Self {
            along,
            near,
            far,
            part,
        }
    }

    /// Between the values of its ends.
    #[inline(always)]
    pub(super) fn of(&self, values: &[f32; 3]) -> f32 {
        between(values[self.near], values[self.far], self.part)
    }

    /// Number of the first place that is not before it, but none before `first`; [`POINTS`] where none is.
    #[inline(always)]
    pub(super) fn first_place(&self, first: u16) -> usize {
        // Beside this number there are whole ones alone.
        const WHOLE: f32 = 8_388_608.0;
        // To round up: what lies less than a ten-thousandth of a place behind one counts as there, for both triangles of an edge.
        const UP: f32 = 0.4999;
        let place = self.along.max(f32::from(first)).min(POINTS as f32);
        ((place + UP + WHOLE).to_bits() - WHOLE.to_bits()) as usize
    }
}

fn between(near: f32, far: f32, part: f32) -> f32 {
    near + part * (far - near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_place_is_the_next_whole_number_between_the_ends() {
        let place = |along: f32, first: u16| {
            let cut = Cut {
                along,
                near: 0,
                far: 1,
                part: 0.5,
            };
            cut.first_place(first)
        };
        for first in [0, 19, 20] {
            for k in 0..=POINTS {
                let [on, behind] = [0.0, 0.001].map(|more| place(k as f32 + more, first));
                let least = usize::from(first);
                assert_eq!([on, behind], [k, k + 1].map(|k| k.clamp(least, POINTS)));
            }
            assert_eq!(place(-1e6, first), usize::from(first));
            assert_eq!(place(1e6, first), POINTS);
        }
    }
}
