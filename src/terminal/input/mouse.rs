//! Parses reports of the mouse.

use super::super::mouse::{MouseButton, MouseEventKind, MouseReport};

/// Bits of a report's first number besides those of the button.
const MOTION: u32 = 32;
/// The bits of the wheel and of buttons beyond the third.
const OTHERS: u32 = 64 | 128;

/// The report in `unit`, a control sequence: `CSI < button ; column ; row` and `M`, or `m` for a
/// released button (xterm's control sequences, "Extended coordinates").
pub(crate) fn parse(unit: &[u8]) -> Option<MouseReport> {
    let text = str::from_utf8(unit.strip_prefix(b"\x1b[<")?).ok()?;
    let (numbers, is_release) = match text.strip_suffix('M') {
        Some(numbers) => (numbers, false),
        None => (text.strip_suffix('m')?, true),
    };
    let mut numbers = numbers.split(';').map(|number| number.parse().ok());
    let [code, column, row] = [numbers.next()??, numbers.next()??, numbers.next()??];
    let kind = kind(code, is_release)?;
    numbers.next().is_none().then_some(MouseReport { kind, place: [column, row] })
}

/// The report in `unit`: `CSI M` and three bytes, from old terminals without the other form.
pub(crate) fn parse_bytes(unit: &[u8]) -> Option<MouseReport> {
    let &[code, column, row] = unit.strip_prefix(b"\x1b[M")? else { return None };
    let [code, column, row] = [code, column, row].map(|byte| u32::from(byte.saturating_sub(32)));
    Some(MouseReport { kind: kind(code, false)?, place: [column, row] })
}

fn kind(code: u32, is_release: bool) -> Option<MouseEventKind> {
    Some(match code & 3 {
        _ if code & OTHERS != 0 => return None,
        _ if code & MOTION != 0 => MouseEventKind::Moved,
        _ if is_release => MouseEventKind::Released,
        0 => MouseEventKind::Pressed(MouseButton::Left),
        1 => MouseEventKind::Pressed(MouseButton::Middle),
        2 => MouseEventKind::Pressed(MouseButton::Right),
        _ => MouseEventKind::Released,
    })
}
