//! The texts of the status line.

use std::fmt::{self, Write};

use super::{Part, StatusLine, StatusValues, Toggles};
use crate::app::bindings::{Action, Bindings};
use crate::app::panels::whole_seconds;
use crate::app::stats::Stats;
use crate::game::PlayerId;

impl StatusLine {
    pub(crate) fn write(&mut self, values: &StatusValues) -> fmt::Result {
        let StatusValues { game, level, share_seen, toggles, mouse, stats, bindings, .. } = *values;
        let player = game.grid().and_then(|game| game.seen_by(PlayerId::FIRST));
        let mission = game.grid().filter(|game| game.is_mission()).zip(player);
        if let Some((game, player)) = mission {
            self.write_vitals(game, &player, values.health_signs)?;
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
        self.write_modes(toggles, mouse, mission.is_some_and(|it| it.1.lamp_is_lit()))?;
        self.write_keys(game.keys())?;
        self.write_notice(values)?;
        if let Some(stats) = stats {
            self.write_stats(stats)?;
        }
        if let Some(share) = share_seen {
            self.both(Part::Seen, format_args!("{:.0} % seen", (share * 100.0).floor()))?;
        }
        self.both(Part::Time, format_args!("{}", whole_seconds(game.elapsed())))?;
        self.write_help(bindings)
    }

    /// Writes what a key has done, the message of the game, or the goal.
    fn write_notice(&mut self, values: &StatusValues) -> fmt::Result {
        let StatusValues { game, goal, notice, .. } = *values;
        let notice = notice.filter(|notice| notice.is_shown());
        if let (None, Some(message)) = (notice, game.message()) {
            return self.both(Part::Notice, format_args!("{message}"));
        }
        if let Some(line) = notice.or(Some(goal)).filter(|line| line.is_shown()) {
            let [short, long] = self.forms(Part::Notice);
            short.push_str(line.short());
            long.push_str(line.text());
        }
        Ok(())
    }

    /// Writes the modes that are switched on.
    pub fn write_modes(&mut self, toggles: Toggles, mouse: bool, lamp: bool) -> fmt::Result {
        let modes = [
            (toggles.runs, "running"),
            (toggles.ducks, "ducking"),
            (toggles.keeps_walking, "walking on"),
            (mouse, "mouse"),
            (lamp, "lamp"),
        ];
        for (index, (_, mode)) in modes.into_iter().filter(|(is_on, _)| *is_on).enumerate() {
            let comma = if index > 0 { ", " } else { "" };
            self.both(Part::Modes, format_args!("{comma}{mode}"))?;
        }
        Ok(())
    }

    /// Writes the figures of frames and the link.
    pub fn write_stats(&mut self, stats: &Stats) -> fmt::Result {
        let [short, long] = self.forms(Part::Stats);
        write!(short, "{}", stats.rates)?;
        write!(long, "{stats}")
    }

    /// Writes the names of the keys that the player has.
    pub fn write_keys<'k>(&mut self, keys: impl Iterator<Item = &'k str>) -> fmt::Result {
        for (index, key) in keys.enumerate() {
            let comma = if index > 0 { ", " } else { "" };
            self.both(Part::Keys, format_args!("{comma}{key} key"))?;
        }
        Ok(())
    }

    /// Writes the keys that show the help.
    pub fn write_help(&mut self, bindings: &Bindings) -> fmt::Result {
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
    pub fn forms(&mut self, part: Part) -> &mut [String; 2] {
        &mut self.texts[part as usize]
    }

    /// Appends to both forms of `part`.
    pub fn both(&mut self, part: Part, text: fmt::Arguments) -> fmt::Result {
        self.texts[part as usize].iter_mut().try_for_each(|form| form.write_fmt(text))
    }
}
