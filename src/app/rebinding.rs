//! The page of keys: the keys of each action, and their change by pressing the new key.
//!
//! - The pressed key replaces the first key of the action. The other keys stay, so the arrows still
//!   walk and Escape still goes back. If the key belonged to another action, that action loses it.
//! - The usual keys are the keys of the configuration file and its preset. The store keeps the
//!   actions whose keys differ from them.
//! - A modifier binds when it is released without another key. Otherwise, Shift would be bound in
//!   place of every key that is typed with it.

use crate::app::App;
use crate::app::controls::{Action, Bindings, Preset};
use crate::app::page::Menu;
use crate::app::screen::{AppScreen, MenuChoice, capitalized};
use crate::app::setting::Choice;
use crate::terminal::Key;

impl App {
    /// The keys of every action.
    pub(crate) fn keys_menu(&self) -> Menu<MenuChoice> {
        let bindings = &self.settings.bindings;
        Menu::new("keys")
            .line("Enter, then the new key. Delete: the usual keys.")
            .keeping_text()
            .entries(Action::ALL.map(|(_, does, action, _)| {
                let keys = Some(bindings.key_names(action)).filter(|keys| !keys.is_empty());
                let choice = MenuChoice::Open(AppScreen::Binding(action));
                (capitalized(does), keys.unwrap_or_else(|| "none".to_owned()), choice)
            }))
            .entry_with("All keys", self.preset_name(), MenuChoice::ChangePreset)
    }

    /// The preset whose keys all actions have.
    fn preset(&self) -> Option<Preset> {
        let has_keys = |preset: &Preset| preset.bindings() == self.settings.bindings;
        Preset::ALL.iter().map(|(preset, ..)| *preset).find(has_keys)
    }

    fn preset_name(&self) -> &'static str {
        self.preset().map_or("own", Choice::name)
    }

    /// Gives all actions the keys of the next preset, or of the one before.
    pub(crate) fn change_preset(&mut self, forward: bool) {
        let preset = self.preset().map_or_else(Preset::default, |it| it.neighbour(forward));
        self.set_bindings(preset.bindings());
        self.say_in_menu(&format!("The keys are now those of {}.", preset.name()));
    }

    /// The question for a new key of `action`.
    pub(crate) fn binding_menu(&self, action: Action) -> Menu<MenuChoice> {
        let mut menu = Menu::new(action.does());
        let keys = self.settings.bindings.key_names(action);
        if !keys.is_empty() {
            menu = menu.line(format!("now: {keys}"));
        }
        menu.line("Press the new key. Escape cancels.")
    }

    /// Binds `key` to `action`, and returns to the page of keys. If the key cannot be bound, says why
    /// and keeps asking.
    pub(crate) fn bind(&mut self, action: Action, key: Key) {
        if let Some(why) = not_bindable(key) {
            return self.say_in_menu(&format!("{key} cannot be bound: {why}."));
        }
        let bindings = &self.settings.bindings;
        let before = bindings.action(key);
        let sentence = match before {
            Some(before) if before == action => {
                format!("{key} already means \"{}\".", action.does())
            }
            Some(before) => {
                let (now, before) = (action.does(), before.does());
                format!("{key} now means \"{now}\" and no longer \"{before}\".")
            }
            None => format!("{key} now means \"{}\".", action.does()),
        };
        if before != Some(action) {
            let replaced = bindings.keys(action).next().filter(|&first| first != Key::Escape);
            let others = bindings.keys(action).filter(|&other| Some(other) != replaced);
            let keys = [key].into_iter().chain(others).collect();
            self.set_bindings(bindings.clone().with_keys(action, keys));
        }
        self.close();
        self.say_in_menu(&sentence);
    }

    /// Gives `action` its usual keys.
    pub(crate) fn restore_keys(&mut self, action: Action) {
        let (bindings, usual) = (&self.settings.bindings, &self.usual_keys);
        let lost = |key: Key| Some((key, bindings.action(key).filter(|&other| other != action)?));
        let lost = usual.keys(action).find_map(lost);
        let sentence = match lost {
            Some((key, other)) => {
                let (now, other) = (action.does(), other.does());
                format!("\"{now}\" has its usual keys again, and \"{other}\" lost {key}.")
            }
            None => format!("\"{}\" has its usual keys.", action.does()),
        };
        let keys = usual.keys(action).collect();
        self.set_bindings(bindings.clone().with_keys(action, keys));
        self.say_in_menu(&sentence);
    }

    fn set_bindings(&mut self, bindings: Bindings) {
        self.store.set_keys(bindings.differences(&self.usual_keys));
        self.settings.bindings = bindings;
    }
}

/// The reason why `key` cannot be bound; `None` if it can.
fn not_bindable(key: Key) -> Option<&'static str> {
    match key {
        Key::Enter => Some("it chooses in menus"),
        Key::Control | Key::Alt => Some("with another key, it is a command to the terminal"),
        // Such a key could not be stored.
        _ if key.to_string().parse() != Ok(key) => Some("it has no name"),
        _ => None,
    }
}
