//! The campaign in a plain terminal of 80 by 24 cells, without key releases, by bytes: the first
//! three levels from the title to the summary of each, and the records that the program stores
//! about them.
//!
//! The way through each level is a script of taps, which `tests/campaign/taps.rs` finds. It is
//! typed step by step, and the run that the program stores must be that script. This proves that
//! every byte was decoded, and that every key was held for its steps.

use std::fs;
use std::path::Path;

use cellcaster::game::{Intent, Intents, Script, Stretch};

use super::clock::{CLOCK, Typist};
use super::game::PROGRAM;
use super::titles::folder;
use crate::support::cellcaster;

/// The steps for which a tap walks.
const TAP: u32 = 5;
/// The number of steps in which a new panel accepts no key, plus a few more.
const PANEL: u32 = 64;

/// A level: its name, its goal, and parts of its summary.
struct Level {
    name: &'static str,
    goal: &'static str,
    summary: [&'static str; 3],
}

const LEVELS: [Level; 3] = [
    Level {
        name: "cellar",
        goal: "Two cups, and wake nobody",
        summary: ["Cellar", "level 1 of 12", "of 130"],
    },
    Level {
        name: "museum",
        goal: "Take the crown of plaster",
        summary: ["The Museum of Walls", "level 2 of 12", "of 225"],
    },
    Level {
        name: "kennels",
        goal: "Cup and collar, then the gate",
        summary: ["The Kennels", "level 3 of 12", "of 180"],
    },
];

/// Starts the program, which stores results in `data`.
fn start(data: &Path) -> Typist {
    let data = data.to_str().unwrap();
    let environment = [("HOME", env!("CARGO_TARGET_TMPDIR")), ("CELLCASTER_DATA", data), CLOCK];
    Typist::start(PROGRAM, &[], &environment)
}

/// Starts the first level of the easiest game from the title.
fn begin(data: &Path) -> Typist {
    let typist = start(data);
    typist.wait_to_see("> New game");
    typist.tap("\r", PANEL);
    typist.wait_to_see("> Normal");
    typist.tap("\x1b[A", PANEL);
    typist.wait_to_see("> Easy");
    typist.send("\r");
    typist
}

/// The script of taps through a level.
fn script(name: &str) -> Script {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/terminal/taps").join(name);
    let text = fs::read_to_string(path.with_extension("script")).unwrap();
    Script::parse(&text, name).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The key for `intents`; `None` if there are no intents.
fn key(intents: Intents) -> Option<&'static str> {
    intents.iter().next().map(|intent| match intent {
        Intent::Forward => "w",
        Intent::Back => "s",
        Intent::StrafeLeft => "a",
        Intent::StrafeRight => "d",
        other => panic!("no key for {other:?}"),
    })
}

/// Types a script of taps. Its first `passed` steps, in which the player stands, have already
/// passed.
fn play(typist: &Typist, script: &Script, mut passed: u32) {
    for Stretch { steps, intents } in script.sections().iter().flat_map(|it| &it.stretches) {
        let Some(key) = key(*intents) else {
            typist.pass(steps - passed);
            passed = 0;
            continue;
        };
        // The exit cuts the last tap of a script short.
        assert!(*steps <= TAP, "{steps} steps are no tap");
        typist.tap(key, *steps);
    }
}

/// Leaves the game, and confirms it.
fn leave(typist: &mut Typist) {
    typist.tap("q", PANEL);
    typist.wait_to_see("q or Enter leaves");
    typist.send("\r");
    let ending = typist.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success());
}

/// Asserts that the run which the program has stored for a level has the steps of `script`, and
/// that it wins.
fn assert_kept(data: &Path, name: &str, script: &Script) {
    let steps = script.steps();
    let path = data.join(format!("runs/{name}.easy.{steps}.script"));
    let kept =
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let kept = Script::parse(&kept, name).unwrap_or_else(|faults| panic!("{faults}"));
    let intents = |script: &Script| script.iter().map(|(_, intents)| intents).collect::<Vec<_>>();
    assert!(intents(&kept) == intents(script), "{name} was not played as it was typed");
    let verified = cellcaster(&["replay", path.to_str().unwrap(), "--verify"]).output().unwrap();
    assert!(verified.status.success(), "{}", String::from_utf8_lossy(&verified.stdout));
}

#[test]
fn the_first_three_levels_are_won_by_taps_in_a_plain_terminal() {
    let data = folder("campaign");
    let mut typist = begin(&data);
    for Level { name, goal, summary } in LEVELS {
        let begun = typist.steps();
        typist.wait_to_see(goal);
        typist.wait_for("♥♥♥♥♥♥");
        let script = script(name);
        play(&typist, &script, typist.steps() - begun);
        typist.wait_to_see("you found the way out");
        for shown in summary.into_iter().chain(["in 0:", "rank: ", "gold: 1", "alarms: "]) {
            assert!(typist.text().contains(shown), "{shown}:\n{}", typist.text());
        }
        assert_kept(&data, name, &script);
        typist.pass(PANEL);
        typist.send("\r");
    }
    typist.wait_to_see("Take the chalice");
    let progress = fs::read_to_string(data.join("progress.toml")).unwrap();
    for Level { name, .. } in LEVELS {
        assert!(progress.contains(&format!("[best.{name}.easy]")), "{name}:\n{progress}");
    }
    leave(&mut typist);
}

#[test]
fn a_held_key_walks_as_long_as_it_repeats() {
    let data = folder("campaign-holding");
    let mut typist = begin(&data);
    typist.wait_to_see(LEVELS[0].goal);
    typist.hold("d", 120);
    typist.pass(60);
    leave(&mut typist);
    let runs = fs::read_dir(data.join("runs")).unwrap();
    let saved: Vec<_> = runs.map(|run| fs::read_to_string(run.unwrap().path()).unwrap()).collect();
    let saved = Script::parse(&saved[0], "the saved game").unwrap();
    let aside: Intents = [Intent::StrafeRight].into_iter().collect();
    let stretches: Vec<_> = saved.sections()[0].stretches.iter().skip(1).collect();
    let walks: Vec<_> = stretches.iter().map(|it| (it.intents == aside, it.steps)).collect();
    // A tap, a pause up to the first repetition, and the repetitions, up to the time at which the
    // next repetition would have come.
    let [(true, TAP), (false, 25), (true, held), (false, _)] = walks[..] else {
        panic!("{walks:?}");
    };
    assert!((90..98).contains(&held), "{walks:?}");
}

#[test]
fn the_second_level_is_offered_at_the_next_start() {
    let data = folder("campaign-goes-on");
    let best = "version = 1\n[preferences]\ncrosshair = false\ncompass = false\nbell = false\n\
                ghost = true\ndifficulty = \"easy\"\n[best.\"cellar\".easy]\nsteps = 1800\n\
                treasure = [115, 130]\nsecrets = [0, 1]\nalarms = 0\ndeaths = 0\nstunned = 0\n\
                rank = \"Shadow\"\n";
    fs::write(data.join("progress.toml"), best).unwrap();
    let typist = start(&data);
    typist.wait_to_see("> Continue  Museum");
    typist.send("\r");
    typist.wait_to_see("Take the crown of plaster");
}
