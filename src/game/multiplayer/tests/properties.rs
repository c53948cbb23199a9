//! Invariants for every sequence of joins, leaves and intents.

use proptest::prelude::*;

use super::*;
use crate::game::tests::missions::EVERYTHING;
use crate::game::tests::script;

/// An event in a game.
#[derive(Clone, Debug)]
enum Event {
    Join(PlayerColor),
    Leave(usize),
    /// A number of steps, and for each input its slot, its intents, and the age of the step that
    /// the player saw.
    Play(usize, Vec<(usize, Vec<Intent>, u64)>),
}

fn event() -> impl Strategy<Value = Event> {
    let held = prop::sample::subsequence(Intent::ALL.to_vec(), 0..=6);
    let wanted = prop::collection::vec((0..8_usize, held, 0..40_u64), 0..8);
    prop_oneof![
        1 => prop::sample::select(&PlayerColor::ALL[..]).prop_map(Event::Join),
        1 => (0..8_usize).prop_map(Event::Leave),
        4 => (1..40_usize, wanted).prop_map(|(steps, wanted)| Event::Play(steps, wanted)),
    ]
}

fn rules() -> impl Strategy<Value = MultiplayerRules> {
    let strikes =
        prop::sample::select(&[StrikeEffect::Nobody, StrikeEffect::Push, StrikeEffect::Stun][..]);
    (any::<bool>(), any::<bool>(), strikes).prop_map(|(collides, respawns, strikes)| {
        MultiplayerRules { collides, respawns, strikes, ..MultiplayerRules::default() }
    })
}

/// Applies `event`. At most eight players are in the game at once.
fn happen(game: &mut Game, event: &Event) {
    match event {
        Event::Join(color) => {
            if game.players().count() < 8 {
                game.join(*color);
            }
        }
        Event::Leave(index) => game.leave(PlayerId::new(*index).unwrap()),
        Event::Play(steps, wanted) => {
            for _ in 0..*steps {
                let inputs = wanted.iter().map(|(index, list, ago)| Input {
                    player: PlayerId::new(*index).unwrap(),
                    intents: intents(list),
                    seen: game.steps().saturating_sub(*ago),
                });
                let inputs: Vec<Input> = inputs.collect();
                game.step_all(&inputs);
                assert_is_valid(game);
            }
        }
    }
}

/// Asserts that no player is inside an obstacle or, if players collide, inside another player.
fn assert_is_valid(game: &Game) {
    let collides = game.multiplayer_rules().unwrap().collides;
    let least = 2.0 * RADIUS.cells();
    for (index, player) in game.playing() {
        assert!(player.motion.has_room(&game.world), "{index}: {:?}", player.motion);
        let position = player.motion.position();
        let is_apart = |other: DVec2| other.distance_squared(position) >= least * least;
        let mut others = game.playing().filter(|&(other, _)| other != index);
        assert!(!collides || others.all(|(_, other)| is_apart(other.motion.position())));
    }
    let figures = game.members.as_ref().unwrap().each().filter(|(_, member)| !member.has_won);
    let shown = game.world.figures().len();
    assert!(shown >= figures.count() && game.members.as_ref().unwrap().turn.is_none());
    for player in game.players() {
        let view = game.seen_by(player).unwrap();
        assert!(view.health().points <= view.health().most);
        assert!(view.others().all(|other| other.id != player));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_sequence_gives_a_valid_and_repeatable_state(
        rules in rules(),
        events in prop::collection::vec(event(), 0..16),
    ) {
        let mut games = [0; 2].map(|_| Game::for_players(world(EVERYTHING), RULES, rules));
        for game in &mut games {
            game.join(PlayerColor::Red);
            for event in &events {
                happen(game, event);
            }
        }
        prop_assert_eq!(games[0].checksum(), games[1].checksum());
        prop_assert!(games[0] == games[1]);
    }

    #[test]
    fn one_player_plays_as_in_a_single_player_game(rules in rules(), script in script()) {
        let mut alone = Game::with_rules(world(EVERYTHING), RULES);
        let (mut game, ids) = with_players(world(EVERYTHING), rules, 1);
        for (steps, held) in &script {
            for _ in 0..*steps {
                if alone.outcome() != Outcome::Playing {
                    break;
                }
                alone.step(intents(held));
                play(&mut game, 1, &[(ids[0], held)]);
            }
        }
        assert_plays_alike(&alone, &game);
    }

    #[test]
    fn players_who_have_left_change_nothing(script in script(), count in 1..6_usize) {
        let rules = MultiplayerRules { collides: true, ..MultiplayerRules::default() };
        let mut games = [0; 2].map(|_| with_players(world(EVERYTHING), rules, 1).0);
        for (steps, held) in &script {
            let guests: Vec<_> =
                (0..count).filter_map(|_| games[1].join(PlayerColor::Pink)).collect();
            guests.into_iter().rev().for_each(|guest| games[1].leave(guest));
            for game in &mut games {
                play(game, *steps, &[(PlayerId::FIRST, held)]);
            }
        }
        prop_assert_eq!(games[0].checksum(), games[1].checksum());
        prop_assert!(games[0].guards == games[1].guards);
    }

    #[test]
    fn waiting_equals_taking_as_many_steps(steps in 0..200_u64, wins in any::<bool>()) {
        let (mut game, ids) = with_players(level(&["@.X"], "", "X = { exit = true }"), MultiplayerRules::default(), 1);
        prop_assert!(!game.is_at_rest(Intents::new()));
        if wins {
            play(&mut game, 120, &[(ids[0], &[Intent::Forward])]);
        } else {
            game.leave(ids[0]);
        }
        prop_assert!(game.is_at_rest(Intents::new()));
        let mut waited = game.clone();
        waited.wait(steps);
        (0..steps).for_each(|_| game.step_all(&[]));
        prop_assert!(waited == game);
    }
}
