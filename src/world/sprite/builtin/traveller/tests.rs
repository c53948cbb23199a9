//! Properties of the pictures of players: colours and frames can be told apart.

use super::*;
use crate::color::lab::Lab;
use crate::world::GuardKind;
use crate::world::sprite::builtin::{INK, named};

fn texels(picture: &Texture) -> impl Iterator<Item = (u32, u32)> + use<> {
    let (width, height) = (picture.width(), picture.height());
    (0..width).flat_map(move |x| (0..height).map(move |y| (x, y)))
}

/// The mean colour of what a picture shows.
fn mean(picture: &Texture) -> Lab {
    let shown: Vec<Rgb> = texels(picture)
        .map(|(x, y)| picture.texel(x, y))
        .filter_map(|(color, alpha)| (alpha > 0).then_some(color))
        .collect();
    let channel = |channel: usize| {
        let sum: usize = shown.iter().map(|color| usize::from(color.channels()[channel])).sum();
        (sum / shown.len()) as u8
    };
    Lab::from(Rgb::new(channel(0), channel(1), channel(2)))
}

#[test]
fn colors_can_be_told_apart_from_each_other_and_from_guards() {
    let sprites = PlayerColor::ALL.map(|color| (color, player(color).unwrap()));
    for facing in 0..8 {
        let means =
            sprites.each_ref().map(|(color, sprite)| (color, mean(&sprite.pictures()[facing])));
        for (index, (color, one)) in means.iter().enumerate() {
            for (other_color, other) in &means[..index] {
                let distance = one.distance(*other);
                assert!(distance >= 15.0, "{color:?} {other_color:?} {facing}: {distance}");
            }
            for kind in GuardKind::ALL {
                let guard = named(kind.name()).unwrap();
                let distance = one.distance(mean(&guard.pictures()[facing]));
                // Their shapes differ, too.
                assert!(distance >= 5.0, "{color:?} {kind:?} {facing}: {distance}");
            }
        }
    }
}

#[test]
fn pictures_differ_show_a_figure_and_are_not_cut() {
    for color in PlayerColor::ALL {
        let sprite = player(color).unwrap();
        assert_eq!((sprite.frames(), sprite.animated_frames()), (6, 1));
        for (index, picture) in sprite.pictures().iter().enumerate() {
            let shown = texels(picture).filter(|&(x, y)| picture.texel(x, y).1 > 0).count();
            let area = (picture.width() * picture.height()) as usize;
            assert!((area / 10..area * 2 / 3).contains(&shown), "{color:?} {index}: {shown}");
            assert!(!sprite.pictures()[..index].contains(picture), "{color:?} {index}");
            let is_cut = |&(x, y): &(u32, u32)| {
                let is_at_edge = x == 0 || x + 1 == picture.width() || y == 0;
                let (texel, alpha) = picture.texel(x, y);
                is_at_edge && alpha > 0 && texel != INK
            };
            assert_eq!(texels(picture).find(is_cut), None, "{color:?} {index}");
        }
    }
}

#[test]
fn no_dye_is_left() {
    for color in PlayerColor::ALL {
        for picture in player(color).unwrap().pictures() {
            let is_dye = |&(x, y): &(u32, u32)| {
                let ([red, green, blue], alpha) =
                    (picture.texel(x, y).0.channels(), picture.texel(x, y).1);
                alpha > 0 && green == 0 && red > 0 && blue > 0
            };
            assert_eq!(texels(picture).find(is_dye), None, "{color:?}");
        }
        assert_eq!(PlayerColor::named(color.name()), Some(color));
    }
}
