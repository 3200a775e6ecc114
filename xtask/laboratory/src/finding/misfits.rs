//! What remains at the poses of several components on one film: what is usual there.

use fluoropose::finder::{Doubt, FilmMisfits};

/// Misfits in pixels, of each component in each frame, where there is a pose.
pub struct Misfits(pub Vec<Vec<Option<f64>>>);

/// Those that a frame's pose of a component is compared with.
#[derive(Default)]
pub struct Beside {
    own: Vec<f64>,
    others: Vec<f64>,
}

impl Misfits {
    /// The misfits of all frames and components but this one.
    pub fn beside(&self, component: usize, frame: usize) -> Beside {
        let (mut own, mut others) = (Vec::new(), Vec::new());
        for (number, misfits) in self.0.iter().enumerate() {
            if number == component {
                let rest = misfits.iter().enumerate();
                let rest = rest.filter(|&(other, _)| other != frame);
                own.extend(rest.filter_map(|(_, misfit)| *misfit));
            } else {
                others.extend(misfits.iter().flatten());
            }
        }
        Beside { own, others }
    }
}

impl Beside {
    fn misfits(&self) -> FilmMisfits<'_> {
        FilmMisfits {
            own: &self.own,
            others: &self.others,
        }
    }

    /// What is doubtful of a pose with this misfit.
    pub fn doubt(&self, px: f64) -> Option<Doubt> {
        self.misfits().doubt(px)
    }

    /// The misfit at which the search for poses around one with this may end, where there is need of any.
    pub fn look_beyond(&self, px: f64, is_nearly_symmetric: bool) -> Option<f64> {
        self.misfits().look_beyond(px, is_nearly_symmetric)
    }
}
