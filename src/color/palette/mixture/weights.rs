//! The weights and limits by which mixtures are rated, for each palette.

use std::ops::RangeInclusive;

use super::Mixture;
use super::candidates::Candidate;

/// The weights and limits by which mixtures are rated.
#[derive(Clone, Debug)]
pub(super) struct Weights {
    /// The shares of the brighter colour, of [`super::Mixture::WHOLE`].
    pub(super) shares: RangeInclusive<u8>,
    /// The factors of saturation, of dark colours and of bright ones.
    pub(super) saturation: [f64; 2],
    /// The weight of a difference in hue relative to one in saturation or in lightness.
    pub(super) hue_error: f32,
    /// The weights of the differences in lightness and in chroma between the two colours. The mean
    /// square of the error of single pixels counts where both are 1.
    pub(super) contrast: [f32; 2],
    /// The most by which the two colours may differ.
    pub(super) most_difference: f32,
    /// The least cosine between the hues of a colour and of the wanted one.
    pub(super) hue: f32,
    /// Colours with less chroma are mixed of greys only.
    pub(super) least_chroma: f32,
}

impl Weights {
    /// The weighted square of the difference between two colours; none where they differ too much.
    pub(super) fn contrast(&self, one: &Candidate, other: &Candidate) -> Option<f32> {
        let [lightness, red, yellow] = [0, 1, 2].map(|i| (one.lab[i] - other.lab[i]).powi(2));
        let chroma = red + yellow;
        let is_low = lightness + chroma <= self.most_difference * self.most_difference;
        is_low.then(|| self.contrast[0] * lightness + self.contrast[1] * chroma)
    }

    /// The factor of saturation of a colour with that lightness.
    ///
    /// Colours that are almost grey have a factor of 1, so that marble has no coloured dots.
    pub(super) fn saturation(&self, lightness: f64, chroma: f64) -> f64 {
        const DARK: f64 = 0.4;
        const BRIGHT: f64 = 0.6;
        const GREY: f64 = 0.01;
        const COLOURED: f64 = 0.03;
        let [dark, bright] = self.saturation;
        let brightness = ((lightness - DARK) / (BRIGHT - DARK)).clamp(0.0, 1.0);
        let part = ((chroma - GREY) / (COLOURED - GREY)).clamp(0.0, 1.0);
        1.0 + part * (dark + (bright - dark) * brightness - 1.0)
    }
}

/// Chosen by eye in pictures of all levels, and by experiment with `cellcaster wire --palette 256`.
pub(super) const WEIGHTS_OF_256: Weights = Weights {
    shares: Mixture::WHOLE / 2..=Mixture::WHOLE / 2,
    saturation: [1.7, 1.3],
    hue_error: 2.0,
    contrast: [0.82, 0.82],
    most_difference: 0.18,
    hue: 0.9,
    least_chroma: 0.02,
};
/// For a few saturated colours, which users redefine: they are used sparingly.
pub(super) const WEIGHTS_OF_16: Weights = Weights {
    shares: 1..=Mixture::WHOLE - 1,
    saturation: [1.0, 1.0],
    hue_error: 1.0,
    contrast: [0.032, 0.08],
    most_difference: 1.0,
    hue: 0.9,
    least_chroma: 0.045,
};
