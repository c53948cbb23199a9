//! A room and its visitors. Their terminals send arbitrary bytes, and the log of the round
//! reproduces the room bit for bit. A session ends only after it has restored its terminal.

use cellcaster::terminal::{SessionOptions, WindowSize};
use cellcaster_server::fuzzing::FuzzedRoom;

use crate::alacritty::Alacritty;
use crate::bytes::Bytes;

const MAX_VISITORS: usize = 4;
const MAX_OPERATIONS: usize = 200;
/// The largest number of steps of a round that is replayed.
const MAX_STEPS: u64 = 1200;
/// Bytes that a visitor may send.
const KEYS: [&str; 24] = [
    "\r",
    "\x1b",
    "\x1b[A",
    "\x1b[B",
    "\x1b[C",
    "\x1b[D",
    "w",
    "a",
    "s",
    "d",
    " ",
    "t",
    "hi\r",
    "/leave\r",
    "\t",
    "q",
    "?",
    "\x1b[<35;3;4M",
    "\x1b[119;1:3u",
    "\x1b[119;1:1u",
    "\x03",
    "\x1b[I",
    "\x7f",
    "m",
];

/// A visitor's terminal.
struct Terminal {
    screen: Alacritty,
    answers: Vec<u8>,
    is_honest: bool,
}

/// Lets visitors arrive and act.
pub fn run(data: &[u8]) {
    let mut choices = Bytes::new(data);
    let choices = &mut choices;
    let mut room = FuzzedRoom::new(choices.double_word().into());
    let mut terminals: Vec<Terminal> = Vec::new();
    for _ in 0..MAX_OPERATIONS {
        if choices.is_empty() || room.steps() > MAX_STEPS {
            break;
        }
        let what = choices.below(16);
        if terminals.is_empty() || what == 0 && terminals.len() < MAX_VISITORS {
            terminals.push(arrive(&mut room, choices));
        }
        let visitor = choices.below(terminals.len());
        let terminal = &mut terminals[visitor];
        show(&mut room, visitor, terminal);
        if room.is_over(visitor) {
            // Nothing more arrives from this visitor.
            continue;
        }
        match what {
            0..8 => room.receive(visitor, choices.pick(&KEYS).as_bytes()),
            8 => {
                let count = choices.below(24);
                room.receive(visitor, choices.take(count));
            }
            9 => {
                let size = size(choices);
                terminal.screen.resize(size.columns.max(1), size.rows.max(1));
                room.resize(visitor, size);
            }
            10 => room.notify(visitor, choices.byte().into()),
            11 => room.pass(choices.byte().into()),
            _ => {
                let answers = std::mem::take(&mut terminal.answers);
                room.receive(visitor, &answers);
                room.pass(1);
            }
        }
        show(&mut room, visitor, &mut terminals[visitor]);
    }
    room.pass(1);
    check_recording(&room);
}

fn arrive(room: &mut FuzzedRoom, choices: &mut Bytes) -> Terminal {
    let kind = choices.byte();
    let options = SessionOptions::from_environment(|name| match name {
        "TERM" => {
            Some(["xterm-256color", "linux", "tmux", "dumb"][usize::from(kind & 3)].to_owned())
        }
        "SSH_CONNECTION" => Some("a far one".to_owned()),
        "COLORTERM" if kind >> 2 & 1 == 1 => Some("truecolor".to_owned()),
        _ => None,
    });
    let size = size(choices);
    room.arrive(
        ["Ada", "Bo", "字", "a name of a guest"][usize::from(kind >> 4 & 3)],
        options,
        size,
    );
    let screen = Alacritty::new(size.columns.max(1), size.rows.max(1));
    Terminal { screen, answers: Vec::new(), is_honest: true }
}

fn size(choices: &mut Bytes) -> WindowSize {
    let (columns, rows) = (choices.byte(), choices.byte());
    let pixels = if columns & 1 == 1 { (800, 600) } else { (0, 0) };
    WindowSize::new(((columns % 90).into(), (rows % 30).into()), pixels)
}

/// Shows the output of a session, and checks its end.
fn show(room: &mut FuzzedRoom, visitor: usize, terminal: &mut Terminal) {
    let output = room.output(visitor);
    terminal.answers.extend(terminal.screen.process(&output));
    terminal.answers.truncate(4096);
    if room.is_over(visitor) && terminal.is_honest {
        let new = Alacritty::new(1, 1);
        assert_eq!(terminal.screen.modes(), new.modes(), "modes are left");
        terminal.is_honest = false;
    }
}

/// Checks that the log of the round reproduces the room.
fn check_recording(room: &FuzzedRoom) {
    if room.steps() >= MAX_STEPS {
        return;
    }
    let (text, checksum) = room.recording();
    // An entry for a member who does not exist makes the replay run up to the present step.
    let text = format!("{text}{} leave 0\n", room.steps());
    assert_eq!(FuzzedRoom::replayed(&text), Ok(Some(checksum)), "the log gives another room:\n{text}");
}
