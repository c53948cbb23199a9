//! The pictures match the painted ones, and kinds, facings, frames and colours can be told apart.

use std::fmt::Write;

use super::*;
use crate::color::lab::Lab;
use crate::rng::hash;
use crate::world::{GuardKind, Texture};

/// The colour of outlines.
const INK: Rgb = Rgb::new(0x1c, 0x18, 0x20);

/// The sprites that only a game uses, except guards.
const OF_GAMES: [&str; 19] = [
    EXIT,
    KEY,
    "bolt",
    "checkpoint",
    "coins",
    "crown",
    "cup",
    "dart",
    "darts",
    "flask",
    "flasks",
    "heart",
    "lever",
    "note",
    "pebble",
    "pebbles",
    "smoke",
    "spikes",
    "star",
];

fn all() -> impl Iterator<Item = (&'static str, Sprite)> {
    let names = NAMES.iter().copied().chain(OF_GAMES);
    names.map(|name| (name, named(name).unwrap_or_else(|| panic!("{name} is drawn"))))
}

#[test]
fn every_texel_is_as_painted() {
    let print_of_picture = |picture: &Texture| {
        let texels = (0..picture.width()).flat_map(|x| (0..picture.height()).map(move |y| (x, y)));
        hash(
            0,
            texels.map(|(x, y)| {
                let (color, alpha) = picture.texel(x, y);
                u64::from(u32::from_be_bytes([color.red(), color.green(), color.blue(), alpha]))
            }),
        )
    };
    let named = DESIGNS.iter().map(|it| (it.art.name, named(it.art.name)));
    let players = PlayerColor::ALL.map(|color| (color.name(), player(color)));
    let players = players.into_iter().chain([("marked", marked_player())]);
    let mut list = String::new();
    for (name, sprite) in named.chain(players) {
        let print = hash(0, sprite.unwrap().pictures.iter().map(print_of_picture));
        writeln!(list, "{name:10} {print:016x}").unwrap();
    }
    insta::assert_snapshot!(list, @r"
    archer     30d4d6ca1fa363e3
    banner     efe0e9afa4722624
    barrel     708e08d7a022cf6e
    bolt       95a37ad315cd600c
    bones      c484840f402f9121
    books      fb78b01051d929d5
    brazier    eab67e9ae211f7cb
    checkpoint e059fdb3d861df0c
    chest      863b23d1a2a44409
    coins      e6c20cc970a01e57
    column     17c41507bd365c8c
    crate      2c98e69560730656
    crown      6a87cefe94b5cde5
    cup        18792bcd88dbaa75
    dart       0f74dd1e48040602
    darts      ee4178b593f44b01
    flask      b6ca1633d1691431
    flasks     b792c5dc4eaa16f9
    heart      1576cfab48d463ed
    hound      b2e2320e486f1823
    key        7b4cadc9d9fac681
    lamp       b581e8d661e3a839
    lantern    819f1c3ab870992d
    lever      781e137fe2733733
    listener   550a48ff89a1f1d0
    note       b667e4eab693ae82
    pebble     16b627d0fb2c7b55
    pebbles    317232338ee2c24d
    plant      ebde76dd756999ce
    player     26e8e94acc317bd6
    portal     fb77865e6cc77aee
    smoke      82776b74e5a518ca
    spikes     bf2a4769c073edac
    star       428b95aad7311584
    statue     84892881fad244ad
    table      38d56223fd54bae3
    torch      58594607316e2c5e
    warden     2d688dd50417ca48
    red        5a67f8f472ad42ff
    sky        69f28bacb090cc4b
    yellow     9530b27c37087293
    violet     75471a0aa69e8a71
    green      f06f85b56586ed6d
    pink       881592cccbabaa94
    orange     4d1fe30d79521b92
    blue       fe1db73333307d6c
    marked     32b025c140ca988a
    ");
}

#[test]
fn every_picture_shows_something_and_leaves_something_clear() {
    for (name, sprite) in all() {
        for picture in sprite.pictures.iter() {
            let texels = (0..picture.width())
                .flat_map(|x| (0..picture.height()).map(move |y| picture.texel(x, y).1));
            let shown = texels.filter(|&alpha| alpha > 0).count() as u32;
            let area = picture.width() * picture.height();
            assert!((area / 8..area).contains(&shown), "{name}: {shown} of {area}");
        }
    }
    assert_eq!(named("dragon"), None);
}

#[test]
fn frames_selected_by_the_game_are_not_animated() {
    let frames = |name| {
        let sprite = named(name).unwrap();
        (sprite.animated_frames(), sprite.frames())
    };
    assert_eq!((frames("lamp"), frames("torch")), ((2, 3), (3, 4)));
    assert_eq!((frames("checkpoint"), frames("lever")), ((1, 2), (1, 2)));
    assert_eq!((frames("spikes"), frames("smoke")), ((1, 3), (4, 4)));
}

#[test]
fn a_sprites_pictures_share_one_size_and_differ() {
    for (name, sprite) in all() {
        let first = &sprite.pictures[0];
        for (index, picture) in sprite.pictures.iter().enumerate() {
            let size = (picture.width(), picture.height());
            assert_eq!(size, (first.width(), first.height()), "{name}");
            assert!(!sprite.pictures[..index].contains(picture), "{name}: {index}");
        }
    }
}

/// A silhouette of ten pixels for each cell, standing in the middle of the lowest row.
type Silhouette = [[bool; SIDE]; SIDE];

const SIDE: usize = 12;
const PIXELS_IN_CELL: f64 = 10.0;

fn sprite(kind: GuardKind) -> Sprite {
    named(kind.name()).unwrap()
}

fn picture(sprite: &Sprite, frame: GuardFrame, facing: usize) -> &Texture {
    &sprite.pictures()[usize::from(frame.index()) * 8 + facing]
}

/// Sets each pixel if the figure covers more than half of it.
fn silhouette(sprite: &Sprite, picture: &Texture) -> Silhouette {
    let texels_in_pixel = f64::from(picture.height()) / (sprite.height.cells() * PIXELS_IN_CELL);
    let mut covered = [[0.0; SIDE]; SIDE];
    for (x, y) in texels(picture).filter(|&(x, y)| picture.texel(x, y).1 > 0) {
        let across = f64::from(x) + 0.5 - f64::from(picture.width()) / 2.0;
        let above = f64::from(picture.height()) - 0.5 - f64::from(y);
        let column = (across / texels_in_pixel + SIDE as f64 / 2.0) as usize;
        covered[(above / texels_in_pixel) as usize][column] += 1.0;
    }
    let half = texels_in_pixel * texels_in_pixel / 2.0;
    covered.map(|row| row.map(|texels| texels > half))
}

fn texels(picture: &Texture) -> impl Iterator<Item = (u32, u32)> + use<> {
    let (width, height) = (picture.width(), picture.height());
    (0..width).flat_map(move |x| (0..height).map(move |y| (x, y)))
}

fn difference(one: &Silhouette, other: &Silhouette) -> usize {
    let pairs = one.iter().flatten().zip(other.iter().flatten());
    pairs.filter(|(one, other)| one != other).count()
}

/// The mean colour of the figure.
fn mean(picture: &Texture) -> Rgb {
    let shown: Vec<Rgb> = texels(picture)
        .map(|(x, y)| picture.texel(x, y))
        .filter_map(|(color, alpha)| (alpha > 0).then_some(color))
        .collect();
    let channel = |channel: usize| {
        let sum: usize = shown.iter().map(|color| usize::from(color.channels()[channel])).sum();
        (sum / shown.len()) as u8
    };
    Rgb::new(channel(0), channel(1), channel(2))
}

#[test]
fn pictures_share_one_size_differ_and_show_a_figure() {
    for kind in GuardKind::ALL {
        let sprite = sprite(kind);
        assert_eq!((sprite.frames(), sprite.animated_frames()), (8, 1));
        assert_eq!(sprite.lamp.is_some(), kind == GuardKind::Lantern);
        let first = &sprite.pictures()[0];
        for (index, picture) in sprite.pictures().iter().enumerate() {
            let size = (picture.width(), picture.height());
            assert_eq!(size, (first.width(), first.height()), "{kind:?}");
            let shown = texels(picture).filter(|&(x, y)| picture.texel(x, y).1 > 0).count();
            let area = (size.0 * size.1) as usize;
            assert!((area / 10..area * 2 / 3).contains(&shown), "{kind:?} {index}: {shown}");
            assert!(!sprite.pictures()[..index].contains(picture), "{kind:?}: {index}");
        }
    }
}

#[test]
fn figures_stay_within_their_pictures() {
    for kind in GuardKind::ALL {
        let sprite = sprite(kind);
        for (index, picture) in sprite.pictures().iter().enumerate() {
            // A figure that reaches the edge of a picture has no outline there, and looks cut off.
            let is_cut = |&(x, y): &(u32, u32)| {
                let is_at_edge = x == 0 || x + 1 == picture.width() || y == 0;
                let (color, alpha) = picture.texel(x, y);
                is_at_edge && alpha > 0 && color != INK
            };
            assert_eq!(texels(picture).find(is_cut), None, "{kind:?} {index}");
        }
    }
}

#[test]
fn kinds_differ_in_shape_and_colour_at_ten_pixels() {
    for facing in 0..8 {
        let looks = GuardKind::ALL.map(|kind| {
            let sprite = sprite(kind);
            let picture = picture(&sprite, GuardFrame::Stand, facing);
            (kind, silhouette(&sprite, picture), Lab::from(mean(picture)))
        });
        for (index, (kind, shape, color)) in looks.iter().enumerate() {
            for (other_kind, other_shape, other_color) in &looks[..index] {
                let pixels = difference(shape, other_shape);
                assert!(pixels >= 7, "{kind:?} {other_kind:?} {facing}: {pixels} pixels");
                let distance = color.distance(*other_color);
                assert!(distance >= 15.0, "{kind:?} {other_kind:?} {facing}: {distance}");
            }
        }
    }
}

#[test]
fn winding_up_changes_the_silhouette_from_every_side() {
    for kind in GuardKind::ALL {
        let sprite = sprite(kind);
        for facing in 0..8 {
            let [stands, winds_up] = [GuardFrame::Stand, GuardFrame::WindUp]
                .map(|frame| silhouette(&sprite, picture(&sprite, frame, facing)));
            let shown = stands.iter().flatten().filter(|&&is_set| is_set).count();
            let changed = difference(&stands, &winds_up);
            assert!(changed * 4 >= shown, "{kind:?} {facing}: {changed} of {shown}");
        }
    }
}

#[test]
fn the_front_is_lighter_than_the_back() {
    for kind in GuardKind::ALL {
        let sprite = sprite(kind);
        let [front, back] = [0, 4].map(|facing| {
            let color = mean(picture(&sprite, GuardFrame::Stand, facing));
            color.channels().into_iter().map(u32::from).sum::<u32>()
        });
        assert!(front * 100 >= back * 103, "{kind:?}: {front} {back}");
    }
}

#[test]
fn colors_can_be_told_apart_from_each_other_and_from_guards() {
    let sprites = PlayerColor::ALL.map(|color| (color, player(color).unwrap()));
    for facing in 0..8 {
        let means = sprites
            .each_ref()
            .map(|(color, sprite)| (color, Lab::from(mean(&sprite.pictures()[facing]))));
        for (index, (color, one)) in means.iter().enumerate() {
            for (other_color, other) in &means[..index] {
                let distance = one.distance(*other);
                assert!(distance >= 15.0, "{color:?} {other_color:?} {facing}: {distance}");
            }
            for kind in GuardKind::ALL {
                let guard = named(kind.name()).unwrap();
                let distance = one.distance(Lab::from(mean(&guard.pictures()[facing])));
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
fn no_dye_placeholder_remains() {
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

#[test]
fn a_marked_player_is_brighter_than_others_and_has_an_arrow() {
    let marked = marked_player().unwrap();
    let sum = |sprite: &Sprite| -> u32 {
        let picture = &sprite.pictures[0];
        let texels = (0..picture.width()).flat_map(|x| (0..picture.height()).map(move |y| (x, y)));
        let lit = texels.map(|(x, y)| picture.texel(x, y)).filter(|texel| texel.1 > 0);
        lit.map(|(color, _)| u32::from(color.luma())).sum()
    };
    for color in PlayerColor::ALL {
        let plain = player(color).unwrap();
        assert!(sum(&marked) > sum(&plain), "{}", color.name());
        let (with, without) = (marked.pictures[0].height(), plain.pictures[0].height());
        let texel = marked.height.cells() / f64::from(with);
        assert!((texel - plain.height.cells() / f64::from(without)).abs() < 1e-12);
        let is_arrow = |y| marked.pictures[0].texel(marked.pictures[0].width() / 2, y).1 > 0;
        assert!((0..with - without).all(is_arrow));
    }
    assert!(marked.glows && marked.height.cells() < 1.0, "it stands below the ceiling");
}
