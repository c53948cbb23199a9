//! Work-precision diagrams of the report: an error over a cost, both logarithmic.
//!
//! Each diagram of a table is a row of panels, one for each problem. In a panel, a method is a line
//! of points, joined in the order of its parameter; bars are the quartiles of times. Dots of later
//! methods are smaller, so that none hides another. The description of the file has the whole report
//! as CSV, so that a plot holds what the tables hold.

use super::formats::{csv, heading};
use super::run::Run;
use crate::accuracy::{Diagram, Table, Value};
use crate::cli::plot::{
    Align, Axis, BLUE, Chart, GRAY, GREEN, ORANGE, PURPLE, Page, Point, RED, TEAL,
};
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

/// The colours of methods, in the order of the table.
const COLORS: [Rgb; 7] = [ORANGE, BLUE, TEAL, GREEN, PURPLE, RED, GRAY];

/// The plots as an SVG file.
pub(crate) fn svg(run: &Run, tables: &[Table]) -> String {
    let mut page = Page::default();
    let mut y = MARGIN;
    for table in tables.iter().filter(|table| !table.diagrams.is_empty()) {
        y = put_heading(table, y, &mut page);
        for diagram in &table.diagrams {
            y = put_diagram(table, diagram, y, &mut page);
        }
    }
    for (name, value) in run.parts() {
        y += LINE;
        page.text((MARGIN, y), Align::Start, &format!("{name}: {value}"));
    }
    page.svg((WIDTH, y + MARGIN), &csv(run, tables))
}

/// The title of a table and the legend of its methods. Returns the position below.
fn put_heading(table: &Table, mut y: f64, page: &mut Page) -> f64 {
    page.text((MARGIN, y), Align::Start, &format!("{}: {}.", table.name, table.title));
    y += LINE;
    let mut x = MARGIN;
    for (index, method) in methods(table).into_iter().enumerate() {
        page.dot((x + 5.0, y - 4.0), radius(index), color(index));
        x += 2.0 * CHARACTER;
        page.text((x, y), Align::Start, method);
        x += CHARACTER * (method.chars().count() + 2) as f64;
    }
    y + LINE
}

/// The panels of a diagram that have points. Returns the position below.
fn put_diagram(table: &Table, diagram: &Diagram, mut y: f64, page: &mut Page) -> f64 {
    let panels: Vec<Panel> = table
        .problems()
        .into_iter()
        .filter_map(|problem| Panel::new(table, diagram, problem))
        .collect();
    // Two rows of two are easier to compare than one of three and one more.
    let columns = if panels.len() == 4 { 2 } else { 3 };
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
struct Panel {
    problem: String,
    title: String,
    points: Vec<Sample>,
}

struct Sample {
    /// The index of the method.
    method: usize,
    parameter: String,
    cost: f64,
    /// The quartiles, if the cost is a time.
    quartiles: Option<(f64, f64)>,
    error: f64,
}

impl Panel {
    /// The panel of `problem`; `None` if it has no points.
    fn new(table: &Table, diagram: &Diagram, problem: &str) -> Option<Self> {
        let methods = methods(table);
        let rows = table.rows.iter().filter(|row| row.keys[0] == problem);
        let mut points: Vec<Sample> = rows
            .filter_map(|row| {
                let (cost, error) = diagram.point(row)?;
                let quartiles = match row.values[diagram.columns[0]] {
                    Value::Time(timing) => Some((timing.lower_quartile, timing.upper_quartile)),
                    _ => None,
                };
                let method = methods.iter().position(|method| *method == row.keys[1])?;
                Some(Sample { method, parameter: row.keys[2].clone(), cost, quartiles, error })
            })
            .collect();
        // Lines join the points of a method, which a table may list by parameter.
        points.sort_by_key(|point| point.method);
        let (problem, title) = (problem.to_owned(), title(table, diagram));
        (!points.is_empty()).then_some(Self { problem, title, points })
    }

    /// Draws the panel with its top left corner at `corner`.
    fn draw(&self, corner: Point, width: f64, page: &mut Page) {
        let chart = Chart {
            left: corner.0 + LEFT,
            right: corner.0 + width - RIGHT,
            top: corner.1 + TOP,
            bottom: corner.1 + PANEL_HEIGHT - BOTTOM,
            across: Axis::around(self.points.iter().map(|point| point.cost)),
            up: Axis::around(self.points.iter().map(|point| point.error)),
        };
        page.text((chart.left, chart.top - LINE - 14.0), Align::Start, &self.problem);
        page.text((chart.left, chart.top - 14.0), Align::Start, &self.title);
        for power in chart.across.powers() {
            chart.tick_across(10_f64.powi(power), &format!("1e{power}"), LINE, page);
        }
        for power in chart.up.powers() {
            chart.tick_up(10_f64.powi(power), &format!("1e{power}"), page);
        }
        let at = |point: &Sample| chart.at((point.cost, point.error));
        for pair in self.points.windows(2).filter(|pair| pair[0].method == pair[1].method) {
            page.line(at(&pair[0]), at(&pair[1]), color(pair[0].method));
        }
        for point in &self.points {
            if let Some((lower, upper)) = point.quartiles {
                let [from, to] = [lower, upper].map(|cost| chart.at((cost, point.error)));
                page.line(from, to, color(point.method));
            }
            page.dot(at(point), radius(point.method), color(point.method));
        }
        let labels = self.points.iter().map(|point| (at(point), point.parameter.as_str()));
        put_labels(labels, (corner.0 + width, chart.top), page);
    }
}

/// The labels of points where they overlap neither dots nor each other, left of `right` and below `top`; the
/// others are left out.
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
    for (own, ((x, y), label)) in points.enumerate() {
        let width = CHARACTER * label.chars().count() as f64;
        let lefts = [x + GAP, x - GAP - width, x - width / 2.0];
        let candidates = [0.0, -14.0, 14.0]
            .into_iter()
            .flat_map(|below| lefts.map(|left| (left, left + width, y + below)));
        let is_free = |candidate: &Extent| {
            let others = taken.iter().enumerate();
            candidate.1 < right
                && candidate.2 >= top
                && others
                    .into_iter()
                    .all(|(index, other)| index == own || !overlap(candidate, other))
        };
        let place = candidates.skip(usize::from(label.is_empty()) * 9).find(is_free);
        if let Some(place) = place {
            taken.push(place);
            page.text((place.0, place.2 + 4.0), Align::Start, label);
        }
    }
}

/// The methods of `table`, in order.
fn methods(table: &Table) -> Vec<&str> {
    let mut methods: Vec<&str> = Vec::new();
    for row in &table.rows {
        if !methods.contains(&row.keys[1].as_str()) {
            methods.push(&row.keys[1]);
        }
    }
    methods
}

fn color(method: usize) -> Rgb {
    COLORS[method % COLORS.len()]
}

fn radius(method: usize) -> f64 {
    const LARGEST: f64 = 8.0;
    (LARGEST - method as f64).max(2.0)
}

/// What a diagram shows, as in `distance, relative over time, ns a ray`.
fn title(table: &Table, diagram: &Diagram) -> String {
    let [across, up] = diagram.columns.map(|index| heading(&table.columns[index]));
    format!("{up} over {across}")
}
