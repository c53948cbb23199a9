//! The messages between a session and its driver, and the facts that a session starts with.

use std::sync::Arc;
use std::time::{Duration, SystemTime};

use super::endings::IdleLimits;
use crate::accounts::{AccountSettings, Day, Name};
use crate::line::Line;
use crate::rooms::ghost::Ghost;
use crate::rooms::invitation::RoomCode;
use crate::rooms::replayed::RoomRecord;
use crate::rooms::room::{Catalog, Command, MemberId, Mode};
use crate::rooms::summary::{RoomId, RoomRequest, RoomSummary};
use crate::visitors::Onlookers;
use cellcaster::app::Configuration;
use cellcaster::app::store::Preferences;
use cellcaster::game::Rank;
use cellcaster::world::Difficulty;

/// The visitor's identity and settings.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Profile {
    /// Whether they have an account, which makes their results rank. Otherwise they are a guest.
    pub(crate) has_account: bool,
    /// The name of the account, or else a free name to offer.
    pub(crate) name: Line,
    /// Whether the account already has this name.
    pub(crate) is_named: bool,
    pub(crate) preferences: Preferences,
    /// The players whose talk is not shown.
    pub(crate) ignored: Vec<Name>,
    /// The visitor's configuration, including key bindings and start-up settings.
    pub(crate) configuration: Configuration,
}

/// The facts about the host and the connection.
#[derive(Clone, Debug)]
pub(crate) struct SessionContext {
    /// The host's name.
    pub(crate) name: Line,
    /// The message of the day.
    pub(crate) message: Option<Line>,
    /// A notice about the visitor's key.
    pub(crate) notice: Option<Line>,
    /// Whether the connection compresses output.
    pub(crate) compresses: bool,
    /// The locale setting that restricts the visitor to ASCII, such as `LANG=C`.
    pub(crate) ascii_locale: Option<Line>,
    pub(crate) catalog: Arc<Catalog>,
    /// The day whose daily level the lobby offers.
    pub(crate) today: Day,
    /// The initial interval between frames.
    pub(crate) frame_time: Duration,
    pub(crate) idle: IdleLimits,
    /// Whether the host records rooms.
    pub(crate) has_recordings: bool,
}

/// A way into a room.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RoomEntry {
    /// Watch an existing room.
    Watch(RoomId),
    /// Become a member of an existing room.
    Enter(RoomId),
    /// Open a new room and become its member. Others enter a private room with its code only.
    Open { request: RoomRequest, is_private: bool },
}

/// A request from a session to its driver.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SessionRequest {
    /// Take this name. Answered by [`SessionEvent::Named`].
    Name(String),
    /// Send the rooms and the visitors, now and on every change, until the session enters a room. Answered by
    /// [`SessionEvent::Onlookers`] and [`SessionEvent::Rooms`].
    Rooms,
    /// Enter a room. Answered by [`SessionEvent::Entered`] or [`SessionEvent::Refused`].
    Go(RoomEntry),
    /// Enter the private room with this code. Answered like [`SessionRequest::Go`].
    Code(Line),
    /// Submit a command to the room, other than [`Command::Join`] or [`Command::Leave`].
    Command(Command),
    /// Say a line in the lobby.
    Say(Line),
    /// Write to another visitor. Answered by [`SessionEvent::Told`] or [`SessionEvent::Advice`].
    Tell { to: Line, text: Line },
    /// List the other visitors in the room or in the lobby. Answered by [`SessionEvent::Players`].
    Players,
    /// Report a player, with the last lines of theirs that were shown. Answered by [`SessionEvent::Advice`].
    Report { player: Line, reason: Option<Line>, lines: Vec<String> },
    /// Carry out an act of a moderator. Answered by [`SessionEvent::Advice`].
    Moderate { player: Line, act: Moderation, reason: Option<Line> },
    /// List the recordings of public rooms. Answered by [`SessionEvent::Recordings`].
    Recordings,
    /// Load a record. Answered by [`SessionEvent::Record`].
    Record(RecordWish),
    /// The record is no longer watched. Not answered.
    EndRecord,
    /// Leave the room. Not answered.
    Leave,
    /// Load a board. Answered by [`SessionEvent::Board`].
    Board { level: String, difficulty: Difficulty },
    /// Load the ghosts of a level. Answered by [`SessionEvent::Ghosts`].
    Ghosts { level: String, difficulty: Difficulty },
    /// Save the settings. Not answered.
    Save(AccountSettings),
}

/// A record to watch.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RecordWish {
    /// The recording in this file.
    Room(String),
    /// The run of this player on a board.
    Run { level: String, difficulty: Difficulty, name: Line },
}

/// An act of a moderator against a player.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Moderation {
    /// Nobody reads what they say for this time.
    Mute(Duration),
    /// They may talk again.
    Unmute,
    /// Their sessions end.
    Kick,
}

/// A finished recording of a public room, in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RecordingRow {
    /// The name of the file without its ending.
    pub(crate) name: String,
    /// The mode and the level of the first round.
    pub(crate) mode: Mode,
    pub(crate) level: String,
    /// When the recording ended.
    pub(crate) ended: SystemTime,
}

/// An event from the driver to a session.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SessionEvent {
    /// The visitor's new name, or a sentence that says why they cannot have it.
    Named(Result<Line, String>),
    /// The visitors who play in no room, for the lobby.
    Onlookers(Arc<Onlookers>),
    /// The rooms for the lobby, and the day.
    Rooms { rooms: Arc<[RoomSummary]>, today: Day },
    /// The visitor has entered a room; `member` is `None` if they watch. A private room has a `code`.
    Entered { room: RoomId, member: Option<MemberId>, code: Option<RoomCode> },
    /// The visitor cannot enter the room, for the reason in the sentence.
    Refused(String),
    /// The visitor has left the room, for the reason in the sentence.
    Left(String),
    /// A board, best entry first.
    Board { level: String, difficulty: Difficulty, rows: Arc<[BoardRow]> },
    /// The ghosts of a level.
    Ghosts { level: String, difficulty: Difficulty, ghosts: Arc<[Ghost]> },
    /// The recordings of public rooms, newest first.
    Recordings(Arc<[RecordingRow]>),
    /// A record, or a sentence that says why it cannot be watched.
    Record(Result<RoomRecord, String>),
    /// A sentence about a result, or another message from the host.
    Result(String),
    /// A line from the operator.
    Said(Line),
    /// A line from another visitor, to this visitor alone or to everybody in the lobby.
    Heard { from: Line, text: Line, is_private: bool },
    /// The visitor's line has reached the visitor `to`.
    Told { to: Line, text: Line },
    /// A sentence about talk or moderation.
    Advice(String),
    /// The other visitors in the room or in the lobby, and whether this visitor is a moderator.
    Players { names: Arc<[Line]>, moderates: bool },
    /// The server shuts down at `ends_at`. `can_return` states whether the visitor can return to the room
    /// through another host.
    Draining { ends_at: Duration, can_return: bool },
    /// The session ends, for the reason in the sentence.
    Ended(String),
}

/// An entry on a board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct BoardRow {
    pub(crate) name: Line,
    /// The time of the fastest run, in steps.
    pub(crate) steps: u64,
    /// The highest rank.
    pub(crate) rank: Rank,
    /// Whether the entry is the visitor's own.
    pub(crate) is_own: bool,
}
