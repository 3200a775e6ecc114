//! What hides a part of an outline.

use std::f64::consts::TAU;

use anyhow::Result;
use fluoropose::image::contour::Point;
use fluoropose::image::mask::Mask;
use rand::{Rng, RngExt};

use super::curve::Curve;
use crate::mask_buffer::MaskBuffer;

/// The shape of an occluder, without its size.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// All that lies on one side of a straight line; the direction away from it.
    HalfPlane([f64; 2]),
    /// A disc about a point.
    Disc(Point),
    /// A band through a point; the direction across it.
    Band(Point, [f64; 2]),
}

/// Something that hides what is behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Occluder {
    shape: Shape,
    /// Half width, radius, or how far a half plane reaches, pixels.
    reach: f64,
    /// Whether what is hidden is traced as a part of the silhouette; else it is left out.
    solid: bool,
}

/// Room about a silhouette within which a solid occluder is traced, as a part of the
/// silhouette's larger side.
const ROOM: f64 = 0.1;

impl Occluder {
    /// A random occluder that hides the part `fraction` of the length of all curves together,
    /// or of what the frame shows of them; `None` where there is nothing to hide.
    ///
    /// Half planes, discs and bands are equally likely. Directions are uniform; discs and bands
    /// are centred on a random place of the outline.
    pub(super) fn draw(
        curves: &[Curve],
        fraction: f64,
        size: [usize; 2],
        random: &mut impl Rng,
    ) -> Option<Self> {
        let [width, height] = size.map(|side| side as f64);
        let inside =
            |p: &Point| (0.0..=width).contains(&p.column) && (0.0..=height).contains(&p.row);
        let places: Vec<(Point, f64)> = curves
            .iter()
            .flat_map(|curve| curve.points.iter().copied().zip(curve.lengths()))
            .filter(|(point, _)| inside(point))
            .collect();
        let kind = random.random_range(0..3);
        let (sine, cosine) = libm::sincos(random.random_range(0.0..TAU));
        let share = random.random_range(0.0..1.0);
        let solid = random.random_range(0..2) == 1;
        let (centre, _) = places.get((share * places.len() as f64) as usize)?;
        let shape = match kind {
            0 => Shape::HalfPlane([cosine, sine]),
            1 => Shape::Disc(*centre),
            _ => Shape::Band(*centre, [cosine, sine]),
        };
        let reach = shape.reach(&places, fraction);
        Some(Self {
            shape,
            reach,
            solid,
        })
    }

    /// Whether a point is hidden.
    pub(super) fn hides(&self, point: Point) -> bool {
        self.shape.distance(point) <= self.reach
    }

    /// The pixels whose centres are hidden.
    ///
    /// # Errors
    /// For a shape that no mask has.
    pub(super) fn hidden(&self, width: usize, height: usize) -> Result<MaskBuffer> {
        let mut hidden = MaskBuffer::new(width, height)?;
        hidden.draw(|mask| {
            for row in 0..height {
                for column in 0..width {
                    let centre = Point::new(column as f64 + 0.5, row as f64 + 0.5);
                    mask.set(column, row, self.hides(centre));
                }
            }
        });
        Ok(hidden)
    }

    /// A mask as it is traced with the occluder before it. A solid one is traced as a part of the
    /// silhouette as far as a tenth of the silhouette's size beyond it: nobody traces to the
    /// frame's border.
    ///
    /// # Errors
    /// Where `mask` and `hidden` differ in size.
    pub(super) fn before(&self, mask: &Mask<'_>, hidden: &MaskBuffer) -> Result<MaskBuffer> {
        let mask_copy = MaskBuffer::copy_of(mask);
        if !self.solid {
            return mask_copy.combined(hidden, |mask, hidden| mask & !hidden);
        }
        let (columns, rows) = mask.bounds();
        let room = (ROOM * columns.len().max(rows.len()) as f64) as usize;
        let mut near = MaskBuffer::new(mask.width(), mask.height())?;
        let pixels = hidden.mask();
        near.draw(|near| {
            for row in rows.start.saturating_sub(room)..rows.end + room {
                for column in columns.start.saturating_sub(room)..columns.end + room {
                    near.set(column, row, pixels.get(column, row));
                }
            }
        });
        mask_copy.combined(&near, |mask, near| mask | near)
    }
}

impl Shape {
    /// What an occluder of this shape must reach to hide a point, pixels.
    fn distance(&self, point: Point) -> f64 {
        let across = |direction: [f64; 2], from: Point| {
            direction[0] * (point.column - from.column) + direction[1] * (point.row - from.row)
        };
        match *self {
            Self::HalfPlane(direction) => across(direction, Point::default()),
            Self::Disc(centre) => libm::hypot(point.column - centre.column, point.row - centre.row),
            Self::Band(centre, direction) => across(direction, centre).abs(),
        }
    }

    /// How far it must reach to hide a part of an outline given by places and lengths.
    fn reach(&self, places: &[(Point, f64)], fraction: f64) -> f64 {
        let mut order: Vec<(f64, f64)> = places
            .iter()
            .map(|&(point, length)| (self.distance(point), length))
            .collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let wanted = fraction * order.iter().map(|(_, length)| length).sum::<f64>();
        let mut sum = 0.0;
        order
            .iter()
            .find(|(_, length)| {
                sum += length;
                sum >= wanted
            })
            .or(order.last())
            .map_or(0.0, |(distance, _)| *distance)
    }
}
