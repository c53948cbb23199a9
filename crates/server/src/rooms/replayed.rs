//! Replaying recorded rooms.
//!
//! The time that a recording takes is bounded by its entries: between two of them, and after the last one, at most
//! [`MAX_QUIET`] steps pass. Rejected: a limit on the length of a round. A round of tag begins when a second member
//! comes, and a standing room may wait for days until then.

use std::sync::Arc;

use crate::line::Line;
use crate::rooms::room::{
    Catalog, Command, Entry, Header, MemberId, Mode, Room, SECOND, Seat, is_of_other_version,
    no_level, parse_log,
};
use cellcaster::app::parts::{Cursor, MarkKind, Record};
use cellcaster::game::{Intents, Look, PlayerColor, Script, Stretch};

/// The maximum size of a room's recording, both written and replayed, in bytes.
pub(crate) const MAX_RECORDED_BYTES: u64 = 64 << 20;

/// The result of a recorded round.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RoundReport {
    /// The number of the round, from 1.
    pub(crate) round: u32,
    pub(crate) level: String,
    pub(crate) mode: Mode,
    /// The length of the recorded round, in steps.
    pub(crate) steps: u64,
    /// The names with their points in the round, winner first. If the round did not end: all members, with 0 points.
    pub(crate) standings: Vec<(String, u32)>,
    /// The checksum of the room's last state. It is the same on every machine.
    pub(crate) checksum: u64,
}

/// The maximum number of steps without an entry: a day and an hour. A member leaves after a day without a key, the
/// greatest limit that a host can set, and a room without members takes no steps.
const MAX_QUIET: u64 = 25 * 60 * 60 * SECOND;
/// The maximum length of a round in a fuzz target, where it takes time from other inputs: 20 seconds.
const MAX_FUZZED: u64 = 20 * SECOND;

/// A recorded room: its rounds, which share nothing but the names of their members.
#[derive(Clone, Debug)]
pub(crate) struct RoomRecord {
    catalog: Arc<Catalog>,
    /// The entries are in the order of their steps.
    rounds: Arc<[(Header, Vec<Entry>)]>,
}

impl PartialEq for RoomRecord {
    fn eq(&self, other: &Self) -> bool {
        self.rounds == other.rounds
    }
}

impl RoomRecord {
    /// Reads the log of a room.
    ///
    /// # Errors
    /// A sentence fragment, if the text is not a recording, has another version, or needs a level that is not in
    /// the catalog.
    pub(crate) fn parse(text: &str, catalog: &Arc<Catalog>) -> Result<Self, String> {
        if is_of_other_version(text) {
            return Err("it was recorded by another version of Cellcaster".to_owned());
        }
        let mut rounds =
            parse_log(text).ok_or("a line is neither part of a header nor an entry")?;
        for (header, entries) in &mut rounds {
            if !catalog.has(&header.level) {
                return Err(no_level(&header.level));
            }
            let mut last = 0;
            for entry in entries {
                entry.step = entry.step.max(last);
                last = entry.step;
            }
        }
        Ok(Self { catalog: Arc::clone(catalog), rounds: rounds.into() })
    }

    /// The run of `script` in a room of one member, in a level of the catalog.
    pub(crate) fn of_script(script: &Script, name: Line, catalog: &Arc<Catalog>) -> Option<Self> {
        let level = script.header().level.as_ref()?.as_str();
        let (member, color) = (MemberId(1), PlayerColor::ALL[0]);
        let header = Header {
            next_member: 2,
            members: vec![Seat { id: member, color, points: 0, name, kept: None }],
            ..Header::new(level, Mode::Alone, script.header().rules().difficulty, 0)
        };
        let mut step = 0;
        let mut entries = Vec::new();
        let mut want = |step, intents| {
            let command = Command::Intents { seen: step, intents };
            entries.push(Entry { step, member, command });
        };
        for Stretch { steps, intents } in script.sections().iter().flat_map(|it| &it.stretches) {
            // The angles of an entry apply in one step only.
            let turns = intents.look() != Look::NONE;
            (0..if turns { *steps } else { 1 }).for_each(|it| want(step + u64::from(it), *intents));
            step += u64::from(*steps);
        }
        want(step, Intents::new());
        let is_known = catalog.has(level);
        is_known
            .then(|| Self { catalog: Arc::clone(catalog), rounds: Arc::from([(header, entries)]) })
    }

    /// The headers of all rounds.
    pub(crate) fn headers(&self) -> impl Iterator<Item = &Header> {
        self.rounds.iter().map(|(header, _)| header)
    }

    /// The entries of a round that take effect after `step` steps.
    fn entries(&self, round: usize, step: u64) -> &[Entry] {
        let entries = &self.rounds[round].1;
        let [first, end] =
            [step, step + 1].map(|step| entries.partition_point(|entry| entry.step < step));
        &entries[first..end]
    }

    /// The step of the first entry after `step` steps.
    fn next_entry(&self, round: usize, step: u64) -> Option<u64> {
        let entries = &self.rounds[round].1;
        let next = entries.get(entries.partition_point(|entry| entry.step <= step));
        next.map(|entry| entry.step)
    }

    /// Whether the next step is in the next round. The last round ends with its last entry.
    fn is_round_over(&self, round: usize, room: &Room) -> bool {
        let end = self.rounds[round].1.last().map_or(0, |entry| entry.step);
        let is_last = round + 1 >= self.rounds.len();
        room.step() >= end && (is_last || room.is_over())
    }
}

impl Record for RoomRecord {
    type Game = Room;
    type Stored = Vec<u8>;

    fn steps(&self) -> u64 {
        let last = |entries: &[Entry]| entries.last().map_or(0, |entry| entry.step);
        self.rounds.iter().map(|(_, entries)| last(entries)).fold(0, u64::saturating_add)
    }

    fn begin(&mut self, round: usize) -> Option<Room> {
        let (header, _) = self.rounds.get(round)?;
        let mut room = Room::new(&self.catalog, header.clone())?;
        self.entries(round, 0).iter().for_each(|entry| room.apply(entry));
        Some(room)
    }

    fn goes_on(&self, cursor: Cursor, room: &Room) -> bool {
        cursor.part + 1 < self.rounds.len() || !self.is_round_over(cursor.part, room)
    }

    fn is_over(&self, round: usize, room: &Room) -> bool {
        self.is_round_over(round, room)
    }

    fn advance(&self, cursor: Cursor, room: &mut Room) {
        room.advance();
        self.entries(cursor.part, room.step()).iter().for_each(|entry| room.apply(entry));
    }

    fn store(&self, room: &Room) -> Vec<u8> {
        room.checkpoint()
    }

    fn restore(&mut self, _: usize, stored: &Vec<u8>) -> Option<Room> {
        Room::restore(&self.catalog, stored).ok()
    }

    fn events(&self, room: &Room) -> [u32; MarkKind::ALL.len()] {
        let game = room.game();
        let tallies = || game.players().filter_map(|player| Some(game.seen_by(player)?.tally()));
        let finds = tallies().next().map_or(0, |it| it.treasure.found + it.secrets.found);
        let keys = game.players().filter_map(|player| Some(game.seen_by(player)?.keys().count()));
        let [caught, ends] = room.events();
        [
            finds + keys.sum::<usize>() as u32,
            tallies().map(|it| it.alarms).sum(),
            caught,
            ends,
            tallies().map(|it| it.deaths).sum(),
        ]
    }
}

/// Replays the rounds of a recording. Each round lasts until the next one begins, and the last round until
/// its last entry. `look` receives the room before each step.
///
/// # Errors
/// A sentence fragment, if the text is not a recording, has another version, needs a level that is not in the catalog, or
/// if nothing happens in a round for too long; or the first error of `look`.
pub(crate) fn replayed(
    text: &str,
    catalog: &Arc<Catalog>,
    look: &mut dyn FnMut(&Room) -> Result<(), String>,
) -> Result<Vec<RoundReport>, String> {
    let mut record = RoomRecord::parse(text, catalog)?;
    let mut reports = Vec::new();
    for round in 0..record.rounds.len() {
        let mut room =
            record.begin(round).ok_or_else(|| no_level(&record.rounds[round].0.level))?;
        // The step of the last entry.
        let mut last = 0;
        while !record.is_over(round, &room) {
            let step = room.step();
            let next = record.next_entry(round, step).unwrap_or(step);
            if next - last > MAX_QUIET || cfg!(feature = "fuzzing") && step >= MAX_FUZZED {
                let round = room.header().round;
                return Err(format!("nothing happens in round {round} for longer than a day"));
            }
            look(&room)?;
            record.advance(Cursor { step, part: round }, &mut room);
            if !record.entries(round, room.step()).is_empty() {
                last = room.step();
            }
        }
        reports.push(report(&room, room.header()));
    }
    if reports.is_empty() { Err("it is empty".to_owned()) } else { Ok(reports) }
}

fn report(room: &Room, header: &Header) -> RoundReport {
    let view = room.view();
    let name = |id| view.member(id).map(|member| member.name.to_string());
    let ranked = view.standings.iter();
    let ranked = ranked.filter_map(|standing| Some((name(standing.member)?, standing.points)));
    let all = view.members.iter().map(|member| (member.name.to_string(), 0));
    let standings: Vec<_> = ranked.collect();
    RoundReport {
        round: header.round,
        level: header.level.clone(),
        mode: header.mode,
        steps: room.step(),
        standings: if standings.is_empty() { all.collect() } else { standings },
        checksum: room.checksum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rooms::room::NAME_COLUMNS;
    use cellcaster::app::parts::Player;
    use cellcaster::game::Game;
    use cellcaster::map::builtin;
    use cellcaster::terminal::Key;

    const TOGETHER: &str =
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/together.log"));

    impl RoomRecord {
        /// The text of the log.
        pub(crate) fn log(&self) -> String {
            let round = |(header, entries): &(Header, Vec<Entry>)| {
                let entries = entries.iter().map(|entry| format!("{entry}\n"));
                header.to_string() + &entries.collect::<String>()
            };
            self.rounds.iter().map(round).collect()
        }
    }

    #[test]
    fn a_run_of_a_board_is_the_same_in_a_room() {
        let catalog = Arc::new(Catalog::builtin());
        for level in &builtin::LEVELS[..4] {
            let path = format!("../../maps/scripts/{}.normal.script", level.name);
            let text = std::fs::read_to_string(path).expect("each level has a script");
            let script = Script::parse(&text, "it").expect("the script is valid");
            let mut alone = Game::with_rules(level.world().unwrap(), script.header().rules());
            let mut intents = script.iter();
            while !alone.is_finished() {
                alone.step(intents.next().expect("the script wins").1);
            }
            let name = Line::of("Mara", NAME_COLUMNS).unwrap();
            let record = RoomRecord::of_script(&script, name, &catalog).unwrap();
            let (mut player, mut room) = Player::new(record).unwrap();
            let won = |room: &Room| room.events()[1] > 0;
            while !won(&room) && !player.is_paused() {
                player.advance(1, &mut room, &|| true);
            }
            let view = room.view();
            let tally = view.game.seen_by(view.members[0].player.unwrap()).unwrap().tally();
            assert_eq!(tally, alone.tally(), "{}", level.name);
        }
    }

    #[test]
    fn jumps_lead_to_the_states_that_playing_leads_to() {
        let record = RoomRecord::parse(TOGETHER, &Arc::new(Catalog::builtin())).unwrap();
        let (mut player, mut room) = Player::new(record.clone()).unwrap();
        let mut states = vec![room.checksum()];
        while !player.is_paused() {
            if player.advance(1, &mut room, &|| true) > 0 {
                states.push(room.checksum());
            }
        }
        assert!(states.len() > 600);
        let (mut player, mut room) = Player::new(record).unwrap();
        player.toggle_pause();
        let keys = [Key::End, Key::Left, Key::Char(','), Key::Home, Key::Right, Key::Char('.')];
        for key in keys.iter().chain(&[Key::Right, Key::Left, Key::Left, Key::End]) {
            player.press(*key, false);
            while player.is_busy() {
                player.advance(0, &mut room, &|| true);
            }
            assert_eq!(room.checksum(), states[player.cursor().step as usize], "{key:?}");
        }
    }
}
