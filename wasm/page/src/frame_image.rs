//! Frames held and painted with window and level.

use std::rc::Rc;

use fluoropose::image::frame::{Frame, Pixel};
use fluoropose::image::grey::Grey;
use fluoropose::image::shuttered::Shuttered;
use fluoropose_tracing::smoothed::{Scale, Smoothed};
use js_sys::{Uint8Array, Uint16Array};
use wasm_bindgen::prelude::*;
use web_sys::CanvasRenderingContext2d;

use crate::covered::Covered;
use crate::error::sentence;
use crate::paint::{Rgba, put};
use crate::preprocessing;

/// One frame's pixels.
#[wasm_bindgen]
pub struct FrameImage {
    /// Of all that look at this film: nobody changes them.
    pixels: Rc<Pixels>,
    /// Of them are not of the picture.
    covered: Covered,
    width: usize,
    height: usize,
    /// The picture that was last shown instead of the film itself.
    derived: Option<(Derived, Vec<u8>)>,
}

/// A picture made from a frame.
#[wasm_bindgen]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derived {
    /// Strength of edges.
    Edges,
    /// Contrast equalised region by region.
    Equalised,
}

/// Grey values as they came.
pub enum Pixels {
    /// Of 8 bits.
    Eight(Vec<u8>),
    /// Of 9 to 16 bits.
    Sixteen(Vec<u16>),
}

/// The share of pixels that a suggested window leaves out at either end.
const CLIPPED: f64 = 0.005;

#[wasm_bindgen]
impl FrameImage {
    /// Takes 8-bit pixels, row by row.
    ///
    /// # Errors
    /// The core's sentence when the shape does not fit the pixels.
    #[wasm_bindgen(js_name = fromEightBit)]
    pub fn from_eight_bit(pixels: Vec<u8>, width: u32, height: u32) -> Result<FrameImage, JsError> {
        check(&pixels, width, height)?;
        Ok(Self {
            pixels: Rc::new(Pixels::Eight(pixels)),
            covered: Covered::default(),
            width: width as usize,
            height: height as usize,
            derived: None,
        })
    }

    /// Takes 16-bit pixels, row by row.
    ///
    /// # Errors
    /// The core's sentence when the shape does not fit the pixels.
    #[wasm_bindgen(js_name = fromSixteenBit)]
    pub fn from_sixteen_bit(
        pixels: Vec<u16>,
        width: u32,
        height: u32,
    ) -> Result<FrameImage, JsError> {
        check(&pixels, width, height)?;
        Ok(Self {
            pixels: Rc::new(Pixels::Sixteen(pixels)),
            covered: Covered::default(),
            width: width as usize,
            height: height as usize,
            derived: None,
        })
    }

    /// From now on these pixels are not of the picture: nothing is read or shown there. They are numbered row by row, of each run the
    /// first one and the one after its last; the tools for tracing find what their values are, which should be as beside them.
    ///
    /// # Errors
    /// A sentence where they are no runs of the frame's pixels.
    pub fn cover(&mut self, ends: Vec<u32>) -> Result<(), JsError> {
        let covered = Covered::new(ends, self.width * self.height);
        self.covered =
            covered.ok_or_else(|| JsError::new("what is covered is not of this frame"))?;
        Ok(())
    }

    /// The pixels that are not of the picture, as [`Self::cover`] takes them.
    #[wasm_bindgen(getter)]
    pub fn covered(&self) -> Vec<u32> {
        self.covered.ends().to_vec()
    }

    /// Least and greatest grey value, then the centre and width of a window that leaves out half a percent at either end.
    #[wasm_bindgen(js_name = greyRange)]
    pub fn grey_range(&self) -> Vec<f64> {
        match self.pixels() {
            Pixels::Eight(pixels) => grey_range(pixels, &self.covered),
            Pixels::Sixteen(pixels) => grey_range(pixels, &self.covered),
        }
    }

    /// Paints the frame at the canvas's upper left corner, one canvas pixel a pixel. Grey values up to
    /// `centre - width / 2` are black, from `centre + width / 2` white.
    ///
    /// # Errors
    /// What the canvas throws.
    pub fn paint(
        &self,
        context: &CanvasRenderingContext2d,
        centre: f64,
        width: f64,
    ) -> Result<(), JsValue> {
        self.put(context, &shades(centre, width, self.levels()))
    }

    /// The same with dark and bright exchanged.
    ///
    /// # Errors
    /// What the canvas throws.
    #[wasm_bindgen(js_name = paintInverted)]
    pub fn paint_inverted(
        &self,
        context: &CanvasRenderingContext2d,
        centre: f64,
        width: f64,
    ) -> Result<(), JsValue> {
        let mut shades = shades(centre, width, self.levels());
        for [red, green, blue, _] in &mut shades {
            [*red, *green, *blue] = [!*red, !*green, !*blue];
        }
        self.put(context, &shades)
    }

    /// Paints a picture made from the frame, whose own grey values run from 0 to 255. It is made once and kept until
    /// another one is asked for.
    ///
    /// # Errors
    /// What the canvas throws.
    #[wasm_bindgen(js_name = paintDerived)]
    pub fn paint_derived(
        &mut self,
        context: &CanvasRenderingContext2d,
        look: Derived,
        centre: f64,
        width: f64,
    ) -> Result<(), JsValue> {
        let shades = shades(centre, width, 1 << 8);
        let kept = self.derived.take().filter(|(made, _)| *made == look);
        let (_, picture) = self.derived.insert(kept.unwrap_or_else(|| {
            (
                look,
                Self::derive(&self.pixels, look, self.width, self.height),
            )
        }));
        develop(picture, &self.covered, &shades, self.width, context)
    }

    /// A copy of the pixels, row by row, for another thread: `Uint8Array` of an 8-bit frame, `Uint16Array` of a 16-bit one.
    #[wasm_bindgen(js_name = copyPixels, unchecked_return_type = "Uint8Array | Uint16Array")]
    pub fn copy_pixels(&self) -> JsValue {
        match self.pixels() {
            Pixels::Eight(pixels) => Uint8Array::from(&pixels[..]).into(),
            Pixels::Sixteen(pixels) => Uint16Array::from(&pixels[..]).into(),
        }
    }

    /// The grey value of the pixel at a column and row; nothing outside the picture.
    #[wasm_bindgen(js_name = greyAt)]
    pub fn grey_at(&self, column: u32, row: u32) -> Option<u32> {
        let (column, row) = (column as usize, row as usize);
        if column >= self.width || row >= self.height {
            return None;
        }
        let index = row * self.width + column;
        if self.covered.has(index) {
            return None;
        }
        match self.pixels() {
            Pixels::Eight(pixels) => pixels.get(index).map(|&grey| grey.into()),
            Pixels::Sixteen(pixels) => pixels.get(index).map(|&grey| grey.into()),
        }
    }

    fn levels(&self) -> usize {
        match self.pixels() {
            Pixels::Eight(_) => 1 << 8,
            Pixels::Sixteen(_) => 1 << 16,
        }
    }
}

impl FrameImage {
    /// Row by row.
    pub fn pixels(&self) -> &Pixels {
        &self.pixels
    }

    /// The same pixels, not copied: the page may let go of its film while work on it goes on.
    pub fn shared(&self) -> Self {
        Self {
            pixels: Rc::clone(&self.pixels),
            covered: self.covered.clone(),
            width: self.width,
            height: self.height,
            derived: None,
        }
    }

    /// The frame in squares of `side` x `side` pixels (the core's `Frame::reduce`); a square of which a pixel is covered is.
    ///
    /// # Errors
    /// The core's sentence where no square fits.
    pub fn reduced(&self, side: usize) -> Result<Self, JsError> {
        let whole @ (width, height) = (self.width, self.height);
        let side = side.max(1);
        let size = (width / side, height / side);
        let pixels = match self.pixels() {
            Pixels::Eight(pixels) => Frame::new(pixels, width, height, width)
                .and_then(|frame| frame.reduced(side))
                .map(Pixels::Eight),
            Pixels::Sixteen(pixels) => Frame::new(pixels, width, height, width)
                .and_then(|frame| frame.reduced(side))
                .map(Pixels::Sixteen),
        };
        let pixels = pixels.map_err(sentence)?;
        Ok(Self {
            pixels: Rc::new(pixels),
            covered: self.covered.reduced(whole, size, side),
            width: size.0,
            height: size.1,
            derived: None,
        })
    }

    fn put(&self, context: &CanvasRenderingContext2d, shades: &[Rgba]) -> Result<(), JsValue> {
        let count = self.width * self.height;
        match self.pixels() {
            Pixels::Eight(pixels) => {
                develop(&pixels[..count], &self.covered, shades, self.width, context)
            }
            Pixels::Sixteen(pixels) => {
                develop(&pixels[..count], &self.covered, shades, self.width, context)
            }
        }
    }

    /// Smooths the film into as many cells as it has pixels.
    ///
    /// # Errors
    /// The core's sentence where there are fewer.
    pub fn smooth(&self, cells: &mut [u16]) -> Result<Scale, JsError> {
        let (width, height) = (self.width, self.height);
        let smoothed = match self.pixels() {
            Pixels::Eight(pixels) => {
                let frame = Frame::new(pixels, width, height, width).map_err(sentence)?;
                Smoothed::new(&frame, cells).map(|smoothed| smoothed.scale())
            }
            Pixels::Sixteen(pixels) => {
                let frame = Frame::new(pixels, width, height, width).map_err(sentence)?;
                Smoothed::new(&frame, cells).map(|smoothed| smoothed.scale())
            }
        };
        smoothed.map_err(sentence)
    }

    /// Columns and rows.
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// Calls `with` with the frame, to be read between its pixels' centres; there is nothing where it is covered.
    ///
    /// # Errors
    /// That of `with`.
    pub fn look<T>(
        &self,
        with: impl FnOnce(&dyn Grey) -> Result<T, JsError>,
    ) -> Result<T, JsError> {
        match self.pixels() {
            Pixels::Eight(pixels) => self.look_at(pixels, with),
            Pixels::Sixteen(pixels) => self.look_at(pixels, with),
        }
    }

    fn look_at<T, P: Pixel>(
        &self,
        pixels: &[P],
        with: impl FnOnce(&dyn Grey) -> Result<T, JsError>,
    ) -> Result<T, JsError> {
        let (width, height) = (self.width, self.height);
        let frame = Frame::new(pixels, width, height, width).map_err(sentence)?;
        if self.covered.is_empty() {
            return with(&frame);
        }
        let words = self.covered.words(width, height)?;
        with(&Shuttered::new(frame, words).map_err(sentence)?)
    }

    /// What is not of the picture.
    pub(crate) fn behind(&self) -> &Covered {
        &self.covered
    }

    fn derive(pixels: &Pixels, look: Derived, width: usize, height: usize) -> Vec<u8> {
        match (pixels, look) {
            (Pixels::Eight(pixels), Derived::Edges) => {
                preprocessing::edges(&pixels[..width * height], width, height)
            }
            (Pixels::Eight(pixels), Derived::Equalised) => {
                preprocessing::equalised(&pixels[..width * height], width, height)
            }
            (Pixels::Sixteen(pixels), Derived::Edges) => {
                preprocessing::edges(&pixels[..width * height], width, height)
            }
            (Pixels::Sixteen(pixels), Derived::Equalised) => {
                preprocessing::equalised(&pixels[..width * height], width, height)
            }
        }
    }
}

fn check<P: Pixel>(pixels: &[P], width: u32, height: u32) -> Result<(), JsError> {
    let (width, height) = (width as usize, height as usize);
    Frame::new(pixels, width, height, width)
        .map(|_| ())
        .map_err(sentence)
}

/// The colour of every grey value.
fn shades(centre: f64, width: f64, levels: usize) -> Vec<Rgba> {
    let width = width.max(1.0);
    let black = centre - width / 2.0;
    (0..levels)
        .map(|grey| {
            let shade = ((grey as f64 - black) / width * 255.0)
                .round()
                .clamp(0.0, 255.0) as u8;
            [shade, shade, shade, 255]
        })
        .collect()
}

/// Rows that are developed at a time: the memory for them is used again and again and stays in the processor's caches.
const STRIP: usize = 64;

/// What is covered is not painted: the canvas is clear there.
fn develop<P: Pixel>(
    pixels: &[P],
    covered: &Covered,
    shades: &[Rgba],
    width: usize,
    context: &CanvasRenderingContext2d,
) -> Result<(), JsValue> {
    let mut strip: Vec<Rgba> = Vec::new();
    for (number, pixels) in pixels.chunks((STRIP * width).max(1)).enumerate() {
        // There is a shade for every value of the type.
        let shade = |&grey: &P| shades.get(grey.into() as usize).copied();
        strip.clear();
        strip.extend(pixels.iter().map(|grey| shade(grey).unwrap_or_default()));
        let first = number * STRIP * width;
        for run in covered.runs() {
            let place = |number: usize| number.saturating_sub(first).min(strip.len());
            let [from, to] = [run.start, run.end].map(place);
            strip[from..to].fill(Rgba::default());
        }
        put(context, &strip, width, 0, number * STRIP)?;
    }
    Ok(())
}

fn grey_range<P: Pixel>(pixels: &[P], covered: &Covered) -> Vec<f64> {
    let mut counts = vec![0usize; 1 << 16];
    let mut all = 0.0;
    let ends = covered.runs().map(|run| (run.start, run.end));
    let mut from = 0;
    for (to, next) in ends.chain([(pixels.len(), 0)]) {
        for &grey in &pixels[from..to] {
            if let Some(count) = counts.get_mut(grey.into() as usize) {
                *count += 1;
            }
        }
        all += (to - from) as f64;
        from = next;
    }
    let low = level_below(&counts, 0.0);
    let high = level_below(&counts, all - 1.0);
    let dark = level_below(&counts, all * CLIPPED);
    let bright = level_below(&counts, all * (1.0 - CLIPPED));
    // A blank frame has no range of its own: it is as bright as its grey value is among all of its type.
    let (dark, bright) = match bright > dark {
        true => (dark, bright),
        false => (0.0, (1u32 << (8 * size_of::<P>())) as f64 - 1.0),
    };
    vec![low, high, (dark + bright) / 2.0, bright - dark]
}

/// The least grey value that more than `rank` pixels do not exceed.
fn level_below(counts: &[usize], rank: f64) -> f64 {
    let mut sum = 0;
    let level = counts.iter().position(|count| {
        sum += count;
        sum as f64 > rank
    });
    level.unwrap_or(counts.len() - 1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_maps_its_ends_to_black_and_white() {
        let shades = shades(100.0, 50.0, 256);
        assert_eq!(shades[75], [0, 0, 0, 255]);
        assert_eq!(shades[74], [0, 0, 0, 255]);
        assert_eq!(shades[125], [255; 4]);
        assert_eq!(shades[100][0], 128);
    }

    #[test]
    fn who_shares_a_film_reads_its_pixels_where_they_are() {
        let film = FrameImage::from_eight_bit(vec![1, 2, 3, 4], 2, 2)
            .ok()
            .unwrap();
        assert!(std::ptr::eq(film.pixels(), film.shared().pixels()));
    }

    #[test]
    fn squares_are_means_and_covered_where_a_pixel_is() {
        let mut film = FrameImage::from_eight_bit((0..35).collect(), 7, 5)
            .ok()
            .unwrap();
        assert!(film.cover(vec![1, 2, 20, 22]).is_ok());
        let squares = film.reduced(2).ok().unwrap();
        assert_eq!(squares.size(), (3, 2));
        let Pixels::Eight(pixels) = squares.pixels() else {
            panic!("bytes stay bytes")
        };
        assert_eq!(pixels[..], [4, 6, 8, 18, 20, 22]);
        // Pixel 20 is beyond the last square of its row, pixel 21 in the row below.
        assert_eq!(squares.covered(), [0, 1, 3, 4]);
    }

    #[test]
    fn a_blank_frame_is_as_dark_as_it_is() {
        let none = Covered::default();
        assert_eq!(grey_range(&[0u8; 9], &none), vec![0.0, 0.0, 127.5, 255.0]);
        let sixteen = grey_range(&[700u16; 9], &none);
        assert_eq!(sixteen, vec![700.0, 700.0, 32_767.5, 65_535.0]);
    }

    #[test]
    fn the_suggested_window_ignores_a_few_extreme_pixels() {
        let mut pixels: Vec<u16> = (0..10_000).map(|i| 1000 + (i % 101) as u16).collect();
        pixels[0] = 0;
        pixels[1] = 65_535;
        let none = Covered::default();
        assert_eq!(
            grey_range(&pixels, &none),
            vec![0.0, 65_535.0, 1050.0, 100.0]
        );
        let ends = Covered::new(vec![0, 1, 9_000, 10_000], pixels.len()).unwrap();
        pixels[9_000..].fill(7);
        assert_eq!(
            grey_range(&pixels, &ends),
            vec![1000.0, 65_535.0, 1050.0, 100.0]
        );
    }
}
