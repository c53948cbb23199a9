//! What keys do in a room, besides walking.

use super::line_entry::LineEntry;
use super::messages::Request;
use super::page::Page;
use super::settings::Preference;
use super::visit::Visit;
use crate::rooms::room::{CHAT_COLUMNS, Command};
use cellcaster::app::parts::{Action, is_answerable};
use cellcaster::game::Intent;
use cellcaster::terminal::Key;
use cellcaster::tui::Press;

/// The step by which a key widens or narrows the view, in degrees.
const VIEW_STEP: f64 = 6.0;

impl Visit {
    pub(crate) fn press_in_room(&mut self, key: Key, press: Press) {
        let action = self.bindings.action(key);
        match action {
            Some(Action::WidenView) => return self.widen_view(VIEW_STEP),
            Some(Action::NarrowView) => return self.widen_view(-VIEW_STEP),
            _ if press == Press::Repeat => return,
            _ => {}
        }
        let Some(stay) = &mut self.stay else { return };
        let (is_member, watches) = (stay.member.is_some(), stay.is_watching);
        match key {
            Key::Enter if stay.dead_since.is_some() => return self.press_to_go_on(press),
            Key::Enter | Key::Char('/') if is_member => {
                self.entry = LineEntry::new(CHAT_COLUMNS);
                return self.open(Page::Chat);
            }
            Key::Char('1') if is_member => return self.open(Page::Emotes),
            Key::Char(';') => stay.talk.toggle(),
            Key::Tab | Key::Right | Key::Down if watches => stay.watch_another(true),
            Key::Left | Key::Up if watches => stay.watch_another(false),
            Key::Tab => stay.shows_members ^= true,
            _ => return self.act_on(action),
        }
        self.is_stale = true;
    }

    fn act_on(&mut self, action: Option<Action>) {
        let Some(stay) = &mut self.stay else { return };
        let toggles = &mut self.controls.toggles;
        match action {
            Some(Action::ToggleHelp) => self.open(Page::Help),
            Some(Action::Leave | Action::TogglePause) => self.open(Page::RoomMenu),
            Some(Action::ToggleMinimap) => stay.map.is_shown ^= true,
            Some(Action::ChangeMap(change)) => stay.map.change(change),
            Some(Action::ToggleDuck) => toggles.ducks ^= true,
            Some(Action::ToggleRun) => toggles.runs ^= true,
            Some(Action::ToggleWalkOn) => toggles.keeps_walking ^= true,
            Some(Action::ToggleCrosshair) => self.change_preference(Preference::Crosshair, true),
            Some(Action::ToggleCompass) => self.change_preference(Preference::Compass, true),
            Some(Action::ToggleGhost) => self.change_preference(Preference::Ghost, true),
            Some(Action::ToggleMouse) => self.change_preference(Preference::Mouse, true),
            Some(Action::ToggleStats) => self.shows_stats ^= true,
            _ => return,
        }
        self.is_stale = true;
    }

    fn widen_view(&mut self, degrees: f64) {
        self.look.widen(degrees);
        self.is_stale = true;
    }

    /// Goes on after a death by Enter, from the same time on as at home.
    fn press_to_go_on(&mut self, press: Press) {
        let Some(dead_since) = self.stay.as_ref().and_then(|stay| stay.dead_since) else { return };
        if is_answerable(&self.controls.held, dead_since, self.now) {
            self.press_to_answer(Key::Enter, press);
        }
    }

    /// Goes on after a death: from the last checkpoint, or from the beginning.
    pub(crate) fn retry(&mut self) {
        let Some(stay) = self.stay.as_mut().filter(|stay| stay.dead_since.is_some()) else {
            return;
        };
        if stay.dies_for_good {
            return self.ask(Request::Command(Command::Again));
        }
        stay.intents.set([Intent::Retry].into_iter().collect());
        self.want();
    }
}
