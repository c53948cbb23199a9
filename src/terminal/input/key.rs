//! Parses a unit of bytes as a key.

use termina::event::{KeyCode, KeyEventKind, ModifierKeyCode, Modifiers as Reported};

use super::super::key::{Key, KeyEvent, Modifiers, Phase, base_key};

/// The key event of `unit`; `None` if it is not a key, or one that cannot be bound.
pub(crate) fn parse(unit: &[u8]) -> Option<KeyEvent> {
    match unit {
        [0x1b, character] => {
            let event = parse(&[*character])?;
            Some(KeyEvent { modifiers: Modifiers { alt: true, ..event.modifiers }, ..event })
        }
        _ => translate(reported(unit)?, told_base(unit)),
    }
}

/// The third part of the first number of `CSI … u` in the kitty protocol: the character of the key
/// in the US layout.
fn told_base(unit: &[u8]) -> Option<char> {
    let numbers = unit.strip_prefix(b"\x1b[")?.strip_suffix(b"u")?;
    let number = numbers.split(|&byte| byte == b';').next()?.split(|&byte| byte == b':').nth(2)?;
    char::from_u32(str::from_utf8(number).ok()?.parse().ok()?)
}

/// The parser's event for `unit`. Each unit has a new parser: one that has kept bytes of an unknown
/// unit would prefix them to the next.
fn reported(unit: &[u8]) -> Option<termina::event::KeyEvent> {
    let mut parser = termina::Parser::default();
    parser.parse(unit, false);
    match parser.pop() {
        Some(termina::Event::Key(event)) => Some(event),
        _ => None,
    }
}

fn translate(event: termina::event::KeyEvent, told_base: Option<char>) -> Option<KeyEvent> {
    // The parser drops Shift if the terminal reports the character that it types, too.
    let is_upper = matches!(event.code, KeyCode::Char(character) if character.is_uppercase());
    let modifiers = Modifiers {
        shift: is_upper || event.modifiers.contains(Reported::SHIFT),
        control: event.modifiers.contains(Reported::CONTROL),
        alt: event.modifiers.contains(Reported::ALT),
    };
    let phase = match event.kind {
        KeyEventKind::Press => Phase::Press,
        KeyEventKind::Repeat => Phase::Repeat,
        KeyEventKind::Release => Phase::Release,
    };
    let key = name(event.code)?;
    Some(KeyEvent { key, base: base_key(key, told_base), modifiers, phase })
}

fn name(code: KeyCode) -> Option<Key> {
    Some(match code {
        KeyCode::Char(character) if character.is_control() => return None,
        KeyCode::Char(character) => Key::typing(character),
        KeyCode::Enter => Key::Enter,
        KeyCode::Backspace => Key::Backspace,
        KeyCode::Tab | KeyCode::BackTab => Key::Tab,
        KeyCode::Escape => Key::Escape,
        KeyCode::Left => Key::Left,
        KeyCode::Right => Key::Right,
        KeyCode::Up => Key::Up,
        KeyCode::Down => Key::Down,
        KeyCode::Home => Key::Home,
        KeyCode::End => Key::End,
        KeyCode::PageUp => Key::PageUp,
        KeyCode::PageDown => Key::PageDown,
        KeyCode::Insert => Key::Insert,
        KeyCode::Delete => Key::Delete,
        KeyCode::Function(number) => Key::Function(number),
        KeyCode::Modifier(ModifierKeyCode::LeftShift | ModifierKeyCode::RightShift) => Key::Shift,
        KeyCode::Modifier(ModifierKeyCode::LeftControl | ModifierKeyCode::RightControl) => {
            Key::Control
        }
        KeyCode::Modifier(ModifierKeyCode::LeftAlt | ModifierKeyCode::RightAlt) => Key::Alt,
        _ => return None,
    })
}
