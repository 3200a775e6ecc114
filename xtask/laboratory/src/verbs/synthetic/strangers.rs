//! Outlines that are no view of a model.

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use fluoropose::image::border::follow_border;
use fluoropose::image::contour::{Contour, Outline, Point};
use fluoropose::image::mask::{Mask, MaskMut};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::files::MaskBuffer;

/// Corners that a border may have.
const CORNERS: usize = 1 << 15;

/// An ellipse of a silhouette's area and place, 1.05 to 2.5 times as long as wide.
pub(super) fn ellipse(like: &Mask<'_>, random: &mut ChaCha8Rng) -> Result<MaskBuffer> {
    let ratio = random.random_range(1.05..2.5f64).sqrt();
    let turn = random.random_range(0.0..TAU);
    round(like, |angle| {
        let (sin, cos) = libm::sincos(angle - turn);
        1.0 / (cos / ratio).hypot(sin * ratio)
    })
}

/// A round shape whose radius swings in the first few waves.
pub(super) fn blob(like: &Mask<'_>, random: &mut ChaCha8Rng) -> Result<MaskBuffer> {
    let waves: Vec<[f64; 2]> = (0..6)
        .map(|_| {
            [
                random.random_range(0.0..0.12),
                random.random_range(0.0..TAU),
            ]
        })
        .collect();
    round(like, |angle| {
        let swing = waves.iter().zip(2..);
        1.0 + swing
            .map(|([size, phase], count)| size * libm::sin(f64::from(count) * angle + phase))
            .sum::<f64>()
    })
}

/// A shape of the silhouette's place and area by its radius over the angle.
fn round(like: &Mask<'_>, radius: impl Fn(f64) -> f64) -> Result<MaskBuffer> {
    const CORNERS: usize = 720;
    let angles = (0..CORNERS).map(|k| TAU * k as f64 / CORNERS as f64);
    let mean_square = angles.clone().map(|a| radius(a) * radius(a)).sum::<f64>() / CORNERS as f64;
    let size = (like.area() as f64 / (TAU / 2.0 * mean_square)).sqrt();
    let centre = like.moments().centroid();
    let points = angles.map(|angle| {
        let (sin, cos) = libm::sincos(angle);
        let r = size * radius(angle);
        Point::new(centre.column + r * cos, centre.row + r * sin)
    });
    filled(&points.collect::<Vec<_>>(), like)
}

/// The convex hull of a silhouette.
pub(super) fn hull(like: &Mask<'_>) -> Result<MaskBuffer> {
    let mut border = Box::<Contour<CORNERS>>::default();
    follow_border(like, border.as_mut())?;
    let mut points: Vec<Point> = border.to_vec();
    points.sort_by(|a, b| {
        (a.column, a.row)
            .partial_cmp(&(b.column, b.row))
            .expect("finite")
    });
    // Both chains of Andrew, Inform. Process. Lett. 9, 1979.
    let chain = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for point in points {
            while let [.., a, b] = chain.as_slice() {
                let (dx, dy) = (b.column - a.column, b.row - a.row);
                if dx * (point.row - a.row) - dy * (point.column - a.column) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut around = chain(&mut points.iter().copied());
    around.extend(chain(&mut points.iter().rev().copied()));
    filled(&around, like)
}

/// A silhouette of which a fifth of the area is cut off along a straight line.
pub(super) fn cut(like: &Mask<'_>, random: &mut ChaCha8Rng) -> Result<MaskBuffer> {
    const PART: f64 = 0.2;
    let (sin, cos) = libm::sincos(random.random_range(0.0..TAU));
    let along = |column: usize, row: usize| column as f64 * cos + row as f64 * sin;
    let all = (0..like.height())
        .flat_map(|row| (0..like.width()).map(move |column| (column, row)))
        .filter(|&(column, row)| like.get(column, row));
    let mut places: Vec<f64> = all.map(|(column, row)| along(column, row)).collect();
    let count = (PART * places.len() as f64) as usize;
    let (_, &mut limit, _) = places.select_nth_unstable_by(count, f64::total_cmp);
    let mut kept = MaskBuffer::new(like.width(), like.height())?;
    kept.draw(|mask| {
        for row in 0..mask.height() {
            for column in 0..mask.width() {
                let stays = like.get(column, row) && along(column, row) >= limit;
                mask.set(column, row, stays);
            }
        }
    });
    kept.drop_specks()?;
    Ok(kept)
}

fn filled(points: &[Point], like: &Mask<'_>) -> Result<MaskBuffer> {
    let (width, height) = (like.width(), like.height());
    let outline = Outline::new(points, width, height).context("a made outline")?;
    let mut filled = MaskBuffer::new(width, height)?;
    filled.draw(|mask: &mut MaskMut<'_>| mask.fill_outline(&outline));
    Ok(filled)
}
