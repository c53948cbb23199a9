use super::*;
use crate::color::Rgb;

fn mixture(red: u8, green: u8, blue: u8) -> Mixture {
    OF_256.of(linear(Rgb::new(red, green, blue)).map(level))
}

#[test]
fn dark_bricks_are_mixed_of_red_and_grey() {
    let Mixture { colors, share, .. } = mixture(80, 32, 24);
    let [darker, brighter] = colors.map(|index| Oklab::from(of_256(index)));
    assert!(share > 0 && share < Mixture::WHOLE);
    assert!(darker.0[0] <= brighter.0[0]);
    assert!(darker.0[1].max(brighter.0[1]) > 0.05, "{colors:?}");
}

fn mean_light(Mixture { colors, share, .. }: Mixture) -> [f64; 3] {
    let part = f64::from(share) / f64::from(Mixture::WHOLE);
    let [darker, brighter] = colors.map(|index| linear(of_256(index)));
    array::from_fn(|i| darker[i] + (brighter[i] - darker[i]) * part)
}

#[test]
fn dark_wood_is_brown() {
    for [red, green, blue] in [[96, 64, 36], [80, 52, 28], [72, 46, 26], [70, 40, 26]] {
        let mixture = mixture(red, green, blue);
        let Oklab([_, redness, yellowness]) = Oklab::from_linear(mean_light(mixture));
        let Oklab([_, wanted_redness, wanted_yellowness]) = Rgb::new(red, green, blue).into();
        let wanted = wanted_redness + wanted_yellowness;
        assert!(redness + yellowness > 0.5 * wanted, "{mixture:?}");
    }
}

/// Dark colours of every hue.
fn dark_colours() -> impl Iterator<Item = [u8; 3]> {
    (0..8 * 8 * 8)
        .map(|number| [number / 64, number / 8 % 8, number % 8].map(|digit| 12 * digit as u8))
}

fn chroma(Oklab([_, red, yellow]): Oklab) -> f64 {
    libm::hypot(red, yellow)
}

#[test]
fn dark_mixtures_are_even_and_have_no_bright_dots() {
    for [red, green, blue] in dark_colours() {
        let mixture = mixture(red, green, blue);
        assert!(mixture.is_dark && [0, Mixture::WHOLE / 2].contains(&mixture.share), "{mixture:?}");
        let wanted = Oklab::from(Rgb::new(red, green, blue)).0[0];
        for index in mixture.colors {
            let Oklab([lightness, ..]) = of_256(index).into();
            assert!(lightness < wanted + 0.24, "{red} {green} {blue}: {mixture:?}");
        }
        let [darker, brighter] = mixture.colors.map(|index| Oklab::from(of_256(index)).0[0]);
        assert!(brighter - darker < 0.2, "{red} {green} {blue}: {mixture:?}");
    }
}

#[test]
fn dark_mixtures_have_no_foreign_hue() {
    for [red, green, blue] in dark_colours() {
        let wanted = Oklab::from(Rgb::new(red, green, blue));
        let mixture = mixture(red, green, blue);
        for color in mixture.colors.map(|index| Oklab::from(of_256(index))) {
            let along = (1..3).map(|i| color.0[i] * wanted.0[i]).sum::<f64>();
            // Mixtures are stored by levels: the hue of a level differs a little.
            let is_near = along >= 0.6 * chroma(color) * chroma(wanted);
            assert!(chroma(color) < 0.01 || is_near, "{red} {green} {blue}: {mixture:?}");
        }
    }
}

#[test]
fn levels_are_as_fine_in_the_dark_as_in_the_light() {
    for value in 0..=u8::MAX {
        let [light, ..] = linear(Rgb::new(value, value, value));
        let [shown, wanted] =
            [light_of_level(level(light)), light].map(|light| Oklab::from_linear([light; 3]).0[0]);
        assert!((shown - wanted).abs() < 0.009, "{value}");
    }
}

#[test]
fn greys_are_mixed_of_greys() {
    for level in (0..=255).step_by(4) {
        let Mixture { colors, single, .. } = mixture(level, level, level);
        for index in [colors[0], colors[1], single] {
            let [red, green, blue] = of_256(index).channels();
            assert!(red == green && green == blue, "{level}: {index}");
        }
    }
}

#[test]
fn a_bright_mixture_looks_more_like_the_colour_than_the_nearest_colour_does() {
    let mut better = 0;
    for color in
        [[180, 110, 90], [150, 140, 110], [110, 140, 170], [140, 130, 115], [120, 150, 120]]
    {
        let wanted = Oklab::from(Rgb::new(color[0], color[1], color[2]));
        let [red, green, blue] = color;
        let mixed = mean_light(mixture(red, green, blue));
        let mixed = Oklab::from_linear(mixed).distance_squared(&wanted);
        let nearest = (CUBE..=u8::MAX)
            .map(|index| Oklab::from(of_256(index)).distance_squared(&wanted))
            .fold(f64::INFINITY, f64::min);
        better += u32::from(mixed < 0.5 * nearest);
    }
    assert!(better >= 4, "{better} of 5");
}
