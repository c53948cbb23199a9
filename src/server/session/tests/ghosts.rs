//! Ghosts in races.

use super::*;
use crate::game::{Game, Intent, Intents, Rules};
use crate::server::ghost::Ghost;
use crate::world::FieldOfView;

const RUN: &str = "3 s forward\n2 s stand\n";

/// A race with `ghosts`, and Mara in it.
fn race(ghosts: impl IntoIterator<Item = Ghost>) -> (Rig, usize) {
    let mut rig = Rig::new(Mode::Race);
    rig.ghosts = ghosts.into_iter().collect();
    let mara = rig.member("Mara", (80, 24), Speaks::Plain);
    (rig, mara)
}

fn ghost(rig: &Rig, name: Option<&str>) -> Ghost {
    Ghost::of_script(rig.catalog.world("hall").unwrap(), RUN, name)
}

/// The steps since the race began.
fn steps(rig: &Rig) -> Option<u64> {
    let view = rig.room.view();
    view.begun().map(|begun| view.step - begun)
}

#[test]
fn a_stored_run_walks_along_where_the_script_was() {
    let jon = ghost(&Rig::new(Mode::Race), Some("Jon"));
    let (mut rig, mara) = race([jon]);
    assert!(!rig.text(mara).contains("Jon's best"), "before the start nobody runs");
    while steps(&rig) != Some(90) {
        rig.pump(16);
    }
    rig.pump(30);
    assert!(rig.text(mara).contains("Jon's best"), "{}", rig.text(mara));
    let step = steps(&rig).unwrap();
    let mut game =
        Game::with_rules(rig.catalog.world("hall").unwrap().as_ref().clone(), Rules::default());
    let forward: Intents = [Intent::Forward].into_iter().collect();
    (0..step - step % 2).for_each(|_| game.step(forward));
    let view = rig.room.view();
    let visit = &rig.visitors[mara].session.visit;
    let seen: Vec<_> = visit.stay.as_ref().unwrap().ghosts(&view, &visit.look).collect();
    let at = game.camera(FieldOfView::default()).position();
    assert!(seen[0].figure.position.distance(at) < 1e-4, "{:?} {at}", seen[0].figure);
    assert!(seen[0].figure.opacity < u8::MAX, "one can see through it");
    rig.press(mara, "0");
    assert!(!rig.text(mara).contains("Jon's best"), "{}", rig.text(mara));
    rig.press(mara, "0");
    rig.pump(4_000);
    assert!(!rig.text(mara).contains("Jon's best"), "the run is over");
}

#[test]
fn a_room_is_the_same_with_and_without_ghosts() {
    let of_mara = ghost(&Rig::new(Mode::Race), None);
    let checksums = [vec![], vec![of_mara.clone(), of_mara]].map(|ghosts| {
        let (mut rig, mara) = race(ghosts);
        rig.pump(4_000);
        for key in ["w", "w", "d", "o", " "] {
            rig.press(mara, key);
        }
        (rig.room.checksum(), rig.room.step())
    });
    assert_eq!(checksums[0], checksums[1]);
}

#[test]
fn a_ghost_is_of_the_level_that_is_played() {
    let (mut rig, mara) = race([]);
    let late = ghost(&rig, Some("Jon"));
    let news = |level: &str| News::Ghosts {
        level: level.to_owned(),
        difficulty: Difficulty::Normal,
        ghosts: Arc::from([late.clone()]),
    };
    rig.pump(4_000);
    let now = rig.now;
    rig.visitors[mara].session.tell(news("museum"), now);
    rig.pump(100);
    assert!(!rig.text(mara).contains("Jon's best"), "it is of another level");
    rig.visitors[mara].session.tell(news("hall"), rig.now);
    rig.pump(100);
    assert!(rig.text(mara).contains("Jon's best"), "{}", rig.text(mara));
}
