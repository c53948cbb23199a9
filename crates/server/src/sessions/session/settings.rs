//! The settings page.
//!
//! The page shows the settings of the game at home, the preset of key bindings, and the chat switch. The
//! choices are saved with the account, except for the map, which belongs to a stay in a room, and chat, which belongs
//! to the session.

use super::messages::SessionRequest;
use super::pages::Choice;
use super::ui::{Ui, bindings_of};
use crate::accounts::AccountSettings;
use cellcaster::app::MapDisplay;
use cellcaster::app::parts::{Choices, FieldAt, Menu, Preset, Setting, settings_menu};
use cellcaster::app::store::Preferences;

/// The values that the page shows and changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SessionChoices {
    pub(crate) common: Choices,
    preset: Preset,
    chat: bool,
}

impl AsMut<Choices> for SessionChoices {
    fn as_mut(&mut self) -> &mut Choices {
        &mut self.common
    }
}

impl AsMut<Preferences> for SessionChoices {
    fn as_mut(&mut self) -> &mut Preferences {
        &mut self.common.preferences
    }
}

const PRESET: Setting<SessionChoices> = Setting {
    key: "preset",
    about: "Keys",
    value: &FieldAt(|it: &mut SessionChoices| &mut it.preset),
};
const CHAT: Setting<SessionChoices> =
    Setting { key: "chat", about: "Chat", value: &FieldAt(|it: &mut SessionChoices| &mut it.chat) };

/// The rows in the order of the page. The last one appears only in a room.
const ROWS: [Setting<SessionChoices>; 14] = [
    Setting::DIFFICULTY,
    PRESET,
    Setting::MOUSE,
    Setting::CROSSHAIR,
    Setting::COMPASS,
    Setting { about: "Ghosts of best runs", ..Setting::GHOST },
    Setting::BELL,
    Setting::GLYPHS,
    Setting::COLORS,
    Setting::CORRECTION,
    Setting::MARKS,
    Setting::RUNS,
    CHAT,
    Setting::MAP,
];
const ROWS_OUTSIDE_OF_ROOMS: usize = 13;

impl Ui {
    pub(crate) fn settings_menu(&self) -> Menu<Choice> {
        let note = (!self.identity.has_account)
            .then_some("You are a guest: settings last for this session.");
        let choices = self.choices();
        let count = if self.stay.is_some() { ROWS.len() } else { ROWS_OUTSIDE_OF_ROOMS };
        let rows = ROWS[..count].iter().enumerate();
        let rows =
            rows.map(|(index, row)| (row.about, row.value.label(&choices), Choice::Change(index)));
        settings_menu(note, !self.is_ascii(), rows)
    }

    /// The current values.
    fn choices(&self) -> SessionChoices {
        let Self { identity, stay, .. } = self;
        let preferences = Preferences { glyphs: Some(self.glyphs()), ..identity.preferences };
        let stay = stay.as_ref();
        let map = stay.map_or(MapDisplay::Off, |stay| stay.map.display());
        SessionChoices {
            common: Choices { preferences, mouse: self.pointer.is_on(), map },
            preset: identity.configuration.preset,
            chat: self.talk.is_on(),
        }
    }

    /// Changes the setting in this row to its next value, or to the previous one if `forward` is false.
    pub(crate) fn change_setting(&mut self, row: usize, forward: bool) {
        self.change_choices(|choices| ROWS[row].value.change(choices, forward));
    }

    /// Changes some of the current values, and saves the account's settings if they are affected.
    pub(crate) fn change_choices(&mut self, change: impl FnOnce(&mut SessionChoices)) {
        let before = self.choices();
        let mut after = before;
        change(&mut after);
        let Self { identity, stay, pointer, bindings, controls, .. } = self;
        identity.preferences.choose(before.common.preferences, after.common.preferences);
        controls.toggles.runs_by_default = identity.preferences.runs;
        if after.preset != before.preset {
            identity.configuration.set_preset(after.preset);
            *bindings = bindings_of(&identity.configuration);
        }
        if after.common.mouse != before.common.mouse {
            identity.configuration.mouse = after.common.mouse;
            pointer.toggle();
        }
        if let Some(stay) = stay {
            stay.map.is_shown = after.common.map != MapDisplay::Off;
        }
        if after.chat != before.chat {
            self.talk.toggle();
        }
        let is_kept = |it: SessionChoices| (it.common.preferences, it.preset, it.common.mouse);
        if is_kept(after) != is_kept(before) {
            self.save_settings();
        }
        self.renew_menu();
    }

    /// Saves the account's settings, including the ignored players.
    pub(crate) fn save_settings(&mut self) {
        self.ask(SessionRequest::Save(AccountSettings {
            preferences: self.identity.preferences,
            configuration: self.identity.configuration.to_string(),
            ignored: self.ignored.names().to_vec(),
        }));
    }
}
