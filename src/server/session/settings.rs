//! The settings page.

use super::choice::Choice;
use super::news::Ask;
use super::visit::Visit;
use crate::app::parts::{COLORS, GLYPHS, Menu, after, name, on_or_off};
use crate::world::Difficulty;

/// A setting on the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Preference {
    Difficulty,
    Crosshair,
    Compass,
    Map,
    Chat,
    Glyphs,
    Colors,
}

/// The settings of everybody, and those of a room that one is in.
const USUAL: [(Preference, &str); 5] = [
    (Preference::Difficulty, "Difficulty"),
    (Preference::Crosshair, "Crosshair"),
    (Preference::Compass, "Compass"),
    (Preference::Glyphs, "Characters"),
    (Preference::Colors, "Colours"),
];
const IN_A_ROOM: [(Preference, &str); 2] = [(Preference::Map, "Map"), (Preference::Chat, "Chat")];

impl Visit {
    pub(super) fn settings_menu(&self) -> Menu<Choice> {
        let menu = Menu::new("settings").line("Enter or left and right change a setting.");
        let in_a_room = IN_A_ROOM.into_iter().filter(|_| self.stay.is_some());
        USUAL.into_iter().chain(in_a_room).fold(menu, |menu, (setting, label)| {
            menu.entry_with(label, self.value_of(setting), Choice::Change(setting))
        })
    }

    /// Changes a setting to its next value, or to the one before if `forward` is false.
    pub(super) fn change_preference(&mut self, preference: Preference, forward: bool) {
        let before = self.identity.preferences;
        let preferences = &mut self.identity.preferences;
        match preference {
            Preference::Difficulty => {
                let difficulty = before.difficulty;
                preferences.difficulty = after(&Difficulty::ALL, |&it| it == difficulty, forward);
            }
            Preference::Crosshair => preferences.crosshair ^= true,
            Preference::Compass => preferences.compass ^= true,
            Preference::Glyphs => {
                let glyphs = self.look.glyphs;
                preferences.glyphs = Some(after(&GLYPHS, |it| it.0 == glyphs, forward).0);
            }
            Preference::Colors => {
                let colors = before.colors;
                preferences.colors = after(&COLORS, |it| it.0 == colors, forward).0;
            }
            Preference::Map | Preference::Chat => {
                let Some(stay) = &mut self.stay else { return };
                match preference {
                    Preference::Map => stay.map.is_shown ^= true,
                    _ => stay.talk.toggle(),
                }
            }
        }
        let preferences = self.identity.preferences;
        self.look.follow(&preferences);
        if preferences != before {
            self.ask(Ask::Save(preferences));
        }
        self.renew_menu();
    }

    fn value_of(&self, preference: Preference) -> String {
        let preferences = &self.identity.preferences;
        let stay = self.stay.as_ref();
        match preference {
            Preference::Difficulty => preferences.difficulty.name().to_owned(),
            Preference::Crosshair => on_or_off(preferences.crosshair),
            Preference::Compass => on_or_off(preferences.compass),
            Preference::Map => on_or_off(stay.is_some_and(|stay| stay.map.is_shown)),
            Preference::Chat => on_or_off(stay.is_some_and(|stay| stay.talk.is_on())),
            Preference::Glyphs => name(&GLYPHS, self.look.glyphs),
            Preference::Colors => name(&COLORS, preferences.colors),
        }
    }
}
