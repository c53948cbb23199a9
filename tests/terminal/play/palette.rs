//! The terminal's palette and repeated characters: used if the terminal proves that they work, and
//! restored however the game ends.

use rustix::process::Signal;

use super::game::{ENVIRONMENT, Game, Key, PROGRAM, halves_shown};
use crate::emulator::{Emulator, Speaks};
use crate::player::Player;

const DEFINITION: &str = "\x1b]4;";

/// A game that turns, in a terminal whose palette it uses.
fn turning() -> Game {
    let demand = [("CELLCASTER_PANIC", "1")];
    let game = Game::with(Speaks::Alacritty, (80, 24), None, &[], &demand);
    game.press(Key::Right);
    game.wait_until("used the palette", uses_palette);
    game
}

/// Returns whether the screen shows palette entries that were defined.
fn uses_palette(emulator: &Emulator) -> bool {
    let terminal = emulator.alacritty();
    terminal.entries_in_use().intersection(&terminal.entries_defined()).count() > 10
}

#[track_caller]
fn assert_palette_given_back(player: &Player) {
    let defined = player.look(|emulator| emulator.alacritty().entries_defined());
    assert!(defined.is_empty(), "{defined:?} are not as they were");
}

fn text(player: &Player) -> String {
    String::from_utf8(player.bytes()).unwrap()
}

/// Returns whether a control sequence repeats a character (`CSI n b`) after the probe for it.
fn repeats(text: &str) -> bool {
    let mut sequences = text.split("\x1b[").skip(1);
    let is_repetition =
        |rest: &str| rest.trim_start_matches(|next: char| next.is_ascii_digit()).starts_with('b');
    sequences.by_ref().filter(|rest| is_repetition(rest)).nth(1).is_some()
}

/// Returns whether an entry was defined after the probe. Only the probe defines entry 254 alone.
fn defines(text: &str) -> bool {
    text.split(DEFINITION).skip(1).filter(|rest| !rest.starts_with("255;?")).count() > 1
}

#[test]
fn a_redefined_palette_shows_the_same_picture_in_fewer_bytes() {
    let games = [Speaks::Kitty, Speaks::Alacritty].map(|speaks| {
        let game = Game::with(speaks, (80, 24), None, &[], &[]);
        game.wait_for_releases();
        // By then, all queries have been answered, and the resized picture is painted from nothing.
        let before = game.bytes_written();
        game.resize(100, 30);
        game.wait_until("repainted", |emulator| emulator.bytes().len() > before + 1000);
        game.wait_for_rest();
        (before, game)
    });
    let [without, with] = games.each_ref().map(|(before, game)| game.bytes_written() - before);
    let [(_, plain), (_, game)] = &games;
    assert!(game.look(uses_palette), "the palette is not used");
    assert!(repeats(&text(game)), "nothing is repeated");
    assert!(!repeats(&text(plain)) && !defines(&text(plain)), "neither was answered");
    let wanted = plain.look(halves_shown);
    assert!(game.look(halves_shown) == wanted, "the pictures differ");
    assert!(with < without, "{with} bytes with a palette, {without} without");
}

#[test]
fn the_palette_is_restored_however_the_game_ends() {
    type End = fn(&Game);
    let ends: [End; 6] = [
        Game::leave,
        |game| game.send("\x1b[99;5u"),
        |game| game.signal(Signal::TERM),
        |game| game.signal(Signal::HUP),
        |game| game.signal(Signal::INT),
        |game| game.send("\x1b[24~"),
    ];
    for end in ends {
        let mut game = turning();
        end(&game);
        game.wait_for_end().assert_given_back();
        assert_palette_given_back(&game);
    }
}

#[test]
fn the_shell_has_its_palette_while_the_game_is_suspended() {
    let script = "set -m; \"$0\" play cellar; echo stopped; read line; fg; echo ended";
    let arguments = ["-c", script, PROGRAM];
    let mut player = Player::start((80, 24), Speaks::Alacritty, "/bin/sh", arguments, &ENVIRONMENT);
    player.wait_until("asked for releases", |emulator| emulator.modes().key_flags == [0, 1]);
    player.send(Key::Right.event(1));
    player.wait_until("used the palette", uses_palette);
    player.send("\x1b[122;5u");
    player.wait_for("stopped");
    assert_palette_given_back(&player);
    player.send("\r");
    player.wait_until("used the palette again", uses_palette);
    player.send(Key::Char('q').event(1) + &Key::Enter.event(1));
    player.wait_for("ended");
    player.wait_for_end().assert_given_back();
    assert_palette_given_back(&player);
}

#[test]
fn a_multiplexer_is_not_probed() {
    for variable in [
        ("TERM", "screen-256color"),
        ("TERM", "tmux-256color"),
        ("TMUX", "/tmp/tmux-1000/default,1,0"),
        ("STY", "1.pts-0.host"),
    ] {
        let game = Game::with(Speaks::Alacritty, (80, 24), None, &[], &[variable]);
        // The program does not request releases either, so the key is repeated as terminals do.
        for _ in 0..10 {
            game.send("\x1b[C");
            std::thread::sleep(std::time::Duration::from_millis(30));
        }
        game.wait_for_rest();
        let text = text(&game);
        assert!(!text.contains(DEFINITION), "{variable:?}");
        assert!(!text.contains("\x1b[6n"), "{variable:?}");
        assert!(game.look(|emulator| emulator.alacritty().entries_in_use().is_empty()));
    }
}

/// Some terminals define entries but cannot reset them.
#[test]
fn a_palette_that_cannot_be_restored_is_not_used() {
    const OWN: &str = "\x1b]4;255;rgb:eeee/eeee/eeee\x07";
    const DEFINED: &str = "\x1b]4;255;rgb:1212/abab/5656\x07";
    for (last, is_used) in [(DEFINED, false), (OWN, true)] {
        let mut game = Game::with(Speaks::Kitty, (80, 24), None, &[], &[]);
        game.send([OWN, DEFINED, last].concat());
        game.press(Key::Right);
        game.wait_until("turned", |emulator| emulator.bytes().len() > 60_000);
        assert_eq!(defines(&text(&game)), is_used);
        game.leave();
        game.wait_for_end().assert_given_back();
    }
}
