//! Maps whose pictures take seconds to draw.

use std::fs;
use std::path::Path;

use rustix::process::Signal;

use super::game::{ENVIRONMENT, PROGRAM, halves_shown};
use crate::emulator::{Emulator, Speaks};
use crate::player::Player;

/// The largest window: 200,000 cells.
const WINDOW: (u16, u16) = (1000, 200);

/// A game among a thousand spheres. As many of them as a map allows are in one place.
fn among_spheres(name: &str) -> Player {
    let sphere =
        |x, radius| format!("{{ center = [{x}, 0, 0], radius = {radius}, color = '#ff8000' }},");
    let near = sphere(9, 8).repeat(141);
    let far: String = (0..859).map(|number| sphere(100 + 3 * number, 1)).collect();
    let text = format!("start = {{ at = [0, 0, 0], heading = 0 }}\nsphere = [{near}{far}]\n");
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name).with_extension("toml");
    fs::write(&path, text).unwrap();
    let arguments = ["play", path.to_str().unwrap()];
    let player = Player::start(WINDOW, Speaks::Plain, PROGRAM, arguments, &ENVIRONMENT);
    player.wait_until("took the terminal", |emulator| emulator.modes().alternate_screen);
    player
}

/// Returns whether the last row of the picture is black, as it is before the picture is complete.
fn is_incomplete(emulator: &Emulator) -> bool {
    let (columns, rows) = (usize::from(WINDOW.0), usize::from(WINDOW.1));
    let halves = halves_shown(emulator);
    let last = &halves[(rows - 2) * columns..(rows - 1) * columns];
    last.iter().all(|halves| *halves == Some([[0; 3]; 2]))
}

#[test]
fn q_asks_before_a_slow_picture_is_complete_and_enter_leaves() {
    let mut player = among_spheres("slow_q");
    player.send("q");
    player.wait_until("asked, over an incomplete picture", |emulator| {
        emulator.text().contains("any other key cancels") && is_incomplete(emulator)
    });
    player.send("\r");
    player.wait_for_end().assert_given_back();
}

#[test]
fn control_c_signals_and_resizes_interrupt_a_slow_picture() {
    let ends: [fn(&Player); 3] = [
        |player| player.send("\x03"),
        |player| player.signal(Signal::TERM),
        |player| player.resize(40, 12),
    ];
    for (number, end) in ends.into_iter().enumerate() {
        let mut player = among_spheres(&format!("slow_end_{number}"));
        end(&player);
        if number == 2 {
            player.wait_for("without a name");
            player.send("qq");
        }
        let ending = player.wait_for_end();
        ending.assert_given_back();
        assert!(ending.status.success(), "{ending:?}");
    }
}
