//! A room with members on links with faults, a thousand times, each repeatable by its seed.
//!
//! A steady member turns all the time; the others send keys and noise, change their windows, answer
//! late or not at all, and leave. After each run:
//!
//! - the log and the header of the room give the same room again;
//! - the steady member has missed no picture;
//! - who does not answer has been sent at most one frame and a question.

use super::*;
use crate::rng::SplitMix64;

const STEPS: u64 = 120;
/// The pictures of two seconds at 30 a second, but for those at the beginning.
const LEAST_PICTURES: u64 = 50;
/// The most bytes of a frame of a window of that many cells.
const BYTES_OF_A_CELL: usize = 40;

const KEYS: [&str; 12] = [
    "\x1b[119;1:1u",
    "\x1b[119;1:3u",
    "\x1b[100;1:1u",
    "\x1b[100;1:3u",
    "\x1b[A",
    "\x1b[13u",
    "\x1b[9u",
    "\x1b[47u",
    "\x1b[104:72;2u",
    "\x1b[109u",
    "\x1b[63u",
    "\x1b[59u",
];

/// Something that happens to a member whose link has faults.
fn disturb(rig: &mut Rig, index: usize, chance: &mut SplitMix64) {
    let now = rig.now;
    let visitor = &mut rig.visitors[index];
    match chance.below(10) {
        0 => {
            let size = [chance.below(60), chance.below(20)].map(|cells| cells as u16);
            visitor.session.resize(WindowSize::of_cells(size[0], size[1]), now);
            visitor.emulator.resize(size[0].max(1), size[1].max(1));
        }
        1 => {
            let noise: Vec<u8> = (0..chance.below(30)).map(|_| chance.below(256) as u8).collect();
            visitor.session.receive(&noise, now);
        }
        2 => visitor.latency = Duration::from_millis(chance.below(400) as u64),
        3 => {
            visitor.session.tell(News::Said(line("all is well")), now);
        }
        _ => visitor.session.receive(KEYS[chance.below(KEYS.len())].as_bytes(), now),
    }
    rig.serve(index);
}

fn play(seed: u64) {
    let mut chance = SplitMix64::new(seed);
    let mode = [Mode::Roam, Mode::Tag, Mode::Race, Mode::Together][chance.below(4)];
    let mut rig = Rig::new(mode);
    let steady = rig.member("Mara", (24, 7), Speaks::Kitty);
    let faulty = rig.member("Jon", (24, 7), Speaks::Kitty);
    let silent = rig.member("Lu", (24, 7), Speaks::Kitty);
    rig.send(steady, "\x1b[C\x1b[1;1:1C");
    rig.visitors[silent].answers = false;
    let before = rig.visitors[steady].pictures;
    let silent_before = rig.visitors[silent].bytes;
    for _ in 0..STEPS {
        if chance.below(4) == 0 {
            disturb(&mut rig, faulty, &mut chance);
        }
        if chance.below(200) == 0 {
            rig.apply(faulty, Deed::Leave);
        }
        rig.pump(16);
    }
    let pictures = rig.visitors[steady].pictures - before;
    assert!(pictures >= LEAST_PICTURES, "seed {seed}: {pictures} pictures in {mode:?}");
    let bytes = rig.visitors[silent].bytes - silent_before;
    assert!(bytes <= 24 * 7 * BYTES_OF_A_CELL, "seed {seed}: {bytes} bytes");
    let header = rig.room.header().clone();
    let mut again = Room::new(&rig.catalog, header).unwrap();
    let mut entries = rig.log.iter().peekable();
    while again.step() < rig.room.step() {
        while let Some(entry) = entries.next_if(|entry| entry.step <= again.step()) {
            again.apply(entry);
        }
        again.advance();
    }
    assert_eq!(again.checksum(), rig.room.checksum(), "seed {seed}");
}

#[test]
fn five_hundred_seeds_of_faulty_links() {
    (0..500).for_each(play);
}

#[test]
fn five_hundred_more_seeds_of_faulty_links() {
    (500..1_000).for_each(play);
}
