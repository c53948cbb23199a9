//! Stored games restore to the same game, and other bytes never restore to a game that fails.

#[path = "../../../tests/support/crowd.rs"]
mod crowd;
mod damage;

use proptest::prelude::*;

use self::crowd::Crowd;
use super::*;
use crate::game::tests::missions::EVERYTHING;
use crate::game::{Game, Intents, MultiplayerRules, Rules, Script, ShownPlayers, StrikeEffect};
use crate::generate::{Extent, GeneratedLevel, Generator};
use crate::map::builtin::LEVELS;
use crate::rng::SplitMix64;
use crate::world::{Difficulty, World};

/// The intents of a level's winning script, step by step.
pub(crate) fn winning(level: &str, difficulty: Difficulty) -> Vec<Intents> {
    let root = env!("CARGO_MANIFEST_DIR");
    let path = format!("{root}/maps/scripts/{level}.{}.script", difficulty.name());
    let text = std::fs::read_to_string(path).unwrap();
    let script = Script::parse(&text, level).unwrap_or_else(|faults| panic!("{faults}"));
    script.iter().map(|(_, intents)| intents).collect()
}

/// The game restored on `start` from the bytes of `game`. It must equal `game` and store to the
/// same bytes.
fn again(start: &Game, game: &Game) -> Game {
    let bytes = game.stored().unwrap();
    let restored = start.clone().restored(&bytes).unwrap_or_else(|error| panic!("{error}"));
    assert_same(&restored, game);
    restored
}

/// Asserts that both games are equal in every field, to the bit.
fn assert_same(one: &Game, other: &Game) {
    assert_eq!(one.world().things(), other.world().things());
    assert_eq!(one.world().figures(), other.world().figures());
    assert!(one.world() == other.world(), "the worlds differ");
    assert_eq!(one.guards, other.guards);
    assert_eq!((&one.player, &one.members), (&other.player, &other.members));
    assert!(one == other, "the games differ");
    assert!(one.stored() == other.stored(), "the bytes differ");
    assert_eq!(one.checksum(), other.checksum());
}

#[test]
fn every_winning_script_resumes_from_any_step() {
    for (number, level) in (0..).zip(LEVELS) {
        for difficulty in Difficulty::ALL {
            let rules = Rules { difficulty, seed: 0 };
            let start = Game::with_rules(level.world().unwrap(), rules);
            let script = winning(level.name, difficulty);
            let mut random = SplitMix64::new(number << 8 | difficulty as u64);
            let stops = [0, random.below(script.len()), random.below(script.len())];
            let mut game = start.clone();
            let mut restored: Vec<Game> = Vec::new();
            for (step, &intents) in script.iter().enumerate() {
                if stops.contains(&step) {
                    restored.push(again(&start, &game));
                }
                game.step(intents);
                for other in &mut restored {
                    other.step(intents);
                }
                // A difference persists, so a check some steps later finds it.
                if step % 32 == 0 {
                    let sums = restored.iter().map(Game::checksum);
                    assert!(
                        sums.eq(vec![game.checksum(); restored.len()]),
                        "{} {step}",
                        level.name
                    );
                }
            }
            for other in &restored {
                assert_same(other, &game);
            }
        }
    }
}

/// Plays with at most four players in a level. One of them may follow its winning script.
fn played(world: World, script: Vec<Intents>, seed: u64, steps: usize) {
    let mut random = SplitMix64::new(seed);
    let multiplayer = MultiplayerRules {
        collides: random.one_in(2),
        respawns: !random.one_in(3),
        shows_on_map: [ShownPlayers::Nobody, ShownPlayers::InSight, ShownPlayers::All]
            [random.below(3)],
        strikes: [StrikeEffect::Nobody, StrikeEffect::Push, StrikeEffect::Stun][random.below(3)],
    };
    let difficulty = Difficulty::ALL[random.below(3)];
    let rules = Rules { difficulty, seed: random.bits() };
    let start = Game::for_players(world, rules, multiplayer);
    let (mut game, mut crowd) = (start.clone(), Crowd::new(script, 4, random));
    (0..steps).for_each(|_| crowd.step(&mut [&mut game]));
    let mut other = again(&start, &game);
    for step in 0..1200 {
        crowd.step(&mut [&mut game, &mut other]);
        if step % 100 == 0 {
            assert_same(&other, &game);
        }
    }
    assert_same(&again(&start, &other), &game);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn games_with_several_players_resume(
        level in prop::sample::select(LEVELS),
        has_script: bool,
        has_guards in prop::bool::weighted(0.8),
        seed: u64,
        steps in 0..3600_usize,
    ) {
        let world = level.world().unwrap();
        let world = if has_guards { world } else { world.without_guards().without_exits() };
        let script = if has_script { winning(level.name, Difficulty::Normal) } else { Vec::new() };
        played(world, script, seed, steps);
    }

    #[test]
    fn games_in_a_map_with_everything_resume(seed: u64, steps in 0..1200_usize) {
        played(crate::map::parse_str(EVERYTHING).unwrap(), Vec::new(), seed, steps);
    }

    #[test]
    fn a_game_resumes_after_a_death(seed: u64, steps in 0..3600_usize) {
        let world = crate::map::parse_str(EVERYTHING).unwrap();
        let mut random = SplitMix64::new(seed);
        let rules = Rules { difficulty: Difficulty::ALL[random.below(3)], seed };
        let start = Game::with_rules(world, rules);
        let (mut game, mut crowd) = (start.clone(), Crowd::new(Vec::new(), 1, random));
        (0..steps).for_each(|_| crowd.step_alone(&mut [&mut game]));
        let mut other = again(&start, &game);
        (0..1200).for_each(|_| crowd.step_alone(&mut [&mut game, &mut other]));
        assert_same(&other, &game);
    }
}

#[test]
fn a_generated_level_is_not_stored() {
    let level = GeneratedLevel::new(Generator::Maze.terrain(7), Extent::Endless).unwrap();
    let start = level.start().unwrap();
    let game = Game::in_level(level, start).unwrap();
    assert_eq!(game.stored(), None);
}

#[test]
fn a_different_game_is_refused_with_a_sentence() {
    let world = |index: usize| LEVELS[index].world().unwrap();
    let game = Game::new(world(0));
    let bytes = game.stored().unwrap();
    let refused = |start: Game, bytes: &[u8]| start.restored(bytes).unwrap_err();
    assert_eq!(refused(Game::new(world(1)), &bytes), RestoreError::OtherLevel);
    let hard = Rules { difficulty: Difficulty::Hard, seed: 0 };
    assert_eq!(refused(Game::with_rules(world(0), hard), &bytes), RestoreError::OtherLevel);
    let several = Game::for_players(world(0), Rules::default(), MultiplayerRules::default());
    assert_eq!(refused(several, &bytes), RestoreError::OtherLevel);
    let line = String::from_utf8_lossy(&bytes).lines().next().unwrap().to_owned();
    assert_eq!(line, format!("cellcaster-game 2 rules 2 version {}", env!("CARGO_PKG_VERSION")));
    let newer = [line.replace("rules 2", "rules 3").as_bytes(), &bytes[line.len()..]].concat();
    let error = refused(game.clone(), &newer);
    assert_eq!(error, RestoreError::OtherVersion);
    assert!(error.to_string().ends_with("with version 2 of the rules"), "{error}");
    let older = [line.replace("game 2", "game 1").as_bytes(), &bytes[line.len()..]].concat();
    assert_eq!(refused(game.clone(), &older), RestoreError::OtherVersion);
    let longer = [&bytes[..], &[0]].concat();
    assert_eq!(refused(game.clone(), &longer), RestoreError::Longer);
    assert_eq!(refused(game, &vec![0; MAX_BYTES + 1]), RestoreError::TooLong);
}
