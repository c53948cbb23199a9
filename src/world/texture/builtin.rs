//! The built-in textures, computed when one is first shown.
//!
//! All are 64 texels square and lit from the upper left. Each is a function from a texel's position
//! to its colour, in integers only, so that it is the same on every machine. They tile horizontally
//! without a seam, and vertically except for `plaster`, which has a rail and a skirting board, and
//! `fence`, which stands on the ground. `grate` and `fence` have holes.
//!
//! Features are large and noise is faint: a wall is rarely more than thirty pixels high in a
//! terminal, where noise shimmers and costs bytes. Compiled-in picture files were refused: they
//! would be larger than this code, and changes to them could not be reviewed.

mod block;
mod facing;
mod hedge;
mod masonry;
mod metal;
mod noise;
mod panorama;
mod shade;
mod timber;

use std::num::NonZeroU32;

use super::Texture;
use crate::color::Rgb;

/// The names of the built-in textures.
pub const NAMES: &[&str] = &names();

/// The built-in texture `name`; `None` if there is none.
pub fn named(name: &str) -> Option<Texture> {
    let (_, painter) = PAINTERS.iter().find(|(known, _)| *known == name)?;
    Some(match *painter {
        Painter::Solid(paint) => Texture::on_demand(SIDE_LENGTH, SIDE_LENGTH, false, move || {
            move |x, y| (paint(x as i32, y as i32), OPAQUE)
        }),
        Painter::WithHoles(paint) => {
            Texture::on_demand(SIDE_LENGTH, SIDE_LENGTH, true, move || {
                move |x, y| paint(x as i32, y as i32).map_or((HOLE, CLEAR), |color| (color, OPAQUE))
            })
        }
    })
}

/// The names of the built-in panoramas.
pub const PANORAMAS: &[&str] = &["hills"];

/// The built-in panorama `name`; `None` if there is none.
pub fn panorama(name: &str) -> Option<Texture> {
    const WIDTH: NonZeroU32 = NonZeroU32::new(panorama::WIDTH as u32).expect("it is not 0");
    const HEIGHT: NonZeroU32 = NonZeroU32::new(panorama::HEIGHT as u32).expect("it is not 0");
    (name == PANORAMAS[0]).then(|| {
        Texture::on_demand(WIDTH, HEIGHT, false, || {
            let paint = panorama::hills();
            move |x, y| (paint(x as i32, y as i32), OPAQUE)
        })
    })
}

/// The number of texels along each side.
const SIDE: i32 = SIDE_LENGTH.get() as i32;
const SIDE_LENGTH: NonZeroU32 = NonZeroU32::new(64).expect("64 is not 0");

/// The function from a texel `(x, y)`, both from 0 up to [`SIDE`], to its colour.
#[derive(Clone, Copy)]
enum Painter {
    Solid(fn(i32, i32) -> Rgb),
    /// A texture with holes, for which the function returns `None`.
    WithHoles(fn(i32, i32) -> Option<Rgb>),
}

/// The colour of holes if a wall has such a texture.
const HOLE: Rgb = Rgb::new(0x1c, 0x1e, 0x22);
const CLEAR: u8 = 0;
const OPAQUE: u8 = u8::MAX;

const PAINTERS: [(&str, Painter); 16] = [
    ("brick", Painter::Solid(masonry::brick)),
    ("stone", Painter::Solid(masonry::stone)),
    ("moss", Painter::Solid(masonry::moss)),
    ("wood", Painter::Solid(timber::wood)),
    ("oak", Painter::Solid(timber::oak)),
    ("metal", Painter::Solid(metal::metal)),
    ("tile", Painter::Solid(facing::tile)),
    ("flagstone", Painter::Solid(masonry::flagstone)),
    ("plaster", Painter::Solid(facing::plaster)),
    ("sandstone", Painter::Solid(masonry::sandstone)),
    ("hedge", Painter::Solid(hedge::hedge)),
    ("marble", Painter::Solid(facing::marble)),
    ("jamb", Painter::Solid(metal::jamb)),
    ("grate", Painter::WithHoles(metal::grate)),
    ("fence", Painter::WithHoles(timber::fence)),
    ("coffer", Painter::Solid(facing::coffer)),
];

/// The difference of two positions, the shorter way around the texture.
fn wrapped(difference: i32) -> i32 {
    (difference + SIDE / 2).rem_euclid(SIDE) - SIDE / 2
}

const fn names() -> [&'static str; PAINTERS.len()] {
    let mut names = [""; PAINTERS.len()];
    let mut index = 0;
    while index < names.len() {
        names[index] = PAINTERS[index].0;
        index += 1;
    }
    names
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fmt::Write;

    use super::*;

    /// The texels of the texture `name`, column by column.
    fn columns(name: &str) -> Vec<Vec<Rgb>> {
        let texture = named(name).unwrap();
        let middle = |x: i32| (f64::from(x) + 0.5) / f64::from(SIDE);
        (0..SIDE).map(|x| texture.column(middle(x)).to_vec()).collect()
    }

    fn rows(columns: &[Vec<Rgb>]) -> Vec<Vec<Rgb>> {
        (0..columns[0].len()).map(|y| columns.iter().map(|column| column[y]).collect()).collect()
    }

    /// The sum of the differences of all channels of two lines of texels.
    fn difference(one: &[Rgb], other: &[Rgb]) -> u32 {
        let channels = |line: &[Rgb]| line.iter().flat_map(|texel| texel.channels()).collect();
        let (one, other): (Vec<u8>, Vec<u8>) = (channels(one), channels(other));
        one.iter().zip(other).map(|(&one, other)| u32::from(one.abs_diff(other))).sum()
    }

    /// Whether the last of `lines` and the first differ at most twice as much as neighbours do on
    /// average.
    fn wraps(lines: &[Vec<Rgb>]) -> bool {
        let between: u32 = lines.windows(2).map(|pair| difference(&pair[0], &pair[1])).sum();
        let seam = difference(&lines[lines.len() - 1], &lines[0]);
        seam * (lines.len() as u32 - 1) <= 2 * between
    }

    #[test]
    fn the_textures_differ() {
        let mut seen = Vec::new();
        for name in NAMES {
            let texture = named(name).unwrap();
            assert_eq!((texture.width(), texture.height()), (64, 64), "{name}");
            assert!(!seen.contains(&texture), "{name} looks like another one");
            seen.push(texture);
        }
        assert_eq!(named("Brick"), None);
        assert_eq!(named(""), None);
    }

    #[test]
    fn walls_tile_horizontally_without_a_seam() {
        for name in NAMES {
            assert!(wraps(&columns(name)), "{name}");
        }
    }

    #[test]
    fn floors_tile_vertically_without_a_seam() {
        for name in NAMES.iter().filter(|name| !["plaster", "fence"].contains(name)) {
            assert!(wraps(&rows(&columns(name))), "{name}");
        }
    }

    #[test]
    fn mean_brightness_leaves_room_for_shading() {
        for name in NAMES {
            let luma = named(name).unwrap().mean().luma();
            assert!((70..=210).contains(&luma), "{name}: {luma}");
        }
    }

    #[test]
    fn features_are_visible_when_a_wall_is_eight_pixels_high() {
        const PIXEL: usize = SIDE as usize / 8;
        for name in NAMES {
            let columns = columns(name);
            let pixel_luma = |x: usize, y: usize| {
                let texels = columns[x..x + PIXEL].iter().flat_map(|column| &column[y..y + PIXEL]);
                texels.map(|texel| u32::from(texel.luma())).sum::<u32>() / (PIXEL * PIXEL) as u32
            };
            let steps = || (0..SIDE as usize).step_by(PIXEL);
            let lumas: Vec<u32> = steps()
                .flat_map(|x| steps().map(move |y| (x, y)))
                .map(|(x, y)| pixel_luma(x, y))
                .collect();
            let contrast = lumas.iter().max().unwrap() - lumas.iter().min().unwrap();
            assert!(contrast >= 20, "{name}: {contrast}");
        }
    }

    #[test]
    fn palettes_are_small() {
        for name in NAMES {
            let colors: BTreeSet<[u8; 3]> =
                columns(name).iter().flatten().map(|texel| texel.channels()).collect();
            assert!(colors.len() <= 100, "{name}: {}", colors.len());
        }
    }

    #[test]
    fn grates_and_fences_have_holes() {
        for name in NAMES {
            let texture = named(name).unwrap();
            let texels = || (0..64).flat_map(|x| (0..64).map(move |y| (x, y)));
            let holes = texels().filter(|&(x, y)| texture.texel(x, y).1 == CLEAR).count();
            if ["grate", "fence"].contains(name) {
                assert!((64 * 64 / 3..64 * 64 * 3 / 4).contains(&holes), "{name}: {holes}");
                assert!(texture.has_alpha(), "{name}");
            } else {
                assert!(holes == 0 && !texture.has_alpha(), "{name}: {holes}");
            }
        }
    }

    #[test]
    fn textures_are_the_same_on_every_machine() {
        let mut list = String::new();
        for name in NAMES {
            let columns = columns(name);
            let fingerprint = columns.iter().flatten().fold(0, |sum, texel| {
                let [red, green, blue] = texel.channels().map(i32::from);
                noise::hash(red << 16 | green << 8 | blue, 0, sum)
            });
            writeln!(list, "{name:9} {} {fingerprint:08x}", named(name).unwrap().mean()).unwrap();
        }
        insta::assert_snapshot!(list, @r"
        brick     #a4614c fc4b38eb
        stone     #787b84 2057e56f
        moss      #607454 5c82026b
        wood      #855b36 1ed0e4e3
        oak       #926231 34f64b78
        metal     #636e7a a98a0733
        tile      #789590 8701390b
        flagstone #7b6f61 98697f34
        plaster   #bba88c d8e05a63
        sandstone #ba9661 e42eb514
        hedge     #447535 0f990761
        marble    #c1c4ca ed3037a3
        jamb      #75767a bf2e1ee8
        grate     #56585c bce9d347
        fence     #6a5c47 bfff9378
        coffer    #a39884 12742fe1
        ");
    }
}
