//! Plots: marks on a page, and two file formats to write them in.
//!
//! A plot is a list of marks. The SVG writer and the PNG writer draw marks without knowing their
//! meaning. The background of every page is white, so that it looks the same on a light and on a
//! dark page. A charting library was refused: those that draw text into pixels include a font
//! engine.

mod png;
mod svg;

pub(crate) use self::png::write as write_png;
pub(crate) use self::svg::write as write_svg;
use cellcaster::color::Rgb;

/// A page and its marks. Positions are relative to the top left corner.
pub(crate) struct Page {
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) marks: Vec<Mark>,
    /// What is drawn, in text, for programs and for readers who do not see. It may be empty.
    pub(crate) description: String,
}

/// A mark on a page.
pub(crate) enum Mark {
    /// A straight line.
    Line { from: (f64, f64), to: (f64, f64), color: PlotColor },
    /// A point with a white edge, so that a smaller one before it is seen.
    Dot { at: (f64, f64), radius: f64, color: PlotColor },
    /// Text that starts, is centered, or ends at a point.
    Text { at: (f64, f64), align: Align, text: String },
}

/// The colour of a line or a dot. All but the first have similar lightness and high chroma.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlotColor {
    /// Almost white: for grid lines.
    Pale,
    Orange,
    Blue,
    Green,
    Gray,
    Purple,
    Red,
    Teal,
}

impl PlotColor {
    fn rgb(self) -> Rgb {
        match self {
            Self::Pale => Rgb::new(0xdd, 0xdd, 0xdd),
            Self::Orange => Rgb::new(0xd0, 0x60, 0x10),
            Self::Blue => Rgb::new(0x30, 0x60, 0xa0),
            Self::Green => Rgb::new(0x2a, 0x80, 0x50),
            Self::Gray => Rgb::new(0x70, 0x70, 0x70),
            Self::Purple => Rgb::new(0x90, 0x40, 0xa0),
            Self::Red => Rgb::new(0xc0, 0x30, 0x40),
            Self::Teal => Rgb::new(0x10, 0x90, 0x98),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Align {
    Start,
    Middle,
    End,
}

/// A logarithmic axis.
pub(crate) struct Axis {
    /// The decimal logarithms of the ends.
    first: f64,
    last: f64,
}

impl Axis {
    /// The axis from the least to the greatest of `values`, which must be positive.
    pub(crate) fn between(values: impl Iterator<Item = f64>) -> Self {
        // A time below the clock's resolution is 0.
        let powers = values.map(|value| value.max(f64::MIN_POSITIVE).log10());
        let (first, last) = powers
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), power| {
                (low.min(power), high.max(power))
            });
        Self { first, last }
    }

    /// The axis between the powers of ten around `values`, which must be positive.
    pub(crate) fn around(values: impl Iterator<Item = f64>) -> Self {
        let Self { first, last } = Self::between(values);
        let first = first.floor();
        Self { first, last: last.ceil().max(first + 1.0) }
    }

    /// The position of `value` along the axis, from 0 to 1.
    pub(crate) fn share(&self, value: f64) -> f64 {
        ((value.log10() - self.first) / (self.last - self.first)).clamp(0.0, 1.0)
    }

    /// About `most` powers of ten to label.
    pub(crate) fn powers(&self, most: usize) -> impl Iterator<Item = i32> {
        let (first, last) = (self.first.ceil() as i32, self.last.floor() as i32);
        let step = ((last - first) as usize).div_ceil(most).max(1);
        (first..=last).step_by(step)
    }
}
