//! Records of rooms on a visitor's screen: recorded rooms, and the runs of boards.
//!
//! A record is watched like a room, except that its snapshots come from the visitor's own [`Player`]. Its talk is not
//! shown. Until it is read, a session reads it for [`TIME`] in every [`INTERVAL`], so that a few of them leave the
//! processor to the players.

use std::time::{Duration, Instant};

use super::messages::SessionRequest;
use super::pages::Page;
use super::stay::Stay;
use super::ui::Ui;
use crate::rooms::replayed::RoomRecord;
use crate::rooms::room::{Room, RoomView};
use cellcaster::app::MapDisplay;
use cellcaster::app::parts::{Action, Perspective, Player, PlayerKey};
use cellcaster::terminal::{Key, MouseButton, MouseEvent, MouseEventKind};
use cellcaster::tui::Press;

/// The time for which a record is read at once, and the interval at which it is shown and read.
const TIME: Duration = Duration::from_millis(4);
const INTERVAL: Duration = Duration::from_millis(33);

/// The lines of the help page about the keys.
pub(crate) const KEYS: [&str; 2] = [
    "v: a player's eyes, from above, free; Tab: the next player; q leaves",
    "marks: * find, ! alarm, + catch, x death, | a finish or an end",
];

/// A record that is shown.
pub(crate) struct RoomPlayback {
    pub(crate) player: Player<RoomRecord>,
    room: Room,
    /// The page to return to; `None` if the session ends with the record.
    from: Option<Page>,
    /// The time for which the record is read at once, and the interval at which that happens.
    pace: (Duration, Duration),
}

impl RoomPlayback {
    pub(crate) fn view(&self) -> RoomView {
        self.room.view()
    }

    /// The next time at which something may change.
    fn next_at(&self, now: Duration, flies: bool) -> Option<Duration> {
        let changes = self.player.is_busy() || !self.player.is_paused() || flies;
        changes.then(|| now + self.pace.1)
    }
}

impl Ui {
    /// Shows a record from its start, and returns to the page `from`. At home, there is no other page.
    pub(crate) fn begin_playback(&mut self, record: RoomRecord, from: Option<Page>) {
        let Some((player, room)) = Player::new(record) else {
            return self.hear("The record cannot be shown.".to_owned());
        };
        let pace = if from.is_some() { (TIME, INTERVAL) } else { (5 * TIME, INTERVAL / 2) };
        self.playback = Some(Box::new(RoomPlayback { player, room, from, pace }));
        self.stay = Some(Stay::new(None, None, MapDisplay::All));
        self.note = None;
        self.clock.skip_to(self.now);
        self.show(Page::Room);
    }

    /// Ends the playback, if there is one.
    pub(crate) fn end_playback(&mut self) {
        let Some(playback) = self.playback.take() else { return };
        self.stay = None;
        match playback.from {
            None => self.farewell = Some(String::new()),
            Some(page) => {
                self.lobby.begin();
                self.ask(SessionRequest::EndRecord);
                self.show(Page::Lobby);
                self.open(page);
            }
        }
    }

    /// Moves the record and the camera that flies on by the time of `steps` steps.
    pub(crate) fn advance_playback(&mut self, steps: u64) {
        if self.page() != Page::Room {
            return;
        }
        let Some(playback) = &mut self.playback else { return };
        let (begun, time) = (Instant::now(), playback.pace.0);
        playback.player.advance(steps, &mut playback.room, &|| begun.elapsed() > time);
    }

    /// Moves the camera that flies by a step.
    pub(crate) fn fly(&mut self) {
        if self.flies() {
            let intents = self.controls.intents(&self.bindings, self.key_context());
            if let Some(RoomPlayback { player, room, .. }) = self.playback.as_deref_mut() {
                player.fly(room.game().world(), intents);
            }
        }
    }

    /// Whether the keys that walk move a camera.
    pub(crate) fn flies(&self) -> bool {
        let is_free = |it: &RoomPlayback| matches!(it.player.perspective(), Perspective::Free(_));
        self.page() == Page::Room && self.playback.as_deref().is_some_and(is_free)
    }

    /// The next time at which the record may change on the screen.
    pub(crate) fn playback_wakes_at(&self) -> Option<Duration> {
        let playback = self.playback.as_ref().filter(|_| self.page() == Page::Room)?;
        playback.next_at(self.now, self.flies() && self.controls.held.has_taps())
    }

    /// Handles a key during a playback. Returns `false` for a key whose effect is the same as in a room.
    pub(crate) fn press_in_playback(&mut self, key: Key, press: Press) -> bool {
        let (action, flies) = (self.bindings.action(key), self.flies());
        let Some(playback) = self.playback.as_deref_mut() else { return false };
        let moves = |action| matches!(action, Action::Want(_));
        if flies && action.is_some_and(moves) {
            return true;
        }
        self.is_stale = true;
        let is_repeat = press == Press::Repeat;
        match playback.player.press(key, is_repeat) {
            PlayerKey::Done => return true,
            PlayerKey::ToMark(kind) => {
                let name = kind.name().0;
                self.talk.hear_host(name.to_owned(), self.now);
                return true;
            }
            PlayerKey::Other => {}
        }
        match (key, action) {
            (Key::Tab | Key::Backspace, _) => {
                self.stay.iter_mut().for_each(|stay| stay.watch_another(key == Key::Tab));
            }
            (Key::Char('v'), _) if !is_repeat => {
                let view = playback.view();
                if let Some(stay) = &self.stay {
                    playback.player.change_perspective(stay.camera(&view, self.field_of_view));
                }
                self.release_keys();
            }
            (_, Some(Action::TogglePause)) if !is_repeat => playback.player.toggle_pause(),
            (Key::Escape, _) | (_, Some(Action::Leave)) => self.end_playback(),
            (_, Some(action)) if acts_as_in_a_room(action) => return false,
            _ => {}
        }
        true
    }

    /// Handles a mouse event: a press on the time line goes to its place.
    pub(crate) fn mouse_in_playback(&mut self, event: MouseEvent) {
        let Some(playback) = self.playback.as_deref_mut() else { return };
        if event.kind == MouseEventKind::Pressed(MouseButton::Left) {
            let [x, y] = [event.x, event.y].map(|at| (at / MouseEvent::UNITS_PER_CELL) as u16);
            self.is_stale |= playback.player.press_at(x, y);
        }
    }
}

/// Whether an action does the same in a playback as in a room.
fn acts_as_in_a_room(action: Action) -> bool {
    use Action::{ChangeMap, NarrowView, ToggleHelp, ToggleMinimap, ToggleStats, WidenView};
    matches!(
        action,
        ToggleHelp | ToggleMinimap | ChangeMap(_) | WidenView | NarrowView | ToggleStats
    )
}
