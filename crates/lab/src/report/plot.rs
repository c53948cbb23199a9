//! Diagrams of a report as SVG: a cost over an error, both logarithmic.
//!
//! Each diagram of a table is a row of panels, one for each problem; diagrams with one panel share
//! a row. In a panel, a method is a line of points, joined in the order of its parameter; bars are
//! the quartiles along both axes. Dots of later methods are smaller, so that no dot hides another. A
//! line of text names the methods of points that are not on the axes, such as errors of 0. The
//! description in the file contains the whole report as CSV, so a plot holds the same data as the
//! tables. The background is white, so that it looks the same on a light and on a dark page.
//!
//! Rejected: a charting library, which takes more code for quartiles along both axes. Rejected: the
//! parameter beside each point. It hides bars, and the table has it.

use std::fmt::{self, Write};

use super::{Diagram, Report, Spread, Table};
use cellcaster::color::Rgb;

/// The width of the page.
const WIDTH: f64 = 1200.0;
/// The height of a panel with its margins.
const PANEL_HEIGHT: f64 = 312.0;
/// The distance between lines of text.
const LINE: f64 = 18.0;
const MARGIN: f64 = 20.0;
/// The width of a character.
const CHARACTER: f64 = 8.0;

/// The margins of a panel.
const LEFT: f64 = 85.0;
const RIGHT: f64 = 15.0;
const TOP: f64 = 52.0;
const BOTTOM: f64 = 52.0;

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
    /// The names of both axes.
    names: [&'a str; 2],
    /// The index of the method and the values of each point on the axes.
    points: Vec<(usize, [Spread; 2])>,
    /// The methods of the other points.
    outside: Vec<&'a str>,
}

impl<'a> Panel<'a> {
    /// The panels of a diagram that contain points.
    fn all_of(table: &'a Table, diagram: &Diagram) -> Vec<Self> {
        let problems = table.distinct(0).into_iter();
        problems.filter_map(|problem| Self::new(table, diagram, problem)).collect()
    }

    /// The panel of `problem`; `None` if it has no points.
    fn new(table: &'a Table, diagram: &Diagram, problem: &'a str) -> Option<Self> {
        let range = diagram.range[0]..=diagram.range[1];
        let names = diagram.columns.map(|index| table.columns[index].as_str());
        let (mut points, mut outside) = (Vec::new(), Vec::new());
        // Lines join the points of a method, but a table may list them by parameter.
        for (index, method) in table.distinct(1).into_iter().enumerate() {
            let of_method = |keys: &[String; 3]| keys[0] == problem && keys[1] == method;
            for row in table.rows.iter().filter(|row| of_method(&row.keys)) {
                match diagram.point(row) {
                    Some(point) if range.contains(&point[0].median) && point[1].median > 0.0 => {
                        points.push((index, point));
                    }
                    Some(_) if outside.last() != Some(&method) => outside.push(method),
                    _ => {}
                }
            }
        }
        (!points.is_empty()).then_some(Self { problem, names, points, outside })
    }

    /// Draws the panel with its top left corner at `corner`.
    fn draw(&self, corner: Point, width: f64, page: &mut Page) {
        let (left, right) = (corner.0 + LEFT, corner.0 + width - RIGHT);
        let (top, bottom) = (corner.1 + TOP, corner.1 + PANEL_HEIGHT - BOTTOM);
        let values = |axis: usize| self.points.iter().map(move |(_, point)| point[axis]);
        let across = Axis::around(values(0), (left, right));
        let up = Axis::around(values(1), (bottom, top));
        page.text((left, top - LINE - 14.0), "start", self.problem);
        if !self.outside.is_empty() {
            let outside = format!("not on the axes: {}", self.outside.join(", "));
            page.text((left, top - 14.0), "start", &outside);
        }
        page.text((f64::midpoint(left, right), bottom + 2.0 * LINE), "middle", self.names[0]);
        page.upward_text((corner.0 + LINE, f64::midpoint(top, bottom)), self.names[1]);
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
        let at = |[x, y]: [Spread; 2]| (across.place(x.median), up.place(y.median));
        for pair in self.points.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            page.line(at(pair[0].1), at(pair[1].1), color(pair[0].0));
        }
        for &(method, [x, y]) in &self.points {
            let (place, color) = (at([x, y]), color(method));
            let [low, high] = [x.lower_quartile, x.upper_quartile].map(|it| across.place(it));
            page.line((low, place.1), (high, place.1), color);
            let [low, high] = [y.lower_quartile, y.upper_quartile].map(|it| up.place(it));
            page.line((place.0, low), (place.0, high), color);
            page.dot(place, radius(method), color);
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

    /// The axis between the powers of ten around the quartiles of `values`, whose medians are above 0.
    fn around(values: impl Iterator<Item = Spread>, ends: (f64, f64)) -> Self {
        let ends_of = |it: Spread| [it.lower_quartile.max(it.median / 10.0), it.upper_quartile];
        let powers = values.flat_map(ends_of).map(f64::log10);
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

    /// Adds a text that is read upwards, with its middle at the position.
    fn upward_text(&mut self, (x, y): Point, text: &str) {
        let text = escaped(text);
        self.add(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\" \
             transform=\"rotate(-90 {x:.1} {y:.1})\">{text}</text>\n"
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
