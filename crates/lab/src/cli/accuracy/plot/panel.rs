//! A panel: the diagram of one problem.

use super::{CHARACTER, LINE, PANEL_HEIGHT, color, methods, radius, title};
use crate::accuracy::{Diagram, Table, Value};
use crate::cli::plot::{Align, Axis, Mark, PlotColor};

/// The margins of a panel.
const LEFT: f64 = 70.0;
const RIGHT: f64 = 15.0;
const TOP: f64 = 52.0;
const BOTTOM: f64 = 40.0;
/// The greatest number of labelled powers of ten.
const MOST_TICKS: usize = 6;

pub(crate) struct Panel {
    problem: String,
    title: String,
    points: Vec<Point>,
    cost: Axis,
    error: Axis,
}

struct Point {
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
    pub(crate) fn new(table: &Table, diagram: &Diagram, problem: &str) -> Option<Self> {
        let methods = methods(table);
        let rows = table.rows.iter().filter(|row| row.keys[0] == problem);
        let mut points: Vec<Point> = rows
            .filter_map(|row| {
                let (cost, error) = diagram.point(row)?;
                let quartiles = match row.values[diagram.columns[0]] {
                    Value::Time(timing) => Some((timing.lower_quartile, timing.upper_quartile)),
                    _ => None,
                };
                let method = methods.iter().position(|method| *method == row.keys[1])?;
                Some(Point { method, parameter: row.keys[2].clone(), cost, quartiles, error })
            })
            .collect();
        // Lines join the points of a method, which a table may list by parameter.
        points.sort_by_key(|point| point.method);
        let cost = Axis::around(points.iter().map(|point| point.cost));
        let error = Axis::around(points.iter().map(|point| point.error));
        let (problem, title) = (problem.to_owned(), title(table, diagram));
        (!points.is_empty()).then_some(Self { problem, title, points, cost, error })
    }

    /// The marks of the panel with its top left corner at `corner`.
    pub(crate) fn marks(&self, corner: (f64, f64), width: f64) -> Vec<Mark> {
        let mut marks = self.axes(corner, width);
        let at = |cost: f64, error: f64| {
            let x = corner.0 + LEFT + self.cost.share(cost) * (width - LEFT - RIGHT);
            let height = PANEL_HEIGHT - TOP - BOTTOM;
            let y = corner.1 + TOP + (1.0 - self.error.share(error)) * height;
            (x, y)
        };
        for pair in self.points.windows(2).filter(|pair| pair[0].method == pair[1].method) {
            let [from, to] = [&pair[0], &pair[1]].map(|point| at(point.cost, point.error));
            marks.push(Mark::Line { from, to, color: color(pair[0].method) });
        }
        for point in &self.points {
            if let Some((lower, upper)) = point.quartiles {
                let [from, to] = [lower, upper].map(|cost| at(cost, point.error));
                marks.push(Mark::Line { from, to, color: color(point.method) });
            }
            marks.push(Mark::Dot {
                at: at(point.cost, point.error),
                radius: radius(point.method),
                color: color(point.method),
            });
        }
        marks.extend(labels(
            self.points.iter().map(|point| (at(point.cost, point.error), point.parameter.as_str())),
            (corner.0 + width, corner.1 + TOP),
        ));
        marks
    }

    /// The title, the grid and its labels.
    fn axes(&self, corner: (f64, f64), width: f64) -> Vec<Mark> {
        let (left, right) = (corner.0 + LEFT, corner.0 + width - RIGHT);
        let (top, bottom) = (corner.1 + TOP, corner.1 + PANEL_HEIGHT - BOTTOM);
        let text = |at, align, text: &str| Mark::Text { at, align, text: text.to_owned() };
        let line = |from, to| Mark::Line { from, to, color: PlotColor::Pale };
        let mut marks = vec![
            text((left, top - LINE - 14.0), Align::Start, &self.problem),
            text((left, top - 14.0), Align::Start, &self.title),
        ];
        for power in self.cost.powers(MOST_TICKS) {
            let x = left + self.cost.share(10_f64.powi(power)) * (right - left);
            marks.push(line((x, top), (x, bottom)));
            marks.push(text((x, bottom + LINE), Align::Middle, &format!("1e{power}")));
        }
        for power in self.error.powers(MOST_TICKS) {
            let y = bottom - self.error.share(10_f64.powi(power)) * (bottom - top);
            marks.push(line((left, y), (right, y)));
            marks.push(text((left - 8.0, y + 4.0), Align::End, &format!("1e{power}")));
        }
        marks
    }
}

/// The labels of points where they overlap neither dots nor each other, left of `right` and below `top`; the
/// others are left out.
fn labels<'a>(
    points: impl Iterator<Item = ((f64, f64), &'a str)> + Clone,
    (right, top): (f64, f64),
) -> Vec<Mark> {
    const HEIGHT: f64 = 12.0;
    const GAP: f64 = 9.0;
    /// Left, right and middle.
    type Extent = (f64, f64, f64);
    let overlap = |one: &Extent, other: &Extent| {
        one.0 < other.1 && other.0 < one.1 && (one.2 - other.2).abs() < HEIGHT
    };
    let mut taken: Vec<Extent> = points.clone().map(|((x, y), _)| (x - GAP, x + GAP, y)).collect();
    let mut marks = Vec::new();
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
            let at = (place.0, place.2 + 4.0);
            marks.push(Mark::Text { at, align: Align::Start, text: label.to_owned() });
        }
    }
    marks
}
