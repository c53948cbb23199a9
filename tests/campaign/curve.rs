//! The curve of difficulty: how often a person who makes errors wins each level, with how many
//! deaths and in what time.
//!
//! `CELLCASTER_TRIES=50 cargo test --test campaign curve -- --nocapture` plays each level and
//! difficulty fifty times and prints the table. Without the variable, it is [`TRIES`] times.
//!
//! The rates are exact, because every try is repeatable, but a change of the game rolls the dice
//! again. So a level may be won more often than an earlier one by two standard errors of the
//! difference: 13 points with 50 tries, 24 points with 16.

use std::env;
use std::fmt::Write;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread;

use cellcaster::game::{Outcome, Rules};
use cellcaster::map::builtin;
use cellcaster::world::Difficulty;

use crate::person::{self, Loss, Person};

/// The variable that sets the number of tries, and the numbers without it.
const VARIABLE: &str = "CELLCASTER_TRIES";
const TRIES: [u64; 2] = [8, 16];
const DIFFICULTIES: [Difficulty; 2] = [Difficulty::Easy, Difficulty::Normal];

/// The results of all tries at a level on a difficulty.
#[derive(Clone, Debug, Default)]
struct Results {
    tries: u64,
    deaths: u32,
    /// The times of the tries that won, in seconds.
    times: Vec<f64>,
    losses: Vec<Loss>,
}

impl Results {
    fn add(&mut self, person: &Person) {
        let game = &person.pilot.game;
        self.tries += 1;
        self.deaths += game.tally().deaths;
        self.losses.extend(&person.losses);
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
fn played() -> &'static [[Results; 2]] {
    static PLAYED: OnceLock<Vec<[Results; 2]>> = OnceLock::new();
    PLAYED.get_or_init(|| {
        let next = AtomicUsize::new(0);
        let all = Mutex::new(vec![<[Results; 2]>::default(); builtin::LEVELS.len()]);
        let work = || {
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(level) = builtin::LEVELS.get(index / 2) else { break };
                let (column, mut results) = (index % 2, Results::default());
                let rules = Rules { difficulty: DIFFICULTIES[column], seed: 0 };
                let tries = tries().unwrap_or(TRIES[column]);
                (0..tries).for_each(|seed| results.add(&person::play(level, rules, seed)));
                all.lock().unwrap_or_else(PoisonError::into_inner)[index / 2][column] = results;
            }
        };
        thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
        all.into_inner().unwrap()
    })
}

/// The number of tries that the variable requests.
fn tries() -> Option<u64> {
    env::var(VARIABLE).ok().map(|text| text.parse().unwrap())
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
    let all = played();
    let text = table(all);
    eprintln!("{text}");
    for (level, [easy, normal]) in builtin::LEVELS.iter().zip(all).take(4) {
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

    let rates: Vec<f64> = all.iter().map(|[_, normal]| normal.rate()).collect();
    let mean = rates.iter().sum::<f64>() / rates.len() as f64;
    let tolerance = 2.0 * (2.0 * mean * (1.0 - mean) / all[0][1].tries as f64).sqrt();
    let mut least = f64::INFINITY;
    for (level, rate) in builtin::LEVELS.iter().zip(rates) {
        assert!(rate <= least + tolerance, "{} is easier than one before it:\n{text}", level.name);
        least = least.min(rate);
    }
    let tries = tries().map_or_else(|| "few".to_owned(), |tries| tries.to_string());
    insta::assert_snapshot!(format!("curve_{tries}"), text);
}

/// The hardest part of a level is the errand on which most players die, or else lose most health.
/// Most of that loss comes after they came near a checkpoint or a heart.
#[test]
fn a_checkpoint_or_a_heart_precedes_the_hardest_part_of_every_level() {
    let mut faults = Vec::new();
    for (level, [_, normal]) in builtin::LEVELS.iter().zip(played()) {
        let lost = |errand: usize| {
            let losses = normal.losses.iter().filter(move |loss| loss.errand == errand);
            losses.fold((0, 0, 0), |(deaths, all, helped), loss| {
                let points = u32::from(loss.points);
                let helped = helped + if loss.is_helped { points } else { 0 };
                (deaths + u32::from(loss.is_death), all + points, helped)
            })
        };
        let errands = normal.losses.iter().map(|loss| loss.errand);
        let hardest = errands.max_by_key(|errand| lost(*errand)).unwrap();
        let (deaths, all, helped) = lost(hardest);
        if 2 * helped <= all {
            let name = level.name;
            let fault =
                format!("{name}, errand {hardest}: {deaths} deaths, {helped} of {all} points");
            faults.push(fault);
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}
