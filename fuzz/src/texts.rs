//! Texts that players write or store. The first byte chooses the kind, and the others are the text.
//!
//! - If a configuration or a script can be read, writing it and reading it again returns the same
//!   value. A script can also be played.
//! - A damaged progress file is read as far as possible, is kept, and does not prevent a new
//!   record.

use std::fs;

use cellcaster::app::Configuration;
use cellcaster::app::store::{Preferences, Store};
use cellcaster::game::{Game, Script};
use cellcaster::map::builtin;
use cellcaster::terminal::{Fidelity, Key};
use cellcaster::world::Difficulty;

use crate::faults::check_faults;
use crate::folder::Folder;

/// The largest number of steps of a script that are played.
const MAX_STEPS: usize = 300;

/// Reads the text in the way that its first byte chooses.
pub fn run(data: &[u8]) {
    let Some((kind, content)) = data.split_first() else { return };
    match kind % 4 {
        0 => configuration(&String::from_utf8_lossy(content)),
        1 => script(content),
        2 => progress(content),
        _ => names(&String::from_utf8_lossy(content)),
    }
}

fn configuration(text: &str) {
    match Configuration::parse(text, "config.toml") {
        Err(faults) => check_faults(&faults),
        Ok(read) => {
            let written = read.to_string();
            match Configuration::parse(&written, "config.toml") {
                Ok(again) => assert!(again == read, "another one is written:\n{written}"),
                Err(faults) => panic!("{faults}\nin what was written:\n{written}"),
            }
        }
    }
}

fn script(content: &[u8]) {
    let read = match Script::from_bytes(content.to_vec(), "it") {
        Err(faults) => return check_faults(&faults),
        Ok(read) => read,
    };
    let written = read.to_string();
    match Script::parse(&written, "it") {
        Ok(again) => assert_eq!(again, read, "another one is written:\n{written}"),
        Err(faults) => panic!("{faults}\nin what was written:\n{written}"),
    }
    let sum: u64 = read.sections().iter().map(|section| section.steps()).sum();
    assert_eq!(read.steps(), sum);
    let Ok(world) = builtin::LEVELS[0].world() else { unreachable!("it is built in") };
    let mut game = Game::new(world);
    for (section, intents) in read.iter().take(MAX_STEPS) {
        assert!(section < read.sections().len());
        game.step(intents);
    }
}

fn names(text: &str) {
    match text.parse::<Key>() {
        Ok(key) => assert_eq!(key.to_string().parse(), Ok(key)),
        Err(unknown) => assert!(!unknown.to_string().contains(char::is_control)),
    }
    if let Ok(fidelity) = text.parse::<Fidelity>() {
        assert_eq!(fidelity.to_string().parse::<Fidelity>().ok(), Some(fidelity));
    }
}

fn progress(content: &[u8]) {
    let folder = Folder::new();
    let file = folder.write("progress.toml", content);
    let (mut store, sentence) = Store::open(folder.path());
    let seen = look_at(&store);
    let is_newer = sentence.as_deref().is_some_and(|it| it.contains("newer"));
    let preferences = Preferences { compass: !store.preferences().compass, ..store.preferences() };
    store.set_preferences(preferences);
    let begun = store.begin_daily(20_261_122);
    assert_eq!(begun, !seen.had_daily);
    if is_newer {
        assert_eq!(fs::read(&file).expect("it is there"), content, "a newer file is changed");
        return;
    }
    assert_eq!(store.trouble().filter(|it| !it.contains("damaged")), None);
    // Everything that was read is still there, and nothing is damaged any longer.
    let (again, sentence) = Store::open(folder.path());
    assert_eq!(sentence, None, "damaged again:\n{}", fs::read_to_string(&file).unwrap_or_default());
    assert_eq!(again.preferences(), preferences);
    assert_eq!(look_at(&again), Seen { had_daily: true, ..seen });
}

/// The visible contents of a store.
#[derive(Debug, PartialEq)]
struct Seen {
    won: Vec<String>,
    bests: Vec<String>,
    descent: String,
    had_daily: bool,
}

fn look_at(store: &Store) -> Seen {
    let difficulties = [Difficulty::Easy, Difficulty::Normal, Difficulty::Hard];
    let won = difficulties.iter().flat_map(|&it| store.won(it).map(str::to_owned));
    let bests = difficulties
        .iter()
        .flat_map(|&it| store.won(it).map(move |level| format!("{:?}", store.best(level, it))));
    for save in store.saves() {
        _ = store.saved(save.id());
    }
    Seen {
        won: won.collect(),
        bests: bests.collect(),
        descent: format!("{:?}", store.best_descent()),
        had_daily: store.daily(20_261_122).is_some(),
    }
}
