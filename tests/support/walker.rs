//! A player who walks in a small level.

use cellcaster::game::{Game, Intent, Intents};
use cellcaster::map;
use cellcaster::world::FieldOfView;
use glam::DVec2;

/// The line of a map that opens the sky.
pub(crate) const SKY: &str = "ceiling = \"sky\"";

/// A set of intents.
pub(crate) fn want(list: &[Intent]) -> Intents {
    list.iter().copied().collect()
}

/// The player's position.
pub(crate) fn position(game: &Game) -> DVec2 {
    game.camera(FieldOfView::default()).position()
}

/// Advances by `steps` steps with the same intents.
pub(crate) fn walk(game: &mut Game, steps: usize, wanted: &[Intent]) {
    (0..steps).for_each(|_| game.step(want(wanted)));
}

/// A corridor to the east, under the sky or below a ceiling. After the start come three cells of
/// the map's own floor, and then one cell for each description in `tiles`.
pub(crate) fn corridor(ceiling: &str, tiles: &[&str]) -> Game {
    let letters: String = ('a'..).take(tiles.len()).collect();
    let wall = "#".repeat(6 + tiles.len());
    let legend: Vec<String> =
        ('a'..).zip(tiles).map(|(letter, tile)| format!("\"{letter}\" = {{ {tile} }}\n")).collect();
    let legend = legend.concat();
    let map = format!(
        "{ceiling}\ngrid = '''\n{wall}\n#@...{letters}#\n{wall}\n'''\n[tiles]\n\
         \"#\" = {{ wall = \"brick\", height = 99 }}\n{legend}[things]\n\"@\" = {{ start = 0 }}\n"
    );
    Game::new(map::parse_str(&map).unwrap_or_else(|faults| panic!("{map}\n{faults}")))
}
