//! Error over run time, both logarithmic: one drawing, three ways to put it on a page.
//!
//! The drawing is a list of marks on a page of its own, made once; an SVG file, a picture in pixels
//! and a terminal each know how to put marks down, and nothing of methods. A library for charts was
//! refused: those that draw text into pixels bring a font engine along.

mod png;
mod svg;
mod text;

use std::io::{self, Write};

use crate::accuracy::Report;

/// Writes the plot in characters.
pub(super) fn write_text(report: &Report, output: &mut impl Write) -> io::Result<()> {
    text::write(&Plot::of(report), output)
}

/// Writes the plot as an SVG file.
pub(super) fn write_svg(report: &Report, output: &mut impl Write) -> io::Result<()> {
    svg::write(&Plot::of(report).marks(), output)
}

/// Writes the plot as a PNG file.
pub(super) fn write_png(report: &Report, output: &mut impl Write) -> io::Result<()> {
    png::write(&Plot::of(report).marks(), output)
}

/// Width and height of the page.
const PAGE: (f64, f64) = (960.0, 600.0);
/// Where the axes are on it.
const LEFT: f64 = 90.0;
const RIGHT: f64 = 930.0;
const TOP: f64 = 50.0;
const BOTTOM: f64 = 540.0;

/// Methods by time and error.
struct Plot {
    points: Vec<Point>,
    /// Nanoseconds a ray.
    time: Axis,
    /// Root mean square of the relative error of the distance.
    error: Axis,
}

struct Point {
    label: String,
    time: f64,
    error: f64,
    is_on_front: bool,
}

/// A logarithmic axis, from one power of ten to another.
struct Axis {
    first: i32,
    last: i32,
}

/// What is put on a page; places are from its top left corner.
enum Mark {
    /// A straight line, of the axes and their grid, or of the front.
    Line { from: (f64, f64), to: (f64, f64), is_front: bool },
    /// A point.
    Dot { at: (f64, f64), is_front: bool },
    /// Text that begins, is in the middle, or ends there.
    Text { at: (f64, f64), align: Align, text: String },
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Align {
    Start,
    Middle,
    End,
}

/// The part of a line of text, or the dot, that something takes up.
#[derive(Clone, Copy)]
struct Span {
    left: f64,
    right: f64,
    middle: f64,
}

impl Span {
    /// Pixels of a character, from left to right and from top to bottom.
    const CHARACTER: (f64, f64) = (8.0, 11.0);

    fn of_dot((x, y): (f64, f64)) -> Self {
        Self { left: x - 5.0, right: x + 5.0, middle: y }
    }

    /// Where the label of a dot may go, the best place first.
    fn beside((x, y): (f64, f64), label: &str) -> [Self; 6] {
        const GAP: f64 = 9.0;
        let width = Self::CHARACTER.0 * label.chars().count() as f64;
        let (right, left, line) = (x + GAP, x - GAP - width, 14.0);
        [
            (right, y),
            (left, y),
            (right, y - line),
            (right, y + line),
            (left, y - line),
            (left, y + line),
        ]
        .map(|(left, middle)| Self { left, right: left + width, middle })
    }

    fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && (self.middle - other.middle).abs() < Self::CHARACTER.1
    }
}

impl Axis {
    /// The powers of ten around `values`, which are above 0.
    fn around(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value.log10()), high.max(value.log10()))
        });
        let first = low.floor() as i32;
        Self { first, last: (high.ceil() as i32).max(first + 1) }
    }

    /// How far along the axis `value` is, from 0 to 1.
    fn share(&self, value: f64) -> f64 {
        let share = (value.log10() - f64::from(self.first)) / f64::from(self.last - self.first);
        share.clamp(0.0, 1.0)
    }

    /// The powers of ten to label, at most about `most` of them.
    fn ticks(&self, most: usize) -> impl Iterator<Item = i32> {
        let step = ((self.last - self.first) as usize).div_ceil(most).max(1);
        (self.first..=self.last).step_by(step)
    }
}

impl Plot {
    fn of(report: &Report) -> Self {
        /// Where no error at all is drawn: below the rounding of a double.
        const LEAST_ERROR: f64 = 1e-18;
        let points: Vec<Point> = report
            .rows
            .iter()
            .map(|row| Point {
                label: row.method.clone(),
                time: row.timing.median.max(0.1),
                error: row.errors.mean_distance.max(LEAST_ERROR),
                is_on_front: row.is_on_front,
            })
            .collect();
        let time = Axis::around(points.iter().map(|point| point.time));
        let error = Axis::around(points.iter().map(|point| point.error));
        Self { points, time, error }
    }

    fn place(&self, time: f64, error: f64) -> (f64, f64) {
        let x = LEFT + self.time.share(time) * (RIGHT - LEFT);
        let y = BOTTOM - self.error.share(error) * (BOTTOM - TOP);
        (x, y)
    }

    fn marks(&self) -> Vec<Mark> {
        let mut marks = self.axes();
        marks.extend(self.front());
        let dots = || self.points.iter().map(|point| self.place(point.time, point.error));
        marks.extend(
            self.points
                .iter()
                .zip(dots())
                .map(|(point, at)| Mark::Dot { at, is_front: point.is_on_front }),
        );
        let mut taken: Vec<Span> = dots().map(Span::of_dot).collect();
        for (point, dot) in self.points.iter().zip(dots()) {
            let places = Span::beside(dot, &point.label);
            let is_free = |span: &&Span| !taken.iter().any(|other| span.overlaps(other));
            let span = *places.iter().find(is_free).unwrap_or(&places[0]);
            taken.push(span);
            let at = (span.left, span.middle + 4.0);
            marks.push(Mark::Text { at, align: Align::Start, text: point.label.clone() });
        }
        marks
    }

    fn axes(&self) -> Vec<Mark> {
        const MOST_TICKS: usize = 9;
        let text = |at, align, text: &str| Mark::Text { at, align, text: text.to_owned() };
        let line = |from, to| Mark::Line { from, to, is_front: false };
        let mut marks = vec![
            text((LEFT, 28.0), Align::Start, "relative error of the distance (rms) over time"),
            text((RIGHT, 582.0), Align::End, "nanoseconds a ray"),
        ];
        for power in self.time.ticks(MOST_TICKS) {
            let (x, _) = self.place(10_f64.powi(power), 1.0);
            marks.push(line((x, TOP), (x, BOTTOM)));
            marks.push(text((x, BOTTOM + 20.0), Align::Middle, &format!("1e{power}")));
        }
        for power in self.error.ticks(MOST_TICKS) {
            let (_, y) = self.place(1.0, 10_f64.powi(power));
            marks.push(line((LEFT, y), (RIGHT, y)));
            marks.push(text((LEFT - 10.0, y + 4.0), Align::End, &format!("1e{power}")));
        }
        marks
    }

    /// The line from point to point of the front.
    fn front(&self) -> Vec<Mark> {
        let mut front: Vec<(f64, f64)> = self
            .points
            .iter()
            .filter(|point| point.is_on_front)
            .map(|point| self.place(point.time, point.error))
            .collect();
        front.sort_by(|one, other| one.0.total_cmp(&other.0));
        let pairs = front.windows(2);
        pairs.map(|pair| Mark::Line { from: pair[0], to: pair[1], is_front: true }).collect()
    }
}
