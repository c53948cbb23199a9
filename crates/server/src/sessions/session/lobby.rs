//! The lobby as a place: a small live picture of a room, the visitors who are here, and the board of a level.
//!
//! - The picture shows the room with the most members, through the eyes of one of them. It is drawn again only if
//!   the room has changed, and at most [`PICTURES_PER_SECOND`] times a second. If the server is short of processor
//!   time, frames come more rarely, and so do these pictures.
//! - Between pictures, the session holds no snapshot of the room, so the room's steps need not copy its game.
//! - The board of today's daily level is loaded once for each stay in the lobby. On a new day it is empty, so it is not
//!   loaded. Rejected: loading it then. All visitors in the lobby would ask the store at the same moment.

use std::sync::Arc;
use std::time::Duration;

use super::messages::{BoardRow, SessionRequest};
use super::pages::{LevelChoice, Page, RoomTarget};
use super::ui::Ui;
use crate::accounts::Day;
use crate::line::Line;
use crate::rooms::room::{Header, MemberView, RoomView};
use crate::rooms::summary::RoomId;
use crate::visitors::Onlookers;
use cellcaster::app::parts::of_steps;
use cellcaster::game::PlayerView;
use cellcaster::world::{Camera, Difficulty, FieldOfView};

/// The maximum number of pictures per second.
const PICTURES_PER_SECOND: u32 = 4;
/// The number of entries of the board that are shown.
const BOARD_ROWS: usize = 3;
/// The number of a session's usual frames in the time of one picture.
const FRAMES_PER_PICTURE: u32 = 6;

/// The state of the lobby besides its menu.
#[derive(Debug, Default)]
pub(crate) struct Lobby {
    pub(crate) onlookers: Arc<Onlookers>,
    /// The board of today's daily level; `None` until it is requested.
    pub(crate) board: Option<LobbyBoard>,
    /// Whether the window has room for a picture.
    pub(crate) has_picture: bool,
    /// The game time at which the last picture changes by itself.
    pub(crate) next_change: Option<f64>,
    /// The room in the last picture; `None` if the picture shows no room.
    shown: Option<RoomPictureState>,
    drawn_at: Duration,
}

/// The board in the lobby.
#[derive(Debug)]
pub(crate) struct LobbyBoard {
    day: Day,
    /// The entries; `None` until they arrive.
    pub(crate) rows: Option<Arc<[BoardRow]>>,
}

/// The part of a room's state that the picture and its caption depend on.
#[derive(Debug)]
struct RoomPictureState {
    header: Arc<Header>,
    revision: u64,
    camera: Option<Camera>,
    names: Vec<Line>,
    animates_at: Option<f64>,
}

impl Lobby {
    /// Returns true if a picture of `room` would differ from the last one.
    fn differs_from(&self, room: Option<&RoomView>, view: FieldOfView) -> bool {
        let room = room.filter(|room| seen_through(room).is_some());
        match (&self.shown, room) {
            _ if !self.has_picture => false,
            (None, None) => false,
            (Some(shown), Some(room)) => {
                shown.revision != room.game.revision()
                    || shown.camera != camera(room, view)
                    || !shown.names.iter().eq(room.members.iter().map(|member| &member.name))
                    || shown.animates_at.is_some_and(|time| time <= room.game.elapsed())
                    || !Arc::ptr_eq(&shown.header, &room.header)
            }
            _ => true,
        }
    }

    /// Returns true if the picture shows a room, which may change.
    pub(crate) fn is_live(&self) -> bool {
        self.has_picture && self.shown.is_some()
    }

    /// The time from which the picture is out of date, if a picture of `room` would differ from it.
    pub(crate) fn stale_from(
        &self,
        room: Option<&RoomView>,
        view: FieldOfView,
        frame_time: Duration,
    ) -> Option<Duration> {
        let differs = self.differs_from(room, view);
        differs.then(|| self.drawn_at + picture_time(frame_time))
    }

    /// Records that the lobby was drawn at `now`, with `room` as the snapshot.
    pub(crate) fn drawn(&mut self, room: Option<&RoomView>, view: FieldOfView, now: Duration) {
        let room = room.filter(|room| seen_through(room).is_some());
        self.shown = room.map(|room| RoomPictureState {
            header: Arc::clone(&room.header),
            revision: room.game.revision(),
            camera: camera(room, view),
            names: room.members.iter().map(|member| member.name.clone()).collect(),
            animates_at: self.next_change,
        });
        self.drawn_at = now;
    }

    /// Begins another stay, for which the board is loaded again.
    pub(crate) fn begin(&mut self) {
        self.board = None;
        self.shown = None;
    }

    /// Takes the entries of a board, if it is the lobby's.
    pub(crate) fn receive(&mut self, level: &str, rows: &Arc<[BoardRow]>) {
        let board = self.board.as_mut();
        if let Some(board) = board.filter(|board| Day::of_level(level) == Some(board.day)) {
            board.rows = Some(Arc::clone(rows));
        }
    }
}

/// The interval between two pictures, if frames are `frame_time` apart.
pub(crate) fn picture_time(frame_time: Duration) -> Duration {
    (frame_time * FRAMES_PER_PICTURE).max(Duration::from_secs(1) / PICTURES_PER_SECOND)
}

/// The member through whose eyes the picture shows `room`: the first member who still plays and sees.
pub(crate) fn seen_through(room: &RoomView) -> Option<(&MemberView, PlayerView<'_>)> {
    let seeing = || room.members.iter().filter(|member| !member.is_blind);
    let seen = |member| -> Option<(&MemberView, PlayerView<'_>)> {
        let member: &MemberView = member;
        Some((member, room.game.seen_by(member.player?)?))
    };
    let playing = seeing().filter(|member| member.finish.is_none()).find_map(seen);
    playing.or_else(|| seeing().find_map(seen))
}

fn camera(room: &RoomView, view: FieldOfView) -> Option<Camera> {
    seen_through(room).map(|(_, player)| player.camera(view))
}

impl Ui {
    /// The rooms that the lobby may show, the liveliest first; none where no picture is shown.
    pub(crate) fn lively_rooms(&self) -> Vec<RoomId> {
        if self.stay.is_some() || self.page() == Page::Name {
            return Vec::new();
        }
        let rooms = self.rooms_by_life();
        let mut rooms: Vec<_> = rooms.into_iter().filter(|room| !room.members.is_empty()).collect();
        rooms.sort_by_key(|room| std::cmp::Reverse(room.members.len()));
        rooms.into_iter().map(|room| room.id).collect()
    }

    /// Requests the board of today's daily level, or shows an empty one if the day has just begun.
    pub(crate) fn ask_for_lobby_board(&mut self) {
        let day = self.host.today;
        match &mut self.lobby.board {
            Some(board) if board.day == day => {}
            Some(board) => *board = LobbyBoard { day, rows: Some(Arc::from([])) },
            None => {
                self.lobby.board = Some(LobbyBoard { day, rows: None });
                self.ask(SessionRequest::Board {
                    level: day.level(),
                    difficulty: Difficulty::Normal,
                });
            }
        }
    }

    /// The first entries of the board of today's daily level, each with its place; a remark if there are none.
    pub(crate) fn best_of_today(&self) -> Vec<(String, String)> {
        let remark = |text: &str| vec![(text.to_owned(), String::new())];
        match self.lobby.board.as_ref().and_then(|board| board.rows.as_ref()) {
            None => remark("…"),
            Some(rows) if rows.is_empty() => remark("no results yet"),
            Some(rows) => (1..)
                .zip(rows.iter().take(BOARD_ROWS))
                .map(|(place, row)| (format!("{place}. {}", row.name), of_steps(row.steps)))
                .collect(),
        }
    }

    /// The name of a room's level in the catalog.
    pub(crate) fn level_name(&self, target: RoomTarget) -> Option<String> {
        match target {
            RoomTarget::Existing(id) => self.room(id).map(|room| room.level.clone()),
            RoomTarget::New { level, .. } => self.chosen_level(level),
        }
    }

    /// The name of a chosen level in the catalog.
    pub(crate) fn chosen_level(&self, choice: LevelChoice) -> Option<String> {
        match choice {
            LevelChoice::Listed(index) => self.host.catalog.names.get(index).cloned(),
            LevelChoice::Daily => Some(self.host.today.level()),
        }
    }
}
