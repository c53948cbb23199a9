//! The offer to tell tmux that its terminal shows 24-bit colours.

use super::titles::titled;
use super::*;
use crate::app::Offers;
use crate::app::title::TmuxOrder;
use crate::terminal::{ColorSource, TmuxClient};

const OFFER: &str = "24-bit colours in tmux";

fn says(rig: &mut Rig, answer: &str, source: ColorSource) {
    let before = rig.app.tmux_remedy();
    let client = TmuxClient::parse(answer);
    let has_all = client.as_ref().is_some_and(TmuxClient::has_true_color);
    rig.app.terminal.depth = if has_all { ColorDepth::True } else { ColorDepth::Indexed256 };
    rig.app.detection.tmux = client;
    rig.app.detection.source = Some(source);
    rig.app.renew_tmux_offer(before.as_deref());
}

fn title_in_tmux() -> Rig {
    let mut rig = titled(Offers::default(), Store::in_memory());
    says(&mut rig, "title|kitty(0.42.1)|xterm-kitty", ColorSource::Tmux);
    rig
}

fn shows(rig: &mut Rig, words: &str) -> bool {
    missions::text(&mut rig.app, 80, 24).contains(words)
}

#[test]
fn only_terminals_known_to_show_more_get_the_offer() {
    for (answer, source, is_offered) in [
        ("title|kitty(0.42.1)|xterm-kitty", ColorSource::Tmux, true),
        ("title|kitty(0.42.1)|xterm-kitty", ColorSource::NoColor, false),
        ("RGB|kitty(0.42.1)|xterm-kitty", ColorSource::Tmux, false),
        ("title||xterm-256color", ColorSource::Tmux, false),
        ("title|kitty(0.42.1)|x'; kill-server; '", ColorSource::Tmux, false),
    ] {
        let mut rig = titled(Offers::default(), Store::in_memory());
        assert!(!shows(&mut rig, OFFER));
        says(&mut rig, answer, source);
        assert_eq!(shows(&mut rig, OFFER), is_offered, "{answer} {source:?}");
    }
    let mut rig = title_in_tmux();
    rig.app.settings.depth = Some(ColorDepth::Indexed256);
    rig.app.renew_menu();
    assert!(!shows(&mut rig, OFFER), "the player has chosen 256 colours");
}

#[test]
fn tmux_is_told_once_and_only_after_confirmation() {
    let mut rig = title_in_tmux();
    rig.choose(OFFER);
    assert!(shows(&mut rig, "tmux set -as terminal-features ',xterm-kitty:RGB'"));
    assert!(shows(&mut rig, "~/.tmux.conf"));
    assert!(!rig.app.take_tmux_order());
    rig.tap(Key::Escape, 30);
    rig.wait(300);
    assert_eq!(rig.app.screen(), AppScreen::Title);
    assert!(!rig.app.take_tmux_order());
    rig.choose(OFFER);
    rig.choose("Tell tmux");
    assert!(rig.app.take_tmux_order());
    assert!(!rig.app.take_tmux_order());
    rig.app.tmux_told(true);
    assert!(shows(&mut rig, "Done. Detach (prefix d)"));
    assert!(shows(&mut rig, "set -as terminal-features ',xterm-kitty:RGB'"));
    says(&mut rig, "RGB|kitty(0.42.1)|xterm-kitty", ColorSource::Tmux);
    assert_eq!(rig.app.screen(), AppScreen::Title);
    assert!(!shows(&mut rig, OFFER));
    assert_eq!(rig.app.tmux_order, TmuxOrder::None);
}

#[test]
fn a_failure_is_reported_in_one_sentence() {
    let mut rig = title_in_tmux();
    rig.choose(OFFER);
    rig.choose("Tell tmux");
    rig.app.tmux_told(false);
    assert!(shows(&mut rig, "tmux rejected the command; see docs/terminals.md."));
}

#[test]
fn an_answer_from_tmux_keeps_the_selection() {
    let mut rig = titled(Offers::default(), Store::in_memory());
    rig.tap(Key::End, 30);
    assert_eq!(rig.app.pages.menu.label().as_deref(), Some("Leave"));
    says(&mut rig, "title|kitty(0.42.1)|xterm-kitty", ColorSource::Tmux);
    assert_eq!(rig.app.pages.menu.label().as_deref(), Some("Leave"));
    says(&mut rig, "RGB|kitty(0.42.1)|xterm-kitty", ColorSource::Tmux);
    assert_eq!(rig.app.pages.menu.label().as_deref(), Some("Leave"));
}

#[test]
fn the_panel_fits_in_40_columns() {
    let mut rig = title_in_tmux();
    rig.choose(OFFER);
    let text = missions::text(&mut rig.app, 40, 12);
    for words in ["tmux set -as terminal-features", "~/.tmux.conf", "> Tell tmux", "Back"] {
        assert!(text.contains(words), "{text}");
    }
}
