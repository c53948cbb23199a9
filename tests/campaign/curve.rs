//! The curve of difficulty: how often a person who makes errors wins each level, with how many
//! deaths and in what time.
//!
//! `CELLCASTER_TRIES=50 cargo test --test campaign curve -- --nocapture` plays each level and
//! difficulty fifty times and prints the table. Without the variable, it is [`TRIES`] times.

use std::env;
use std::fmt::Write;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use cellcaster::game::{Game, Outcome, Rules};
use cellcaster::map::builtin;
use cellcaster::world::{Difficulty, ThingKind};

use crate::levels::{route, world};
use crate::person::{self, Person};
use crate::ways::Ways;

/// The variable that sets the number of tries, and the number without it.
const VARIABLE: &str = "CELLCASTER_TRIES";
const TRIES: u64 = 8;
const DIFFICULTIES: [Difficulty; 2] = [Difficulty::Easy, Difficulty::Normal];

/// The results of all tries at a level on a difficulty.
#[derive(Clone, Debug, Default)]
struct Results {
    tries: u64,
    deaths: u32,
    /// The times of the tries that won, in seconds.
    times: Vec<f64>,
}

impl Results {
    fn add(&mut self, person: &Person) {
        let game = &person.pilot.game;
        self.tries += 1;
        self.deaths += game.tally().deaths;
        if game.outcome() == Outcome::Won {
            self.times.push(game.elapsed());
        }
    }

    /// The share of the tries that won.
    fn rate(&self) -> f64 {
        self.times.len() as f64 / self.tries as f64
    }

    fn columns(&self) -> String {
        let mut times = self.times.clone();
        times.sort_by(f64::total_cmp);
        let Some(median) = times.get(times.len() / 2) else {
            return format!("{:>7}{:>8}{:>8}", "0 %", "-", "-");
        };
        let deaths = f64::from(self.deaths) / times.len() as f64;
        format!("{:>5.0} %{deaths:>8.1}{median:>6.0} s", 100.0 * self.rate())
    }
}

/// The results on each difficulty, level by level.
fn play_all(tries: u64) -> Vec<[Results; 2]> {
    let next = AtomicUsize::new(0);
    let all = Mutex::new(vec![<[Results; 2]>::default(); builtin::LEVELS.len()]);
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(level) = builtin::LEVELS.get(index / 2) else { break };
            let (column, mut results) = (index % 2, Results::default());
            let rules = Rules { difficulty: DIFFICULTIES[column], seed: 0 };
            (0..tries).for_each(|seed| results.add(&person::play(level, rules, seed)));
            all.lock().unwrap_or_else(PoisonError::into_inner)[index / 2][column] = results;
        }
    };
    thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
    all.into_inner().unwrap()
}

fn table(all: &[[Results; 2]]) -> String {
    let mut text = format!("{:13}{:>23}{:>25}\n", "", "easy", "normal");
    let columns = format!("{:>7}{:>8}{:>8}", "won", "deaths", "median");
    _ = writeln!(text, "{:13}{columns}  {columns}", "");
    for (level, [easy, normal]) in builtin::LEVELS.iter().zip(all) {
        _ = writeln!(text, "{:13}{}  {}", level.name, easy.columns(), normal.columns());
    }
    text
}

#[test]
fn levels_become_harder_for_a_person_who_makes_errors() {
    let tries = env::var(VARIABLE).map_or(TRIES, |text| text.parse().unwrap());
    let all = play_all(tries);
    let text = table(&all);
    eprintln!("{text}");
    for (level, [easy, normal]) in builtin::LEVELS.iter().zip(&all).take(4) {
        assert!(easy.rate() > 0.5, "{} on easy:\n{text}", level.name);
        assert!(normal.rate() >= 0.25, "{} on normal:\n{text}", level.name);
    }
    let mean = |levels: &[[Results; 2]]| {
        let rates = levels.iter().flatten().map(Results::rate);
        rates.sum::<f64>() / (2 * levels.len()) as f64
    };
    let [first, second, third] = [&all[..4], &all[4..8], &all[8..]].map(mean);
    let is_falling = first > second && second > third;
    assert!(is_falling, "{first:.2}, {second:.2}, {third:.2}:\n{text}");
    insta::assert_snapshot!(format!("curve_{tries}"), text);
}

/// A way leads to the checkpoint or heart from a place on the route.
#[test]
fn every_level_has_a_checkpoint_or_a_heart_on_the_way() {
    let helps = |kind| matches!(kind, ThingKind::Checkpoint | ThingKind::Healing(_));
    for level in builtin::LEVELS {
        let game = Game::new(world(level));
        let things = game.world().things().iter().filter(|thing| helps(thing.kind));
        let mut ways = things.map(|thing| Ways::new(&game, thing.cell, |_| 0));
        let is_on_the_way =
            |ways: Ways| route(level).iter().any(|errand| ways.cost(errand.cell) < u32::MAX);
        assert!(ways.any(is_on_the_way), "{}", level.name);
    }
}
