//! Times of candidates that take turns.

use super::table::Value;

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
