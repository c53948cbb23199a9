//! Plots: marks on a page, and two ways to put them into a file.
//!
//! Who draws a plot makes a list of marks; an SVG file and a picture in pixels each know how to put
//! marks down, and nothing of what they are about. Every page is white paper, so that it is read the
//! same on a bright page and on a dark one. A library for charts was refused: those that draw text into
//! pixels bring a font engine along.

mod png;
mod svg;

pub(super) use self::png::write as write_png;
pub(super) use self::svg::write as write_svg;
use crate::color::Rgb;

/// A page and what is on it; places are from its top left corner.
pub(super) struct Page {
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) marks: Vec<Mark>,
}

/// What is put on a page.
pub(super) enum Mark {
    /// A straight line.
    Line { from: (f64, f64), to: (f64, f64), ink: Ink },
    /// A point.
    Dot { at: (f64, f64), ink: Ink },
    /// Text that begins, is in the middle, or ends there; no character of it means anything to XML.
    Text { at: (f64, f64), align: Align, text: String },
}

/// The colour of a line or a dot. All but the first are as bright as each other, and bold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ink {
    /// What is hardly seen: of the lines behind a plot.
    Pale,
    Orange,
    Blue,
    Green,
    Gray,
}

impl Ink {
    fn color(self) -> Rgb {
        match self {
            Self::Pale => Rgb::new(0xdd, 0xdd, 0xdd),
            Self::Orange => Rgb::new(0xd0, 0x60, 0x10),
            Self::Blue => Rgb::new(0x30, 0x60, 0xa0),
            Self::Green => Rgb::new(0x2a, 0x80, 0x50),
            Self::Gray => Rgb::new(0x70, 0x70, 0x70),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Align {
    Start,
    Middle,
    End,
}

/// A logarithmic axis.
pub(super) struct Axis {
    /// The decimal logarithms of its ends.
    first: f64,
    last: f64,
}

impl Axis {
    /// From the least of `values`, which are above 0, to the greatest.
    pub(super) fn between(values: impl Iterator<Item = f64>) -> Self {
        // What a clock was too coarse for took next to nothing.
        let powers = values.map(|value| value.max(f64::MIN_POSITIVE).log10());
        let (first, last) = powers
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), power| {
                (low.min(power), high.max(power))
            });
        Self { first, last }
    }

    /// From one power of ten to another, around `values`, which are above 0.
    pub(super) fn around(values: impl Iterator<Item = f64>) -> Self {
        let Self { first, last } = Self::between(values);
        let first = first.floor();
        Self { first, last: last.ceil().max(first + 1.0) }
    }

    /// How far along the axis `value` is, from 0 to 1.
    pub(super) fn share(&self, value: f64) -> f64 {
        ((value.log10() - self.first) / (self.last - self.first)).clamp(0.0, 1.0)
    }

    /// The powers of ten to label, at most about `most` of them.
    pub(super) fn powers(&self, most: usize) -> impl Iterator<Item = i32> {
        let (first, last) = (self.first.ceil() as i32, self.last.floor() as i32);
        let step = ((last - first) as usize).div_ceil(most).max(1);
        (first..=last).step_by(step)
    }
}
