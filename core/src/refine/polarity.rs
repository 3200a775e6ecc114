//! Whether metal is darker or brighter than what surrounds it, told by a frame itself.

use heapless::Vec;

use super::error::RefineError;
use super::memory::RefineMemory;
use super::samples::outline_samples;
use super::view::Polarity;
use crate::camera::Camera;
use crate::image::grey::Grey;
use crate::image::mask::Mask;
use crate::mesh::Model;
use crate::pose::Pose;

/// So far from the outline a pixel is surely inside or outside of an implant, px.
const ASIDE: f64 = 5.0;

/// Readings along a side of an area.
const READINGS: usize = 24;

/// Surroundings reach so many times as far as an area, and round a place so far, in parts of the frame's shorter side:
/// farther than an implant, nearer than most of a diaphragm.
const WIDER: f64 = 2.0;
const AROUND: f64 = 1.0 / 6.0;

/// A place itself is so wide, px: wider than noise, narrower than metal.
const PLACE: f64 = 2.0;

/// This part of an area that encloses an implant is metal, at least.
const METAL: f64 = 0.1;

/// The polarity of a frame in which a component has this pose: whether most of its outline is darker inside than outside.
///
/// # Errors
/// Where the model cannot be drawn at the pose.
pub fn polarity_at(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    frame: &dyn Grey,
    memory: &mut RefineMemory<'_>,
) -> Result<Polarity, RefineError> {
    let mut darker_inside = 0.0;
    outline_samples(model, camera, pose, memory, |sample| {
        let [right, down] = sample.normal;
        let grey = |away: f64| frame.at(sample.column + away * right, sample.row + away * down);
        if let (Some(inside), Some(outside)) = (grey(-ASIDE), grey(ASIDE)) {
            let side =
                f64::from(u8::from(outside > inside)) - f64::from(u8::from(outside < inside));
            darker_inside += sample.length * side;
        }
    })?;
    Ok(Polarity::of(darker_inside < 0.0))
}

/// The polarity of a frame in which an implant has this silhouette: whether most of its border is darker inside than outside. Where the
/// silhouette is too thin to tell, what lies in its bounds does ([`polarity_inside`]).
#[must_use]
pub fn polarity_across(frame: &dyn Grey, silhouette: &Mask<'_>) -> Polarity {
    let (columns, rows) = silhouette.bounds();
    let mut darker_inside = 0i64;
    let mut look = |inside: [f64; 2], outside: [f64; 2]| {
        let holds = |[column, row]: [f64; 2]| {
            column >= 0.0 && row >= 0.0 && silhouette.get(column as usize, row as usize)
        };
        if !holds(inside) || holds(outside) {
            return;
        }
        let [inside, outside] = [inside, outside].map(|[column, row]| frame.at(column, row));
        if let (Some(inside), Some(outside)) = (inside, outside) {
            darker_inside += i64::from(outside > inside) - i64::from(outside < inside);
        }
    };
    for row in rows.start..=rows.end {
        for column in columns.start..=columns.end {
            let here = silhouette.get(column, row);
            let [x, y] = [column, row].map(|at| at as f64);
            // Across the border to the left of the pixel, and across that above it.
            if here != (column > 0 && silhouette.get(column - 1, row)) {
                let sides = [[x + ASIDE, y + 0.5], [x - ASIDE, y + 0.5]];
                look(sides[usize::from(!here)], sides[usize::from(here)]);
            }
            if here != (row > 0 && silhouette.get(column, row - 1)) {
                let sides = [[x + 0.5, y + ASIDE], [x + 0.5, y - ASIDE]];
                look(sides[usize::from(!here)], sides[usize::from(here)]);
            }
        }
    }
    match darker_inside {
        0 => polarity_inside(
            frame,
            [columns.start, rows.start, columns.end, rows.end].map(|at| at as f64),
        ),
        votes => Polarity::of(votes < 0),
    }
}

/// The polarity of a frame with metal at this place (column, row, pixels): whether it is darker there than in most of what
/// surrounds it.
#[must_use]
pub fn polarity_near(frame: &dyn Grey, [column, row]: [f64; 2]) -> Polarity {
    let (width, height) = frame.size();
    let reach = AROUND * width.min(height) as f64;
    let round = |reach: f64| [column - reach, row - reach, column + reach, row + reach];
    let (around, there) = (sorted(frame, round(reach)), sorted(frame, round(PLACE)));
    Polarity::of(rank(&there, 0.5) > rank(&around, 0.5))
}

/// The polarity of a frame with an implant in this area (left, top, right, bottom, pixels): whether the darkest or the
/// brightest of it is farther from what surrounds it.
#[must_use]
pub fn polarity_inside(frame: &dyn Grey, area: [f64; 4]) -> Polarity {
    let [left, top, right, bottom] = area;
    let (wide, high) = (0.5 * WIDER * (right - left), 0.5 * WIDER * (bottom - top));
    let (column, row) = (0.5 * (left + right), 0.5 * (top + bottom));
    let around = sorted(
        frame,
        [column - wide, row - high, column + wide, row + high],
    );
    let inside = sorted(frame, area);
    let usual = rank(&around, 0.5);
    Polarity::of(rank(&inside, 1.0 - METAL) - usual > usual - rank(&inside, METAL))
}

/// Grey values of an area, as far as it lies in the frame, by rising value.
fn sorted(
    frame: &dyn Grey,
    [left, top, right, bottom]: [f64; 4],
) -> Vec<f64, { READINGS * READINGS }> {
    let step = |k: usize| (k as f64 + 0.5) / READINGS as f64;
    let places = (0..READINGS * READINGS).map(|k| {
        let (column, row) = (step(k % READINGS), step(k / READINGS));
        frame.at(left + column * (right - left), top + row * (bottom - top))
    });
    let mut values: Vec<f64, _> = places.flatten().collect();
    values.sort_unstable_by(f64::total_cmp);
    values
}

/// The value below which this part of sorted values lies; 0 of none.
fn rank(sorted: &[f64], part: f64) -> f64 {
    let place = part * sorted.len() as f64;
    let last = sorted.len().saturating_sub(1);
    sorted
        .get((place as usize).min(last))
        .copied()
        .unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::frame::Frame;

    const SIDE: usize = 120;

    /// A ramp with metal in the middle, a black frame round it (a diaphragm), and noise.
    fn pixels(metal: u8, inverted: bool) -> std::vec::Vec<u8> {
        let pixel = |k: usize| {
            let (column, row) = (k % SIDE, k / SIDE);
            let noise = (k * 7919 % 13) as u8;
            let (dx, dy) = (column.abs_diff(60), row.abs_diff(60));
            let value = if dx < 9 && dy < 12 && !(dx < 3 && dy > 4) {
                metal + noise
            } else if dx * dx + dy * dy > 55 * 55 {
                0
            } else {
                120 + (column / 2) as u8 + noise
            };
            if inverted { 255 - value } else { value }
        };
        (0..SIDE * SIDE).map(pixel).collect()
    }

    #[test]
    fn metal_tells_the_polarity_of_a_frame_and_of_its_negative() {
        for (metal, inverted) in [(0, false), (60, false), (0, true), (60, true)] {
            let pixels = pixels(metal, inverted);
            let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
            let wanted = Polarity::of(inverted);
            for place in [[55.0, 55.0], [54.0, 50.0], [66.0, 69.0]] {
                assert_eq!(polarity_near(&frame, place), wanted, "{metal} {place:?}");
            }
            for area in [[50.0, 46.0, 70.0, 74.0], [46.0, 40.0, 80.0, 78.0]] {
                assert_eq!(polarity_inside(&frame, area), wanted, "{metal} {area:?}");
            }
        }
    }

    /// What surrounds an area that is nearly all metal is farther out.
    #[test]
    fn an_area_that_metal_fills_is_compared_with_what_surrounds_it() {
        for (metal, around) in [(60, 150), (150, 60)] {
            let pixel = |k: usize| {
                let (column, row) = (k % SIDE, k / SIDE);
                let is_metal = (30..70).contains(&column) && (50..70).contains(&row);
                if is_metal { metal } else { around }
            };
            let pixels: std::vec::Vec<u8> = (0..SIDE * SIDE).map(pixel).collect();
            let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
            for area in [
                [30.0, 50.0, 70.0, 70.0],
                [28.0, 49.0, 72.0, 71.0],
                [30.0, 48.0, 74.0, 70.0],
            ] {
                assert_eq!(
                    polarity_inside(&frame, area),
                    Polarity::of(metal > around),
                    "{metal} {area:?}"
                );
            }
        }
    }

    /// The part fills most of a bright field in one frame and is brighter than a dark one in the other.
    #[cfg(feature = "alloc")]
    #[test]
    fn an_outline_tells_the_polarity_by_what_lies_along_it() {
        use crate::mesh::edges::fake::add_box;
        use crate::refine::RefineBuffers;
        let (mut vertices, mut triangles) = (std::vec::Vec::new(), std::vec::Vec::new());
        let (low, high) = ([-9.0, -12.0, -5.0], [9.0, 12.0, 5.0]);
        add_box(low, high, &mut vertices, &mut triangles);
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        let camera = Camera::new(SIDE, SIDE, [500.0; 2], [60.0; 2]).expect("valid");
        let pose = Pose {
            translation: [0.0, 0.0, -300.0],
            ..Pose::IDENTITY
        };
        for (metal, around) in [(60, 150), (150, 60)] {
            let pixel = |k: usize| {
                let (dx, dy) = ((k % SIDE).abs_diff(60), (k / SIDE).abs_diff(60));
                if dx < 15 && dy < 20 { metal } else { around }
            };
            let pixels: std::vec::Vec<u8> = (0..SIDE * SIDE).map(pixel).collect();
            let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
            let mut buffers = RefineBuffers::default();
            let memory = &mut buffers.borrow(&model, &camera);
            let found = polarity_at(&model, &camera, &pose, &frame, memory).expect("drawn");
            assert_eq!(found, Polarity::of(metal > around), "{metal}");
        }
    }

    /// Bright metal in a round field with a white surround near it.
    #[test]
    fn a_silhouette_tells_the_polarity_whatever_lies_farther_off() {
        use crate::image::mask::{MaskMut, words_needed};
        let is_metal =
            |column: usize, row: usize| (56..76).contains(&column) && (40..80).contains(&row);
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        (40..80).for_each(|row| mask.fill_span(row, 56, 76));
        let mask = mask.into_mask();
        for (metal, tissue, surround) in
            [(130, 90, 255), (90, 130, 0), (0, 40, 30), (255, 190, 255)]
        {
            let pixel = |k: usize| {
                let (column, row) = (k % SIDE, k / SIDE);
                let (dx, dy) = (column.abs_diff(50), row.abs_diff(60));
                match () {
                    () if is_metal(column, row) => metal,
                    () if dx * dx + dy * dy > 33 * 33 => surround,
                    () => tissue,
                }
            };
            let pixels: std::vec::Vec<u8> = (0..SIDE * SIDE).map(pixel).collect();
            let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
            let told = polarity_across(&frame, &mask);
            assert_eq!(told, Polarity::of(metal > tissue), "{metal} {tissue}");
        }
        // A line is too thin: what lies round it tells.
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut line = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        line.fill_span(60, 40, 80);
        let line = line.into_mask();
        for (bright, inverted) in [(false, false), (true, true)] {
            let pixels = pixels(60, inverted);
            let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
            assert_eq!(polarity_across(&frame, &line), Polarity::of(bright));
        }
        let nothing = std::vec![0; words_needed(SIDE, SIDE)];
        let nothing = Mask::new(&nothing, SIDE, SIDE).expect("fits");
        let frame = std::vec![9u8; SIDE * SIDE];
        let frame = Frame::new(&frame, SIDE, SIDE, SIDE).expect("fits");
        assert_eq!(polarity_across(&frame, &nothing), Polarity::DarkImplant);
    }

    #[test]
    fn beyond_the_frame_nothing_is_read() {
        let frame = [7u8; 100];
        let frame = Frame::new(&frame, 10, 10, 10).expect("fits");
        assert_eq!(
            polarity_near(&frame, [-50.0, f64::NAN]),
            Polarity::DarkImplant
        );
        assert_eq!(
            polarity_inside(&frame, [30.0, 30.0, 20.0, 20.0]),
            Polarity::DarkImplant
        );
    }
}
