//! The legend of the map, as lines of text.

use super::GlyphSet;
use crate::color::palette::ColorDepth;

/// The meaning of the colours of a map, or of its characters if it is drawn in them. The first line
/// is about the marks.
pub(crate) fn legend(glyphs: GlyphSet, depth: ColorDepth) -> [&'static str; 4] {
    match (glyphs.has_blocks(), depth) {
        (false, _) => [
            "map: you are the arrow; guards in view ( ) n u, your best run g",
            "# wall, + door, . floor, : floor in view, = higher, _ lower, ~ water",
            "% floor that a guard in view looks at",
            "X exit, k key, $ treasure, tool or note, o anything else",
        ],
        (true, ColorDepth::Mono) => [
            "map: you are the arrow; guards in view ▸, your best run ▹",
            "full: walls and doors; chequered: higher floor; dashes: water",
            "few dots: floor in view; slanted dots: floor that a guard looks at",
            "X exit, k key, $ treasure, tool or note, o anything else",
        ],
        (true, ColorDepth::Indexed16) => [
            "map: you are the arrow; guards in view ▸ on red, your best run ▹",
            "floor grey, in view yellow; higher floor cyan, pits red, water blue",
            "floor that a guard in view looks at: red",
            "exit bright green, keys pink, treasure, tools and notes bright cyan",
        ],
        (true, ColorDepth::Indexed256 | ColorDepth::True) => [
            "map: you are the yellow arrow; guards in view ▸ on red, your best run ▹",
            "floor dark, in view lighter; higher floor grey, pits red, water blue",
            "floor that a guard in view looks at: orange",
            "exit green, keys gold, treasure, tools and notes violet",
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::super::top_view::{Floor, MapPoint};
    use super::*;
    use crate::color::Rgb;

    #[test]
    fn every_character_of_the_map_is_in_the_legend() {
        let legend = legend(GlyphSet::Ascii, ColorDepth::Mono).join(" ");
        let floors = [0.0, 1.0, -1.0].map(|height| Floor::new(height, Rgb::WHITE));
        let floors = floors.into_iter().chain([Floor::water(-1.0)]);
        let floors = floors.flat_map(|floor| {
            [MapPoint::Floor(floor), MapPoint::InView(floor), MapPoint::Watched(floor)]
        });
        let others = [MapPoint::Wall(Rgb::WHITE), MapPoint::Door(Rgb::WHITE), MapPoint::Exit];
        let others = others.into_iter().chain([MapPoint::Key, MapPoint::Item, MapPoint::Ornament]);
        for point in floors.chain(others) {
            let character = point.look().character;
            assert!(
                legend.split([' ', ',']).any(|word| word == character.to_string()),
                "{point:?}"
            );
        }
    }
}
