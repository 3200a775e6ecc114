//! A window of the known outline slid along a closed or open outline of a view: the similarity that
//! fits best at each place, in closed form.

use crate::shortlist::{keep, take_out};
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
    /// Most places that are tried: the number of samples of a closed outline.
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
        // What is no better than the last of a full list is not inserted, whatever is near it.
        let limit = match best.last() {
            Some(last) if best.is_full() => last.residual,
            _ => f64::INFINITY,
        };
        let fit = moments.fit(shift, product, own, mean, how.stretch, limit);
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
    let (fours_x, rest_x) = z.x.as_chunks::<FOUR>();
    let (fours_y, rest_y) = z.y.as_chunks::<FOUR>();
    let centred = |x: f32, y: f32| [x - mean[0], y - mean[1]];
    let mut index = 0;
    for (x, y) in fours_x.iter().zip(fours_y) {
        let z: [_; FOUR] = core::array::from_fn(|k| centred(x[k], y[k]));
        add_products(z, w, index, re, im);
        index += FOUR;
    }
    for (&x, &y) in rest_x.iter().zip(rest_y) {
        add_products([centred(x, y)], w, index, re, im);
        index += 1;
    }
}

/// Samples of a window that are taken together, so that sums are read and written once for all of them.
const FOUR: usize = 4;

/// Adds the products of samples of a window, from number `index` on, to the sums of all places.
#[inline(always)]
fn add_products<const N: usize>(
    z: [[f32; 2]; N],
    w: Samples<'_>,
    index: usize,
    re: &mut [f32],
    im: &mut [f32],
) {
    let places = re.len();
    let Some(w) = w.part(index, index + places + N - 1) else {
        return;
    };
    let views = w.x.array_windows::<N>().zip(w.y.array_windows::<N>());
    for ((re, im), (u, v)) in re.iter_mut().zip(im.iter_mut()).zip(views) {
        // Both sums are kept in registers until all samples are in.
        let (mut real, mut imaginary) = (*re, *im);
        for k in 0..N {
            let [x, y] = z[k];
            real += x * u[k] + y * v[k];
            imaginary += x * v[k] - y * u[k];
        }
        (*re, *im) = (real, imaginary);
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
    /// `a = product / own`, and its inverse takes the view to the window. None where the residual is not below `limit`.
    fn fit(
        &self,
        shift: usize,
        product: [f64; 2],
        own: f64,
        mean: [f64; 2],
        stretch: f64,
        limit: f64,
    ) -> Option<Fit> {
        let square = product[0] * product[0] + product[1] * product[1];
        let theirs =
            self.squares - (self.sum[0] * self.sum[0] + self.sum[1] * self.sum[1]) / self.count;
        let growth = square / (own * own);
        if !(growth * stretch * stretch >= 1.0 && growth <= stretch * stretch) {
            return None;
        }
        let residual = ((theirs - square / own) / self.count).max(0.0);
        if residual >= limit {
            return None;
        }
        // 1 / a = own conj(product) / |product|^2
        let factor = [own * product[0] / square, -own * product[1] / square];
        let middle = times(factor, self.sum.map(|sum| sum / self.count));
        Some(Fit {
            shift,
            residual,
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
        if best
            .get(near)
            .is_some_and(|old| old.residual <= fit.residual)
        {
            return;
        }
        take_out(best, near);
    }
    keep(best, fit, |other| other.residual);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const HOW: Slide = Slide {
        places: usize::MAX,
        apart: 4,
        stretch: 1.3,
    };

    type Points = std::vec::Vec<[f64; 2]>;

    fn lists(points: &[[f64; 2]]) -> (std::vec::Vec<f32>, std::vec::Vec<f32>) {
        points.iter().map(|p| (p[0] as f32, p[1] as f32)).unzip()
    }

    /// A closed curve without symmetry, as complex harmonics of its arc.
    fn curve(count: usize, harmonics: &[(f64, f64)]) -> Points {
        (0..count)
            .map(|at| {
                let turn = at as f64 / count as f64 * 2.0 * core::f64::consts::PI;
                let mut point = [60.0 * libm::cos(turn), 60.0 * libm::sin(turn)];
                for (k, (size, phase)) in harmonics.iter().enumerate() {
                    let angle = (k + 2) as f64 * turn + phase;
                    point[0] += size * libm::cos(angle);
                    point[1] += size * libm::sin(angle);
                }
                point
            })
            .collect()
    }

    /// Oracle: least squares at one place from centred sums, without running anything along.
    fn naive(window: &[[f64; 2]], view: &[[f64; 2]]) -> (f64, [f64; 2]) {
        let count = window.len() as f64;
        let mean =
            |list: &[[f64; 2]]| [0, 1].map(|k| list.iter().map(|p| p[k]).sum::<f64>() / count);
        let (z, w) = (mean(window), mean(view));
        let (mut product, mut own, mut theirs) = ([0.0; 2], 0.0, 0.0);
        for (a, b) in window.iter().zip(view) {
            let (a, b) = ([a[0] - z[0], a[1] - z[1]], [b[0] - w[0], b[1] - w[1]]);
            product = [
                product[0] + a[0] * b[0] + a[1] * b[1],
                product[1] + a[0] * b[1] - a[1] * b[0],
            ];
            own += a[0] * a[0] + a[1] * a[1];
            theirs += b[0] * b[0] + b[1] * b[1];
        }
        let a = [product[0] / own, product[1] / own];
        ((theirs - own * (a[0] * a[0] + a[1] * a[1])) / count, a)
    }

    fn best_fits<const K: usize>(window: &[[f64; 2]], view: &[[f64; 2]]) -> Vec<Fit, K> {
        let ((zx, zy), (wx, wy)) = (lists(window), lists(view));
        let (mut re, mut im) = ([0.0; 64], [0.0; 64]);
        let mut sums = Sums {
            re: &mut re,
            im: &mut im,
        };
        let mut best = Vec::new();
        let (window, view) = (Samples { x: &zx, y: &zy }, Samples { x: &wx, y: &wy });
        let how = Slide { apart: 1, ..HOW };
        slide(window, view, &how, 1.0, &mut sums, &mut best);
        best
    }

    properties! {
        #[test]
        fn running_sums_give_what_each_place_gives_alone(
            harmonics in proptest::collection::vec((0.0..12.0f64, 0.0..6.0f64), 4),
            others in proptest::collection::vec((0.0..12.0f64, 0.0..6.0f64), 4)
        ) {
            let view = curve(60, &harmonics);
            let window = curve(60, &others)[5..30].to_vec();
            for fit in &best_fits::<40>(&window, &view) {
                let under = &view[fit.shift..fit.shift + window.len()];
                let (residual, a) = naive(&window, under);
                prop_assert!((fit.residual - residual).abs() < 0.01 + 1e-3 * residual);
                // The similarity given is the inverse of z -> a z + b.
                let unit = times(fit.similarity.factor, a);
                prop_assert!((unit[0] - 1.0).abs() < 1e-3 && unit[1].abs() < 1e-3);
            }
        }

        #[test]
        fn a_piece_is_found_where_it_was_cut_out(
            harmonics in proptest::collection::vec((3.0..12.0f64, 0.0..6.0f64), 4),
            shift in 0..30usize,
            turn in -3.0..3.0f64, grow in 0.85..1.15f64, x in -90.0..90.0f64, y in -90.0..90.0f64
        ) {
            let view = curve(60, &harmonics);
            let similarity = Similarity {
                factor: [grow * libm::cos(turn), grow * libm::sin(turn)],
                offset: [x, y],
            };
            let image = |p: &[f64; 2]| {
                let [u, v] = times(similarity.factor, *p);
                [u + x, v + y]
            };
            let window: Points = view[shift..shift + 28].iter().map(image).collect();
            let best = best_fits::<40>(&window, &view);
            // A short list is the head of a long one.
            prop_assert_eq!(&best_fits::<3>(&window, &view)[..], &best[..best.len().min(3)]);
            let fit = best.iter().find(|fit| fit.shift == shift).expect("among the best");
            prop_assert!(fit.residual < 0.01, "{}", fit.residual);
            prop_assert!(best[0].residual <= fit.residual);
            for k in 0..2 {
                prop_assert!((fit.similarity.factor[k] - similarity.factor[k]).abs() < 1e-3);
                prop_assert!((fit.similarity.offset[k] - similarity.offset[k]).abs() < 0.05);
            }
        }
    }

    #[test]
    fn what_is_too_short_or_too_large_fits_nowhere() {
        let view = curve(40, &[(9.0, 1.0)]);
        assert!(best_fits::<40>(&view[..2], &view).is_empty());
        assert!(best_fits::<40>(&curve(41, &[]), &view).is_empty());
        let large: Points = view[..20].iter().map(|p| p.map(|v| 1.5 * v)).collect();
        let fits = best_fits::<40>(&large, &view);
        assert!(
            fits.iter()
                .all(|fit| fit.similarity.scale() <= HOW.stretch + 1e-6)
        );
        assert!(fits.iter().all(|fit| fit.shift != 0));
        let point: Points = std::vec![[1.0, 1.0]; 9];
        assert!(best_fits::<40>(&point, &view).is_empty());
    }

    #[test]
    fn of_neighbours_the_better_stays() {
        let fit = |shift, residual| Fit {
            shift,
            residual,
            ..Fit::default()
        };
        let mut best: Vec<Fit, 2> = Vec::new();
        for (shift, residual) in [
            (10, 3.0),
            (12, 2.0),
            (9, 5.0),
            (30, 4.0),
            (50, 1.0),
            (70, 9.0),
        ] {
            insert(&mut best, fit(shift, residual), 4);
        }
        let kept: std::vec::Vec<_> = best.iter().map(|fit| fit.shift).collect();
        assert_eq!(kept, [50, 12]);
    }
}
