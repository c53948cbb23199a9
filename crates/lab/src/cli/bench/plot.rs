//! Three plots of the report on one page, with logarithmic axes.

use std::io::{self, Write};

use ratatui::layout::Size;

use super::{Report, WINDOWS};
use crate::cli::plot::{self, Align, Axis, Mark, Page, PlotColor};
use crate::speed::{DrawingRow, Ground, SIDES, Scene};
use crate::wire::PipelineRow;

/// Writes the page as an SVG file.
pub(crate) fn write(report: &Report, output: &mut impl Write) -> io::Result<()> {
    plot::write_svg(&page(report), output)
}

/// The width and the height of a plot.
const PLOT: (f64, f64) = (350.0, 310.0);
/// The margins of a plot, with room for tick labels and the names of lines.
const LEFT: f64 = 60.0;
const RIGHT: f64 = 75.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 50.0;
/// The approximate maximum number of labelled powers of ten.
const MOST_TICKS: usize = 6;
/// The distance between lines of text.
const LINE: f64 = 14.0;

/// A plot of several lines over common ticks.
struct Plot {
    title: &'static str,
    across: &'static str,
    /// The positions of ticks on the horizontal axis, and their labels.
    ticks: Vec<(f64, String)>,
    lines: Vec<Line>,
}

/// One line of a plot.
struct Line {
    name: String,
    color: PlotColor,
    points: Vec<(f64, f64)>,
}

fn page(report: &Report) -> Page {
    let plots = [drawing(report), rays(report), pipeline(report)];
    let width = PLOT.0 * plots.len() as f64;
    let marks =
        plots.iter().enumerate().flat_map(|(index, plot)| plot.marks(PLOT.0 * index as f64));
    Page { width, height: PLOT.1, marks: marks.collect(), description: String::new() }
}

fn drawing(report: &Report) -> Plot {
    let rows = || report.drawing.iter().filter(|row| row.scene == Scene::Planes);
    let place =
        |row: &DrawingRow| f64::from(row.size.width.get()) * f64::from(row.size.height.get());
    let line = |name: &str, color, figure: fn(&DrawingRow) -> f64| Line {
        name: name.to_owned(),
        color,
        points: rows().map(|row| (place(row), figure(row))).collect(),
    };
    Plot {
        title: "Drawing: ns a pixel",
        across: "width of the picture",
        // The labels of all widths would overlap.
        ticks: rows()
            .filter(|row| ![120, 200].contains(&row.size.width.get()))
            .map(|row| (place(row), row.size.width.to_string()))
            .collect(),
        lines: vec![
            line("classic", PlotColor::Blue, |row| row.classic),
            line("ours", PlotColor::Orange, |row| row.ours),
            line("fill", PlotColor::Gray, |row| row.fill),
        ],
    }
}

fn rays(report: &Report) -> Plot {
    let line = |ground: Ground, color| {
        let rows = report.growth.maps.iter().filter(|row| row.ground == ground);
        let points = rows.map(|row| (f64::from(row.side), row.ray.seconds * 1e9)).collect();
        Line { name: ground.name().to_owned(), color, points }
    };
    Plot {
        title: "Rays: ns a ray",
        across: "open cells before it",
        ticks: SIDES.map(|side| (f64::from(side), side.to_string())).into(),
        lines: vec![line(Ground::Plain, PlotColor::Blue), line(Ground::Hall, PlotColor::Orange)],
    }
}

fn pipeline(report: &Report) -> Plot {
    const COLORS: [PlotColor; 4] =
        [PlotColor::Blue, PlotColor::Orange, PlotColor::Green, PlotColor::Gray];
    let encoders = report.pipeline.iter().filter(|row| row.size == WINDOWS[0]);
    let lines = encoders.zip(COLORS).map(|(PipelineRow { encoder, .. }, color)| {
        let rows = report.pipeline.iter().filter(|row| row.encoder == *encoder);
        let points =
            rows.map(|row| (f64::from(row.size.area()), row.time.as_secs_f64() * 1e6)).collect();
        Line { name: encoder.clone(), color, points }
    });
    let window = |size: Size| (f64::from(size.area()), format!("{}x{}", size.width, size.height));
    Plot {
        title: "Pipeline: µs a frame",
        across: "window",
        ticks: WINDOWS.map(window).into(),
        lines: lines.collect(),
    }
}

impl Plot {
    /// The marks of the plot at this `offset` from the left edge of the page.
    fn marks(&self, offset: f64) -> Vec<Mark> {
        let points = || self.lines.iter().flat_map(|line| &line.points);
        let (x_axis, y_axis) = (
            Axis::between(points().map(|point| point.0)),
            Axis::around(points().map(|point| point.1)),
        );
        let (left, right) = (offset + LEFT, offset + PLOT.0 - RIGHT);
        let (top, bottom) = (TOP, PLOT.1 - BOTTOM);
        let x = |value| left + x_axis.share(value) * (right - left);
        let y = |value| bottom - y_axis.share(value) * (bottom - top);
        let text = |at, align, text: &str| Mark::Text { at, align, text: text.to_owned() };
        let mut marks = vec![
            text((left, top - LINE), Align::Start, self.title),
            text((f64::midpoint(left, right), bottom + 2.8 * LINE), Align::Middle, self.across),
        ];
        for (value, label) in &self.ticks {
            let x = x(*value);
            marks.push(Mark::Line { from: (x, top), to: (x, bottom), color: PlotColor::Pale });
            marks.push(text((x, bottom + 1.3 * LINE), Align::Middle, label));
        }
        for power in y_axis.powers(MOST_TICKS) {
            let value = 10_f64.powi(power);
            marks.push(Mark::Line {
                from: (left, y(value)),
                to: (right, y(value)),
                color: PlotColor::Pale,
            });
            marks.push(text((left - 8.0, y(value) + 4.0), Align::End, &value.to_string()));
        }
        for line in &self.lines {
            let places = || line.points.iter().map(|point| (x(point.0), y(point.1)));
            let segments = places().zip(places().skip(1));
            marks.extend(segments.map(|(from, to)| Mark::Line { from, to, color: line.color }));
            marks.extend(places().map(|at| Mark::Dot { at, radius: 5.0, color: line.color }));
        }
        let ends = self.lines.iter().filter_map(|line| Some((y(line.points.last()?.1), line)));
        marks.extend(names(ends.collect(), right + 10.0));
        marks
    }
}

/// The names of lines beside their ends, from the top, without overlaps.
fn names(mut ends: Vec<(f64, &Line)>, x: f64) -> Vec<Mark> {
    ends.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut free = f64::NEG_INFINITY;
    let name = |(end, line): (f64, &Line)| {
        let y = free.max(end);
        free = y + LINE;
        Mark::Text { at: (x, y + 4.0), align: Align::Start, text: line.name.clone() }
    };
    ends.into_iter().map(name).collect()
}
