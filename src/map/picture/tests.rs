use png::{BitDepth, Encoder};
use proptest::prelude::*;

use super::*;

const CLEAR: u8 = 0;
const OPAQUE: u8 = 255;
const PALETTE: &[u8] = &[1, 2, 3, 4, 5, 6];

/// A picture two texels wide and one high.
fn encoded(color_type: ColorType, depth: BitDepth, samples: &[u8]) -> Vec<u8> {
    encoded_with(color_type, depth, samples, |_| {})
}

fn encoded_with(
    color_type: ColorType,
    depth: BitDepth,
    samples: &[u8],
    set_up: impl FnOnce(&mut Encoder<'_, &mut Vec<u8>>),
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(color_type);
    encoder.set_depth(depth);
    set_up(&mut encoder);
    encoder.write_header().unwrap().write_image_data(samples).unwrap();
    bytes
}

fn texels(bytes: &[u8]) -> [(Rgb, u8); 2] {
    let texture = decode(bytes, &mut PictureBudget::default()).unwrap().texture();
    assert_eq!((texture.width(), texture.height()), (2, 1));
    [0, 1].map(|x| (texture.column(f64::from(x) / 2.0)[0], texture.texel(x, 0).1))
}

#[test]
fn gray_of_every_depth_decodes() {
    let expected = [(Rgb::WHITE, OPAQUE), (Rgb::BLACK, OPAQUE)];
    for (depth, samples) in [
        (BitDepth::One, [0b1000_0000].as_slice()),
        (BitDepth::Two, &[0b1100_0000]),
        (BitDepth::Four, &[0xf0]),
        (BitDepth::Eight, &[255, 0]),
        (BitDepth::Sixteen, &[255, 255, 0, 0]),
    ] {
        assert_eq!(texels(&encoded(ColorType::Grayscale, depth, samples)), expected);
    }
}

#[test]
fn gray_with_alpha_decodes() {
    let bytes = encoded(ColorType::GrayscaleAlpha, BitDepth::Eight, &[7, 0, 9, 255]);
    assert_eq!(texels(&bytes), [(Rgb::new(7, 7, 7), CLEAR), (Rgb::new(9, 9, 9), OPAQUE)]);
}

#[test]
fn colours_decode_with_and_without_alpha() {
    let (left, right) = (Rgb::new(1, 2, 3), Rgb::new(4, 5, 6));
    let bytes = encoded(ColorType::Rgb, BitDepth::Eight, &[1, 2, 3, 4, 5, 6]);
    assert_eq!(texels(&bytes), [(left, OPAQUE), (right, OPAQUE)]);
    let bytes = encoded(ColorType::Rgba, BitDepth::Eight, &[1, 2, 3, 128, 4, 5, 6, 0]);
    assert_eq!(texels(&bytes), [(left, 128), (right, CLEAR)]);
    let samples = [1, 99, 2, 99, 3, 99, 128, 99, 4, 99, 5, 99, 6, 99, 0, 99];
    let bytes = encoded(ColorType::Rgba, BitDepth::Sixteen, &samples);
    assert_eq!(texels(&bytes), [(left, 128), (right, CLEAR)]);
}

#[test]
fn palettes_decode_with_and_without_alpha() {
    let (left, right) = (Rgb::new(4, 5, 6), Rgb::new(1, 2, 3));
    let bytes = encoded_with(ColorType::Indexed, BitDepth::One, &[0b1000_0000], |encoder| {
        encoder.set_palette(PALETTE);
    });
    assert_eq!(texels(&bytes), [(left, OPAQUE), (right, OPAQUE)]);
    let bytes = encoded_with(ColorType::Indexed, BitDepth::Eight, &[1, 0], |encoder| {
        encoder.set_palette(PALETTE);
        encoder.set_trns([0, 128].as_slice());
    });
    assert_eq!(texels(&bytes), [(left, 128), (right, CLEAR)]);
}

#[test]
fn a_palette_that_ends_mid_colour_is_an_error() {
    for length in 3..=3 * 256 {
        let palette = vec![7; length];
        let bytes = encoded_with(ColorType::Indexed, BitDepth::Eight, &[0, 0], |encoder| {
            encoder.set_palette(palette);
        });
        let decoded = decode(&bytes, &mut PictureBudget::default());
        match length % 3 {
            0 => assert!(decoded.is_ok(), "{length}"),
            _ => assert!(matches!(decoded, Err(PictureError::BrokenPalette)), "{length}"),
        }
    }
}

#[test]
fn one_colour_can_be_transparent() {
    let samples = [1, 2, 3, 4, 5, 6];
    let bytes = encoded_with(ColorType::Rgb, BitDepth::Eight, &samples, |encoder| {
        encoder.set_trns([0, 1, 0, 2, 0, 3].as_slice());
    });
    assert_eq!(texels(&bytes).map(|(_, alpha)| alpha), [CLEAR, OPAQUE]);
}

#[test]
fn the_largest_picture_decodes() {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, MAX_SIDE, MAX_SIDE);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Sixteen);
    let samples = vec![200; 8 * (MAX_SIDE * MAX_SIDE) as usize];
    encoder.write_header().unwrap().write_image_data(&samples).unwrap();
    let texture = decode(&bytes, &mut PictureBudget::default()).unwrap().texture();
    assert_eq!((texture.width(), texture.height()), (MAX_SIDE, MAX_SIDE));
    assert_eq!(texture.mean(), Rgb::new(200, 200, 200));
}

proptest! {
    #[test]
    fn a_damaged_picture_gives_a_texture_or_an_error(
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        cut in any::<prop::sample::Index>(),
    ) {
        let mut bytes = encoded(ColorType::Rgb, BitDepth::Eight, &[1, 2, 3, 4, 5, 6]);
        for (place, byte) in edits {
            *place.get_mut(&mut bytes) = byte;
        }
        bytes.truncate(cut.index(bytes.len() + 1));
        if let Ok(texture) = decode(&bytes, &mut PictureBudget::default()) {
            prop_assert!(texture.width() <= MAX_SIDE && texture.height() <= MAX_SIDE);
        }
    }
}
