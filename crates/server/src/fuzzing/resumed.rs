//! Rooms that are restored from checkpoints.

use std::sync::LazyLock;

use super::{CATALOG, Command, Entry, Header, Line, Mode, NAME_COLUMNS, PlayerColor, Room};
use cellcaster::game::{Intent, Intents};
use cellcaster::map::builtin::LEVELS;
use cellcaster::rng::SplitMix64;
use cellcaster::world::Difficulty;

/// The number of checkpoints to change.
pub const CHECKPOINTS: usize = 24;
/// The most steps of a room before its checkpoint.
const MOST_STEPS: usize = 900;

static MADE: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| (0..CHECKPOINTS).map(made).collect());

/// A checkpoint of a room that was played, by its number below [`CHECKPOINTS`].
pub fn checkpoint(number: usize) -> &'static [u8] {
    &MADE[number]
}

/// Restores a room from `bytes` and plays it on for that many steps, if they are a checkpoint. Returns
/// why they are none.
///
/// # Errors
/// A sentence.
///
/// # Panics
/// If the restored room has another checkpoint than one that is restored from it.
pub fn resume(bytes: &[u8], seed: u64, steps: usize) -> Result<(), String> {
    let mut room = Room::restore(&CATALOG, bytes)?;
    let bytes = room.checkpoint();
    let again = Room::restore(&CATALOG, &bytes).map(|room| room.checkpoint());
    assert_eq!(again.as_ref(), Ok(&bytes), "a checkpoint of a restored room");
    play(&mut room, &mut SplitMix64::new(seed), steps);
    _ = (room.view().winner(), room.checksum());
    Ok(())
}

fn made(number: usize) -> Vec<u8> {
    let mode = Mode::ALL[number % Mode::ALL.len()];
    let level = LEVELS[number % LEVELS.len()].name;
    let seed = number as u64;
    let header = Header::new(level, mode, Difficulty::ALL[number % 3], seed);
    let mut room = Room::new(&CATALOG, header).expect("the level is built in");
    let mut random = SplitMix64::new(seed);
    let steps = random.below(MOST_STEPS);
    play(&mut room, &mut random, steps);
    room.checkpoint()
}

/// Lets members come, want anything and go.
fn play(room: &mut Room, random: &mut SplitMix64, steps: usize) {
    let mut wanted = Intents::new();
    for _ in 0..steps {
        let (step, next) = (room.step(), room.next_member());
        let mut commands = Vec::new();
        if room.len() < 3 && random.one_in(60) || room.len() == 0 {
            let name = Line::of("Ada", NAME_COLUMNS).expect("it fits");
            commands.push((next, Command::Join { color: PlayerColor::ALL[random.below(8)], name }));
        }
        if let Some((member, ..)) = room.first_member() {
            if random.one_in(20) {
                wanted = [Intent::Forward, Intent::Run].into_iter().collect();
                (0..random.below(4)).for_each(|_| {
                    wanted.insert(Intent::ALL[random.below(Intent::ALL.len())]);
                });
            }
            commands
                .push((member, Command::Intents { seen: room.game().steps(), intents: wanted }));
            if random.one_in(100) {
                let token = random.bits();
                let all = [Command::Leave, Command::Keep, Command::Away, Command::Return { token }];
                commands.extend(all.into_iter().nth(random.below(4)).map(|it| (member, it)));
            }
        }
        for (member, command) in commands {
            room.apply(&Entry { step, member, command });
        }
        room.advance();
        if room.is_over() {
            room.begin_next();
        }
    }
}
