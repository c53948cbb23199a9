//! How far pictures are from the truth, summed over the halves of their cells.

use super::super::table::Value;
use super::truth::Truth;

/// A difference that is easily seen, of 255.
const FAR: f64 = 24.0;

/// Sums over halves of cells; where there are two, of textures and of edges.
#[derive(Clone, Debug, Default)]
pub(crate) struct Differences {
    pixels: [u64; 2],
    errors: [f64; 2],
    far: u64,
    worst: f64,
    moved: [u64; 2],
    changes: [f64; 2],
}

impl Differences {
    /// Adds a picture of a camera that stands still.
    pub(crate) fn add_still(&mut self, truth: &Truth, picture: &[[f64; 3]]) {
        for (half, shown) in truth.halves.iter().zip(picture) {
            let differences: [f64; 3] =
                std::array::from_fn(|channel| (shown[channel] - half.color[channel]).abs());
            let largest = differences.into_iter().fold(0.0, f64::max);
            let place = usize::from(half.is_at_edge);
            self.pixels[place] += 1;
            self.errors[place] += differences.iter().sum::<f64>() / 3.0;
            self.far += u64::from(largest > FAR);
            self.worst = self.worst.max(largest);
        }
    }

    /// Adds the change from one picture to the next.
    pub(crate) fn add_motion(&mut self, truths: [&Truth; 2], pictures: [&[[f64; 3]]; 2]) {
        let halves = truths[0].halves.iter().zip(&truths[1].halves);
        for ((one, other), (before, after)) in halves.zip(pictures[0].iter().zip(pictures[1])) {
            let place = usize::from(one.is_at_edge || other.is_at_edge);
            let change: f64 = (0..3)
                .map(|channel| {
                    let shown = after[channel] - before[channel];
                    (shown - (other.color[channel] - one.color[channel])).abs()
                })
                .sum();
            self.moved[place] += 1;
            self.changes[place] += change / 3.0;
        }
    }

    /// The figures of the table, without the time.
    pub(crate) fn values(&self) -> Vec<Value> {
        let mean = |sum: f64, count: u64| sum / count.max(1) as f64;
        let pixels = self.pixels.iter().sum();
        let share = |count: u64| Value::Share(count as f64 / u64::max(pixels, 1) as f64);
        let means = |sums: [f64; 2], counts: [u64; 2]| {
            let both = mean(sums[0] + sums[1], counts[0] + counts[1]);
            [both, mean(sums[1], counts[1]), mean(sums[0], counts[0])].map(Value::Number)
        };
        let [error, at_edges, of_textures] = means(self.errors, self.pixels);
        let mut values = vec![
            Value::Count(pixels),
            error,
            share(self.far),
            Value::Number(self.worst),
            share(self.pixels[1]),
            at_edges,
            of_textures,
        ];
        values.extend(means(self.changes, self.moved));
        values
    }
}
