//! The frame brought into memory, the regions in it, and the poses that the library has for them.

use super::candidates::{Region, SAME_START, keep};
use super::error::OneClickError;
use super::flooding::flood;
use super::memory::{OneClickMemory, OneClickNeeds};
use super::observation::Observation;
use super::opening::{Opening, sharpness};
use super::state::{OneClick, RADII, READINGS, SQUARE};
use super::statistics::ThresholdStatistics;
use super::window::{BLOCKED, Reading, levels};
use fluoropose::finder::Component;
use fluoropose::image::mask::{Mask, MaskMut, words_needed};
use fluoropose::image::moments::Moments;

/// Regions count as one whose areas differ by less than this fraction, and whose centroids are less than a pixel apart.
const SAME_AREA: f64 = 0.01;

impl OneClick {
    /// Brings a pass into memory: the levels of the frame, smoothed, and their regions around the seed. Returns the number
    /// of grey values for one level.
    pub(super) fn preprocess(
        &mut self,
        pass: usize,
        observation: &Observation<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> f64 {
        let (smoothing, against) = READINGS[pass % READINGS.len()];
        let how = Reading {
            polarity: observation.polarity,
            smoothing,
            against: against.then_some(SQUARE * self.expected.size),
        };
        let (window, grey) = (self.window, &mut *memory.grey);
        let (frame, excluded) = (observation.frame, observation.excluded);
        let step = levels(frame, &window, how, excluded, grey, memory.statistics);
        if self.seeds.is_empty() {
            self.seeds = self.narrowed.unwrap_or(self.prompt).seeds(&window, memory);
        }
        let seed = self.seed(pass);
        flood(memory.grey, &window, seed, memory.reached, memory.links);
        self.current = Some(pass);
        step
    }

    fn seed(&self, pass: usize) -> usize {
        self.seeds.get(pass / READINGS.len()).copied().unwrap_or(0)
    }

    /// Lists the regions of a pass that are worth matching, the best last.
    pub(super) fn list_regions(&mut self, pass: usize, step: f64, memory: &mut OneClickMemory<'_>) {
        let base = memory.reached.get(self.seed(pass)).copied();
        let (grey, reached) = (&*memory.grey, &*memory.reached);
        let base = base.unwrap_or(BLOCKED);
        let window = &self.window;
        let statistics = ThresholdStatistics::new(grey, reached, window, base, memory.statistics);
        if let Some(peak) = statistics.peak([self.expected.areas[0], self.expected.implant]) {
            self.slope = self.slope.max(step * statistics.sharpness(peak));
        }
        let levels = statistics.levels(self.expected.areas);
        self.regions.clear();
        for fraction in RADII.into_iter().rev() {
            let radius = fraction * self.expected.size;
            for &level in levels.iter().rev() {
                if radius == 0.0 || radius >= 1.0 {
                    // There is room for all radii of all levels.
                    let _ = self.regions.push(Region {
                        pass,
                        level,
                        radius,
                    });
                }
            }
        }
    }

    /// Draws a region and what is in doubt of it, and returns the moments of the region.
    pub(super) fn draw(
        &mut self,
        region: &Region,
        observation: &Observation<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Moments, OneClickError> {
        if self.current != Some(region.pass) {
            self.preprocess(region.pass, observation, memory);
        }
        let (width, height) = (observation.camera.width(), observation.camera.height());
        let (a, b) = memory.words.split_at_mut(words_needed(width, height));
        let mut shape = MaskMut::new(a, width, height)?;
        let mut doubt = MaskMut::new(b, width, height)?;
        let mut opening = Opening {
            window: self.window,
            reached: &*memory.reached,
            distance: &mut *memory.distance,
            marks: &mut *memory.marks,
            stack: &mut *memory.links,
        };
        let (seed, level) = (self.seed(region.pass), region.level);
        opening.draw(seed, level, region.radius, &mut shape, &mut doubt);
        Ok(shape.as_mask().moments())
    }

    /// Draws a region and adds the poses that the library has for it to the located poses.
    pub(super) fn try_region(
        &mut self,
        region: Region,
        observation: &Observation<'_>,
        component: Option<&Component<'_>>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<(), OneClickError> {
        let moments = self.draw(&region, observation, memory)?;
        let [least, most] = self.expected.areas;
        if !(least..=most).contains(&(moments.area as f64)) || self.was_matched(&moments) {
            return Ok(());
        }
        // If there are more regions than are remembered, some may be matched twice.
        let _ = self.matched.push(moments);
        let sharp = sharpness(&self.window, memory.grey, memory.marks);
        // Levels against the background are others: they are no measure of a border beside the plain ones.
        let (_, against) = READINGS[region.pass % READINGS.len()];
        if self
            .sharpest
            .is_none_or(|(other, _)| sharp > other && !against)
        {
            self.sharpest = Some((sharp, region));
        }
        let Some(component) = component else {
            return Ok(());
        };
        for located in self.scorer(observation, component).locate(region, memory)? {
            keep(&mut self.located, located, SAME_START, component.model);
        }
        Ok(())
    }

    fn was_matched(&self, moments: &Moments) -> bool {
        let at = moments.centroid();
        self.matched.iter().any(|other| {
            let there = other.centroid();
            let apart = libm::hypot(at.column - there.column, at.row - there.row);
            let ratio = moments.area as f64 / other.area.max(1) as f64;
            (ratio - 1.0).abs() < SAME_AREA && apart < 1.0
        })
    }

    /// Draws the region with the sharpest border, after the last step: the answer where there is no component.
    ///
    /// # Errors
    /// [`OneClickError::NoRegion`] where there is none, and [`OneClickError::Memory`].
    pub fn draw_region<'m>(
        &mut self,
        observation: &Observation<'_>,
        memory: &'m mut OneClickMemory<'_>,
    ) -> Result<Mask<'m>, OneClickError> {
        let (_, region) = self.sharpest.ok_or(OneClickError::NoRegion)?;
        let needs = OneClickNeeds::of(self.window.pixels(), observation.camera);
        self.draw(&region, observation, &mut memory.borrow(&needs)?)?;
        let (width, height) = (observation.camera.width(), observation.camera.height());
        let words = memory.words.get(..words_needed(width, height));
        Ok(Mask::new(words.unwrap_or_default(), width, height)?)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::camera;
    use super::*;
    use fluoropose::image::contour::Point;

    #[test]
    fn a_region_of_the_same_size_at_the_same_place_was_matched() {
        let prompt = super::super::prompt::Prompt::Click(Point::new(9.0, 9.0));
        let mut work = OneClick::new(prompt, &camera(), None).expect("inside");
        let region = |area: u64, column: u64, row: u64| Moments {
            area,
            column: area * column / 100,
            row: area * row / 100,
            column_column: 0,
            column_row: 0,
            row_row: 0,
        };
        assert!(!work.was_matched(&region(1000, 5000, 7000)));
        let _ = work.matched.push(region(1000, 5000, 7000));
        for (area, column, row, right) in [
            (1000, 5000, 7000, true),
            (1009, 5000, 7000, true),
            (991, 5000, 7000, true),
            (1010, 5000, 7000, false),
            (989, 5000, 7000, false),
            (1000, 5060, 7060, true),
            (1000, 5080, 7080, false),
            (1000, 4920, 6920, false),
            (1000, 5100, 7000, false),
        ] {
            let matched = work.was_matched(&region(area, column, row));
            assert_eq!(matched, right, "{area} {column} {row}");
        }
    }
}
