//! Tests of the units that terminals send, whole and in pieces.

use proptest::prelude::*;

use super::super::event::{Key, Modifiers, Phase};
use super::*;
use crate::terminal::event::{MouseButton, MouseEventKind};
use crate::terminal::known::known;

const PLAIN: Modifiers = Modifiers { shift: false, control: false, alt: false };
const SHIFT: Modifiers = Modifiers { shift: true, ..PLAIN };
const CONTROL: Modifiers = Modifiers { control: true, ..PLAIN };
const ALT: Modifiers = Modifiers { alt: true, ..PLAIN };

fn key(key: Key, modifiers: Modifiers, phase: Phase) -> TerminalInput {
    TerminalInput::Key(KeyEvent { key, base: None, modifiers, phase })
}

/// A key of a non-Latin layout, at the place of `base`.
fn elsewhere(name: char, base: char, modifiers: Modifiers, phase: Phase) -> TerminalInput {
    let (key, base) = (Key::Char(name), Some(Key::Char(base)));
    TerminalInput::Key(KeyEvent { key, base, modifiers, phase })
}

fn press(name: Key, modifiers: Modifiers) -> TerminalInput {
    key(name, modifiers, Phase::Press)
}

fn mouse(kind: MouseEventKind, place: [u32; 2]) -> TerminalInput {
    TerminalInput::Mouse(MouseReport { kind, place })
}

/// Complete units that terminals send, with their meanings.
fn vocabulary() -> Vec<(&'static str, Option<TerminalInput>)> {
    let answer = TerminalInput::Answer;
    let meaningful = [
        ("w", press(Key::Char('w'), PLAIN)),
        ("W", press(Key::Char('w'), SHIFT)),
        ("é", press(Key::Char('é'), PLAIN)),
        ("字", press(Key::Char('字'), PLAIN)),
        ("😀", press(Key::Char('😀'), PLAIN)),
        (" ", press(Key::Char(' '), PLAIN)),
        ("\r", press(Key::Enter, PLAIN)),
        ("\t", press(Key::Tab, PLAIN)),
        ("\x7f", press(Key::Backspace, PLAIN)),
        ("\x03", press(Key::Char('c'), CONTROL)),
        ("\x1bx", press(Key::Char('x'), ALT)),
        ("\x1bé", press(Key::Char('é'), ALT)),
        ("\x1b[A", press(Key::Up, PLAIN)),
        ("\x1bOA", press(Key::Up, PLAIN)),
        ("\x1b[1;2D", press(Key::Left, SHIFT)),
        ("\x1b[Z", press(Key::Tab, SHIFT)),
        ("\x1b[[A", press(Key::Function(1), PLAIN)),
        ("\x1bOP", press(Key::Function(1), PLAIN)),
        ("\x1b[24~", press(Key::Function(12), PLAIN)),
        ("\x1b[5~", press(Key::PageUp, PLAIN)),
        ("\x1b[97u", press(Key::Char('a'), PLAIN)),
        ("\x1b[97;2u", press(Key::Char('a'), SHIFT)),
        ("\x1b[97;1:2u", key(Key::Char('a'), PLAIN, Phase::Repeat)),
        ("\x1b[97;1:3u", key(Key::Char('a'), PLAIN, Phase::Release)),
        ("\x1b[97;129u", press(Key::Char('a'), PLAIN)),
        ("\x1b[27;1:3u", key(Key::Escape, PLAIN, Phase::Release)),
        ("\x1b[1;1:3A", key(Key::Up, PLAIN, Phase::Release)),
        ("\x1b[57441;2u", press(Key::Shift, SHIFT)),
        ("\x1b[57448;1:3u", key(Key::Control, CONTROL, Phase::Release)),
        ("\x1b[1094::119;1:1u", elsewhere('ц', 'w', PLAIN, Phase::Press)),
        ("\x1b[1094::119;1:3u", elsewhere('ц', 'w', PLAIN, Phase::Release)),
        ("\x1b[1094:1062:119;2u", elsewhere('ц', 'w', SHIFT, Phase::Press)),
        ("\x1b[1089::99;5u", elsewhere('с', 'c', CONTROL, Phase::Press)),
        ("\x1b[1492::101u", elsewhere('ה', 'e', PLAIN, Phase::Press)),
        ("\x1b[122::119;1:1u", press(Key::Char('z'), PLAIN)),
        ("\x1b[59::122u", press(Key::Char(';'), PLAIN)),
        ("\x1b[97::u", press(Key::Char('a'), PLAIN)),
        ("\x1b[1094::1114112u", elsewhere('ц', 'w', PLAIN, Phase::Press)),
        ("ц", elsewhere('ц', 'w', PLAIN, Phase::Press)),
        ("Ц", elsewhere('ц', 'w', SHIFT, Phase::Press)),
        ("ς", elsewhere('ς', 'w', PLAIN, Phase::Press)),
        ("\x1bф", elsewhere('ф', 'a', ALT, Phase::Press)),
        ("\x1b[?0u", answer(Answer::KeyFlags)),
        ("\x1b[?11u", answer(Answer::KeyFlags)),
        ("\x1b[?62;4c", answer(Answer::Fence)),
        ("\x1b[?1016;2$y", answer(Answer::PixelMouse)),
        ("\x1b[<35;3;4M", mouse(MouseEventKind::Moved, [3, 4])),
        ("\x1b[<32;1200;700M", mouse(MouseEventKind::Moved, [1200, 700])),
        ("\x1b[<0;3;4M", mouse(MouseEventKind::Pressed(MouseButton::Left), [3, 4])),
        ("\x1b[<1;3;4M", mouse(MouseEventKind::Pressed(MouseButton::Middle), [3, 4])),
        ("\x1b[<22;3;4M", mouse(MouseEventKind::Pressed(MouseButton::Right), [3, 4])),
        ("\x1b[<0;3;4m", mouse(MouseEventKind::Released, [3, 4])),
        ("\x1b[M #$", mouse(MouseEventKind::Pressed(MouseButton::Left), [3, 4])),
        ("\x1b[MC#$", mouse(MouseEventKind::Moved, [3, 4])),
        ("\x1b[M##$", mouse(MouseEventKind::Released, [3, 4])),
        ("\x1b[I", TerminalInput::Focus(true)),
        ("\x1b[O", TerminalInput::Focus(false)),
        ("\x1b[0n", answer(Answer::Status)),
        ("\x1b[3n", answer(Answer::Status)),
        ("\x1bP1+r524742=382F382F38\x1b\\", answer(Answer::TrueColor)),
        ("\x1bP1+r524742\x1b\\", answer(Answer::TrueColor)),
        ("\x1bP>|XTerm(390)\x1b\\", answer(Answer::Version(known("XTerm(390)")))),
        ("\x1bP>|kitty(0.40.1)\x1b\\", answer(Answer::Version(known("kitty(0.40.1)")))),
        ("\x1bP>|tmux 3.4\x1b\\", answer(Answer::Version(known("tmux 3.4")))),
        ("\x1bP>|WezTerm 20240203\x1b\\", answer(Answer::Version(known("WezTerm 20240203")))),
    ];
    let meaningless = [
        "\x1bP0+r524742\x1b\\",
        "\x1b[?2026;2$y",
        "\x1b[>1;4000;19c",
        "\x1b[?997;1n",
        "\x1b[12;40R",
        "\x1b[?1016;0$y",
        "\x1b[?1016;4$y",
        "\x1b[<64;3;4M",
        "\x1b[<0;3M",
        "\x1b[<0;3;4;5M",
        "\x1b[<0;99999999999;4M",
        "\x1b[M`!!",
        "\x1b]11;rgb:0000/0000/0000\x1b\\",
        "\x1b]11;rgb:0000/0000/0000\x07",
        "\x1b_Gi=1;OK\x1b\\",
    ];
    meaningful
        .into_iter()
        .map(|(text, input)| (text, Some(input)))
        .chain(meaningless.map(|text| (text, None)))
        .collect()
}

fn decode<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> Vec<TerminalInput> {
    let mut decoder = Decoder::default();
    let mut inputs = Vec::new();
    for piece in pieces {
        decoder.feed(piece, |input| inputs.push(input));
    }
    assert_eq!(decoder.timeout(), None, "the stream ends with a whole unit");
    inputs
}

fn settle(decoder: &mut Decoder) -> Vec<TerminalInput> {
    let mut inputs = Vec::new();
    decoder.give_up(|input| inputs.push(input));
    inputs
}

#[test]
fn every_sequence_decodes_to_its_meaning() {
    for (text, expected) in vocabulary() {
        assert_eq!(decode([text.as_bytes()]), Vec::from_iter(expected), "{text:?}");
    }
}

#[test]
fn a_palette_entry_is_reported_in_one_to_four_digits() {
    let entry = |color| vec![TerminalInput::Answer(Answer::PaletteEntry(color))];
    for (text, expected) in [
        ("\x1b]4;255;rgb:1212/abab/5656\x1b\\", entry([0x1212, 0xabab, 0x5656])),
        ("\x1b]4;255;rgb:12/ab/56\x07", entry([0x1212, 0xabab, 0x5656])),
        ("\x1b]4;255;rgb:f/0/000\x07", entry([0xffff, 0, 0])),
        ("\x1b]4;254;rgb:0000/0000/0000\x07", Vec::new()),
        ("\x1b]4;255;rgb:00000/0000/0000\x07", Vec::new()),
        ("\x1b]4;255;rgb:0000/0000\x07", Vec::new()),
        ("\x1b]4;255;rgb:00/00/00/00\x07", Vec::new()),
        ("\x1b]4;255;rgb://\x07", Vec::new()),
    ] {
        assert_eq!(decode([text.as_bytes()]), expected, "{text:?}");
    }
}

#[test]
fn an_escape_by_itself_is_the_escape_key() {
    let mut decoder = Decoder::default();
    decoder.feed(b"\x1b", |input| panic!("{input:?} came too early"));
    assert!(decoder.timeout().is_some());
    assert_eq!(settle(&mut decoder), [press(Key::Escape, PLAIN)]);
    assert_eq!(decoder.timeout(), None);
}

#[test]
fn two_escapes_are_two_keys() {
    let mut decoder = Decoder::default();
    let mut inputs = Vec::new();
    decoder.feed(b"\x1b\x1b", |input| inputs.push(input));
    inputs.extend(settle(&mut decoder));
    assert_eq!(inputs, [press(Key::Escape, PLAIN); 2]);
}

#[test]
fn alt_with_a_sequence_starter_is_a_key_after_the_wait() {
    for (text, character) in [("\x1b[", '['), ("\x1bO", 'o'), ("\x1bP", 'p'), ("\x1b]", ']')] {
        let mut decoder = Decoder::default();
        decoder.feed(text.as_bytes(), |input| panic!("{input:?} came too early"));
        let [TerminalInput::Key(event)] = settle(&mut decoder)[..] else {
            panic!("{text:?} is a key")
        };
        assert_eq!(event.key, Key::Char(character));
        assert!(event.modifiers.alt);
    }
}

#[test]
fn a_string_cut_short_by_a_key_is_dropped_and_the_key_kept() {
    assert_eq!(decode([&b"\x1bP1+r52\x1b[A"[..]]), [press(Key::Up, PLAIN)]);
}

#[test]
fn an_endless_sequence_is_dropped_and_takes_no_memory() {
    let mut decoder = Decoder::default();
    decoder.feed(b"\x1b[?", |_| ());
    for _ in 0..100_000 {
        decoder.feed(b"1;", |_| ());
    }
    let mut inputs = Vec::new();
    decoder.feed(b"cw", |input| inputs.push(input));
    assert_eq!(inputs, [press(Key::Char('w'), PLAIN)]);
}

proptest! {
    #[test]
    fn events_do_not_depend_on_how_the_bytes_arrive(
        units in prop::collection::vec(prop::sample::select(vocabulary()), 0..20),
        cuts in prop::collection::vec(any::<prop::sample::Index>(), 0..20),
    ) {
        let stream = units.iter().flat_map(|(text, _)| text.bytes()).collect::<Vec<_>>();
        let mut cuts = cuts.iter().map(|cut| cut.index(stream.len() + 1)).collect::<Vec<_>>();
        cuts.extend([0, stream.len()]);
        cuts.sort_unstable();
        let pieces = cuts.windows(2).map(|pair| &stream[pair[0]..pair[1]]);
        let expected = units.iter().filter_map(|(_, input)| *input).collect::<Vec<_>>();
        prop_assert_eq!(decode(pieces), expected);
    }

    #[test]
    fn no_bytes_block_the_keys_after_them(bytes: Vec<u8>) {
        let mut decoder = Decoder::default();
        decoder.feed(&bytes, |_| ());
        settle(&mut decoder);
        prop_assert_eq!(decoder.timeout(), None);
        let mut inputs = Vec::new();
        decoder.feed(b"w", |input| inputs.push(input));
        prop_assert_eq!(inputs, [press(Key::Char('w'), PLAIN)]);
    }

    #[test]
    fn no_sequence_panics(sequence in "\x1b[\\[O]?[0-9;:<>?$ ]{0,12}[@-~]") {
        Decoder::default().feed(sequence.as_bytes(), |_| ());
    }
}
