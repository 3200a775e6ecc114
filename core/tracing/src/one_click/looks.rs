//! The film brought into memory, the regions in it, and what the library has for them.

use super::candidates::{Region, keep};
use super::grow::grow;
use super::job::{OneClick, SAME_START, SMOOTHING};
use super::shape::{Shaper, sharpness};
use super::tally::Tally;
use super::window::{BLOCKED, LEVELS, look};
use super::{OneClickError, OneClickMemory, Part, Scene};
use fluoropose::image::mask::{Mask, MaskMut, words_needed};
use fluoropose::image::moments::Moments;

/// Radii of the discs that cut bridges, in parts of the expected size.
pub(super) const RADII: [f64; 4] = [0.0, 0.03, 0.06, 0.1];
/// Regions are one whose areas differ by less than this part, and whose middles are less than a
/// pixel apart.
const SAME_AREA: f64 = 0.01;

impl OneClick {
    /// Brings a look into memory: the film smoothed, and grown from its seed. Gives the grey
    /// values that a step of it stands for.
    pub(super) fn look(
        &mut self,
        at: usize,
        scene: &Scene<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> f64 {
        let how = (scene.polarity, SMOOTHING[at % SMOOTHING.len()]);
        let histogram = memory.tallies.get_mut(..LEVELS).unwrap_or_default();
        let (window, grey) = (self.window, &mut *memory.grey);
        let step = look(scene.frame, &window, how, scene.excluded, grey, histogram);
        if self.seeds.is_empty() {
            self.seeds = self.narrowed.unwrap_or(self.prompt).seeds(&window, memory);
        }
        let seed = self.seed(at);
        grow(memory.grey, &window, seed, memory.reached, memory.links);
        self.current = Some(at);
        step
    }

    fn seed(&self, look: usize) -> usize {
        self.seeds.get(look / SMOOTHING.len()).copied().unwrap_or(0)
    }

    /// Lists the regions of a look that are worth matching, the best last.
    pub(super) fn list_regions(&mut self, look: usize, step: f64, memory: &mut OneClickMemory<'_>) {
        let base = memory.reached.get(self.seed(look)).copied();
        let (grey, reached) = (&*memory.grey, &*memory.reached);
        let base = base.unwrap_or(BLOCKED);
        let tally = Tally::new(grey, reached, &self.window, base, memory.tallies);
        if let Some(peak) = tally.peak(self.expected.areas) {
            self.slope = self.slope.max(step * tally.sharpness(peak));
        }
        let levels = tally.levels(self.expected.areas);
        self.regions.clear();
        for share in RADII.into_iter().rev() {
            let radius = share * self.expected.size;
            for &level in levels.iter().rev() {
                if radius == 0.0 || radius >= 1.0 {
                    // There is room for all radii of all levels.
                    let _ = self.regions.push(Region {
                        look,
                        level,
                        radius,
                    });
                }
            }
        }
    }

    /// Draws a region and what is in doubt of it; the moments of the region.
    pub(super) fn draw(
        &mut self,
        region: &Region,
        scene: &Scene<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Moments, OneClickError> {
        if self.current != Some(region.look) {
            self.look(region.look, scene, memory);
        }
        let (width, height) = (scene.camera.width(), scene.camera.height());
        let (a, b) = memory.words.split_at_mut(words_needed(width, height));
        let mut shape = MaskMut::new(a, width, height)?;
        let mut doubt = MaskMut::new(b, width, height)?;
        let mut shaper = Shaper {
            window: self.window,
            reached: &*memory.reached,
            distance: &mut *memory.distance,
            marks: &mut *memory.marks,
            stack: &mut *memory.links,
        };
        let (seed, level) = (self.seed(region.look), region.level);
        shaper.shape(seed, level, region.radius, &mut shape, &mut doubt);
        Ok(shape.as_mask().moments())
    }

    /// Draws a region and adds the poses that the library has for it to the finds.
    pub(super) fn try_region(
        &mut self,
        region: Region,
        scene: &Scene<'_>,
        part: Option<&Part<'_>>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<(), OneClickError> {
        let moments = self.draw(&region, scene, memory)?;
        let [least, most] = self.expected.areas;
        if !(least..=most).contains(&(moments.area as f64)) || self.was_matched(&moments) {
            return Ok(());
        }
        // Of more regions than are remembered some may be matched twice.
        let _ = self.matched.push(moments);
        let sharp = sharpness(&self.window, memory.grey, memory.marks);
        if self.sharpest.is_none_or(|(other, _)| sharp > other) {
            self.sharpest = Some((sharp, region));
        }
        let Some(part) = part else { return Ok(()) };
        for find in self.eye(scene, part).find(region, memory)? {
            keep(&mut self.finds, find, SAME_START, part.model);
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

    /// The region with the sharpest border, after the last step: what is left to say without a
    /// component.
    ///
    /// # Errors
    /// [`OneClickError::NoRegion`].
    pub fn draw_region<'m>(
        &mut self,
        scene: &Scene<'_>,
        memory: &'m mut OneClickMemory<'_>,
    ) -> Result<Mask<'m>, OneClickError> {
        let (_, region) = self.sharpest.ok_or(OneClickError::NoRegion)?;
        self.draw(&region, scene, memory)?;
        let (width, height) = (scene.camera.width(), scene.camera.height());
        let words = memory.words.get(..words_needed(width, height));
        Ok(Mask::new(words.unwrap_or_default(), width, height)?)
    }
}
