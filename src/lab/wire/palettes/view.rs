//! A picture as it is seen at arm's length.

use super::GREY;
use crate::color::oklab::Oklab;

/// The pixels of a window: two cells by two.
const WINDOW: [usize; 2] = [2, 4];

/// The last picture that was looked at, blurred, and how much of all of them was grey.
#[derive(Default)]
pub(super) struct Seen {
    blurred: Vec<Oklab>,
    light: Vec<[f64; 3]>,
    grey_windows: usize,
    windows: usize,
    grey_pixels: usize,
    pixels: usize,
}

impl Seen {
    /// Looks at the pixels of a picture of that width, row by row, by their light. There is a window at each pixel
    /// from left to right, and at each cell from top to bottom.
    pub(super) fn look(&mut self, width: usize, light: impl Iterator<Item = [f64; 3]>) {
        self.light.clear();
        self.light.extend(light);
        self.blurred.clear();
        let height = self.light.len() / width;
        let [across, down] = WINDOW;
        for y in (0..(height + 1).saturating_sub(down)).step_by(2) {
            for x in 0..(width + 1).saturating_sub(across) {
                let rows = (y..y + down).map(|y| &self.light[y * width + x..][..across]);
                let sum = rows
                    .flatten()
                    .fold([0.0; 3], |sum, light| std::array::from_fn(|i| sum[i] + light[i]));
                let mean = sum.map(|sum: f64| sum / (across * down) as f64);
                self.blurred.push(Oklab::from_linear(mean));
            }
        }
        let is_grey = |&Oklab([_, red, yellow]): &Oklab| red * red + yellow * yellow < GREY * GREY;
        self.windows += self.blurred.len();
        self.grey_windows += self.blurred.iter().filter(|color| is_grey(color)).count();
        let pixels = self.light.iter().map(|&light| Oklab::from_linear(light));
        self.grey_pixels += pixels.filter(is_grey).count();
        self.pixels += self.light.len();
    }

    /// How far each window is from the same one of `other`.
    pub(super) fn distances(&self, other: &Self) -> impl Iterator<Item = f64> {
        let pairs = self.blurred.iter().zip(&other.blurred);
        pairs.map(|(one, other)| libm::sqrt(one.distance_squared(other)))
    }

    /// How many windows the last picture has.
    pub(super) fn windows(&self) -> usize {
        self.blurred.len()
    }

    /// How much of all that was looked at was grey.
    pub(super) fn share_of_grey(&self) -> f64 {
        self.grey_windows as f64 / self.windows.max(1) as f64
    }

    /// The same without the blur.
    pub(super) fn share_of_grey_pixels(&self) -> f64 {
        self.grey_pixels as f64 / self.pixels.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_checkerboard_looks_like_its_mean_and_as_grey_as_that() {
        let checker = (0..8 * 8)
            .map(|at| if (at + at / 8) % 2 == 0 { [0.8, 0.2, 0.2] } else { [0.2, 0.8, 0.8] });
        let (mut dots, mut flat) = (Seen::default(), Seen::default());
        dots.look(8, checker);
        flat.look(8, (0..8 * 8).map(|_| [0.5; 3]));
        assert_eq!((dots.windows(), dots.blurred.len()), (7 * 3, flat.blurred.len()));
        assert!(dots.distances(&flat).all(|distance| distance < 1e-9));
        assert_eq!((dots.share_of_grey(), dots.share_of_grey_pixels()), (1.0, 0.0));
    }
}
