//! The memory of games with several players. Counts allocations, and measures no times.

use allocation_counter::measure;
use cellcaster::game::{Game, Input, Intent, Intents, MultiplayerRules, PlayerColor, Rules};
use cellcaster::map;

#[test]
fn a_step_with_eight_players_soon_allocates_nothing() {
    let hall = format!("#{}#\n", ".".repeat(20)).repeat(12);
    let edge = "#".repeat(22);
    let grid = format!("{edge}\n#{}@..G#\n{hall}{edge}", ".".repeat(16));
    let text = format!(
        "grid = '''\n{grid}\n'''\n[tiles]\n'#'.wall = 'brick'\n\
         [things]\n'@'.start = 180\nG = {{ guard = 'hound', asleep = true }}\n"
    );
    for collides in [false, true] {
        let world = map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"));
        let rules = MultiplayerRules { collides, ..MultiplayerRules::default() };
        let mut game = Game::for_players(world, Rules::default(), rules);
        let players = PlayerColor::ALL.map(|color| game.join(color).unwrap());
        // Ducking wakes no guard.
        let circling = [Intent::Forward, Intent::Duck, Intent::TurnRight];
        let mut step = || {
            let (seen, intents) = (game.steps(), circling.into_iter().collect::<Intents>());
            game.step_all(&players.map(|player| Input { player, intents, seen }));
        };
        (0..3600).for_each(|_| step());
        let counted = measure(|| (0..600).for_each(|_| step()));
        assert_eq!(counted.count_total, 0, "collides: {collides}");
    }
}
