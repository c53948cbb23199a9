use super::*;

fn mixture(red: u8, green: u8, blue: u8) -> Mixture {
    OF_256.of([red, green, blue].map(|channel| channel >> (u8::BITS - BITS)))
}

#[test]
fn dark_bricks_are_mixed_of_red_and_grey() {
    let Mixture { colors, share, .. } = mixture(80, 32, 24);
    let [darker, brighter] = colors.map(|index| Oklab::from(of_256(index)));
    assert!(share > 0 && share < Mixture::WHOLE);
    assert!(darker.0[0] <= brighter.0[0]);
    assert!(darker.0[1].max(brighter.0[1]) > 0.05, "{colors:?}");
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
        let Mixture { colors, share, .. } = mixture(red, green, blue);
        let part = f64::from(share) / f64::from(Mixture::WHOLE);
        let [darker, brighter] = colors.map(|index| linear(of_256(index)));
        let mixed: [f64; 3] = array::from_fn(|i| darker[i] + (brighter[i] - darker[i]) * part);
        let mixed = Oklab::from_linear(mixed).distance_squared(&wanted);
        let nearest = (CUBE..=u8::MAX)
            .map(|index| Oklab::from(of_256(index)).distance_squared(&wanted))
            .fold(f64::INFINITY, f64::min);
        better += u32::from(mixed < 0.5 * nearest);
    }
    assert!(better >= 4, "{better} of 5");
}
