//! The texts of the status line.

use std::fmt::{self, Write};

use super::{Part, StatusLine, StatusValues};
use crate::app::bindings::Action;
use crate::app::panels::whole_seconds;
use crate::game::Game;

impl StatusLine {
    pub(super) fn write(&mut self, values: &StatusValues) -> fmt::Result {
        let StatusValues { game, goal, level, share_seen, toggles, mouse, stats, bindings, .. } =
            *values;
        let mission = game.grid().filter(|game| game.is_mission());
        if let Some(game) = mission {
            self.write_vitals(game, values.health_signs)?;
        }
        self.both(Part::Title, format_args!("{}", game.title()))?;
        if level.is_one_of_several() {
            let [short, long] = &mut self.texts[Part::Level as usize];
            level.write_short(short)?;
            write!(long, "{level}")?;
        }
        if let Some(site) = game.site() {
            self.both(Part::Site, format_args!("{}, {}", site.column, site.row))?;
        }
        let modes = [
            (toggles.runs, "running"),
            (toggles.ducks, "ducking"),
            (toggles.keeps_walking, "walking on"),
            (mouse, "mouse"),
            (mission.is_some_and(Game::lamp_is_lit), "lamp"),
        ];
        for (index, (_, mode)) in modes.into_iter().filter(|(is_on, _)| *is_on).enumerate() {
            let comma = if index > 0 { ", " } else { "" };
            self.both(Part::Modes, format_args!("{comma}{mode}"))?;
        }
        for (index, key) in game.keys().enumerate() {
            let comma = if index > 0 { ", " } else { "" };
            self.both(Part::Keys, format_args!("{comma}{key} key"))?;
        }
        if let Some(message) = game.message() {
            self.both(Part::Notice, format_args!("{message}"))?;
        } else if goal.is_shown() {
            let [short, long] = &mut self.texts[Part::Notice as usize];
            short.push_str(goal.short());
            long.push_str(goal.text());
        }
        if let Some(stats) = stats {
            let [short, long] = self.forms(Part::Stats);
            write!(short, "{}", stats.rates)?;
            write!(long, "{stats}")?;
        }
        if let Some(share) = share_seen {
            self.both(Part::Seen, format_args!("{:.0} % seen", (share * 100.0).floor()))?;
        }
        self.both(Part::Time, format_args!("{}", whole_seconds(game.elapsed())))?;
        let [short, long] = &mut self.texts[Part::Help as usize];
        for (index, key) in bindings.keys(Action::ToggleHelp).enumerate() {
            let blank = if index > 0 { " " } else { "" };
            write!(long, "{blank}{key}")?;
        }
        short.push_str(long);
        long.push_str(" help");
        Ok(())
    }

    /// The short and the long form of `part`.
    pub(in crate::app) fn forms(&mut self, part: Part) -> &mut [String; 2] {
        &mut self.texts[part as usize]
    }

    /// Appends to both forms of `part`.
    pub(in crate::app) fn both(&mut self, part: Part, text: fmt::Arguments) -> fmt::Result {
        self.texts[part as usize].iter_mut().try_for_each(|form| form.write_fmt(text))
    }
}
