//! Diagrams of a report as SVG: an error over a cost, both logarithmic.
//!
//! Each diagram of a table is a row of panels, one for each problem; diagrams with one panel share
//! a row. In a panel, a method is a line of points, joined in the order of its parameter; bars are
//! the quartiles of times. Dots of later methods are smaller, so that no dot hides another. The
//! description in the file contains the whole report as CSV, so a plot holds the same data as the
//! tables. The background is white, so that it looks the same on a light and on a dark page.
//!
//! Rejected: a charting library. Labels that avoid each other, and quartiles as bars, take more
//! code with a library than without.

use std::fmt::{self, Write};

use super::{Diagram, Report, Table, Value};
use cellcaster::color::Rgb;

/// The width of the page.
const WIDTH: f64 = 1200.0;
/// The height of a panel with its margins.
const PANEL_HEIGHT: f64 = 300.0;
/// The distance between lines of text.
const LINE: f64 = 18.0;
const MARGIN: f64 = 20.0;
/// The width of a character.
const CHARACTER: f64 = 8.0;

/// The margins of a panel.
const LEFT: f64 = 70.0;
const RIGHT: f64 = 15.0;
const TOP: f64 = 52.0;
const BOTTOM: f64 = 40.0;

/// The colours of methods, in the order of the table. They have similar lightness and high chroma.
const COLORS: [Rgb; 7] = [
    Rgb::new(0xd0, 0x60, 0x10),
    Rgb::new(0x30, 0x60, 0xa0),
    Rgb::new(0x10, 0x90, 0x98),
    Rgb::new(0x2a, 0x80, 0x50),
    Rgb::new(0x90, 0x40, 0xa0),
    Rgb::new(0xc0, 0x30, 0x40),
    Rgb::new(0x70, 0x70, 0x70),
];
/// The colour of grid lines, almost white.
const PALE: Rgb = Rgb::new(0xdd, 0xdd, 0xdd);

/// The diagrams as an SVG file.
pub(crate) fn svg(report: &Report) -> String {
    let mut page = Page::default();
    let mut y = MARGIN;
    for table in report.tables.iter().filter(|table| !table.diagrams.is_empty()) {
        y = put_heading(table, y, &mut page);
        let diagrams = table.diagrams.iter().map(|diagram| Panel::all_of(table, diagram));
        let (single, several): (Vec<_>, Vec<_>) = diagrams.partition(|panels| panels.len() == 1);
        for panels in several {
            y = put_panels(&panels, y, &mut page);
        }
        let single: Vec<_> = single.into_iter().flatten().collect();
        y = put_panels(&single, y, &mut page);
    }
    for (name, value) in report.origin.parts() {
        y += LINE;
        page.text((MARGIN, y), "start", &format!("{name}: {value}"));
    }
    page.svg((WIDTH, y + MARGIN), &report.csv())
}

/// Adds the title of a table and the legend of its methods. Returns the position below.
fn put_heading(table: &Table, mut y: f64, page: &mut Page) -> f64 {
    for line in format!("{}: {}.", table.name, table.title).lines() {
        page.text((MARGIN, y), "start", line);
        y += LINE;
    }
    let mut x = MARGIN;
    for (index, method) in table.distinct(1).into_iter().enumerate() {
        page.dot((x + 5.0, y - 4.0), radius(index), color(index));
        x += 2.0 * CHARACTER;
        page.text((x, y), "start", method);
        x += CHARACTER * (method.chars().count() + 2) as f64;
    }
    y + LINE
}

/// Puts panels side by side. Returns the position below.
fn put_panels(panels: &[Panel<'_>], mut y: f64, page: &mut Page) -> f64 {
    // Four panels in two rows are easier to compare than three in one row and one below.
    let columns = if matches!(panels.len(), 1 | 2 | 4) { 2 } else { 3 };
    let width = WIDTH / columns as f64;
    for row in panels.chunks(columns) {
        for (column, panel) in row.iter().enumerate() {
            panel.draw((width * column as f64, y), width, page);
        }
        y += PANEL_HEIGHT;
    }
    y
}

/// The diagram of one problem.
struct Panel<'a> {
    problem: &'a str,
    title: String,
    points: Vec<Sample<'a>>,
}

struct Sample<'a> {
    /// The index of the method.
    method: usize,
    parameter: &'a str,
    cost: f64,
    /// The quartiles, if the cost is a time.
    quartiles: Option<(f64, f64)>,
    error: f64,
}

impl<'a> Panel<'a> {
    /// The panels of a diagram that contain points.
    fn all_of(table: &'a Table, diagram: &Diagram) -> Vec<Self> {
        let problems = table.distinct(0).into_iter();
        problems.filter_map(|problem| Self::new(table, diagram, problem)).collect()
    }

    /// The panel of `problem`; `None` if it has no points.
    fn new(table: &'a Table, diagram: &Diagram, problem: &'a str) -> Option<Self> {
        let methods = table.distinct(1);
        let rows = table.rows.iter().filter(|row| row.keys[0] == problem);
        let mut points: Vec<Sample> = rows
            .filter_map(|row| {
                let (cost, error) = diagram.point(row)?;
                let quartiles = match row.values[diagram.columns[0]] {
                    Value::Time(timing) => Some((timing.lower_quartile, timing.upper_quartile)),
                    _ => None,
                };
                let method = methods.iter().position(|method| *method == row.keys[1])?;
                Some(Sample { method, parameter: &row.keys[2], cost, quartiles, error })
            })
            .collect();
        // Lines join the points of a method, but a table may list them by parameter.
        points.sort_by_key(|point| point.method);
        let [across, up] = diagram.columns.map(|index| &table.columns[index]);
        let title = format!("{up} over {across}");
        (!points.is_empty()).then_some(Self { problem, title, points })
    }

    /// Draws the panel with its top left corner at `corner`.
    fn draw(&self, corner: Point, width: f64, page: &mut Page) {
        let (left, right) = (corner.0 + LEFT, corner.0 + width - RIGHT);
        let (top, bottom) = (corner.1 + TOP, corner.1 + PANEL_HEIGHT - BOTTOM);
        let across = Axis::around(self.points.iter().map(|point| point.cost), (left, right));
        let up = Axis::around(self.points.iter().map(|point| point.error), (bottom, top));
        page.text((left, top - LINE - 14.0), "start", self.problem);
        page.text((left, top - 14.0), "start", &self.title);
        for power in across.powers() {
            let x = across.place(10_f64.powi(power));
            page.line((x, top), (x, bottom), PALE);
            page.text((x, bottom + LINE), "middle", &format!("1e{power}"));
        }
        for power in up.powers() {
            let y = up.place(10_f64.powi(power));
            page.line((left, y), (right, y), PALE);
            page.text((left - 8.0, y + 4.0), "end", &format!("1e{power}"));
        }
        let at = |point: &Sample| (across.place(point.cost), up.place(point.error));
        for pair in self.points.windows(2).filter(|pair| pair[0].method == pair[1].method) {
            page.line(at(&pair[0]), at(&pair[1]), color(pair[0].method));
        }
        for point in &self.points {
            if let Some((lower, upper)) = point.quartiles {
                let y = up.place(point.error);
                page.line((across.place(lower), y), (across.place(upper), y), color(point.method));
            }
            page.dot(at(point), radius(point.method), color(point.method));
        }
        let labels = self.points.iter().map(|point| (at(point), point.parameter));
        put_labels(labels, (corner.0 + width, top), page);
    }
}

/// Adds labels to points, left of `right` and below `top`. Labels that would overlap dots or each
/// other are left out.
fn put_labels<'a>(
    points: impl Iterator<Item = (Point, &'a str)> + Clone,
    (right, top): Point,
    page: &mut Page,
) {
    const HEIGHT: f64 = 12.0;
    const GAP: f64 = 9.0;
    /// Left, right and middle.
    type Extent = (f64, f64, f64);
    let overlap = |one: &Extent, other: &Extent| {
        one.0 < other.1 && other.0 < one.1 && (one.2 - other.2).abs() < HEIGHT
    };
    let mut taken: Vec<Extent> = points.clone().map(|((x, y), _)| (x - GAP, x + GAP, y)).collect();
    for (own, ((x, y), label)) in points.enumerate().filter(|(_, (_, label))| !label.is_empty()) {
        let width = CHARACTER * label.chars().count() as f64;
        let lefts = [x + GAP, x - GAP - width, x - width / 2.0];
        let mut candidates = [0.0, -14.0, 14.0]
            .into_iter()
            .flat_map(|below| lefts.map(|left| (left, left + width, y + below)));
        let is_free = |candidate: &Extent| {
            let mut others = taken.iter().enumerate();
            candidate.1 < right
                && candidate.2 >= top
                && others.all(|(index, other)| index == own || !overlap(candidate, other))
        };
        if let Some(place) = candidates.find(is_free) {
            taken.push(place);
            page.text((place.0, place.2 + 4.0), "start", label);
        }
    }
}

fn color(method: usize) -> Rgb {
    COLORS[method % COLORS.len()]
}

fn radius(method: usize) -> f64 {
    const MAX: f64 = 8.0;
    (MAX - method as f64).max(2.0)
}

/// A logarithmic axis.
struct Axis {
    /// The powers of ten at both ends.
    first: f64,
    last: f64,
    /// The positions of both ends on the page.
    ends: (f64, f64),
}

impl Axis {
    /// The largest number of labelled powers of ten.
    const MAX_TICKS: usize = 6;

    /// The axis between the powers of ten around `values`, which are not negative.
    fn around(values: impl Iterator<Item = f64>, ends: (f64, f64)) -> Self {
        // A time below the clock's resolution is 0.
        let powers = values.map(|value| value.max(f64::MIN_POSITIVE).log10());
        let (low, high) = powers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), power| {
            (low.min(power), high.max(power))
        });
        let first = low.floor();
        Self { first, last: high.ceil().max(first + 1.0), ends }
    }

    /// The position of `value` on the page.
    fn place(&self, value: f64) -> f64 {
        let share = ((value.log10() - self.first) / (self.last - self.first)).clamp(0.0, 1.0);
        self.ends.0 + share * (self.ends.1 - self.ends.0)
    }

    /// The powers of ten to label.
    fn powers(&self) -> impl Iterator<Item = i32> + use<> {
        let (first, last) = (self.first as i32, self.last as i32);
        (first..=last).step_by(((last - first) as usize).div_ceil(Self::MAX_TICKS).max(1))
    }
}

/// A position on a page, relative to the top left corner.
type Point = (f64, f64);

/// A page, to which marks are added.
#[derive(Default)]
struct Page {
    marks: String,
}

impl Page {
    /// The SVG file of this size. `description` is for programs and for readers who cannot see.
    fn svg(&self, (width, height): (f64, f64), description: &str) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"monospace\" font-size=\"13\">\n<desc>{}</desc>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            escaped(description),
            self.marks
        )
    }

    /// Adds a straight line.
    fn line(&mut self, from: Point, to: Point, color: Rgb) {
        let width = if color == PALE { 1 } else { 2 };
        self.add(format_args!(
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{color}\" \
             stroke-width=\"{width}\"/>\n",
            from.0, from.1, to.0, to.1
        ));
    }

    /// Adds a dot with a white edge, so that it stays visible over a larger dot.
    fn dot(&mut self, (x, y): Point, radius: f64, color: Rgb) {
        self.add(format_args!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{color}\" stroke=\"#ffffff\"/>\n"
        ));
    }

    /// Adds a text, whose `anchor` (`start`, `middle` or `end`) is at the position.
    fn text(&mut self, (x, y): Point, anchor: &str, text: &str) {
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
