//! Tables of figures, and the diagrams of their columns.
//!
//! Every part of the report is a [`Table`] with the same shape, so that each format writes all
//! tables by the same code and leaves none out. A row has three keys: the problem, the method, and
//! the method's parameter. A [`Diagram`] names two columns: it has a panel for each problem, and a
//! line for each method, joined through the parameter, as the work-precision diagrams of `SciML` have
//! (<https://docs.sciml.ai/SciMLBenchmarksOutput>). A structure for each part was refused: each of
//! five formats needed code for each of them, and CSV and the plots had left most of them out.

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// A short name without spaces.
    pub name: &'static str,
    /// What is measured, in one or two sentences.
    pub title: &'static str,
    /// The headings of the keys. A key without a heading is empty in every row.
    pub keys: [&'static str; 3],
    /// The columns after the keys.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<Row>,
    /// The diagrams of this table.
    pub diagrams: Vec<Diagram>,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// The heading. It begins with `time` exactly if the values differ from run to run.
    pub name: String,
    /// The unit; empty for counts and fractions.
    pub unit: &'static str,
}

/// A row of a table: the keys, and a value for each column.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The problem, the method and its parameter.
    pub keys: [String; 3],
    /// The values.
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
    /// Any other number that does not differ from run to run.
    Number(f64),
    /// A time that was measured, and differs from run to run.
    Time(Timing),
}

/// A plot of one column over another: an error over its cost. Both axes are logarithmic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagram {
    /// The indices of the columns across and up.
    pub columns: [usize; 2],
    /// The least and the largest error that matter. Others are drawn at the end of the axis.
    pub range: [f64; 2],
}

impl Table {
    /// The problems, in order.
    pub fn problems(&self) -> Vec<&str> {
        let mut problems: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !problems.contains(&row.keys[0].as_str()) {
                problems.push(&row.keys[0]);
            }
        }
        problems
    }
}

impl Column {
    /// A column of figures with this name and unit.
    pub(crate) fn new(name: impl Into<String>, unit: &'static str) -> Self {
        Self { name: name.into(), unit }
    }

    /// Whether the values differ from run to run.
    pub fn is_time(&self) -> bool {
        self.name.starts_with("time")
    }
}

impl Value {
    /// The number; the median of a time.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Count(count) => Some(count as f64),
            Self::Share(number) | Self::Number(number) => Some(number),
            Self::Time(timing) => Some(timing.median),
        }
    }
}

impl Diagram {
    /// The cost and the error of `row`, the error within the range; `None` if there is no such point.
    pub fn point(&self, row: &Row) -> Option<(f64, f64)> {
        let [cost, error] = self.columns.map(|index| row.values.get(index)?.number());
        let (cost, error) = (cost?, error?);
        (cost > 0.0 && !error.is_nan()).then(|| (cost, error.clamp(self.range[0], self.range[1])))
    }
}

// Times of candidates that take turns.

/// The time of a candidate over several rounds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// The median over all rounds.
    pub median: f64,
    /// The lower quartile.
    pub lower_quartile: f64,
    /// The upper quartile.
    pub upper_quartile: f64,
}

impl Timing {
    fn of(mut times: Vec<f64>) -> Option<Self> {
        times.sort_unstable_by(f64::total_cmp);
        let last = times.len().checked_sub(1)?;
        let at = |share: f64| times[(share * last as f64).round() as usize];
        Some(Self { median: at(0.5), lower_quartile: at(0.25), upper_quartile: at(0.75) })
    }
}

/// The times of `count` candidates, as `time` returns them for each index.
///
/// In each of `rounds` rounds, every candidate is timed once, so that a slow phase of the machine
/// affects all of them. Without rounds, there are no times.
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
    let value = |times| Timing::of(times).map_or(Value::None, Value::Time);
    times.into_iter().map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_within_the_range() {
        let diagram = Diagram { columns: [0, 1], range: [0.5, 8.0] };
        let point = |cost, error| {
            let keys = [const { String::new() }; 3];
            diagram.point(&Row { keys, values: vec![cost, error] })
        };
        let count = Value::Count(3);
        assert_eq!(point(count, Value::Number(0.0)), Some((3.0, 0.5)));
        assert_eq!(point(count, Value::Number(f64::INFINITY)), Some((3.0, 8.0)));
        assert_eq!(point(count, Value::Share(0.75)), Some((3.0, 0.75)));
        assert_eq!(point(count, Value::Number(f64::NAN)), None);
        assert_eq!(point(Value::None, count), None);
    }

    #[test]
    fn quartiles_are_in_order() {
        let Timing { median, lower_quartile, upper_quartile } =
            Timing::of(vec![5.0, 1.0, 4.0, 2.0, 3.0]).unwrap();
        assert_eq!((lower_quartile, median, upper_quartile), (2.0, 3.0, 4.0));
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
