//! A restored room equals the original, and a damaged checkpoint is either rejected or yields a valid room.

#[allow(dead_code, reason = "the game's tests use the rest")]
#[path = "../../../../../../tests/support/crowd.rs"]
mod crowd;

use std::fs;
use std::time::Instant;

use proptest::prelude::*;

use self::crowd::Crowd;
use super::*;
use crate::accounts::Day;
use crate::rooms::room::{Command, Emote, Entry, MemberId, Mode};
use crate::simulation;
use cellcaster::app::parts::Choice as _;
use cellcaster::game::stored::first_line;
use cellcaster::game::{Intents, PlayerColor, RULES_VERSION, Script};
use cellcaster::map::builtin::LEVELS;
use cellcaster::rng::SplitMix64;
use cellcaster::world::Difficulty;

fn line(text: &str) -> Line {
    Line::of(text, CHAT_COLUMNS).unwrap()
}

fn today() -> Day {
    Day::of_level("daily-2026-11-28").unwrap()
}

/// A source of members who join, move, talk and leave in the same way in several equal rooms.
struct Party {
    crowd: Crowd,
    random: SplitMix64,
    most: usize,
}

impl Party {
    /// At most `most` members. The first follows the script of the level, if there is one.
    fn new(header: &Header, most: usize, seed: u64) -> Self {
        let is_won = header.mode.has_guards() && LEVELS.iter().any(|it| it.name == header.level);
        let script = if is_won { winning(&header.level, header.difficulty) } else { Vec::new() };
        let mut random = SplitMix64::new(seed);
        let crowd = Crowd::new(script, most, SplitMix64::new(random.bits()));
        Self { crowd, random, most: most.min(header.mode.most()) }
    }

    /// Applies the same entries to all `rooms` and advances each by one step.
    fn step(&mut self, rooms: &mut [&mut Room]) {
        for entry in self.entries(rooms[0]) {
            for room in rooms.iter_mut() {
                room.apply(&entry);
            }
        }
        for room in rooms {
            room.advance();
            if room.is_over() {
                room.begin_next();
            }
        }
    }

    fn entries(&mut self, room: &Room) -> Vec<Entry> {
        let (step, random) = (room.step(), &mut self.random);
        let entry = |member, command| Entry { step, member, command };
        let mut entries = Vec::new();
        if room.len() == 0 || room.len() < self.most && random.one_in(90) {
            let color = PlayerColor::ALL[random.below(8)];
            let join = Command::Join { color, name: line(["Mara", "Jon", "字"][random.below(3)]) };
            entries.push(entry(room.next_member(), join));
        }
        for (slot, member) in room.members.iter().enumerate() {
            let command = match random.below(400) {
                0 if slot > 0 => Some(Command::Leave),
                1 => Some(Command::Say(line("behind you"))),
                2 => Some(Command::Emote(Emote::ALL[random.below(6)].0)),
                3 => Some(Command::Again),
                4 => Some(Command::Keep),
                5 => Some(Command::Away),
                6 => Some(Command::Return { token: random.bits() }),
                7 => Some(Command::Day(today().before(random.below(3) as u32))),
                _ => None,
            };
            entries.extend(command.map(|command| entry(member.id, command)));
            let ago = random.below(20) as u64;
            let seen = if ago == 0 { u64::MAX } else { room.game().steps().saturating_sub(ago) };
            let intents = self.crowd.want(slot);
            entries.push(entry(member.id, Command::Intents { seen, intents }));
        }
        entries
    }
}

/// Restores a room from the checkpoint of `room` and asserts that both are equal.
fn again(room: &Room) -> Room {
    let restored = Room::restore(&room.catalog, &room.checkpoint());
    let restored = restored.unwrap_or_else(|error| panic!("{error}"));
    assert_same(&restored, room);
    restored
}

/// Asserts that both rooms are equal in every field, bit for bit, and in the view of their sessions.
fn assert_same(one: &Room, other: &Room) {
    assert_eq!((one.step, one.next_member), (other.step, other.next_member));
    assert_eq!((&one.header, &one.round), (&other.header, &other.round));
    assert_eq!((&one.members, &one.again), (&other.members, &other.again));
    assert_eq!(one.today, other.today);
    assert_eq!((&one.emotes, &one.standings), (&other.emotes, &other.standings));
    assert_eq!((&one.said, one.said_count), (&other.said, other.said_count));
    assert!(one.game == other.game, "the games differ");
    assert_eq!(one.checksum(), other.checksum());
    assert!(one.checkpoint() == other.checkpoint(), "the bytes differ");
    let (one, other) = (one.view(), other.view());
    assert_eq!((one.phase, &one.members), (other.phase, &other.members));
    assert_eq!((&one.standings, &one.said), (&other.standings, &other.said));
    assert!(one.game.world() == other.game.world(), "the pictures differ");
}

/// Plays `before` steps, restores the room, and continues with both copies.
fn played(catalog: &Arc<Catalog>, header: Header, most: usize, before: u64, seed: u64) {
    let mut party = Party::new(&header, most, seed);
    let mut room = Room::new(catalog, header).unwrap();
    (0..before).for_each(|_| party.step(&mut [&mut room]));
    let mut other = again(&room);
    for step in 0..1200 {
        party.step(&mut [&mut room, &mut other]);
        assert_eq!(room.game.checksum(), other.game.checksum(), "step {step}");
        if step % 10 == 0 {
            assert_eq!(room.checksum(), other.checksum(), "step {step}");
        }
    }
    assert_same(&other, &room);
}

#[test]
fn a_restored_room_plays_on_in_every_level_and_mode() {
    let catalog = Arc::new(Catalog::builtin());
    for (number, level) in (1..).zip(LEVELS) {
        for mode in Mode::ALL {
            for difficulty in Difficulty::ALL {
                let seed = number << 16 | (mode as u64) << 8 | difficulty as u64;
                let header = Header::new(level.name, mode, difficulty, seed);
                let mut random = SplitMix64::new(seed);
                let (most, before) = (1 + random.below(4), random.below(1500) as u64);
                played(&catalog, header, most, before, random.bits());
            }
        }
    }
}

#[test]
fn a_restored_room_plays_on_in_a_daily_level() {
    let catalog = Arc::new(Catalog::builtin());
    for (seed, mode) in (1..).zip([Mode::Alone, Mode::Race, Mode::Together]) {
        let level = today().before(2).level();
        let header = Header::new(&level, mode, Difficulty::Normal, seed);
        played(&catalog, header, 2, 900 * seed, seed);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn a_restored_room_plays_on_after_a_round_ends(
        mode in prop::sample::select(&Mode::ALL[..]),
        before in 0..9000_u64,
        most in 1..5_usize,
        seed: u64,
    ) {
        let catalog = Arc::new(simulation::catalog(simulation::HALL));
        played(&catalog, Header::new("hall", mode, Difficulty::Normal, seed), most, before, seed);
    }
}

/// The catalog and the checkpoint of a room with up to four members, after ten seconds.
fn busy(mode: Mode, seed: u64) -> (Arc<Catalog>, Vec<u8>) {
    let catalog = Arc::new(simulation::catalog(simulation::HALL));
    let header = Header::new("hall", mode, Difficulty::Normal, seed);
    let (mut party, mut room) =
        (Party::new(&header, 4, seed), Room::new(&catalog, header).unwrap());
    (0..600).for_each(|_| party.step(&mut [&mut room]));
    let bytes = room.checkpoint();
    (catalog, bytes)
}

#[test]
fn truncated_checkpoints_are_refused() {
    for mode in Mode::ALL {
        let (catalog, bytes) = busy(mode, 5);
        for length in 0..bytes.len() {
            assert!(Room::restore(&catalog, &bytes[..length]).is_err(), "{mode:?}: {length}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn damaged_checkpoints_are_refused_or_playable(
        mode in prop::sample::select(&Mode::ALL[..]),
        seed in 0..4_u64,
        // Whether only the first bytes are damaged. Later ones are mostly players' positions.
        is_early: bool,
        flips in prop::collection::vec((any::<prop::sample::Index>(), 0..8_u8), 1..4),
    ) {
        let (catalog, mut bytes) = busy(mode, seed);
        let first = first_line(KIND).len();
        let end = if is_early { bytes.len().min(first + 600) } else { bytes.len() };
        for (index, bit) in flips {
            bytes[first + index.index(end - first)] ^= 1 << bit;
        }
        if let Ok(mut room) = Room::restore(&catalog, &bytes) {
            let mut party = Party::new(&room.header.as_ref().clone(), 4, 1);
            (0..600).for_each(|_| party.step(&mut [&mut room]));
            room.view();
            room.checkpoint();
        }
    }
}

#[test]
fn impossible_members_are_refused() {
    let (catalog, bytes) = busy(Mode::Tag, 7);
    let room = Room::restore(&catalog, &bytes).unwrap();
    let is_restored = |next_member, id| {
        let mut room = room.clone();
        (room.next_member, room.members[0].id) = (next_member, MemberId(id));
        Room::restore(&catalog, &room.checkpoint()).is_ok()
    };
    assert!(is_restored(MemberId::MAX.0 + 1, MemberId::MAX.0));
    assert!(!is_restored(u32::MAX, 1_000_000));
    assert!(!is_restored(1_000_000, 1_000_000));
}

#[test]
fn checkpoints_of_other_versions_or_unknown_levels_are_refused() {
    let (catalog, bytes) = busy(Mode::Tag, 7);
    let refused = |catalog: &Arc<Catalog>, bytes: &[u8]| Room::restore(catalog, bytes).unwrap_err();
    let line = first_line(KIND);
    assert!(bytes.starts_with(line.as_bytes()));
    let newer = line.replace(&format!("rules {RULES_VERSION}"), "rules 999");
    let newer = [newer.as_bytes(), &bytes[line.len()..]].concat();
    let sentence = RestoreError::OtherVersion.to_string();
    assert_eq!(refused(&catalog, &newer), sentence);
    let none = Arc::new(Catalog::default());
    assert_eq!(refused(&none, &bytes), "there is no level called hall");
    let longer = [&bytes[..], b"x"].concat();
    assert_eq!(refused(&catalog, &longer), "the state has bytes after its end");
}

/// A checksum must detect each of these changes, and must ignore the chat.
#[test]
fn a_checksum_covers_the_round_the_members_and_the_game() {
    let (catalog, bytes) = busy(Mode::Tag, 7);
    let room = Room::restore(&catalog, &bytes).unwrap();
    let differs = |change: &dyn Fn(&mut Room)| {
        let mut other = room.clone();
        change(&mut other);
        other.checksum() != room.checksum()
    };
    assert!(!differs(&|_| {}));
    assert!(!differs(&|room| room.announce("the host speaks".to_owned())));
    assert!(differs(&|room| room.members[0].seen += 1));
    assert!(differs(&|room| _ = room.again.insert(MemberId(77))));
    assert!(differs(&|room| room.round = super::super::round::Round::new(Mode::Tag, 1)));
    assert!(differs(&|room| Arc::make_mut(&mut room.game).step_all(&[])));
    assert!(differs(&|room| room.apply(&Entry {
        step: room.step(),
        member: room.members[0].id,
        command: Command::Intents {
            seen: 0,
            intents: Crowd::new(Vec::new(), 1, SplitMix64::new(3)).want(0)
        },
    })));
}

/// With `--nocapture`, prints for each level the size of a checkpoint with up to eight members after a
/// minute, and the time for a step, for a checkpoint and for restoring it.
#[test]
fn level_checkpoints_are_small() {
    let catalog = Arc::new(Catalog::builtin());
    for level in LEVELS {
        let header = Header::new(level.name, Mode::Together, Difficulty::Normal, 1);
        let (mut party, mut room) =
            (Party::new(&header, 8, 1), Room::new(&catalog, header).unwrap());
        let started = Instant::now();
        (0..3600).for_each(|_| party.step(&mut [&mut room]));
        let step = started.elapsed() / 3600;
        let started = Instant::now();
        let bytes = room.checkpoint();
        let save = started.elapsed();
        let started = Instant::now();
        let restored = Room::restore(&catalog, &bytes).unwrap();
        let restore = started.elapsed();
        assert_same(&restored, &room);
        println!("{} {} B, {step:?} {save:?} {restore:?}", level.name, bytes.len());
        assert!(bytes.len() < 100_000, "{}: {} bytes", level.name, bytes.len());
    }
}

/// The intents of the script that wins a level, one per step.
fn winning(level: &str, difficulty: Difficulty) -> Vec<Intents> {
    let root = env!("CARGO_MANIFEST_DIR");
    let path = format!("{root}/../../maps/scripts/{level}.{}.script", difficulty.name());
    let text = fs::read_to_string(path).unwrap();
    let script = Script::parse(&text, level).unwrap_or_else(|faults| panic!("{faults}"));
    script.iter().map(|(_, intents)| intents).collect()
}
