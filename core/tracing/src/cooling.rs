//! Which part of a path has stayed the same for some time.

/// Intervals that the time is counted in.
const SLOTS: usize = 8;

/// Watches the paths from one seed. Points that have been the same for some time may be fixed ("path cooling": Mortensen
/// and Barrett, *Interactive segmentation with intelligent scissors*, GMIP 60, 1998).
#[derive(Clone, Debug)]
pub struct Cooling {
    /// Length of a slot, milliseconds.
    slot: f64,
    /// For each slot, the latest first: the least number of points that two successive paths had in common.
    least: [usize; SLOTS],
    /// When the latest slot began, milliseconds; `None` before the first path.
    began: Option<f64>,
}

impl Cooling {
    /// Points count as fixed once they have been the same for about `milliseconds`.
    #[must_use]
    pub fn new(milliseconds: f64) -> Self {
        Self {
            slot: (milliseconds / SLOTS as f64).max(1.0),
            least: [0; SLOTS],
            began: None,
        }
    }

    /// Forgets all paths: for a new seed.
    pub fn restart(&mut self) {
        self.least = [0; SLOTS];
        self.began = None;
    }

    /// Counts a path of `length` points at the time `now`, milliseconds; its first `common` points are those of the path
    /// before it. Returns how many points, from the seed on, have been the same for long enough.
    pub fn observe(&mut self, now: f64, common: usize, length: usize) -> usize {
        self.advance(now);
        self.least[0] = self.least[0].min(common);
        self.least
            .iter()
            .copied()
            .min()
            .unwrap_or_default()
            .min(length)
    }

    /// Opens the slots that have begun since the last path. In a slot without a path nothing changed.
    fn advance(&mut self, now: f64) {
        let Some(began) = self.began else {
            self.began = Some(now);
            return;
        };
        let passed = (now - began) / self.slot;
        // A NaN and a clock that goes backwards open no slot.
        let slots = if passed >= 1.0 { passed as usize } else { 0 };
        for _ in 0..slots.min(SLOTS) {
            self.least.rotate_right(1);
            self.least[0] = usize::MAX;
        }
        self.began = Some(began + slots as f64 * self.slot);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Random;

    #[test]
    fn what_changed_lately_is_not_fixed() {
        let mut cooling = Cooling::new(800.0);
        let mut random = Random(11);
        let mut seen: std::vec::Vec<(f64, usize)> = std::vec::Vec::new();
        let mut now = 0.0;
        for _ in 0..400 {
            now += 60.0 * random.uniform();
            let common = (100.0 + 60.0 * random.uniform()) as usize;
            seen.push((now, common));
            let fixed = cooling.observe(now, common, 150);
            // Oracle: the least of the last 800 ms at least, of the last 900 ms at most.
            let least = |ms: f64| {
                let late = seen.iter().filter(|(at, _)| now - at < ms);
                late.map(|(_, common)| *common)
                    .min()
                    .unwrap_or_default()
                    .min(150)
            };
            if now > 1000.0 {
                assert!(fixed <= least(699.0) && fixed >= least(901.0), "{fixed}");
            } else if now < 700.0 {
                assert_eq!(fixed, 0);
            }
        }
    }

    #[test]
    fn a_path_at_rest_becomes_fixed_and_a_new_seed_begins_again() {
        let mut cooling = Cooling::new(400.0);
        assert_eq!(cooling.observe(0.0, 0, 50), 0);
        assert_eq!(cooling.observe(10.0, 50, 50), 0);
        assert_eq!(cooling.observe(900.0, 48, 60), 48);
        cooling.restart();
        assert_eq!(cooling.observe(910.0, 60, 60), 0);
        assert_eq!(cooling.observe(f64::NAN, 60, 60), 0);
    }
}
