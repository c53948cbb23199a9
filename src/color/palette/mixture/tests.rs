use super::*;
use crate::color::Rgb;

/// The mixture of a pixel, in the tones of the palette.
fn mixture(red: u8, green: u8, blue: u8) -> Mixture {
    let color = Rgb::new(red, green, blue);
    let factor = f64::from(OF_256.tones.factor(color)) / f64::from(ToneCurve::ONE);
    OF_256.of(linear(color).map(|light| level((light * factor).min(1.0))))
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

/// Colours of every hue and lightness.
fn colours() -> impl Iterator<Item = [u8; 3]> {
    (0..8 * 8 * 8)
        .map(|number| [number / 64, number / 8 % 8, number % 8].map(|digit| 36 * digit as u8))
}

fn chroma(Oklab([_, red, yellow]): Oklab) -> f64 {
    libm::hypot(red, yellow)
}

#[test]
fn mixtures_are_even_and_of_low_contrast() {
    for [red, green, blue] in colours() {
        let mixture = mixture(red, green, blue);
        assert!([0, Mixture::WHOLE / 2].contains(&mixture.share), "{mixture:?}");
        let [darker, brighter] = mixture.colors.map(|index| Oklab::from(of_256(index)));
        assert!(darker.0[0] <= brighter.0[0], "{mixture:?}");
        assert!(darker.distance_squared(&brighter) < 0.181 * 0.181, "{mixture:?}");
    }
}

#[test]
fn mixtures_have_no_foreign_hue() {
    for [red, green, blue] in colours() {
        let wanted = Oklab::from(Rgb::new(red, green, blue));
        let mixture = mixture(red, green, blue);
        for color in mixture.colors.map(|index| Oklab::from(of_256(index))) {
            let along = (1..3).map(|i| color.0[i] * wanted.0[i]).sum::<f64>();
            // Mixtures are stored by levels: the hue of a level differs a little.
            let is_near = along >= 0.8 * chroma(color) * chroma(wanted);
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
        for index in mixture(level, level, level).colors {
            let [red, green, blue] = of_256(index).channels();
            assert!(red == green && green == blue, "{level}: {index}");
        }
    }
}

#[test]
fn bricks_are_red_and_their_joints_are_grey() {
    let redness = |[red, green, blue]: [u8; 3]| {
        let Oklab([_, redness, _]) = Oklab::from_linear(mean_light(mixture(red, green, blue)));
        redness
    };
    for brick in [[110, 48, 38], [90, 38, 30], [140, 70, 56]] {
        assert!(redness(brick) > 0.05, "{brick:?}");
    }
    for joint in [[92, 84, 80], [120, 112, 106], [70, 66, 64]] {
        assert!(redness(joint) < 0.01, "{joint:?}");
    }
}
