//! Properties of the guards' pictures: kinds, facings and frames can be told apart.

use super::*;
use crate::color::Rgb;
use crate::color::lab::Lab;
use crate::world::{Sprite, Texture};

/// A silhouette of ten pixels for each cell, standing in the middle of the lowest row.
type Silhouette = [[bool; SIDE]; SIDE];

const SIDE: usize = 12;
const PIXELS_IN_CELL: f64 = 10.0;

fn sprite(kind: GuardKind) -> Sprite {
    super::super::named(kind.name()).unwrap()
}

fn picture(sprite: &Sprite, frame: GuardFrame, facing: usize) -> &Texture {
    &sprite.pictures()[usize::from(frame.index()) * 8 + facing]
}

/// A pixel is set if the figure covers more than half of it.
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
fn pictures_are_of_one_size_differ_and_show_a_figure() {
    for kind in GuardKind::ALL {
        let sprite = sprite(kind);
        assert_eq!((sprite.frames(), sprite.animated_frames()), (8, 1));
        assert_eq!(sprite.height.cells(), figure(kind).height);
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
            // What reaches the edge of a picture is without an outline there, and seems cut.
            let is_cut = |&(x, y): &(u32, u32)| {
                let is_at_edge = x == 0 || x + 1 == picture.width() || y == 0;
                let (color, alpha) = picture.texel(x, y);
                is_at_edge && alpha > 0 && color != super::super::INK
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
fn pictures_need_a_bounded_number_of_lines_of_sight() {
    for kind in GuardKind::ALL {
        let Figure { size, model, .. } = figure(kind);
        let lines = model::lines_of_sight(GuardFrame::ALL.into_iter().map(model), size);
        assert!(lines < 100_000, "{kind:?}: {lines}");
    }
}
