//! The looks of members' figures, by which everybody recognises roles without reading.

use cellcaster::game::{Game, PlayerId};
use cellcaster::world::Figure;

/// The opacity of a pale figure, of 255.
const PALE: u8 = 110;

/// The look of a member's figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) enum FigureLook {
    /// In the member's colour.
    #[default]
    Usual,
    /// Glowing, with a mark above the head: "it", or a seeker.
    Marked,
    /// Translucent: nobody can tag the member, or the member is away.
    Pale,
}

/// The figures of `game` with the looks of its players. `None` if all look as usual.
pub(crate) fn figures(
    game: &Game,
    looks: impl Iterator<Item = (PlayerId, FigureLook)>,
) -> Option<Vec<Figure>> {
    let mut figures = None;
    for (player, look) in looks.filter(|it| it.1 != FigureLook::Usual) {
        let Some(player) = game.seen_by(player) else { continue };
        let figures = figures.get_or_insert_with(|| game.world().figures().to_vec());
        let position = player.position();
        let sprite = player.color().and_then(|color| game.sprite_of_players(color));
        let is_own = |it: &&mut Figure| it.position == position && Some(it.sprite) == sprite;
        let Some(figure) = figures.iter_mut().find(is_own) else { continue };
        match look {
            FigureLook::Marked => {
                figure.sprite = game.sprite_of_marked_players().unwrap_or(figure.sprite);
            }
            FigureLook::Pale => figure.opacity = PALE,
            FigureLook::Usual => {}
        }
    }
    figures
}
