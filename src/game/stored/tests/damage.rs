//! Bytes that are not a stored game, or that are a game nobody has played.

use proptest::prelude::*;

use super::*;

/// A start, and the bytes of a game with three players after `steps` steps.
fn stored(text: &str, seed: u64, steps: usize) -> (Game, Vec<u8>) {
    let world = crate::map::parse_str(text).unwrap();
    let rules = Rules { difficulty: Difficulty::Normal, seed };
    let start = Game::for_players(world, rules, MultiplayerRules::default());
    let (mut game, mut crowd) = (start.clone(), Crowd::new(Vec::new(), 3, SplitMix64::new(seed)));
    (0..steps).for_each(|_| crowd.step(&mut [&mut game]));
    (start, game.stored().unwrap())
}

/// Continues for `steps` steps if the bytes are a game, and queries the views of its players.
fn play_on(start: &Game, bytes: &[u8], steps: usize) -> Result<(), RestoreError> {
    let mut game = start.clone().restored(bytes)?;
    let mut crowd = Crowd::new(Vec::new(), 4, SplitMix64::new(1));
    for _ in 0..steps {
        crowd.step(&mut [&mut game]);
        game.checksum();
        for id in game.players() {
            let view = game.seen_by(id).unwrap();
            view.camera(crate::world::FieldOfView::default());
            _ = (view.tally(), view.note(), view.keys().count(), view.others_on_map().count());
        }
    }
    game.stored().unwrap();
    Ok(())
}

#[test]
fn truncated_bytes_are_refused() {
    let (start, bytes) = stored(EVERYTHING, 3, 900);
    for length in 0..bytes.len() {
        let refused = start.clone().restored(&bytes[..length]);
        assert!(refused.is_err(), "{length} of {} bytes", bytes.len());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn damaged_bytes_are_refused_or_give_a_game(
        seed in 0..8_u64,
        flips in prop::collection::vec((any::<prop::sample::Index>(), 0..8_u8), 1..4),
    ) {
        let (start, mut bytes) = stored(EVERYTHING, seed, 300 + 100 * seed as usize);
        let first = first_line("game").len() + 8;
        for (index, bit) in flips {
            let place = first + index.index(bytes.len() - first);
            bytes[place] ^= 1 << bit;
        }
        _ = play_on(&start, &bytes, 600);
    }

    #[test]
    fn replaced_bytes_are_refused_or_give_a_game(
        seed in 0..8_u64,
        place: prop::sample::Index,
        new in prop::collection::vec(any::<u8>(), 1..9),
    ) {
        let (start, mut bytes) = stored(EVERYTHING, seed, 300 + 100 * seed as usize);
        let first = first_line("game").len() + 8;
        let place = first + place.index(bytes.len() - first - new.len());
        bytes[place..place + new.len()].copy_from_slice(&new);
        _ = play_on(&start, &bytes, 600);
    }
}
