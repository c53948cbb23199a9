//! The colours of a palette that may be mixed to give a colour.

use std::array;

use super::{PaletteColor, Weights};
use crate::color::oklab::{self, Oklab};
use crate::color::product;

/// The most candidates for a mixture: the nearest colours.
const MOST_CANDIDATES: usize = 40;
/// Colours with less chroma are grey and fit every hue.
const GREY: f32 = 0.01;

/// The candidates for a colour, the nearest first.
pub(super) struct Candidates {
    nearest: [Candidate; MOST_CANDIDATES],
    count: usize,
}

/// A colour that may be part of a mixture, and its difference from the wanted colour.
#[derive(Clone, Copy, Default)]
pub(super) struct Candidate {
    pub(super) index: u8,
    distance: f32,
    /// The error in lightness, in saturation, and in hue by its weight. The error of a mixture is
    /// the weighted mean of the errors of its colours: errors are linear in the responses of the
    /// cones, and only scaled to perceived differences.
    pub(super) error: [f32; 3],
    pub(super) lab: [f32; 3],
}

impl Candidates {
    pub(super) fn new(wanted: &Wanted, palette: &[PaletteColor], weights: &Weights) -> Self {
        let nearest = [Candidate::default(); MOST_CANDIDATES];
        let mut candidates = Self { nearest, count: 0 };
        for color in palette.iter().filter(|color| wanted.admits(color, weights)) {
            candidates.insert(wanted.candidate(color, weights));
        }
        candidates
    }

    pub(super) fn as_slice(&self) -> &[Candidate] {
        &self.nearest[..self.count]
    }

    fn insert(&mut self, candidate: Candidate) {
        let nearest = &mut self.nearest;
        if self.count == MOST_CANDIDATES && candidate.distance >= nearest[self.count - 1].distance {
            return;
        }
        self.count = (self.count + 1).min(MOST_CANDIDATES);
        nearest[self.count - 1] = candidate;
        let mut at = self.count - 1;
        while at > 0 && nearest[at - 1].distance > candidate.distance {
            nearest.swap(at - 1, at);
            at -= 1;
        }
    }
}

/// The wanted colour.
pub(super) struct Wanted {
    lab: [f32; 3],
    chroma: f32,
    /// The direction of the hue: its red–green and its yellow–blue component.
    hue: [f32; 2],
    cones: [f32; 3],
    /// The derivatives of the cube roots of the cone responses, bounded near zero.
    slopes: [f32; 3],
}

impl Wanted {
    /// The colour of that red, green and blue light, each from 0 to 1.
    pub(super) fn new(light: [f64; 3]) -> Self {
        let Oklab(lab) = Oklab::from_linear(light);
        let lab = lab.map(|part| part as f32);
        let chroma = chroma(lab);
        let hue = if chroma > 0.0 { [lab[1] / chroma, lab[2] / chroma] } else { [1.0, 0.0] };
        let cones = oklab::cones(light).map(|share| share as f32);
        let slopes = cones.map(|share| {
            let root = libm::cbrtf(share + 0.003);
            1.0 / (3.0 * root * root)
        });
        Self { lab, chroma, hue, cones, slopes }
    }

    /// Whether a colour may be part of a mixture.
    fn admits(&self, color: &PaletteColor, weights: &Weights) -> bool {
        let [_, red, yellow] = color.lab;
        let color_chroma = chroma(color.lab);
        let fits = || {
            let along = red * self.hue[0] + yellow * self.hue[1];
            self.chroma >= weights.least_chroma && along >= weights.hue * color_chroma
        };
        color_chroma < GREY || fits()
    }

    fn candidate(&self, color: &PaletteColor, weights: &Weights) -> Candidate {
        let distance =
            color.lab.iter().zip(self.lab).map(|(part, wanted)| (part - wanted).powi(2)).sum();
        let from_cone_roots = oklab::FROM_CONE_ROOTS.map(|row| row.map(|factor| factor as f32));
        let roots = array::from_fn(|i| (color.cones[i] - self.cones[i]) * self.slopes[i]);
        let [lightness, red, yellow] = product(&from_cone_roots, roots);
        let saturation = red * self.hue[0] + yellow * self.hue[1];
        let hue = yellow * self.hue[0] - red * self.hue[1];
        let error = [lightness, saturation, weights.hue_error * hue];
        Candidate { index: color.index, distance, error, lab: color.lab }
    }
}

fn chroma([_, red, yellow]: [f32; 3]) -> f32 {
    libm::sqrtf(red * red + yellow * yellow)
}
