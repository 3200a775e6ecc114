//! Places of a whole frame where something dark has a shape that a component has from some side.
//!
//! Every region that a threshold could cut out (`DarkRegions`) and that has a possible size is compared with all views of the library, as
//! the outline of a mask is. That needs nobody's click, and it takes a tenth of a second: rulers, bones and the borders of fields have other
//! shapes, however dark they are.

use fluoropose::camera::Camera;
use fluoropose::finder::Component;
use fluoropose::image::contour::Point;
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::locate::{Workspace, locate};
use fluoropose::memory::{TooLittleMemory, first};
use fluoropose::refine::ImageTarget;
use fluoropose::shortlist::keep;
use heapless::Vec;

use crate::cells::Cells;
use crate::dark_regions::{DarkRegions, numbers_needed};
use crate::one_click::background::BACKGROUND;
use crate::one_click::window::{LEVELS, Reading, Window, levels_of};
use crate::one_click::{DISTANCES, SQUARE};

/// Most places.
pub const SHAPES: usize = 4;

/// Least and greatest area of a region, in those of the nearest and the farthest silhouettes: edges are a cell wide, and what touches may
/// be part of it.
const AREAS: [f64; 2] = [0.6, 1.5];
/// So much of its area a region and a view may have apart. Views of what the region is have 0.1 to 0.4 apart in cells as large as these.
const APART: f64 = 0.45;

/// Lengths of [`ShapeMemory`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeNeeds {
    /// Of `levels` and `depths` each.
    pub cells: usize,
    /// Of `numbers`.
    pub numbers: usize,
    /// Of `words`.
    pub words: usize,
}

/// Working memory of [`shapes`].
#[derive(Debug)]
pub struct ShapeMemory<'m> {
    /// Grey levels of cells.
    pub levels: &'m mut [u16],
    /// How deep in a region cells lie.
    pub depths: &'m mut [u16],
    /// Regions.
    pub numbers: &'m mut [u32],
    /// A mask of cells.
    pub words: &'m mut [Word],
    /// As for [`locate`].
    pub workspace: Workspace<'m>,
}

/// Lengths of the memory for frames of a camera.
#[must_use]
pub fn shapes_needed(camera: &Camera) -> ShapeNeeds {
    let cells = Cells::of(camera);
    ShapeNeeds {
        cells: cells.count(),
        numbers: numbers_needed(cells.count()).max(BACKGROUND.max(LEVELS)),
        words: words_needed(cells.columns, cells.rows),
    }
}

/// Places within regions that look like the component from some side, the likest first.
///
/// # Errors
/// [`TooLittleMemory`] where there is less than [`shapes_needed`].
pub fn shapes(
    image: &ImageTarget<'_>,
    component: &Component<'_>,
    camera: &Camera,
    size_px: f64,
    memory: &mut ShapeMemory<'_>,
) -> Result<Vec<Point, SHAPES>, TooLittleMemory> {
    let (cells, needs) = (Cells::of(camera), shapes_needed(camera));
    let seen = Seen {
        image,
        cells,
        camera: coarse(camera, &cells),
        component,
        areas: areas(component, camera, &cells),
    };
    let mut best: Vec<(f64, Point), SHAPES> = Vec::new();
    let mut memory = ShapeMemory {
        levels: first("levels", needs.cells, memory.levels)?,
        depths: first("depths", needs.cells, memory.depths)?,
        numbers: first("numbers", needs.numbers, memory.numbers)?,
        words: first("words", needs.words, memory.words)?,
        workspace: memory.workspace.reborrow(),
    };
    for against in [None, Some(SQUARE * size_px / cells.side)] {
        seen.read(against, &mut memory, |apart, at| {
            let same = |other: &(f64, Point)| {
                (other.1.column - at.column)
                    .abs()
                    .max((other.1.row - at.row).abs())
                    < 2.0 * cells.side
            };
            if best.iter().any(|other| same(other) && other.0 <= apart) {
                return;
            }
            best.retain(|other| !same(other));
            keep(&mut best, (apart, at), |&(apart, _)| apart);
        })?;
    }
    Ok(best.into_iter().map(|(_, at)| at).collect())
}

/// The camera of a frame whose pixels are cells.
fn coarse(camera: &Camera, cells: &Cells) -> Option<Camera> {
    let in_cells = |at: f64| at / cells.side;
    let (focal, point) = (
        camera.focal().map(in_cells),
        camera.principal_point().map(in_cells),
    );
    Camera::new(cells.columns, cells.rows, focal, point).ok()
}

/// Least and greatest area of a region, cells.
fn areas(component: &Component<'_>, camera: &Camera, cells: &Cells) -> [f64; 2] {
    let info = component.library.info();
    let [fx, fy] = camera.focal();
    let unit = fx * fy / (info.focal * info.focal * cells.side * cells.side);
    let views = 0..component.library.views();
    let areas = views.map(|view| f64::from(component.library.record(view).area) * unit);
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    areas.for_each(|area| (least, most) = (least.min(area), most.max(area)));
    let [near, far] = DISTANCES;
    [
        AREAS[0] * least / (far * far),
        AREAS[1] * most / (near * near),
    ]
}

/// A frame in which a component is looked for.
struct Seen<'s> {
    image: &'s ImageTarget<'s>,
    cells: Cells,
    camera: Option<Camera>,
    component: &'s Component<'s>,
    areas: [f64; 2],
}

impl Seen<'_> {
    /// Calls `visit` with how much regions and their views have apart, and a place within: of grey levels as they are, or against what is
    /// larger than a square of so many cells.
    fn read(
        &self,
        against: Option<f64>,
        memory: &mut ShapeMemory<'_>,
        mut visit: impl FnMut(f64, Point),
    ) -> Result<(), TooLittleMemory> {
        let picture = Window {
            left: 0,
            top: 0,
            width: self.cells.columns,
            height: self.cells.rows,
        };
        let how = Reading {
            polarity: self.image.polarity,
            smoothing: 0,
            against,
        };
        levels_of(
            |column, row| self.grey(column, row),
            &picture,
            how,
            memory.levels,
            memory.numbers,
        );
        let mut regions = DarkRegions::new(memory.levels, &picture, memory.numbers)?;
        for region in regions.sharpest(self.areas) {
            memory.words.fill(0);
            let Ok(mut shape) = MaskMut::new(memory.words, picture.width, picture.height) else {
                continue;
            };
            regions.cells(region, |cell| {
                let (column, row) = picture.place(cell);
                shape.set(column, row, true);
            });
            let shape = shape.as_mask();
            // What is cut off there has the shape of no view: the corners beyond a round field look like a femur.
            let cut = regions.cut(region);
            if let Some(apart) = self.apart(&shape, memory.workspace.reborrow())
                && apart + cut <= APART
                && let Some([column, row]) = deepest(&shape, memory.depths)
            {
                visit(apart + cut, self.cells.middle(column, row));
            }
        }
        Ok(())
    }

    fn grey(&self, column: usize, row: usize) -> Option<f64> {
        let at = self.cells.middle(column, row);
        let is_unknown = |mask: &Mask<'_>| mask.get(at.column as usize, at.row as usize);
        match self.image.unknown.is_some_and(is_unknown) {
            true => None,
            false => self.cells.grey(self.image.frame, column, row),
        }
    }

    /// How much a shape and the likest view have apart, as a part of the area; `None` where the component would be too near or too far away.
    fn apart(&self, shape: &Mask<'_>, work: Workspace<'_>) -> Option<f64> {
        let library = self.component.library;
        let located = locate::<1>(shape, self.camera.as_ref()?, library, work).ok()?;
        let best = located.poses.first()?;
        let depth = -best.pose.transform(&self.component.model.bounds().centre)[2];
        let [near, far] = DISTANCES.map(|times| times * library.info().distance);
        let apart = f64::from(best.fine.unmatched) / f64::from(library.info().canonical.area());
        (near..=far).contains(&depth).then_some(apart)
    }
}

/// The cell of a shape that lies deepest in it, by steps to the side; of several the first.
fn deepest(shape: &Mask<'_>, depths: &mut [u16]) -> Option<[usize; 2]> {
    let (width, height) = (shape.width(), shape.height());
    let at = |depths: &[u16], column: Option<usize>, row: Option<usize>| match (column, row) {
        (Some(column), Some(row)) if column < width && row < height => depths[row * width + column],
        _ => 0,
    };
    for row in 0..height {
        for column in 0..width {
            let (left, above) = (
                at(depths, column.checked_sub(1), Some(row)),
                at(depths, Some(column), row.checked_sub(1)),
            );
            let is_in = shape.get(column, row);
            depths[row * width + column] = if is_in {
                left.min(above).saturating_add(1)
            } else {
                0
            };
        }
    }
    let mut best = (0, None);
    for row in (0..height).rev() {
        for column in (0..width).rev() {
            let (right, below) = (
                at(depths, Some(column + 1), Some(row)),
                at(depths, Some(column), Some(row + 1)),
            );
            let own = &mut depths[row * width + column];
            *own = (*own).min(right.min(below).saturating_add(1));
            if *own > 0 && *own >= best.0 {
                best = (*own, Some([column, row]));
            }
        }
    }
    best.1
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::PlacesBuffers;
    use crate::one_click::tests::{SIDE, camera, library, model, pose, silhouette};
    use fluoropose::finder::FinderBuffers;
    use fluoropose::image::frame::Frame;
    use fluoropose::library::Library;
    use fluoropose::mesh::Model;
    use fluoropose::refine::Polarity;
    use fluoropose::search::kernels::Kernels;
    use std::vec::Vec;

    /// A round field with black corners, a black ruler, black letters, and a dark bar along the border; of the implant less than of all these.
    fn drawn(implant: &Mask<'_>) -> Vec<u16> {
        let grey = |k: usize| {
            let (column, row) = (k % SIDE, k / SIDE);
            let middle = SIDE as f64 / 2.0;
            let off = libm::hypot(column as f64 - middle, row as f64 - middle);
            let is_ruler = (30..42).contains(&column) && row % 3 > 0;
            let is_word = (300..360).contains(&column)
                && row < 30
                && (column / 6 + row / 6).is_multiple_of(2);
            match (
                off > 1.2 * middle || is_ruler || is_word || column > SIDE - 20,
                implant.get(column, row),
            ) {
                (true, _) => 100,
                (false, true) => 9000,
                (false, false) => 20_000 + 40 * column as u16,
            }
        };
        (0..SIDE * SIDE).map(grey).collect()
    }

    fn places(pixels: &[u16], unknown: Option<&Mask<'_>>, polarity: Polarity) -> Vec<Point> {
        let (vertices, triangles) = model();
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        let (bytes, camera) = (library(model, 1000.0), camera());
        let library = Library::open(&bytes).expect("a library");
        let component = Component {
            library: &library,
            model: &model,
            planes: &[],
        };
        let frame = Frame::new(pixels, SIDE, SIDE, SIDE).expect("fits");
        let image = ImageTarget {
            frame: &frame,
            unknown,
            polarity,
            film: None,
        };
        let (mut buffers, mut finder) = (PlacesBuffers::default(), FinderBuffers::default());
        let mut memory = buffers.borrow(&camera, finder.workspace(&library, Kernels::PORTABLE));
        let size = crate::seeds::expected_size(&component, &camera);
        let found = shapes(&image, &component, &camera, size, &mut memory.shapes);
        let found = found.expect("enough memory").to_vec();
        memory.shapes.words = &mut [];
        assert!(shapes(&image, &component, &camera, size, &mut memory.shapes).is_err());
        found
    }

    #[test]
    fn what_has_the_shape_of_a_view_comes_before_what_is_darker() {
        let (vertices, triangles) = model();
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        let words = silhouette(&model, &pose());
        let implant = Mask::new(&words, SIDE, SIDE).expect("valid");
        let is_in = |at: &Point| implant.get(at.column as usize, at.row as usize);
        let pixels = drawn(&implant);
        let found = places(&pixels, None, Polarity::DarkImplant);
        assert!(found.first().is_some_and(is_in), "{found:?}");
        let negative: Vec<u16> = pixels.iter().map(|grey| 40_000 - grey).collect();
        assert_eq!(places(&negative, None, Polarity::BrightImplant), found);
        let elsewhere = places(&pixels, Some(&implant), Polarity::DarkImplant);
        assert!(!elsewhere.iter().any(is_in), "{elsewhere:?}");
        let uniform = std::vec![7; SIDE * SIDE];
        assert!(places(&uniform, None, Polarity::DarkImplant).is_empty());
    }

    #[test]
    fn the_deepest_cell_is_the_one_farthest_from_all_that_is_outside() {
        let mut words = std::vec![0; words_needed(20, 12)];
        let mut shape = MaskMut::new(&mut words, 20, 12).expect("fits");
        (2..9).for_each(|row| shape.fill_span(row, 3, 8));
        (5..6).for_each(|row| shape.fill_span(row, 8, 18));
        let mut depths = std::vec![0; 240];
        assert_eq!(deepest(&shape.as_mask(), &mut depths), Some([5, 4]));
        let nothing = std::vec![0; words_needed(20, 12)];
        let nothing = Mask::new(&nothing, 20, 12).expect("fits");
        assert_eq!(deepest(&nothing, &mut depths), None);
    }
}
