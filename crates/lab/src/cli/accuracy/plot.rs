//! Work-precision diagrams of the report: an error over a cost, both logarithmic.
//!
//! Each diagram of a table is a row of panels, one for each problem. In a panel, a method is a line
//! of points, joined in the order of its parameter; bars are the quartiles of times. Dots of later
//! methods are smaller, so that none hides another. The description of the file has the whole report
//! as CSV, so that a plot holds what the tables hold.

mod panel;

use std::io::{self, Write};

use super::csv;
use super::run::Run;
use super::text::heading;
use crate::accuracy::{Diagram, Table};
use crate::cli::plot::{self, Align, Mark, Page, PlotColor};
use panel::Panel;

/// Writes the plots as an SVG file.
pub(crate) fn write_svg(run: &Run, tables: &[Table], output: &mut impl Write) -> io::Result<()> {
    plot::write_svg(&page(run, tables), output)
}

/// Writes the plots as a PNG file.
pub(crate) fn write_png(run: &Run, tables: &[Table], output: &mut impl Write) -> io::Result<()> {
    plot::write_png(&page(run, tables), output)
}

/// The width of the page.
const WIDTH: f64 = 1200.0;
/// The height of a panel with its margins.
const PANEL_HEIGHT: f64 = 300.0;
/// The distance between lines of text.
const LINE: f64 = 18.0;
const MARGIN: f64 = 20.0;
/// The width of a character.
const CHARACTER: f64 = 8.0;

/// The colours of methods, in the order of the table.
const COLORS: [PlotColor; 7] = [
    PlotColor::Orange,
    PlotColor::Blue,
    PlotColor::Teal,
    PlotColor::Green,
    PlotColor::Purple,
    PlotColor::Red,
    PlotColor::Gray,
];

fn page(run: &Run, tables: &[Table]) -> Page {
    let mut marks = Vec::new();
    let mut y = MARGIN;
    for table in tables.iter().filter(|table| !table.diagrams.is_empty()) {
        y = put_heading(table, y, &mut marks);
        for diagram in &table.diagrams {
            y = put_diagram(table, diagram, y, &mut marks);
        }
    }
    for (name, value) in run.parts() {
        y += LINE;
        let text = format!("{name}: {value}");
        marks.push(Mark::Text { at: (MARGIN, y), align: Align::Start, text });
    }
    Page { width: WIDTH, height: y + MARGIN, marks, description: csv::text(run, tables) }
}

/// The title of a table and the legend of its methods. Returns the position below.
fn put_heading(table: &Table, mut y: f64, marks: &mut Vec<Mark>) -> f64 {
    let text = format!("{}: {}.", table.name, table.title);
    marks.push(Mark::Text { at: (MARGIN, y), align: Align::Start, text });
    y += LINE;
    let mut x = MARGIN;
    for (index, method) in methods(table).into_iter().enumerate() {
        marks.push(Mark::Dot {
            at: (x + 5.0, y - 4.0),
            radius: radius(index),
            color: color(index),
        });
        x += 2.0 * CHARACTER;
        marks.push(Mark::Text { at: (x, y), align: Align::Start, text: method.to_owned() });
        x += CHARACTER * (method.chars().count() + 2) as f64;
    }
    y + LINE
}

/// The panels of a diagram that have points. Returns the position below.
fn put_diagram(table: &Table, diagram: &Diagram, mut y: f64, marks: &mut Vec<Mark>) -> f64 {
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
            marks.extend(panel.marks((width * column as f64, y), width));
        }
        y += PANEL_HEIGHT;
    }
    y
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

fn color(method: usize) -> PlotColor {
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
