//! A plot of error over run time, both logarithmic, as an image or in characters.

mod text;

use std::io::{self, Write};

use crate::cli::plot::{self, Align, Axis, Mark, Page, PlotColor};
use crate::lab::accuracy::Report;

/// Writes the plot in characters.
pub(super) fn write_text(report: &Report, output: &mut impl Write) -> io::Result<()> {
    text::write(&Plot::of(report), output)
}

/// Writes the plot as an SVG file.
pub(super) fn write_svg(report: &Report, output: &mut impl Write) -> io::Result<()> {
    plot::write_svg(&Plot::of(report).page(), output)
}

/// Writes the plot as a PNG file.
pub(super) fn write_png(report: &Report, output: &mut impl Write) -> io::Result<()> {
    plot::write_png(&Plot::of(report).page(), output)
}

/// The width and the height of the page.
const PAGE: (f64, f64) = (960.0, 600.0);
/// The edges of the plot area.
const LEFT: f64 = 90.0;
const RIGHT: f64 = 930.0;
const TOP: f64 = 50.0;
const BOTTOM: f64 = 540.0;
/// The colour of the methods on the Pareto front, and of the line between them.
const FRONT: PlotColor = PlotColor::Orange;
const OTHERS: PlotColor = PlotColor::Blue;

/// A scatter plot of methods by time and error.
struct Plot {
    points: Vec<Point>,
    /// Nanoseconds for each ray.
    time: Axis,
    /// The root mean square of the relative error of the distance.
    error: Axis,
}

struct Point {
    label: String,
    time: f64,
    error: f64,
    is_on_front: bool,
}

/// The bounding box of a label or a dot.
#[derive(Clone, Copy)]
struct BoundingBox {
    left: f64,
    right: f64,
    middle: f64,
}

impl BoundingBox {
    /// The size of a character, in pixels.
    const CHARACTER: (f64, f64) = (8.0, 11.0);

    fn of_dot((x, y): (f64, f64)) -> Self {
        Self { left: x - 5.0, right: x + 5.0, middle: y }
    }

    /// The candidate positions for the label of a dot, best first.
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

impl Plot {
    fn of(report: &Report) -> Self {
        /// The position of methods without any error: below the rounding of a double.
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

    fn page(&self) -> Page {
        let mut marks = self.axes();
        marks.extend(self.front());
        let dots = || self.points.iter().map(|point| self.place(point.time, point.error));
        marks.extend(self.points.iter().zip(dots()).map(|(point, at)| Mark::Dot {
            at,
            color: if point.is_on_front { FRONT } else { OTHERS },
        }));
        let mut taken: Vec<BoundingBox> = dots().map(BoundingBox::of_dot).collect();
        for (point, dot) in self.points.iter().zip(dots()) {
            let places = BoundingBox::beside(dot, &point.label);
            let is_free =
                |candidate: &&BoundingBox| !taken.iter().any(|other| candidate.overlaps(other));
            let label = *places.iter().find(is_free).unwrap_or(&places[0]);
            taken.push(label);
            let at = (label.left, label.middle + 4.0);
            marks.push(Mark::Text { at, align: Align::Start, text: point.label.clone() });
        }
        Page { width: PAGE.0, height: PAGE.1, marks }
    }

    fn axes(&self) -> Vec<Mark> {
        const MOST_TICKS: usize = 9;
        let text = |at, align, text: &str| Mark::Text { at, align, text: text.to_owned() };
        let line = |from, to| Mark::Line { from, to, color: PlotColor::Pale };
        let mut marks = vec![
            text((LEFT, 28.0), Align::Start, "relative error of the distance (rms) over time"),
            text((RIGHT, 582.0), Align::End, "nanoseconds a ray"),
        ];
        for power in self.time.powers(MOST_TICKS) {
            let (x, _) = self.place(10_f64.powi(power), 1.0);
            marks.push(line((x, TOP), (x, BOTTOM)));
            marks.push(text((x, BOTTOM + 20.0), Align::Middle, &format!("1e{power}")));
        }
        for power in self.error.powers(MOST_TICKS) {
            let (_, y) = self.place(1.0, 10_f64.powi(power));
            marks.push(line((LEFT, y), (RIGHT, y)));
            marks.push(text((LEFT - 10.0, y + 4.0), Align::End, &format!("1e{power}")));
        }
        marks
    }

    /// The line between the points of the front.
    fn front(&self) -> Vec<Mark> {
        let mut front: Vec<(f64, f64)> = self
            .points
            .iter()
            .filter(|point| point.is_on_front)
            .map(|point| self.place(point.time, point.error))
            .collect();
        front.sort_by(|one, other| one.0.total_cmp(&other.0));
        let pairs = front.windows(2);
        pairs.map(|pair| Mark::Line { from: pair[0], to: pair[1], color: FRONT }).collect()
    }
}
