//! The settings page.
//!
//! It has the settings of the page at home, and the preset of keys. What is chosen is kept with the
//! account, except the map and the chat, which are those of a stay in a room.

use super::choice::Choice;
use super::messages::Request;
use super::visit::{Visit, bindings_of};
use crate::accounts::AccountSettings;
use cellcaster::app::parts::{Menu, Value, with_card};

/// A setting on the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Preference {
    Difficulty,
    Keys,
    Mouse,
    Crosshair,
    Compass,
    Ghost,
    Bell,
    Map,
    Chat,
    Glyphs,
    Colors,
    Correction,
}

/// The settings of everybody, and those of a room that one is in.
const USUAL: [(Preference, &str); 10] = [
    (Preference::Difficulty, "Difficulty"),
    (Preference::Keys, "Keys"),
    (Preference::Mouse, "Mouse turns"),
    (Preference::Crosshair, "Crosshair"),
    (Preference::Compass, "Compass"),
    (Preference::Ghost, "Ghosts of best runs"),
    (Preference::Bell, "Bell when noticed or hurt"),
    (Preference::Glyphs, "Characters"),
    (Preference::Colors, "Colours"),
    (Preference::Correction, "Picture"),
];
const IN_A_ROOM: [(Preference, &str); 2] = [(Preference::Map, "Map"), (Preference::Chat, "Chat")];

impl Visit {
    pub(crate) fn settings_menu(&self) -> Menu<Choice> {
        let menu = Menu::new("settings").line("Enter or left and right change a setting.");
        let menu = if self.identity.has_account {
            menu
        } else {
            menu.line("You are a guest: they hold for this session.")
        };
        let menu = if self.look.is_ascii() { menu } else { with_card(menu) };
        let in_a_room = IN_A_ROOM.into_iter().filter(|_| self.stay.is_some());
        USUAL.into_iter().chain(in_a_room).fold(menu, |menu, (setting, label)| {
            menu.entry_with(label, self.value_of(setting), Choice::Change(setting))
        })
    }

    /// Changes a setting to its next value, or to the one before if `forward` is false.
    pub(crate) fn change_preference(&mut self, preference: Preference, forward: bool) {
        let before = (self.identity.preferences, self.identity.configuration.clone());
        self.change(preference, forward);
        self.look.follow(&self.identity.preferences);
        let (preferences, configuration) =
            (self.identity.preferences, &self.identity.configuration);
        if (preferences, configuration) != (before.0, &before.1) {
            let configuration = configuration.to_string();
            self.ask(Request::Save(AccountSettings { preferences, configuration }));
        }
        self.renew_menu();
    }

    fn change(&mut self, preference: Preference, forward: bool) {
        let Self { identity, look, stay, .. } = self;
        let preferences = &mut identity.preferences;
        match preference {
            Preference::Difficulty => {
                preferences.difficulty = preferences.difficulty.after(forward);
            }
            Preference::Crosshair => preferences.crosshair ^= true,
            Preference::Compass => preferences.compass ^= true,
            Preference::Ghost => preferences.ghost ^= true,
            Preference::Bell => preferences.bell ^= true,
            Preference::Glyphs => preferences.glyphs = Some(look.glyphs.after(forward)),
            Preference::Colors => preferences.colors = preferences.colors.after(forward),
            Preference::Correction => {
                preferences.correction = preferences.correction.after(forward);
            }
            Preference::Keys => self.change_keys(forward),
            Preference::Mouse => self.switch_mouse(),
            Preference::Map => {
                if let Some(stay) = stay {
                    stay.map.is_shown ^= true;
                }
            }
            Preference::Chat => {
                if let Some(stay) = stay {
                    stay.talk.toggle();
                }
            }
        }
    }

    fn change_keys(&mut self, forward: bool) {
        let configuration = &mut self.identity.configuration;
        configuration.change_preset(forward);
        self.bindings = bindings_of(configuration);
    }

    fn switch_mouse(&mut self) {
        let configuration = &mut self.identity.configuration;
        configuration.mouse ^= true;
        if self.pointer.is_on() != configuration.mouse {
            self.pointer.toggle();
        }
    }

    fn value_of(&self, preference: Preference) -> String {
        let preferences = &self.identity.preferences;
        let stay = self.stay.as_ref();
        match preference {
            Preference::Difficulty => preferences.difficulty.label(),
            Preference::Keys => self.identity.configuration.preset.label(),
            Preference::Mouse => self.pointer.is_on().label(),
            Preference::Crosshair => preferences.crosshair.label(),
            Preference::Compass => preferences.compass.label(),
            Preference::Ghost => preferences.ghost.label(),
            Preference::Bell => preferences.bell.label(),
            Preference::Map => stay.is_some_and(|stay| stay.map.is_shown).label(),
            Preference::Chat => stay.is_some_and(|stay| stay.talk.is_on()).label(),
            Preference::Glyphs => self.look.glyphs.label(),
            Preference::Colors => preferences.colors.label(),
            Preference::Correction => preferences.correction.label(),
        }
    }
}
