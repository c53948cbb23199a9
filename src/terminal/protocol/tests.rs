use super::*;
use crate::terminal::{Key, KeyEvent};
use crate::tui::canvas::Canvas;
use ratatui::style::Color;

const ENTERED: &str = "\x1b[?1049h";

fn options(term: &str) -> SessionOptions {
    SessionOptions::from_environment(|name| (name == "TERM").then(|| term.to_owned()))
}

fn begun(term: &str) -> Protocol {
    let mut protocol = Protocol::new(options(term), WindowSize::of_cells(80, 24));
    protocol.begin(Duration::ZERO);
    protocol
}

fn sent(protocol: &mut Protocol, now: Duration) -> String {
    let bytes = std::mem::take(protocol.output(now));
    protocol.written(now);
    String::from_utf8(bytes).unwrap()
}

fn draw(protocol: &mut Protocol, character: char) {
    protocol.draw(|screen| screen.draw_character(0, 0, character, [Color::Reset; 2]));
}

const ANSWERS: &[u8] = b"\x1b[0n\x1b[?62;22c";

#[test]
fn every_enabled_mode_is_restored() {
    let mut protocol = begun("xterm-kitty");
    let now = Duration::from_millis(20);
    assert!(sent(&mut protocol, now).starts_with(ENTERED));
    protocol.receive(b"\x1b[?0u\x1b[0n\x1b[?62;22c", now);
    protocol.set_mouse(true);
    assert_eq!(protocol.next_event(), Some(Event::KeyReleases(true)));
    let text = sent(&mut protocol, now);
    assert!(text.contains(sequence::PUSH_KEY_FLAGS) && text.contains(sequence::ENABLE_MOUSE));
    protocol.end(now);
    let text = sent(&mut protocol, now);
    assert!(text.contains(sequence::POP_KEY_FLAGS) && text.contains(sequence::DISABLE_MOUSE));
    assert!(text.contains(sequence::QUERY_FENCE));
    assert!(!protocol.has_ended(now));
    assert!(!protocol.has_ended(now + Duration::from_secs(4)), "it has answered before");
    assert!(protocol.has_ended(now + Duration::from_secs(6)));
    protocol.receive(b"w\x1b[?62;22c", now);
    assert!(protocol.has_ended(now));
    protocol.finish();
    assert_eq!(sent(&mut protocol, now), "\x1b[?1049l");
}

#[test]
fn answers_after_the_end_change_nothing() {
    let now = Duration::from_millis(20);
    let size = WindowSize::new((80, 24), (800, 600));
    let mut protocol = Protocol::new(options("xterm-kitty"), size);
    protocol.begin(Duration::ZERO);
    protocol.set_mouse(true);
    sent(&mut protocol, now);
    protocol.end(now);
    sent(&mut protocol, now);
    protocol.receive(b"\x1b[?0u\x1b[?1016;2$y\x1b[0n\x1b[?62;22c", now);
    protocol.set_mouse(false);
    protocol.set_mouse(true);
    assert_eq!(sent(&mut protocol, now), "");
}

/// A pop without its push would take the flags of another program.
#[test]
fn keyboard_flags_are_popped_after_a_loss_only_if_they_were_received() {
    let mut protocol = begun("xterm-kitty");
    let at = Duration::from_millis;
    sent(&mut protocol, at(0));
    draw(&mut protocol, 'a');
    sent(&mut protocol, at(10));
    assert!(!protocol.changes().end_after_loss().contains('u'), "none were pushed");
    protocol.receive(b"\x1b[?0u\x1b[0n\x1b[?62;22c", at(20));
    assert!(sent(&mut protocol, at(20)).contains(sequence::PUSH_KEY_FLAGS));
    let text = protocol.changes().end_after_loss();
    assert!(!text.contains(sequence::POP_KEY_FLAGS) && text.contains(sequence::CLEAR_KEY_FLAGS));
    assert!(!text.contains(sequence::QUERY_FENCE), "its answer would come too late");
    // The answer to the frame before the flags.
    protocol.receive(b"\x1b[0n", at(30));
    let text = protocol.changes().end_after_loss();
    assert!(text.contains(sequence::POP_KEY_FLAGS) && !text.contains(sequence::CLEAR_KEY_FLAGS));
    // The terminal may have received a part of the sequences that end the session, including the
    // pop.
    let mut changes = protocol.changes();
    changes.mark_key_flags_uncertain();
    assert!(!changes.end_after_loss().contains(sequence::POP_KEY_FLAGS));
}

#[test]
fn a_terminal_that_reads_nothing_is_sent_nothing() {
    let mut protocol = begun("xterm");
    let now = Duration::from_millis(20);
    sent(&mut protocol, now);
    protocol.receive(ANSWERS, now);
    let mut sends = 0;
    for second in 1..100 {
        let now = Duration::from_secs(second);
        protocol.wake(now);
        if protocol.is_ready(now) {
            draw(&mut protocol, if second % 2 == 0 { 'a' } else { 'b' });
        }
        let text = sent(&mut protocol, now);
        sends += u32::from(!text.is_empty());
    }
    // The frame, and the request that asks whether the terminal is still there.
    assert_eq!(sends, 2);
}

#[test]
fn the_next_frame_follows_an_answered_one() {
    let mut protocol = begun("xterm");
    sent(&mut protocol, Duration::ZERO);
    protocol.receive(ANSWERS, Duration::from_millis(10));
    for frame in 1_u64..50 {
        let now = Duration::from_millis(10 + frame * 40);
        assert!(protocol.is_ready(now), "{frame}");
        let character = char::from(b'a' + (frame % 26) as u8);
        draw(&mut protocol, character);
        let text = sent(&mut protocol, now);
        assert!(text.contains(character), "{text:?}");
        let answers = [(sequence::QUERY_STATUS, &b"\x1b[0n"[..]), ("\x1b[c", b"\x1b[?62;22c")];
        for (_, answer) in answers.iter().filter(|(query, _)| text.contains(query)) {
            protocol.receive(answer, now + Duration::from_millis(20));
        }
    }
}

#[test]
fn shown_frames_are_counted() {
    let mut protocol = begun("xterm");
    sent(&mut protocol, Duration::ZERO);
    protocol.receive(ANSWERS, Duration::from_millis(10));
    let at = Duration::from_millis;
    let counts = |protocol: &Protocol| [protocol.frames_sent(), protocol.frames_answered()];
    draw(&mut protocol, 'a');
    sent(&mut protocol, at(20));
    assert_eq!(counts(&protocol), [1, 0]);
    protocol.receive(b"\x1b[0n", at(40));
    assert_eq!(counts(&protocol), [1, 1]);
    draw(&mut protocol, 'a');
    sent(&mut protocol, at(60));
    assert_eq!(counts(&protocol), [1, 1], "nothing has changed");
    let mut silent = begun("xterm");
    sent(&mut silent, Duration::ZERO);
    for second in 1..4 {
        draw(&mut silent, if second % 2 == 0 { 'a' } else { 'b' });
        sent(&mut silent, Duration::from_secs(10 * second));
    }
    assert_eq!(counts(&silent), [3, 3], "it never answers");
}

#[test]
fn the_next_frame_waits_until_the_caller_takes_the_bytes() {
    let mut protocol = begun("xterm");
    let now = Duration::from_millis(10);
    protocol.receive(ANSWERS, now);
    assert!(!protocol.is_ready(now), "the queries are not taken yet");
    sent(&mut protocol, now);
    assert!(protocol.is_ready(now));
}

#[test]
fn an_escape_byte_alone_becomes_a_key_after_a_wait() {
    let mut protocol = begun("xterm");
    let now = Duration::from_millis(10);
    protocol.receive(ANSWERS, now);
    while protocol.next_event().is_some() {}
    protocol.receive(b"\x1b", now);
    assert_eq!(protocol.next_event(), None);
    let wakes_at = protocol.wakes_at().unwrap();
    assert!(wakes_at > now && wakes_at < now + Duration::from_millis(200));
    protocol.wake(wakes_at);
    let event = protocol.next_event();
    assert!(matches!(event, Some(Event::Key(KeyEvent { key: Key::Escape, .. }))), "{event:?}");
}

#[test]
fn a_resized_window_is_drawn_whole() {
    let mut protocol = begun("xterm");
    let now = Duration::from_millis(10);
    sent(&mut protocol, now);
    protocol.receive(ANSWERS, now);
    while protocol.next_event().is_some() {}
    draw(&mut protocol, '#');
    sent(&mut protocol, now);
    protocol.receive(b"\x1b[0n", now);
    protocol.resize(WindowSize::of_cells(20, 5), now);
    assert_eq!(protocol.next_event(), Some(Event::Resized));
    draw(&mut protocol, '#');
    assert!(sent(&mut protocol, now).contains('#'));
}

const PROVEN: &[u8] = b"\x1b]4;255;rgb:eeee/eeee/eeee\x07\x1b]4;255;rgb:1212/abab/5656\x07\
    \x1b]4;255;rgb:eeee/eeee/eeee\x07";

fn draw_color(protocol: &mut Protocol) {
    protocol.draw(|screen| screen.draw_character(0, 0, 'x', [Color::Rgb(18, 52, 86); 2]));
}

fn depths(protocol: &mut Protocol) -> Vec<ColorDepth> {
    let events = std::iter::from_fn(|| protocol.next_event());
    let depth = |event| if let Event::ColorDepth(depth) = event { Some(depth) } else { None };
    events.filter_map(depth).collect()
}

#[test]
fn a_256_colour_terminal_with_a_proven_palette_shows_all_colours() {
    let mut protocol = begun("xterm-256color");
    let now = Duration::from_millis(20);
    sent(&mut protocol, now);
    protocol.receive(PROVEN, now);
    assert_eq!(depths(&mut protocol), []);
    protocol.receive(ANSWERS, now);
    assert_eq!(depths(&mut protocol), [ColorDepth::True]);
    assert_eq!(protocol.color_source(), ColorSource::Palette);
    draw_color(&mut protocol);
    let text = sent(&mut protocol, now);
    assert!(text.contains(";#123456") && !text.contains("38;2;"), "{text:?}");
    protocol.end(now);
    assert!(sent(&mut protocol, now).contains("\x1b]104;24;"));
}

#[test]
fn a_24_bit_answer_takes_precedence_over_redefining_the_palette() {
    let mut protocol = begun("xterm-256color");
    let now = Duration::from_millis(20);
    sent(&mut protocol, now);
    protocol.receive(b"\x1bP>|XTerm(390)\x1b\\", now);
    assert!(sent(&mut protocol, now).contains(sequence::QUERY_TRUE_COLOR));
    protocol.receive(PROVEN, now);
    protocol.receive(ANSWERS, now);
    assert_eq!(protocol.color_depth(), ColorDepth::Indexed256, "an answer is missing");
    protocol.receive(b"\x1bP1+r524742=38\x1b\\\x1b[?62;22c", now);
    assert_eq!(depths(&mut protocol), [ColorDepth::True]);
    assert_eq!(protocol.color_source(), ColorSource::Answer);
}

#[test]
fn a_terminal_is_known_by_its_name() {
    let mut protocol = begun("xterm-kitty");
    let now = Duration::from_millis(20);
    assert!(sent(&mut protocol, now).contains(sequence::QUERY_VERSION));
    assert_eq!(protocol.glyph_support(), GlyphSet::Half);
    protocol.receive(b"\x1bP>|kitty(0.42.1)\x1b\\", now);
    assert_eq!(protocol.next_event(), Some(Event::Identified));
    assert_eq!(protocol.glyph_support(), GlyphSet::Octant);
    assert_eq!(protocol.shade_ink(), ShadeInk::Dots);
}

const OWN: [u16; 3] = [0xeeee; 3];
const DEFINED: [u16; 3] = sequence::DEFINED;

fn after(reports: &[[u16; 3]]) -> PaletteProbe {
    reports.iter().fold(PaletteProbe::default(), |palette, color| palette.after_report(*color))
}

#[test]
fn a_palette_is_usable_if_it_can_be_defined_and_reset() {
    assert_eq!(after(&[OWN, DEFINED, OWN]), PaletteProbe::Reset);
    for reports in [
        &[OWN][..],
        &[OWN, DEFINED],
        &[OWN, OWN],
        &[OWN, OWN, OWN],
        &[OWN, DEFINED, DEFINED],
        &[OWN, [0; 3], OWN],
        &[DEFINED, DEFINED, OWN],
        &[OWN, DEFINED, OWN, OWN],
    ] {
        assert_ne!(after(reports), PaletteProbe::Reset, "{reports:x?}");
    }
}
