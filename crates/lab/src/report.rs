//! Reports: tables of figures, which every format writes in the same way.
//!
//! Every measurement is a [`Table`] of the same shape, so one writer for each format serves all
//! tables and leaves none out. A row has three keys: the problem, the method, and the method's
//! parameter. A [`Diagram`] names two columns. It has a panel for each problem, and a line for each
//! method over its parameter, like the work-precision diagrams of `SciML`, with the error across and
//! the cost up (<https://docs.sciml.ai/SciMLBenchmarksOutput>). Rejected: a structure for each table. Five
//! formats needed code for each of them, and CSV and the plots left most of them out.

mod formats;
mod page;
mod plot;

use std::time::Instant;

pub use formats::{Format, markdown};
pub(crate) use formats::{Origin, Report};
pub(crate) use page::update_page;

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// A short name without spaces.
    pub name: &'static str,
    /// The subject, in one or two sentences without the last full stop.
    pub title: String,
    /// The headings of the keys. A key without a heading is empty in every row.
    pub keys: [&'static str; 3],
    /// The headings of the values: a name, followed by a comma and the unit if there is one. A
    /// heading begins with `time` if and only if the values differ from run to run.
    pub columns: Vec<String>,
    /// The rows.
    pub rows: Vec<Row>,
    /// The diagrams of this table.
    pub diagrams: Vec<Diagram>,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The problem, the method and its parameter.
    pub keys: [String; 3],
    /// A value for each column.
    pub values: Vec<Value>,
}

/// A figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// There is no such figure.
    None,
    /// A number of things.
    Count(u64),
    /// A fraction, from 0 to 1.
    Share(f64),
    /// Any other number.
    Number(f64),
    /// The median of several values, with its quartiles.
    Spread(Spread),
}

/// A plot of one column over another, such as a time over an error. Both axes are logarithmic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagram {
    /// The indices of the columns across and up.
    pub columns: [usize; 2],
    /// The smallest and the largest value across that matters. The plot names the methods of points outside.
    pub range: [f64; 2],
}

/// The headings of columns.
pub(crate) fn headings<const COUNT: usize>(names: [&str; COUNT]) -> Vec<String> {
    names.map(str::to_owned).into()
}

impl Table {
    /// The problems (`key` 0) or the methods (`key` 1), in order.
    fn distinct(&self, key: usize) -> Vec<&str> {
        let mut distinct: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !distinct.contains(&row.keys[key].as_str()) {
                distinct.push(&row.keys[key]);
            }
        }
        distinct
    }
}

impl Row {
    pub(crate) fn new(keys: [&str; 3], values: Vec<Value>) -> Self {
        Self { keys: keys.map(str::to_owned), values }
    }
}

impl Value {
    /// The number, or the median of a time.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Count(count) => Some(count as f64),
            Self::Share(number) | Self::Number(number) => Some(number),
            Self::Spread(spread) => Some(spread.median),
        }
    }

    /// The number, as if there were several.
    fn spread(self) -> Option<Spread> {
        match self {
            Self::Spread(spread) => Some(spread),
            other => other.number().map(|number| Spread::of(vec![number]).unwrap_or_default()),
        }
    }

    /// The spread of `values`.
    pub(crate) fn of(values: Vec<f64>) -> Self {
        Spread::of(values).map_or(Self::None, Self::Spread)
    }

    /// `number`, if there is one.
    pub(crate) fn maybe(number: Option<f64>) -> Self {
        number.map_or(Self::None, Self::Number)
    }

    /// The fraction of `all` that `part` makes up.
    pub(crate) fn share(part: usize, all: usize) -> Self {
        Self::Share(part as f64 / all.max(1) as f64)
    }
}

impl Diagram {
    /// The range of diagrams that show every point.
    pub(crate) const ALL: [f64; 2] = [f64::MIN_POSITIVE, f64::MAX];

    /// The values of `row` across and up.
    fn point(&self, row: &Row) -> Option<[Spread; 2]> {
        let [across, up] = self.columns.map(|index| row.values.get(index)?.spread());
        Some([across?, up?])
    }
}

/// The median of several values, and its quartiles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The lower quartile.
    pub lower_quartile: f64,
    /// The upper quartile.
    pub upper_quartile: f64,
}

impl Spread {
    fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_unstable_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        // Between two values, their weighted mean.
        let at = |share: f64| {
            let place = share * last as f64;
            let (below, above) = (values[place.floor() as usize], values[place.ceil() as usize]);
            below + (above - below) * place.fract()
        };
        Some(Self { median: at(0.5), lower_quartile: at(0.25), upper_quartile: at(0.75) })
    }
}

/// The times of `count` candidates, as `time` returns them for each index.
///
/// In each of `rounds` rounds, every candidate is timed once, so that a slow phase of the machine
/// affects all of them. If `rounds` is 0, there are no times.
pub(crate) fn time_in_rounds(
    count: usize,
    rounds: usize,
    mut time: impl FnMut(usize) -> f64,
) -> Vec<Value> {
    let mut times: Vec<Vec<f64>> = vec![Vec::with_capacity(rounds); count];
    for _ in 0..rounds {
        for (index, times) in times.iter_mut().enumerate() {
            times.push(time(index));
        }
    }
    times.into_iter().map(Value::of).collect()
}

/// The duration of `work`, in seconds.
pub(crate) fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// The median of `values`; 0 if there are none.
pub(crate) fn median(values: Vec<f64>) -> f64 {
    Spread::of(values).unwrap_or_default().median
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_in_order() {
        let Spread { median, lower_quartile, upper_quartile } =
            Spread::of(vec![5.0, 1.0, 4.0, 2.0, 3.0]).unwrap();
        assert_eq!((lower_quartile, median, upper_quartile), (2.0, 3.0, 4.0));
        let even = Spread::of(vec![4.0, 1.0, 2.0, 3.0]).unwrap();
        assert_eq!((even.lower_quartile, even.median, even.upper_quartile), (1.75, 2.5, 3.25));
    }

    #[test]
    fn candidates_take_turns() {
        let mut order = Vec::new();
        let times = time_in_rounds(2, 2, |index| {
            order.push(index);
            index as f64
        });
        assert_eq!(order, [0, 1, 0, 1]);
        assert_eq!(times[1].number(), Some(1.0));
        assert_eq!(time_in_rounds(1, 0, |_| 1.0), [Value::None]);
    }
}
