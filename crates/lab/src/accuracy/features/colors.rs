//! Palettes: the distance of the nearest colour, and whether it is the nearest.

use std::hint::black_box;

use super::Feature;
use cellcaster::color::Rgb;
use cellcaster::color::lab::Lab;
use cellcaster::color::oklab::Oklab;
use cellcaster::color::palette::{nearest_of_16, nearest_of_256, of_256};

/// Every fifteenth value of each channel.
const STEP: usize = 15;

pub(crate) fn features() -> Vec<Feature> {
    vec![
        palette("palette of 256", 16..=255, nearest_of_256),
        palette("palette of 16", 0..=15, nearest_of_16),
    ]
}

/// A colour is wrong if another index is nearer in Oklab, in which the palette is searched. The
/// errors are those of the colours that are shown, in ΔE of CIE76, of which 2.3 is just seen.
fn palette(
    name: &'static str,
    indices: std::ops::RangeInclusive<u8>,
    nearest: fn(Rgb) -> u8,
) -> Feature {
    let values = || (0..=255_u8).step_by(STEP);
    let colors: Vec<Rgb> = values()
        .flat_map(|red| {
            values().flat_map(move |green| values().map(move |blue| Rgb::new(red, green, blue)))
        })
        .collect();
    let mut errors = Vec::new();
    let mut wrong = 0;
    for &color in &colors {
        let distance = |index: u8| Oklab::from(of_256(index)).distance_squared(&Oklab::from(color));
        let chosen = nearest(color);
        wrong += usize::from(indices.clone().any(|index| distance(index) < distance(chosen)));
        errors.push(Lab::from(of_256(chosen)).distance(Lab::from(color)));
    }
    let cases = colors.len();
    let work = move || {
        for &color in &colors {
            black_box(nearest(black_box(color)));
        }
    };
    let work: Option<Box<dyn FnMut()>> = Some(Box::new(work));
    Feature { name, figure: "colour", unit: "ΔE", cases, wrong, errors, work }
}
