//! The built-in textures: sheets of `maps/art`.
//!
//! All textures are 64 texels square and lit from the upper left. They tile horizontally without a
//! seam. They also tile vertically, except for `plaster`, which has a rail and a skirting board,
//! and `fence`, which stands on the ground. `grate` and `fence` have holes.
//!
//! Features are large and noise is faint: a wall in a terminal is rarely more than thirty pixels
//! high, and at that size noise shimmers and costs bytes.

use super::Texture;
use crate::world::art::{Art, art};

/// The names of the built-in textures.
pub const NAMES: &[&str] = &names();

/// The built-in texture `name`; `None` if there is none.
pub fn named(name: &str) -> Option<Texture> {
    let art = TEXTURES.iter().find(|art| art.name == name)?;
    Some(art.texture(WITH_HOLES.contains(&name)))
}

/// The names of the built-in panoramas.
pub const PANORAMAS: &[&str] = &[HILLS.name];

/// The built-in panorama `name`; `None` if there is none.
pub fn panorama(name: &str) -> Option<Texture> {
    (name == HILLS.name).then(|| HILLS.texture(false))
}

/// The sheets of all textures and panoramas.
pub(crate) fn sheets() -> impl Iterator<Item = Art> {
    TEXTURES.into_iter().chain([HILLS])
}

const TEXTURES: [Art; 16] = [
    art!("brick"),
    art!("stone"),
    art!("moss"),
    art!("wood"),
    art!("oak"),
    art!("metal"),
    art!("tile"),
    art!("flagstone"),
    art!("plaster"),
    art!("sandstone"),
    art!("hedge"),
    art!("marble"),
    art!("jamb"),
    art!("grate"),
    art!("fence"),
    art!("coffer"),
];

const WITH_HOLES: [&str; 2] = ["grate", "fence"];

/// Three ranges of hills under a morning sky, 512 texels around and 64 texels up from the horizon.
const HILLS: Art = art!("hills");

const fn names() -> [&'static str; TEXTURES.len()] {
    let mut names = [""; TEXTURES.len()];
    let mut index = 0;
    while index < names.len() {
        names[index] = TEXTURES[index].name;
        index += 1;
    }
    names
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fmt::Write;

    use super::*;
    use crate::color::Rgb;
    use crate::rng::hash;

    const SIDE: i32 = 64;

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

    /// Returns whether the last of `lines` and the first differ at most twice as much as neighbours
    /// do on average.
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
            let holes = texels().filter(|&(x, y)| texture.texel(x, y).1 == 0).count();
            if ["grate", "fence"].contains(name) {
                assert!((64 * 64 / 3..64 * 64 * 3 / 4).contains(&holes), "{name}: {holes}");
                assert!(texture.has_alpha(), "{name}");
            } else {
                assert!(holes == 0 && !texture.has_alpha(), "{name}: {holes}");
            }
        }
    }

    #[test]
    fn every_texel_is_as_painted() {
        let mut list = String::new();
        for name in NAMES.iter().chain(PANORAMAS) {
            let texture = named(name).or_else(|| panorama(name)).unwrap();
            let texels =
                (0..texture.width()).flat_map(|x| (0..texture.height()).map(move |y| (x, y)));
            let print = hash(
                0,
                texels.map(|(x, y)| {
                    let (color, alpha) = texture.texel(x, y);
                    u64::from(u32::from_be_bytes([color.red(), color.green(), color.blue(), alpha]))
                }),
            );
            writeln!(list, "{name:9} {} {print:016x}", texture.mean()).unwrap();
        }
        insta::assert_snapshot!(list, @r"
        brick     #a4614c c8b9508f43b5652a
        stone     #787b84 c6098b938bfa14d5
        moss      #607454 414ed3c702ca3819
        wood      #855b36 6ad9a9106206a536
        oak       #926231 be913f1172cd03f4
        metal     #636e7a a250a28157a705f3
        tile      #789590 03ac29c5d8b3684d
        flagstone #7b6f61 54cad51b0ffe02e7
        plaster   #bba88c d346000bfb851299
        sandstone #ba9661 f3f11a2fc70d3f19
        hedge     #447535 55406f1161c05273
        marble    #c1c4ca a4ff234cbc0ebb81
        jamb      #75767a 1a2b91bb0efb0410
        grate     #56585c 978e68d5fc596def
        fence     #6a5c47 caec2b706ec57302
        coffer    #a39884 bdf5aa933325c8c2
        hills     #90a8bb 72f4b0c000fadcdd
        ");
    }
}
