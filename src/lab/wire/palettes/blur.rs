//! The blur of a picture seen from a distance.

use super::GREY;
use crate::color::oklab::Oklab;

/// The pixels of a window, which is two by two cells.
const WINDOW: [usize; 2] = [2, 4];

/// The last picture, blurred, and the grey fractions of all pictures so far.
#[derive(Default)]
pub(super) struct BlurredPicture {
    blurred: Vec<Oklab>,
    light: Vec<[f64; 3]>,
    grey_windows: usize,
    windows: usize,
    grey_pixels: usize,
    pixels: usize,
}

impl BlurredPicture {
    /// Blurs a picture of this width, given as linear light row by row, and counts its grey. There
    /// is one window at each pixel column and at each cell row.
    pub(super) fn add(&mut self, width: usize, light: impl Iterator<Item = [f64; 3]>) {
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

    /// The distance of each window from the same window of `other`.
    pub(super) fn distances(&self, other: &Self) -> impl Iterator<Item = f64> {
        let pairs = self.blurred.iter().zip(&other.blurred);
        pairs.map(|(one, other)| libm::sqrt(one.distance_squared(other)))
    }

    /// The number of windows of the last picture.
    pub(super) fn windows(&self) -> usize {
        self.blurred.len()
    }

    /// The grey fraction of all windows so far.
    pub(super) fn share_of_grey(&self) -> f64 {
        self.grey_windows as f64 / self.windows.max(1) as f64
    }

    /// The grey fraction of all pixels so far.
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
        let (mut dots, mut flat) = (BlurredPicture::default(), BlurredPicture::default());
        dots.add(8, checker);
        flat.add(8, (0..8 * 8).map(|_| [0.5; 3]));
        assert_eq!((dots.windows(), dots.blurred.len()), (7 * 3, flat.blurred.len()));
        assert!(dots.distances(&flat).all(|distance| distance < 1e-9));
        assert_eq!((dots.share_of_grey(), dots.share_of_grey_pixels()), (1.0, 0.0));
    }
}
