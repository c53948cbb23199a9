//! The weights and limits by which mixtures are rated, for each palette.

use super::candidates::Candidate;

/// The weights and limits by which mixtures are rated.
#[derive(Clone, Copy)]
pub(super) struct Weights {
    /// The weight of a difference in chroma relative to one in lightness, for mixtures.
    pub(super) chroma: f32,
    /// The same for single colours, which would otherwise be grey too often.
    pub(super) single: f32,
    /// The weight of a difference in hue relative to one in saturation.
    pub(super) hue_error: f32,
    /// The weights of the differences in lightness and in chroma between the two colours.
    pub(super) contrast: [f32; 2],
    /// The most by which the lightness of a colour may differ from that of the wanted one.
    pub(super) most_difference: f32,
    /// The least cosine between the hues of a colour and of the wanted one.
    pub(super) hue: f32,
    /// Colours with less chroma are mixed of greys only.
    pub(super) least_chroma: f32,
    /// The most by which the chroma of a colour may exceed that of the wanted one: more shows as
    /// dots.
    pub(super) most_excess: f32,
    /// Whether they are those of dark colours: see [`super::Mixture::is_dark`].
    pub(super) is_dark: bool,
}

impl Weights {
    /// The contrast between two colours.
    pub(super) fn contrast(&self, one: &Candidate, other: &Candidate) -> f32 {
        let square = |index: usize| (one.lab[index] - other.lab[index]).powi(2);
        self.contrast[0] * square(0) + self.contrast[1] * (square(1) + square(2))
    }
}

/// Chosen by eye in pictures of all levels, and by experiment with `cellcaster wire --palette 256`.
pub(super) const WEIGHTS_OF_256: [(f32, Weights); 3] = {
    let bright = Weights {
        chroma: 2.0,
        single: 1.0,
        hue_error: 0.7,
        contrast: [0.03, 0.01],
        most_difference: 1.0,
        hue: 0.5,
        least_chroma: 0.005,
        most_excess: 0.1,
        is_dark: false,
    };
    let dark = Weights {
        hue_error: 2.0,
        contrast: [0.15, 0.08],
        most_difference: 0.22,
        hue: 0.77,
        least_chroma: 0.022,
        is_dark: true,
        ..bright
    };
    let darkest = Weights { hue_error: 0.4, least_chroma: 0.03, ..dark };
    [(0.4, darkest), (0.57, dark), (f32::INFINITY, bright)]
};
/// For a few saturated colours, which users redefine: they are used sparingly.
pub(super) const WEIGHTS_OF_16: [(f32, Weights); 1] = {
    let weights = Weights {
        chroma: 1.0,
        single: 1.0,
        hue_error: 1.0,
        contrast: [0.008, 0.02],
        most_difference: 1.0,
        hue: 0.9,
        least_chroma: 0.045,
        most_excess: 1.0,
        is_dark: false,
    };
    [(f32::INFINITY, weights)]
};
