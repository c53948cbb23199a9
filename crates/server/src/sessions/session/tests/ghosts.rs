//! Ghosts in races.

use std::sync::Arc;

use super::*;
use crate::rooms::ghost::Ghost;
use cellcaster::game::{Game, Intent, Intents, Rules};
use cellcaster::world::{Difficulty, World};

const RUN: &str = "3 s forward\n2 s stand\n";

/// A race with `ghosts` that Mara has entered.
fn race(ghosts: impl IntoIterator<Item = Ghost>) -> (Rig, usize) {
    let mut rig = Rig::new(Mode::Race);
    let mara = rig.member("Mara", (80, 24), Speaks::Plain);
    notify(&rig, mara, "hall", ghosts);
    (rig, mara)
}

/// Passes ghosts to a session, as its driver would.
fn notify(rig: &Rig, index: usize, level: &str, ghosts: impl IntoIterator<Item = Ghost>) {
    let (level, ghosts) = (level.to_owned(), ghosts.into_iter().collect());
    let event = SessionEvent::Ghosts { level, difficulty: Difficulty::Normal, ghosts };
    rig.session(index, |session, _| session.notify(event, session.ui.now));
}

fn hall() -> Arc<World> {
    catalog(HALL).world("hall").unwrap()
}

fn ghost(name: Option<&str>) -> Ghost {
    Ghost::of_script(&hall(), RUN, name)
}

/// The number of steps since the race began.
fn steps(rig: &Rig) -> Option<u64> {
    let view = rig.view();
    view.begun.map(|begun| view.step - begun)
}

#[test]
fn a_stored_run_walks_along_where_the_script_was() {
    let jon = ghost(Some("Jon"));
    let (mut rig, mara) = race([jon]);
    assert!(!rig.text(mara).contains("Jon's best"), "before the start nobody runs");
    while steps(&rig) != Some(90) {
        rig.pump(16);
    }
    rig.pump(30);
    assert!(rig.text(mara).contains("Jon's best"), "{}", rig.text(mara));
    let step = steps(&rig).unwrap();
    let mut game = Game::with_rules(hall().as_ref().clone(), Rules::default());
    let forward: Intents = [Intent::Forward].into_iter().collect();
    (0..step - step % 2).for_each(|_| game.step(forward));
    let view = rig.view();
    let (position, opacity) = rig.session(mara, move |session, _| {
        let ui = &session.ui;
        let figure = ui.stay.as_ref().unwrap().ghosts(&view, true).next().unwrap();
        (figure.position, figure.opacity)
    });
    let at = game.camera(FieldOfView::default()).position();
    assert!(position.distance(at) < 1e-4, "{position} {at}");
    assert!(opacity < u8::MAX, "one can see through it");
    rig.press(mara, "0");
    assert!(!rig.text(mara).contains("Jon's best"), "{}", rig.text(mara));
    rig.press(mara, "0");
    rig.pump(4_000);
    assert!(!rig.text(mara).contains("Jon's best"), "the run is over");
}

#[test]
fn a_room_is_the_same_with_and_without_ghosts() {
    let of_mara = ghost(None);
    let checksums = [vec![], vec![of_mara.clone(), of_mara]].map(|ghosts| {
        let (mut rig, mara) = race(ghosts);
        rig.pump(4_000);
        for key in ["w", "w", "d", "o", " "] {
            rig.press(mara, key);
        }
        (rig.view().game.checksum(), rig.view().step)
    });
    assert_eq!(checksums[0], checksums[1]);
}

#[test]
fn ghosts_of_other_levels_are_not_shown() {
    let (mut rig, mara) = race([]);
    let late = ghost(Some("Jon"));
    rig.pump(4_000);
    notify(&rig, mara, "museum", [late.clone()]);
    rig.pump(100);
    assert!(!rig.text(mara).contains("Jon's best"), "it is of another level");
    notify(&rig, mara, "hall", [late]);
    rig.pump(100);
    assert!(rig.text(mara).contains("Jon's best"), "{}", rig.text(mara));
}
