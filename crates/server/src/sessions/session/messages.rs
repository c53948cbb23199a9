//! Messages between a session and its driver, and the facts that a session begins with.

use std::sync::Arc;
use std::time::Duration;

use crate::accounts::AccountSettings;
use crate::line::Line;
use crate::rooms::ghost::Ghost;
use crate::rooms::room::{Catalog, Command, MemberId};
use crate::rooms::summary::{RoomId, RoomSummary, RoomWish};
use cellcaster::app::Configuration;
use cellcaster::app::store::Preferences;
use cellcaster::game::Rank;
use cellcaster::world::Difficulty;

/// The visitor's identity and choices.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Identity {
    /// Whether they have an account, so that their results rank. Otherwise they are a guest.
    pub(crate) has_account: bool,
    /// The name of the account, or else a name that nobody has, to be offered.
    pub(crate) name: Line,
    /// Whether the account has that name already.
    pub(crate) is_named: bool,
    pub(crate) preferences: Preferences,
    /// The keys that they use, and how the game begins.
    pub(crate) configuration: Configuration,
}

/// The host and the connection, as a session knows them.
#[derive(Clone, Debug)]
pub(crate) struct HostFacts {
    /// The name of the host.
    pub(crate) name: Line,
    /// The message of the day.
    pub(crate) message: Option<Line>,
    /// A notice about the visitor's key.
    pub(crate) notice: Option<Line>,
    /// Whether the connection compresses what is sent.
    pub(crate) compresses: bool,
    /// The setting of the visitor's locale that restricts them to ASCII, such as `LANG=C`.
    pub(crate) ascii_locale: Option<Line>,
    pub(crate) catalog: Arc<Catalog>,
    /// The least time between two frames, at first.
    pub(crate) frame_time: Duration,
}

/// A way into a room.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Way {
    /// To watch it.
    Watch(RoomId),
    /// As a member.
    Enter(RoomId),
    /// As a member of a new room.
    Open(RoomWish),
}

/// A request of a session to its driver.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Request {
    /// To have this name: [`SessionEvent::Named`].
    Name(String),
    /// The rooms, now and whenever they change, until the session is in a room: [`SessionEvent::Rooms`].
    Rooms,
    /// To be in a room: [`SessionEvent::Entered`] or [`SessionEvent::Refused`].
    Go(Way),
    /// To do something in the room: neither [`Command::Join`] nor [`Command::Leave`].
    Command(Command),
    /// To be in the room no more. Nothing is answered.
    Leave,
    /// A board: [`SessionEvent::Board`].
    Board { level: String, difficulty: Difficulty },
    /// The runs that walk along in a level: [`SessionEvent::Ghosts`].
    Ghosts { level: String, difficulty: Difficulty },
    /// To keep the settings. Nothing is answered.
    Save(AccountSettings),
}

/// An event that the driver reports to a session.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SessionEvent {
    /// The visitor has this name, or a sentence why they cannot have it.
    Named(Result<Line, String>),
    /// The rooms.
    Rooms(Arc<[RoomSummary]>),
    /// The visitor is in a room; `None` if they watch.
    Entered { room: RoomId, member: Option<MemberId> },
    /// A sentence why they cannot be in the room.
    Refused(String),
    /// The visitor is in the room no more, and why: a sentence.
    Left(String),
    /// A board, the best first.
    Board { level: String, difficulty: Difficulty, rows: Arc<[BoardRow]> },
    /// The runs that walk along in a level.
    Ghosts { level: String, difficulty: Difficulty, ghosts: Arc<[Ghost]> },
    /// The outcome of a result: a sentence.
    Result(String),
    /// A line from the host to all.
    Said(Line),
    /// The server ends at `ends_at`; whether the visitor finds the room as it was on another one.
    Draining { ends_at: Duration, can_return: bool },
    /// The session ends, and why: a sentence.
    Ended(String),
}

/// An entry of a board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct BoardRow {
    pub(crate) name: Line,
    /// The time of the fastest run, in steps.
    pub(crate) steps: u64,
    /// The highest rank.
    pub(crate) rank: Rank,
    /// Whether it is the visitor's own.
    pub(crate) is_own: bool,
}
