//! A window of the known outline slid along a closed or open outline of a view: the similarity that
//! fits best at each place, in closed form.

use heapless::Vec;

use super::similarity::{Similarity, times};

/// Samples in two lists: to the right and upwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples<'a> {
    pub(super) x: &'a [f32],
    pub(super) y: &'a [f32],
}

impl<'a> Samples<'a> {
    pub(super) fn len(&self) -> usize {
        self.x.len().min(self.y.len())
    }

    fn part(&self, from: usize, to: usize) -> Option<Self> {
        Some(Self {
            x: self.x.get(from..to)?,
            y: self.y.get(from..to)?,
        })
    }

    fn sum(&self) -> [f64; 2] {
        let sum = |values: &[f32]| values.iter().map(|&v| f64::from(v)).sum();
        [sum(self.x), sum(self.y)]
    }
}

/// A place at which a window fits a view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Fit {
    /// First sample of the view that the window lies on.
    pub(super) shift: usize,
    /// Mean squared distance, in the view's units.
    pub(super) residual: f64,
    /// From the view to the window.
    pub(super) similarity: Similarity,
}

impl Fit {
    fn scaled(mut self, scale: f64) -> Self {
        let scaled = |v: f64| v * scale;
        self.similarity.factor = self.similarity.factor.map(scaled);
        self.similarity.offset = self.similarity.offset.map(scaled);
        self
    }
}

/// Working memory: two numbers for each place.
pub(super) struct Sums<'a> {
    pub(super) re: &'a mut [f32],
    pub(super) im: &'a mut [f32],
}

/// How a window is slid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slide {
    /// Places looked at, at most: as many as a closed outline has samples.
    pub(super) places: usize,
    /// Of places nearer to each other than this the better is kept.
    pub(super) apart: usize,
    /// The window's scale relative to the view lies within this factor of 1.
    pub(super) stretch: f64,
}

/// Looks for the places along `view` that a `window` fits, of which there are
/// `view.len() - window.len() + 1` (a closed outline is handed in with its beginning repeated), and
/// enters the best into `best`; `scale` multiplies the similarities.
pub(super) fn slide<const K: usize>(
    window: Samples<'_>,
    view: Samples<'_>,
    how: &Slide,
    scale: f64,
    sums: &mut Sums<'_>,
    best: &mut Vec<Fit, K>,
) {
    let count = window.len();
    let places = how.places.min((view.len() + 1).saturating_sub(count));
    if count < 3 {
        return;
    }
    let (Some(re), Some(im)) = (sums.re.get_mut(..places), sums.im.get_mut(..places)) else {
        return;
    };
    let mean = window.sum().map(|sum| sum / count as f64);
    correlate(window, mean.map(|v| v as f32), view, re, im);
    let own = spread(window, mean);
    let mut moments = Moments::new(view, count);
    for (shift, (&re, &im)) in re.iter().zip(&*im).enumerate() {
        let product = [f64::from(re), f64::from(im)];
        let fit = moments.fit(shift, product, own, mean, how.stretch);
        moments.advance(view, shift, count);
        if let Some(fit) = fit {
            insert(best, fit.scaled(scale), how.apart);
        }
    }
}

/// `sum conj(z) w` for the window `z` less its mean and each place of the view `w`.
///
/// The inner loop runs along the places, so that it is done several at a time without changing
/// the order of any sum.
fn correlate(z: Samples<'_>, mean: [f32; 2], w: Samples<'_>, re: &mut [f32], im: &mut [f32]) {
    re.fill(0.0);
    im.fill(0.0);
    let places = re.len();
    for (index, (&x, &y)) in z.x.iter().zip(z.y).enumerate() {
        let (x, y) = (x - mean[0], y - mean[1]);
        let Some(w) = w.part(index, index + places) else {
            return;
        };
        let sums = re.iter_mut().zip(im.iter_mut());
        for ((re, im), (&u, &v)) in sums.zip(w.x.iter().zip(w.y)) {
            *re += x * u + y * v;
            *im += x * v - y * u;
        }
    }
}

/// `sum |z - mean|^2`.
fn spread(z: Samples<'_>, mean: [f64; 2]) -> f64 {
    let pairs = z.x.iter().zip(z.y);
    pairs
        .map(|(&x, &y)| {
            let (x, y) = (f64::from(x) - mean[0], f64::from(y) - mean[1]);
            x * x + y * y
        })
        .sum()
}

/// Running sums over the part of the view under the window.
struct Moments {
    count: f64,
    sum: [f64; 2],
    squares: f64,
}

impl Moments {
    fn new(view: Samples<'_>, count: usize) -> Self {
        let mut moments = Self {
            count: count as f64,
            sum: [0.0; 2],
            squares: 0.0,
        };
        for index in 0..count {
            moments.add(view, index, 1.0);
        }
        moments
    }

    fn add(&mut self, view: Samples<'_>, index: usize, sign: f64) {
        if let (Some(&x), Some(&y)) = (view.x.get(index), view.y.get(index)) {
            let (x, y) = (f64::from(x), f64::from(y));
            self.sum[0] += sign * x;
            self.sum[1] += sign * y;
            self.squares += sign * (x * x + y * y);
        }
    }

    fn advance(&mut self, view: Samples<'_>, shift: usize, count: usize) {
        self.add(view, shift, -1.0);
        self.add(view, shift + count, 1.0);
    }

    /// The best similarity at a place: `z -> a z + b` takes the window to the view with
    /// `a = product / own`, and its inverse takes the view to the window.
    fn fit(
        &self,
        shift: usize,
        product: [f64; 2],
        own: f64,
        mean: [f64; 2],
        stretch: f64,
    ) -> Option<Fit> {
        let square = product[0] * product[0] + product[1] * product[1];
        let theirs =
            self.squares - (self.sum[0] * self.sum[0] + self.sum[1] * self.sum[1]) / self.count;
        let growth = square / (own * own);
        if !(growth * stretch * stretch >= 1.0 && growth <= stretch * stretch) {
            return None;
        }
        // 1 / a = own conj(product) / |product|^2
        let factor = [own * product[0] / square, -own * product[1] / square];
        let middle = times(factor, self.sum.map(|sum| sum / self.count));
        Some(Fit {
            shift,
            residual: ((theirs - square / own) / self.count).max(0.0),
            similarity: Similarity {
                factor,
                offset: [mean[0] - middle[0], mean[1] - middle[1]],
            },
        })
    }
}

/// Puts a fit in its place by rising residual; of neighbours the better stays.
fn insert<const K: usize>(best: &mut Vec<Fit, K>, fit: Fit, apart: usize) {
    if let Some(near) = best
        .iter()
        .position(|other| other.shift.abs_diff(fit.shift) < apart)
    {
        if best[near].residual <= fit.residual {
            return;
        }
        best.remove(near);
    }
    let place = best.partition_point(|other| other.residual <= fit.residual);
    if place == K {
        return;
    }
    if best.is_full() {
        best.pop();
    }
    // There is room now.
    let _ = best.insert(place, fit);
}
