//! Axes of a plot: from numbers to places in a drawing.

use crate::drawing::{Anchor, BLACK, Colour, Drawing, Stroke};

/// One axis: from numbers to places in the drawing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) step: f64,
}

impl Scale {
    /// An axis over numbers, ended at marks, some `marks` of them. Without numbers it is one from 0 to 1.
    pub(crate) fn over(values: impl Iterator<Item = f64>, marks: f64, from: f64, to: f64) -> Self {
        let known = values.filter(|value| value.is_finite());
        let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let step = step_for((high - low).max(1e-3) / marks);
        let (first, last) = ((low / step).floor(), (high / step).ceil());
        let last = if last > first { last } else { first + 1.0 };
        Self {
            low: first * step,
            high: last * step,
            from,
            to,
            step,
        }
    }

    /// An axis from the one number to the other, with some `marks` marks between them.
    #[cfg(feature = "png")]
    pub(crate) fn between([low, high]: [f64; 2], marks: f64, from: f64, to: f64) -> Self {
        Self {
            low,
            high,
            from,
            to,
            step: step_for((high - low).max(1e-3) / marks),
        }
    }

    pub(crate) fn at(&self, value: f64) -> f64 {
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    pub(crate) fn marks(&self) -> impl Iterator<Item = (f64, String)> {
        // As many as tell its marks apart.
        let places = (-self.step.log10().floor()).clamp(0.0, 9.0) as usize;
        let Self { step, .. } = *self;
        // Ends that are marks themselves are so up to rounding.
        let first = (self.low / step - 1e-6).ceil() as i32;
        let last = (self.high / step + 1e-6).floor() as i32;
        (first..=last).map(move |k| {
            let value = f64::from(k) * step;
            let value = if value.abs() < 1e-9 { 0.0 } else { value };
            (value, format!("{value:.places$}").replace('-', "\u{2212}"))
        })
    }
}

/// The next of 1, 2 and 5 times a power of ten.
fn step_for(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0];
    let next = steps.into_iter().find(|step| step * power >= 0.999 * least);
    next.unwrap_or(10.0) * power
}

/// A plot: two axes and the frame they span.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plot {
    pub(crate) x: Scale,
    pub(crate) y: Scale,
}

impl Plot {
    pub(crate) fn place(&self, x: f64, y: f64) -> [f64; 2] {
        [self.x.at(x), self.y.at(y)]
    }

    /// Axes with marks and labels; `below` says whether the numbers of the x axis are written. The label beside may have two lines.
    pub(crate) fn axes(&self, drawing: &mut Drawing, labels: [&str; 2], below: bool) {
        const INK: Stroke = Stroke::of(BLACK, 0.8);
        let (left, right, bottom, top) = (self.x.from, self.x.to, self.y.from, self.y.to);
        drawing.open("axes");
        if self.y.low < 0.0 && self.y.high > 0.0 {
            let zero = self.y.at(0.0);
            let pale = Stroke::of(Colour::grey(0xbb), 0.6);
            drawing.line(&[[left, zero], [right, zero]], pale);
        }
        drawing.line(&[[left, top], [left, bottom], [right, bottom]], INK);
        for (value, text) in self.x.marks() {
            let x = self.x.at(value);
            drawing.line(&[[x, bottom], [x, bottom + 4.0]], INK);
            if below {
                drawing.words([x, bottom + 16.0], Anchor::Middle, 11.0, text);
            }
        }
        for (value, text) in self.y.marks() {
            let y = self.y.at(value);
            drawing.line(&[[left - 4.0, y], [left, y]], INK);
            drawing.words([left - 7.0, y + 4.0], Anchor::End, 11.0, text);
        }
        if below {
            let middle = (left + right) / 2.0;
            drawing.words([middle, bottom + 33.0], Anchor::Middle, 12.0, labels[0]);
        }
        let middle = (top + bottom) / 2.0;
        for (line, text) in labels[1].rsplit('\n').enumerate() {
            let x = left - 36.0 - 14.0 * line as f64;
            drawing.upwards([x, middle], 12.0, text);
        }
        drawing.close();
    }
}
