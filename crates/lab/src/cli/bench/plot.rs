//! Three plots of the report on one page, with logarithmic axes.

use cellcaster::color::Rgb;
use ratatui::layout::Size;

use super::{Report, WINDOWS};
use crate::cli::plot::{Align, Axis, BLUE, Chart, GRAY, GREEN, ORANGE, Page};
use crate::speed::{DrawingRow, Ground, SIDES, Scene};
use crate::wire::PipelineRow;

/// The width and the height of a plot.
const PLOT: (f64, f64) = (350.0, 310.0);
/// The margins of a plot, with room for tick labels and the names of lines.
const LEFT: f64 = 60.0;
const RIGHT: f64 = 75.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 50.0;
/// The distance between lines of text.
const LINE: f64 = 14.0;

/// The plots as an SVG file.
pub(crate) fn svg(report: &Report) -> String {
    let plots = [drawing(report), rays(report), pipeline(report)];
    let mut page = Page::default();
    for (index, plot) in plots.iter().enumerate() {
        plot.draw(PLOT.0 * index as f64, &mut page);
    }
    page.svg((PLOT.0 * plots.len() as f64, PLOT.1), "")
}

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
    color: Rgb,
    points: Vec<(f64, f64)>,
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
            line("classic", BLUE, |row| row.classic),
            line("ours", ORANGE, |row| row.ours),
            line("fill", GRAY, |row| row.fill),
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
        lines: vec![line(Ground::Plain, BLUE), line(Ground::Hall, ORANGE)],
    }
}

fn pipeline(report: &Report) -> Plot {
    const COLORS: [Rgb; 4] = [BLUE, ORANGE, GREEN, GRAY];
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
    /// Draws the plot at this `offset` from the left edge of the page.
    fn draw(&self, offset: f64, page: &mut Page) {
        let points = || self.lines.iter().flat_map(|line| &line.points);
        let chart = Chart {
            left: offset + LEFT,
            right: offset + PLOT.0 - RIGHT,
            top: TOP,
            bottom: PLOT.1 - BOTTOM,
            across: Axis::between(points().map(|point| point.0)),
            up: Axis::around(points().map(|point| point.1)),
        };
        page.text((chart.left, chart.top - LINE), Align::Start, self.title);
        let middle = f64::midpoint(chart.left, chart.right);
        page.text((middle, chart.bottom + 2.8 * LINE), Align::Middle, self.across);
        for (value, label) in &self.ticks {
            chart.tick_across(*value, label, 1.3 * LINE, page);
        }
        for value in chart.up.powers().map(|power| 10_f64.powi(power)) {
            chart.tick_up(value, &value.to_string(), page);
        }
        self.lines.iter().for_each(|line| chart.series(&line.points, line.color, page));
        let ends =
            self.lines.iter().filter_map(|line| Some((chart.at(*line.points.last()?).1, line)));
        put_names(ends.collect(), chart.right + 10.0, page);
    }
}

/// The names of lines beside their ends, from the top, without overlaps.
fn put_names(mut ends: Vec<(f64, &Line)>, x: f64, page: &mut Page) {
    ends.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut free = f64::NEG_INFINITY;
    for (end, line) in ends {
        let y = free.max(end);
        free = y + LINE;
        page.text((x, y + 4.0), Align::Start, &line.name);
    }
}
