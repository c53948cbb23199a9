//! The choice of a given number of colours that stand for many: k-means in Oklab.
//!
//! The search begins with the present entries. In each round, colours go to their nearest entries,
//! entries move to the means of their colours, and entries without colours go to where the error is
//! largest, those first that have been unused for longest (as in the method of Linde, Buzo and Gray,
//! 1980). An entry takes the colour of the frame that is nearest to its mean, so that large areas of
//! one colour, such as black, are exact.
//!
//! Rejected: a median cut, which begins from nothing. Entries that keep their places need no new
//! definition, and cells that show them need not be sent again.

use super::super::super::style::Shade;

/// A colour of a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) shade: Shade,
    pub(crate) lab: [f32; 3],
    /// The number of half cells that have it.
    pub(crate) count: f32,
}

/// Clusters of colours, one for each entry.
#[derive(Debug)]
pub(crate) struct Clusters {
    /// Their centres in Oklab, component by component.
    centers: [Vec<f32>; 3],
    /// The number of the frame in which each was last in use.
    used_at: Vec<u32>,
}

/// The sums of a cluster's colours.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f32,
    lab: [f32; 3],
    /// The squares of the distances.
    error: f32,
    /// The sample with the largest error, and that error.
    worst: (usize, f32),
}

/// The centre of an entry that is undefined.
const UNDEFINED: f32 = 1e9;
/// The largest number of rounds. Eight are needed to find all entries from nothing.
const ROUNDS: u32 = 12;
/// The mean error that needs no further entries.
const ENOUGH: f32 = 0.002;
/// An entry within this distance of its mean keeps its colour.
const NEAR: f32 = 0.004;

impl Clusters {
    /// Undefined clusters.
    pub(crate) fn new(count: usize) -> Self {
        Self { centers: [0, 1, 2].map(|_| vec![UNDEFINED; count]), used_at: vec![0; count] }
    }

    /// Records that an entry is in use.
    pub(crate) fn note_use(&mut self, place: u8, frame: u32) {
        self.used_at[usize::from(place)] = frame;
    }

    /// The cluster nearest to a colour, and the distance.
    pub(crate) fn nearest(&self, [l, a, b]: [f32; 3]) -> (u8, f32) {
        /// At least the number of entries.
        const MOST: usize = 256;
        let [ls, as_, bs] = &self.centers;
        let mut squares = [f32::INFINITY; MOST];
        for (square, ((&one, &two), &three)) in squares.iter_mut().zip(ls.iter().zip(as_).zip(bs)) {
            let (l, a, b) = (one - l, two - a, three - b);
            *square = l * l + a * a + b * b;
        }
        let mut nearest = 0;
        for (place, &square) in squares.iter().enumerate() {
            if square < squares[nearest] {
                nearest = place;
            }
        }
        (nearest as u8, squares[nearest].sqrt())
    }

    /// Fits the entries, which have the colours `shades`, to `samples`. Returns their new colours.
    pub(crate) fn fit(&mut self, samples: &[Sample], shades: &[Shade]) -> Vec<Shade> {
        let before = self.centers.clone();
        for _ in 0..ROUNDS {
            let (sums, error) = self.sums(samples);
            for (place, sums) in sums.iter().enumerate().filter(|(_, sums)| sums.count > 0.0) {
                self.move_to(place, sums.lab.map(|sum| sum / sums.count));
            }
            if error <= ENOUGH || !self.split(&sums, samples) {
                break;
            }
        }
        self.settle(samples, shades, &before)
    }

    /// The sums of each cluster, and the mean distance of all samples.
    fn sums(&self, samples: &[Sample]) -> (Vec<Sums>, f32) {
        let mut all = vec![Sums::default(); self.used_at.len()];
        let (mut distances, mut count) = (0.0, 0.0);
        for (index, sample) in samples.iter().enumerate() {
            let (place, distance) = self.nearest(sample.lab);
            let sums = &mut all[usize::from(place)];
            let error = sample.count * distance * distance;
            sums.count += sample.count;
            sums.error += error;
            for (sum, component) in sums.lab.iter_mut().zip(sample.lab) {
                *sum += sample.count * component;
            }
            if error > sums.worst.1 {
                sums.worst = (index, error);
            }
            distances += sample.count * distance;
            count += sample.count;
        }
        (all, distances / count)
    }

    /// Moves entries without colours to where the error is largest. Returns whether there are any.
    fn split(&mut self, sums: &[Sums], samples: &[Sample]) -> bool {
        let mut spare: Vec<usize> =
            (0..sums.len()).filter(|&place| sums[place].count == 0.0).collect();
        spare.sort_by_key(|&place| self.used_at[place]);
        let mut worst: Vec<Sums> = sums.iter().copied().filter(|sums| sums.worst.1 > 0.0).collect();
        worst.sort_by(|one, other| other.error.total_cmp(&one.error));
        for (&place, sums) in spare.iter().zip(&worst) {
            self.move_to(place, samples[sums.worst.0].lab);
        }
        !spare.is_empty() && !worst.is_empty()
    }

    /// Moves each centre to a colour of its own cluster, or back if it is near enough to where it was
    /// `before`. Returns the colours.
    fn settle(
        &mut self,
        samples: &[Sample],
        shades: &[Shade],
        before: &[Vec<f32>; 3],
    ) -> Vec<Shade> {
        let mut nearest = vec![(f32::INFINITY, 0); shades.len()];
        for (index, sample) in samples.iter().enumerate() {
            let (place, distance) = self.nearest(sample.lab);
            let known = &mut nearest[usize::from(place)];
            if distance < known.0 {
                *known = (distance, index);
            }
        }
        let mut settled: Vec<Shade> = Vec::with_capacity(shades.len());
        for (place, (&shade, &(distance, index))) in shades.iter().zip(&nearest).enumerate() {
            let old = before.each_ref().map(|components| components[place]);
            let has_colors = distance.is_finite();
            let is_kept = !has_colors || self.distance(place, old) <= NEAR.max(distance);
            let (lab, chosen) =
                if is_kept { (old, shade) } else { (samples[index].lab, samples[index].shade) };
            // Two entries of one colour could not be told apart.
            let is_new = chosen != Shade::NONE && !settled.contains(&chosen);
            self.move_to(place, if is_new { lab } else { [UNDEFINED; 3] });
            settled.push(if is_new { chosen } else { Shade::NONE });
        }
        settled
    }

    fn move_to(&mut self, place: usize, lab: [f32; 3]) {
        for (centers, component) in self.centers.iter_mut().zip(lab) {
            centers[place] = component;
        }
    }

    fn distance(&self, place: usize, lab: [f32; 3]) -> f32 {
        let squares = self.centers.iter().zip(lab).map(|(centers, component)| {
            let difference = centers[place] - component;
            difference * difference
        });
        squares.sum::<f32>().sqrt()
    }
}
