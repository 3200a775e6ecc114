//! A frame as large as it has to be to find something in it, and no larger.
//!
//! What a search costs grows with the pixels of what is sought, and what it asks for is in pixels: where a component is many of them, the frame
//! is read from farther away. So a film that was scanned twice as finely is searched in the same steps, for the same price.

use fluoropose::camera::Camera;
use fluoropose::image::contour::Point;
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::image::shuttered::Shuttered;
use fluoropose::memory::{TooLittleMemory, first};
use fluoropose::refine::ImageTarget;

/// Square root of the area that a component has in a frame that was reduced, pixels: an outline of some 330. The frame itself makes a pose
/// exact; noise and blur that hide the right pose in finer pixels are averaged here.
const SIZE: f64 = 75.0;
/// Frames are not reduced by less: it saves little, and softens what is sharp.
const LEAST: f64 = 1.5;
/// A pixel that stands for many is the mean of readings at these parts of its side to either side of its middle.
const ASIDE: [[f64; 2]; 4] = [[-0.25, -0.25], [0.25, -0.25], [-0.25, 0.25], [0.25, 0.25]];

/// Lengths of a [`ReducedMemory`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReducedNeeds {
    /// Of `pixels`.
    pub pixels: usize,
    /// Of `unknown`.
    pub words: usize,
}

/// Lengths of the memory for frames of a camera, whatever is sought in them.
#[must_use]
pub fn reduced_needed(camera: &Camera) -> ReducedNeeds {
    let [width, height] = sides(camera, LEAST);
    ReducedNeeds {
        pixels: width * height,
        words: words_needed(width, height),
    }
}

/// Memory for a reduced frame.
#[derive(Debug)]
pub struct ReducedMemory<'m> {
    /// Its grey values.
    pub pixels: &'m mut [u16],
    /// A mask of those that are not known.
    pub unknown: &'m mut [Word],
}

/// A reduced frame as it was written into a [`ReducedMemory`].
#[derive(Clone, Copy, Debug)]
pub struct ReducedPixels<'m> {
    /// Its grey values.
    pub pixels: &'m [u16],
    /// A mask of those that are not known.
    pub unknown: &'m [Word],
}

/// By how much a frame is reduced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reduction {
    /// Side of a reduced frame's pixel, pixels: 1 where it is not reduced.
    times: f64,
    camera: Camera,
}

impl Reduction {
    /// Of a camera's frames in which the square root of a component's area is `size_px`.
    pub(crate) fn of(size_px: f64, camera: &Camera) -> Self {
        let none = Self {
            times: 1.0,
            camera: *camera,
        };
        let times = size_px / SIZE;
        // A NaN is none either.
        if !(LEAST..f64::INFINITY).contains(&times) {
            return none;
        }
        let [width, height] = sides(camera, times);
        let (focal, point) = (camera.focal(), camera.principal_point());
        let reduced = Camera::new(
            width,
            height,
            focal.map(|at| at / times),
            point.map(|at| at / times),
        );
        reduced.map_or(none, |camera| Self { times, camera })
    }

    /// Whether there is any.
    pub(crate) fn is_any(&self) -> bool {
        self.times > 1.0
    }

    /// The camera of reduced frames.
    pub(crate) fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Where a place of a frame is in the reduced one.
    pub(crate) fn reduced(&self, at: Point) -> Point {
        Point::new(at.column / self.times, at.row / self.times)
    }

    /// Writes a frame, reduced. A pixel is not known where any of what it stands for is not.
    ///
    /// # Errors
    /// [`TooLittleMemory`] where there is less than [`reduced_needed`].
    pub(crate) fn write(
        &self,
        image: &ImageTarget<'_>,
        memory: &mut ReducedMemory<'_>,
    ) -> Result<(), TooLittleMemory> {
        let (width, height) = (self.camera.width(), self.camera.height());
        let words = words_needed(width, height);
        let pixels = first("pixels", width * height, memory.pixels)?;
        let unknown = first("words", words, memory.unknown)?;
        unknown.fill(0);
        let places = || (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        let read = |(column, row)| self.mean(image, column, row);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in places().filter_map(read) {
            (low, high) = (value.min(low), value.max(high));
        }
        // All of a frame's range, so that little is lost: nothing that is asked of a frame depends on units.
        let unit = f64::from(u16::MAX) / (high - low).max(f64::MIN_POSITIVE);
        let mut unknown = MaskMut::new(unknown, width, height).ok();
        for (place, pixel) in places().zip(pixels) {
            *pixel = match (read(place), &mut unknown) {
                (Some(value), _) => ((value - low) * unit + 0.5) as u16,
                (None, Some(unknown)) => {
                    unknown.set(place.0, place.1, true);
                    0
                }
                (None, None) => 0,
            };
        }
        Ok(())
    }

    /// The frame that was written last.
    ///
    /// # Errors
    /// [`TooLittleMemory`] where it was not.
    pub(crate) fn frame<'m>(
        &self,
        written: ReducedPixels<'m>,
    ) -> Result<Shuttered<Frame<'m, u16>, &'m [Word]>, TooLittleMemory> {
        let (width, height) = (self.camera.width(), self.camera.height());
        let needs = (width * height, words_needed(width, height));
        let lack = |what, needed, given| TooLittleMemory {
            what,
            needed,
            given,
        };
        let frame = Frame::new(written.pixels, width, height, width);
        let frame = frame.map_err(|_| lack("pixels", needs.0, written.pixels.len()))?;
        let unknown = written.unknown.get(..needs.1).unwrap_or_default();
        Shuttered::new(frame, unknown).map_err(|_| lack("words", needs.1, written.unknown.len()))
    }

    /// The mean grey value of what a pixel stands for; `None` where some of it is not known.
    fn mean(&self, image: &ImageTarget<'_>, column: usize, row: usize) -> Option<f64> {
        let (width, height) = image.frame.size();
        let at = |cell: usize, aside: f64, side: usize| {
            let at = self.times * (cell as f64 + 0.5 + aside);
            at.clamp(0.5, side as f64 - 0.5)
        };
        let mut sum = 0.0;
        for [right, down] in ASIDE {
            let (column, row) = (at(column, right, width), at(row, down, height));
            let is_in = |mask: &Mask<'_>| mask.get(column as usize, row as usize);
            if image.unknown.is_some_and(is_in) {
                return None;
            }
            sum += image.frame.at(column, row)?;
        }
        Some(sum / ASIDE.len() as f64)
    }
}

/// Columns and rows of a camera's frames reduced so many times.
fn sides(camera: &Camera, times: f64) -> [usize; 2] {
    [camera.width(), camera.height()].map(|side| (side as f64 / times) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::grey::Grey;
    use fluoropose::refine::Polarity;

    const SIDE: usize = 448;

    fn camera() -> Camera {
        Camera::new(SIDE, SIDE, [2000.0, 2100.0], [200.0, 260.0]).expect("valid")
    }

    #[test]
    fn small_things_stay_as_they_are_and_large_ones_become_alike() {
        for size in [50.0, SIZE, 1.49 * SIZE, f64::NAN] {
            let reduction = Reduction::of(size, &camera());
            assert!(!reduction.is_any(), "{size}");
            assert_eq!(*reduction.camera(), camera());
        }
        let reduction = Reduction::of(4.0 * SIZE, &camera());
        assert_eq!(reduction.times, 4.0);
        assert!(reduction.is_any());
        let reduced = reduction.camera();
        assert_eq!([reduced.width(), reduced.height()], [SIDE / 4; 2]);
        let at = [3.0, -2.0, -900.0];
        let project = |camera: &Camera| camera.project(&at).expect("before the camera");
        let [there, here] = [project(reduced), reduction.reduced(project(&camera()))];
        assert!((there.column - here.column).abs() < 1e-9 && (there.row - here.row).abs() < 1e-9);
    }

    #[test]
    fn a_reduced_pixel_is_the_mean_of_those_that_it_stands_for() {
        let pixels: std::vec::Vec<u16> = (0..SIDE * SIDE)
            .map(|k| 40 + (k * k * 31 % 977) as u16)
            .collect();
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut unknown = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        (40..44).for_each(|row| unknown.fill_span(row, 80, 84));
        let unknown = unknown.into_mask();
        let image = ImageTarget {
            frame: &frame,
            unknown: Some(&unknown),
            polarity: Polarity::DarkImplant,
            film: None,
        };
        let needs = reduced_needed(&camera());
        let mut room = (std::vec![7; needs.pixels], std::vec![7; needs.words]);
        let reduction = Reduction::of(4.0 * SIZE, &camera());
        let mut memory = ReducedMemory {
            pixels: &mut room.0,
            unknown: &mut room.1,
        };
        reduction.write(&image, &mut memory).expect("enough memory");
        let short = ReducedMemory {
            pixels: &mut [],
            ..memory
        };
        assert!(reduction.write(&image, &mut { short }).is_err());
        let written = ReducedPixels {
            pixels: &room.0,
            unknown: &room.1,
        };
        let reduced = reduction.frame(written).expect("it was written");
        let side = SIDE / 4;
        assert_eq!(reduced.size(), (side, side));
        let mean = |column: usize, row: usize| {
            let of = (0..16).map(|k| pixels[(4 * row + k / 4) * SIDE + 4 * column + k % 4]);
            of.map(f64::from).sum::<f64>() / 16.0
        };
        let at = |column: usize, row: usize| {
            let at = reduced.at(column as f64 + 0.5, row as f64 + 0.5);
            at.expect("known")
        };
        // Offset and unit are the same for all.
        let [one, other] = [(0, 0), (5, 9)];
        let unit = (at(5, 9) - at(0, 0)) / (mean(5, 9) - mean(0, 0));
        assert!(unit.abs() > 1.0, "{one:?} {other:?}");
        for (column, row) in [(7, 3), (side - 1, side - 1), (21, 10)] {
            let expected = at(0, 0) + unit * (mean(column, row) - mean(0, 0));
            assert!((at(column, row) - expected).abs() < 0.02 * unit.abs());
        }
        assert_eq!(reduced.at(20.5, 10.5), None, "unknown");
        let nothing = ReducedPixels {
            pixels: &[],
            unknown: &[],
        };
        let lack = reduction.frame(nothing).err();
        assert_eq!(lack.map(|lack| lack.needed), Some(side * side));
    }

    #[test]
    fn a_frame_has_all_of_the_range_and_needs_no_more_memory_than_is_said() {
        let pixels: std::vec::Vec<u16> = (0..SIDE * SIDE)
            .map(|k| 100 + (k % SIDE / 8) as u16)
            .collect();
        let image = ImageTarget {
            frame: &Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits"),
            unknown: None,
            polarity: Polarity::DarkImplant,
            film: None,
        };
        let reduction = Reduction::of(4.0 * SIZE, &camera());
        let (side, words) = (SIDE / 4, words_needed(SIDE / 4, SIDE / 4));
        let mut room = (std::vec![7; side * side], std::vec![7; words]);
        let mut memory = ReducedMemory {
            pixels: &mut room.0,
            unknown: &mut room.1,
        };
        reduction.write(&image, &mut memory).expect("enough memory");
        let ends = (room.0.iter().min(), room.0.iter().max());
        assert_eq!(ends, (Some(&0), Some(&u16::MAX)));
        assert!(room.1.iter().all(|&word| word == 0));
        // A pixel at the border, of which a part reaches beyond the middles of the frame's own, is known too.
        for times in [1.5, 1.6, 2.3, 3.1] {
            let reduction = Reduction::of(times * SIZE, &camera());
            let needs = reduced_needed(&camera());
            let mut room = (std::vec![7; needs.pixels], std::vec![7; needs.words]);
            let mut memory = ReducedMemory {
                pixels: &mut room.0,
                unknown: &mut room.1,
            };
            reduction.write(&image, &mut memory).expect("enough memory");
            let [width, height] = sides(&camera(), times);
            let unknown = &room.1[..words_needed(width, height)];
            assert!(unknown.iter().all(|&word| word == 0), "{times}");
        }
        let written = |pixels, words| {
            let written = ReducedPixels {
                pixels: &room.0[..pixels],
                unknown: &room.1[..words],
            };
            reduction.frame(written).is_ok()
        };
        assert!(written(side * side, words));
        assert!(!written(side * side - 1, words) && !written(side * side, words - 1));
    }
}
