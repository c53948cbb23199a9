//! Plots as SVG: charts with logarithmic axes on a page.
//!
//! The background of every page is white, so that it looks the same on a light and on a dark page. Rejected: a charting
//! library. Labels that avoid each other and quartiles as bars take more code with one than without.

use std::fmt::{self, Write};

use cellcaster::color::Rgb;

/// A page that grows by marks. Positions are relative to the top left corner.
#[derive(Default)]
pub(crate) struct Page {
    marks: String,
}

/// A position on a page.
pub(crate) type Point = (f64, f64);

/// Almost white: for grid lines.
const PALE: Rgb = Rgb::new(0xdd, 0xdd, 0xdd);
// Colours with similar lightness and high chroma.
pub(crate) const ORANGE: Rgb = Rgb::new(0xd0, 0x60, 0x10);
pub(crate) const BLUE: Rgb = Rgb::new(0x30, 0x60, 0xa0);
pub(crate) const GREEN: Rgb = Rgb::new(0x2a, 0x80, 0x50);
pub(crate) const GRAY: Rgb = Rgb::new(0x70, 0x70, 0x70);
pub(crate) const PURPLE: Rgb = Rgb::new(0x90, 0x40, 0xa0);
pub(crate) const RED: Rgb = Rgb::new(0xc0, 0x30, 0x40);
pub(crate) const TEAL: Rgb = Rgb::new(0x10, 0x90, 0x98);

/// The side of a text at its position, in the words of SVG.
#[derive(Clone, Copy)]
pub(crate) enum Align {
    Start,
    Middle,
    End,
}

impl Page {
    /// The SVG file of this size. `description` is what is drawn in text, for programs and for readers who do not see; it
    /// may be empty.
    pub(crate) fn svg(&self, (width, height): (f64, f64), description: &str) -> String {
        let description = match description {
            "" => String::new(),
            text => format!("<desc>{}</desc>\n", escaped(text)),
        };
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"monospace\" font-size=\"13\">\n{description}\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.marks
        )
    }

    /// Adds a straight line.
    pub(crate) fn line(&mut self, from: Point, to: Point, color: Rgb) {
        let width = if color == PALE { 1 } else { 2 };
        self.add(format_args!(
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{color}\" \
             stroke-width=\"{width}\"/>\n",
            from.0, from.1, to.0, to.1
        ));
    }

    /// Adds a dot with a white edge, so that a smaller one before it is seen.
    pub(crate) fn dot(&mut self, (x, y): Point, radius: f64, color: Rgb) {
        self.add(format_args!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{color}\" stroke=\"#ffffff\"/>\n"
        ));
    }

    /// Adds a text.
    pub(crate) fn text(&mut self, (x, y): Point, align: Align, text: &str) {
        let anchor = match align {
            Align::Start => "start",
            Align::Middle => "middle",
            Align::End => "end",
        };
        let text = escaped(text);
        self.add(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{text}</text>\n"
        ));
    }

    fn add(&mut self, mark: fmt::Arguments<'_>) {
        self.marks.write_fmt(mark).expect("a string takes any text");
    }
}

/// `text` without the characters that are special in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// The area of a chart on a page, and its axes.
pub(crate) struct Chart {
    pub(crate) left: f64,
    pub(crate) right: f64,
    pub(crate) top: f64,
    pub(crate) bottom: f64,
    pub(crate) across: Axis,
    pub(crate) up: Axis,
}

impl Chart {
    /// The position of a pair of values.
    pub(crate) fn at(&self, (x, y): (f64, f64)) -> Point {
        (
            self.left + self.across.share(x) * (self.right - self.left),
            self.bottom - self.up.share(y) * (self.bottom - self.top),
        )
    }

    /// Adds a line of the grid upwards at `value`, with `label` at `distance` below it.
    pub(crate) fn tick_across(&self, value: f64, label: &str, distance: f64, page: &mut Page) {
        let (x, _) = self.at((value, 0.0));
        page.line((x, self.top), (x, self.bottom), PALE);
        page.text((x, self.bottom + distance), Align::Middle, label);
    }

    /// Adds a line of the grid across at `value`, with `label` on its left.
    pub(crate) fn tick_up(&self, value: f64, label: &str, page: &mut Page) {
        let (_, y) = self.at((0.0, value));
        page.line((self.left, y), (self.right, y), PALE);
        page.text((self.left - 8.0, y + 4.0), Align::End, label);
    }

    /// Adds dots that a line joins.
    pub(crate) fn series(&self, points: &[(f64, f64)], color: Rgb, page: &mut Page) {
        for pair in points.windows(2) {
            page.line(self.at(pair[0]), self.at(pair[1]), color);
        }
        for &point in points {
            page.dot(self.at(point), 5.0, color);
        }
    }
}

/// A logarithmic axis.
pub(crate) struct Axis {
    /// The decimal logarithms of the ends.
    first: f64,
    last: f64,
}

impl Axis {
    /// The greatest number of labelled powers of ten.
    const MOST_TICKS: usize = 6;

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
    fn share(&self, value: f64) -> f64 {
        ((value.log10() - self.first) / (self.last - self.first)).clamp(0.0, 1.0)
    }

    /// The values that are within the axis.
    pub(crate) fn within(&self, values: &[f64]) -> impl Iterator<Item = f64> {
        values.iter().copied().filter(|&value| 0.0 < self.share(value) && self.share(value) < 1.0)
    }

    /// Some powers of ten to label.
    pub(crate) fn powers(&self) -> impl Iterator<Item = i32> + use<> {
        let (first, last) = (self.first.ceil() as i32, self.last.floor() as i32);
        let step = ((last - first) as usize).div_ceil(Self::MOST_TICKS).max(1);
        (first..=last).step_by(step)
    }
}
