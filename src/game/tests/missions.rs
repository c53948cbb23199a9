//! Properties of games with guards, mechanisms, hazards and pickups.

use super::*;
use crate::game::script::{Script, ScriptWriter};
use crate::map;
use crate::world::{Difficulty, Supply};

/// A level with every feature.
pub(crate) const EVERYTHING: &str = r##"
par = 60
treasure_needed = 60
grid = '''
######################
#@.t.c.~~.s.p#..h...X#
#.......~~...#..g....#
#..l..T.~~.f.S..2..d.#
#.a##D####.m.#.3...b.#
#.w.#...n#.m.#######G#
#.W.#.u..#.L..F.v.p.k#
######################
'''
[tiles]
'#' = { wall = "brick" }
D = { door = "oak" }
G = { door = "metal", switch = "gate" }
S = { secret = "brick" }
'~' = { water = true, floor = "#204060" }
p = { plate = "gate", floor = "#909090" }
m = { floor_height = 0, ceiling = "sky", moves_to = 1, switch = "lift" }
W = { wall = "stone", switch = "lift" }
w = { floor_height = -0.2 }
c = { floor = "wood", crumbles = -3 }
v = { floor_height = -2.5 }
[things]
'@' = { start = 0 }
X = { exit = true }
t = { treasure = 20 }
T = { treasure = 50 }
a = { darts = 2 }
b = { flasks = 2 }
u = { checkpoint = true }
n = { note = "It listens." }
h = { healing = 2 }
s = { spikes = 2.0, delay = 0.5 }
l = { lever = "lift" }
L = { lever = "gate" }
F = { sprite = "torch", douse = true }
f = { pebbles = 2 }
k = { treasure = 5 }
g = { guard = "warden", heading = 180, patrol = "23" }
2 = { waypoint = true }
3 = { waypoint = true }
d = { guard = "hound", heading = 90, asleep = true }
"##;

fn everything(difficulty: Difficulty) -> Game {
    game(EVERYTHING, difficulty)
}

/// The same level with all guards asleep.
fn at_night(difficulty: Difficulty) -> Game {
    let text = EVERYTHING.replace("patrol = \"23\"", "asleep = true");
    game(&text.replace("{ waypoint = true }", "{ pebbles = 1 }"), difficulty)
}

fn game(text: &str, difficulty: Difficulty) -> Game {
    let world = map::parse_str(text).unwrap_or_else(|faults| panic!("{faults}"));
    Game::with_rules(world, Rules { difficulty, seed: 7 })
}

fn difficulty() -> impl Strategy<Value = Difficulty> {
    prop::sample::select(&Difficulty::ALL[..])
}

/// Sets of intents, each held for some time. Two thirds of them walk or turn.
fn play() -> impl Strategy<Value = Vec<(u32, Intents)>> {
    let held = prop::sample::subsequence(Intent::ALL.to_vec(), 0..=6);
    let look = (-400..400_i16).prop_map(|turn| Look { turn, tilt: 0 });
    let walks = prop_oneof![Just(vec![Intent::Forward]), Just(vec![Intent::Forward, Intent::Run])];
    let wants = prop_oneof![
        held.prop_map(intents_of),
        walks.prop_map(intents_of),
        look.prop_map(|look| Intents::new().with_look(look)),
    ];
    prop::collection::vec((1..90_u32, wants), 1..40)
}

fn intents_of(list: Vec<Intent>) -> Intents {
    list.into_iter().collect()
}

/// The names of the parts in which two games differ.
fn differences(one: &Game, other: &Game) -> Vec<&'static str> {
    let parts = [
        ("world", one.world == other.world),
        ("player", one.player == other.player),
        ("doors", one.doors == other.doors),
        ("mechanisms", one.mechanisms == other.mechanisms),
        ("spikes", one.spikes == other.spikes),
        ("missiles", one.missiles == other.missiles && one.smoke == other.smoke),
        ("guards", one.guards == other.guards),
        ("game", one == other),
    ];
    parts.into_iter().filter(|&(_, is_same)| !is_same).map(|(name, _)| name).collect()
}

fn assert_is_valid(game: &Game) {
    let health = game.health();
    assert!(health.points <= health.most);
    assert!(Supply::ALL.iter().all(|&supply| game.supplies(supply) <= 9));
    for share in [game.treasure(), game.secrets()] {
        assert!(share.found <= share.total);
    }
    assert_eq!(game.treasure().total, 75);
    assert!(game.player.motion.has_room(game.world()), "{:?}", game.player.motion);
    assert_eq!(game.is_dead(), health.is_gone());
    assert!(game.sounds.is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_intents_give_a_valid_and_repeatable_state(
        script in play(),
        difficulty in difficulty(),
    ) {
        let mut game = everything(difficulty);
        for &(steps, intents) in &script {
            for _ in 0..steps {
                game.step(intents);
                assert_is_valid(&game);
            }
        }
        let mut again = everything(difficulty);
        for &(steps, intents) in &script {
            (0..steps).for_each(|_| again.step(intents));
        }
        prop_assert_eq!(again.checksum(), game.checksum());
        prop_assert!(again == game);
    }

    #[test]
    fn waiting_equals_taking_as_many_steps(
        script in play(),
        difficulty in difficulty(),
        is_night in any::<bool>(),
    ) {
        let begin = if is_night { at_night } else { everything };
        let (mut stepped, mut waited) = (begin(difficulty), begin(difficulty));
        for (steps, intents) in script {
            let mut left = u64::from(steps);
            while left > 0 {
                let rests = waited.is_at_rest(intents);
                let steps = if rests { left } else { 1 };
                if rests {
                    waited.wait(steps);
                } else {
                    waited.step(intents);
                }
                let revision = stepped.revision();
                (0..steps).for_each(|_| stepped.step(intents));
                left -= steps;
                if rests {
                    prop_assert_eq!(stepped.revision(), revision);
                    prop_assert_eq!(differences(&waited, &stepped), [""; 0], "{:?}", intents);
                }
            }
        }
        prop_assert_eq!(waited.checksum(), stepped.checksum());
    }

    #[test]
    fn a_saved_game_resumes_as_if_never_interrupted(before in play(), after in play()) {
        let mut game = everything(Difficulty::Normal);
        let mut text = Vec::new();
        let mut recorder = ScriptWriter::new(&mut text);
        for (steps, intents) in before {
            recorder.record(intents, steps.into())?;
            (0..steps).for_each(|_| game.step(intents));
        }
        drop(recorder);
        let script = Script::parse(&String::from_utf8(text)?, "saved").unwrap();
        let mut loaded = everything(Difficulty::Normal);
        script.iter().for_each(|(_, intents)| loaded.step(intents));
        for (steps, intents) in after {
            for _ in 0..steps {
                game.step(intents);
                loaded.step(intents);
            }
            prop_assert_eq!(game.checksum(), loaded.checksum());
        }
    }
}

#[test]
fn a_checksum_notices_every_change() {
    let game = everything(Difficulty::Normal);
    let changes: [fn(&mut Game); 10] = [
        |_| {},
        |game| game.player.health.points -= 1,
        |game| game.player.supplies.add(Supply::Darts, 1),
        |game| game.player.treasure += 1,
        |game| game.player.has_light = true,
        |game| game.steps += 1,
        |game| game.player.counts.stunned += 1,
        |game| game.rules.seed += 1,
        |game| game.doors.open(Cell { column: 5, row: 4 }),
        |game| game.smoke.add(DVec2::ONE, 0.0),
    ];
    let sums: std::collections::BTreeSet<u64> = changes
        .iter()
        .map(|change| {
            let mut changed = game.clone();
            change(&mut changed);
            (0..3).for_each(|_| changed.step(Intents::new()));
            changed.checksum()
        })
        .collect();
    assert_eq!(sums.len(), changes.len());
}
