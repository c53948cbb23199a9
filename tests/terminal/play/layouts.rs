//! Keyboards without Latin letters, and terminals that show only ASCII.

use std::thread;
use std::time::Duration;

use super::game::{ENVIRONMENT, Game, PROGRAM};
use crate::emulator::Speaks;
use crate::player::Player;

#[test]
fn a_cyrillic_layout_plays_by_key_position() {
    let game = Game::with(Speaks::Kitty, (120, 40), Some("corridor"), &[], &[]);
    game.wait_for_releases();
    let before = game.arrow();
    game.send("\x1b[1094::119;1:1u");
    game.wait_for_arrow("walked", |arrow| arrow.column > before.column + 4);
    game.send("\x1b[1094::119;1:3u");
    game.wait_for_rest();
    assert!(game.arrow().column < before.column + 32, "the release was not heard");
}

#[test]
fn a_letter_alone_is_mapped_by_its_position() {
    for forward in ["ц", "ς"] {
        let game = Game::with(Speaks::Plain, (120, 40), Some("corridor"), &[], &[]);
        let before = game.arrow();
        for _ in 0..100 {
            game.send(forward);
            thread::sleep(Duration::from_millis(30));
        }
        game.wait_for_arrow("walked", |arrow| arrow.column > before.column + 2);
    }
}

#[test]
fn control_c_leaves_in_every_layout() {
    let mut game = Game::start();
    game.wait_for_releases();
    game.send("\x1b[1089::99;5u");
    game.wait_for_end().assert_given_back();
}

/// The terminal receives only the sentence.
#[test]
fn a_terminal_that_cannot_move_its_cursor_is_refused_with_a_sentence() {
    for term in ["dumb", "unknown"] {
        let environment = [&ENVIRONMENT[..], &[("TERM", term)]].concat();
        let mut player =
            Player::start((240, 24), Speaks::Kitty, PROGRAM, ["play", "cellar"], &environment);
        let ending = player.wait_for_end();
        assert_eq!(ending.status.code(), Some(2));
        player.wait_for("TERM is");
        let text = String::from_utf8(player.bytes()).unwrap();
        let (said, _) = text.split_once("\x1b]2;the end").unwrap();
        assert!(said.contains(&format!("TERM is \"{term}\"")), "{said:?}");
        assert!(!said.contains('\x1b') && said.lines().count() == 1, "{said:?}");
    }
}

#[test]
fn without_utf8_in_the_locale_only_ascii_is_sent() {
    for locale in [("LC_ALL", "C"), ("LANG", "de_DE.ISO-8859-1")] {
        let game = Game::with(Speaks::Kitty, (80, 24), None, &[], &[locale]);
        game.wait_for_releases();
        game.send("?");
        game.wait_for(&format!("ASCII only: {}={} is not UTF-8", locale.0, locale.1));
        game.send("?");
        game.wait_for("+map");
        assert!(game.bytes().is_ascii());
    }
}

#[test]
fn requested_glyphs_are_sent_in_every_locale() {
    let options = ["--glyphs", "half"];
    let game = Game::with(Speaks::Kitty, (80, 24), None, &options, &[("LC_ALL", "C")]);
    game.wait_for_picture(&[]);
}

#[test]
fn the_help_says_why_colours_are_limited() {
    let environment = [("COLORTERM", "")];
    let game = Game::with(Speaks::Plain, (120, 40), None, &[], &environment);
    game.send("?");
    game.wait_for("256 colours: your terminal did not offer more");
    game.wait_for("no key releases");
    let game = Game::with(Speaks::Kitty, (120, 40), None, &[], &environment);
    game.wait_for_releases();
    game.send("?");
    game.wait_for("this help");
    assert!(!game.text().contains("colours:"), "{}", game.text());
}
