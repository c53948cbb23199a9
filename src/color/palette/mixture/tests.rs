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

#[test]
fn dark_colours_have_no_bright_dots() {
    for number in 0..8 * 8 * 8 {
        let [red, green, blue] =
            [number / 64, number / 8 % 8, number % 8].map(|digit| 12 * digit as u8);
        let Oklab([wanted, ..]) = Rgb::new(red, green, blue).into();
        let mixture = mixture(red, green, blue);
        for index in mixture.colors {
            let Oklab([lightness, ..]) = of_256(index).into();
            assert!(lightness < wanted + 0.2, "{red} {green} {blue}: {mixture:?}");
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
fn a_mixture_looks_more_like_the_colour_than_the_nearest_colour_does() {
    let mut better = 0;
    for color in [[100, 40, 30], [90, 80, 60], [60, 90, 120], [140, 130, 115], [40, 60, 40]] {
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
