//! Checkpoints of rooms: as a host has made them, with changed bytes, or made of arbitrary bytes.
//!
//! A checkpoint is either rejected with a sentence, or a room is restored from it. The restored
//! room has a checkpoint itself, and continues to run: one second in most cases, and ten seconds in
//! one case of eight.

use cellcaster_server::fuzzing::{CHECKPOINTS, checkpoint, resume};

use crate::bytes::Bytes;

/// The number of steps of most restored rooms, and of the others.
const STEPS: usize = 60;
const MAX_STEPS: usize = 600;
const MAX_CHANGES: usize = 24;

/// Changes the checkpoint with the number in the first byte, or replaces everything after its first
/// line by the bytes of the input.
pub fn run(data: &[u8]) {
    let mut choices = Bytes::new(data);
    let number = usize::from(choices.byte());
    let made = checkpoint(number % CHECKPOINTS);
    let bytes = if number < CHECKPOINTS {
        changed(made.to_vec(), &mut choices)
    } else {
        let line = made.iter().position(|&byte| byte == b'\n').expect("it has a first line");
        [&made[..=line], choices.take(data.len())].concat()
    };
    let steps = if data.len().is_multiple_of(8) { MAX_STEPS } else { STEPS };
    if let Err(sentence) = resume(&bytes, data.len() as u64, steps) {
        assert!(!sentence.is_empty() && !sentence.contains(char::is_control), "{sentence:?}");
    }
    if data.len() == 1 && number < CHECKPOINTS {
        assert_eq!(resume(made, 0, MAX_STEPS), Ok(()), "nothing is changed");
    }
}

/// Sets, flips, inserts and removes bytes.
fn changed(mut bytes: Vec<u8>, choices: &mut Bytes) -> Vec<u8> {
    for _ in 0..MAX_CHANGES {
        if choices.is_empty() || bytes.is_empty() {
            break;
        }
        let kind = choices.below(5);
        let place = choices.double_word() as usize % bytes.len();
        match kind {
            0 => bytes[place] = choices.byte(),
            1 => bytes[place] ^= 1 << choices.below(8),
            2 => bytes.insert(place, choices.byte()),
            3 => _ = bytes.remove(place),
            _ => {
                let count = choices.below(9).min(bytes.len() - place);
                let new = choices.take(count);
                bytes[place..place + new.len()].copy_from_slice(new);
            }
        }
    }
    bytes
}
