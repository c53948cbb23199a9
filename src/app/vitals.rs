//! The state of the player in a level with guards and hazards, for the status line.

use std::fmt::{self, Write};

use super::status::{Part, StatusLine};
use crate::color::palette::ColorDepth;
use crate::game::{Alarm, Game, GuardView, Health, PlayerView, Share};
use crate::tui::GlyphSet;
use crate::world::{FieldOfView, Supply};

/// How health is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HealthSigns {
    Hearts,
    Digits,
}

/// Visibility below which the player is in the dark, and below which the light is dim.
const DARK: u8 = 64;
const DIM: u8 = 144;

impl HealthSigns {
    /// The signs that a picture of that kind shows best.
    pub fn for_picture(glyphs: GlyphSet, depth: ColorDepth) -> Self {
        let has_hearts = glyphs.has_blocks() && depth != ColorDepth::Mono;
        if has_hearts { Self::Hearts } else { Self::Digits }
    }
}

impl StatusLine {
    /// Writes health, alarm, light, supplies and treasure.
    pub fn write_vitals(
        &mut self,
        game: &Game,
        player: &PlayerView,
        signs: HealthSigns,
    ) -> fmt::Result {
        self.write_health(player.health(), signs)?;
        self.write_alarm(game, player)?;
        let light = match player.visibility() {
            0..DARK => "dark",
            DARK..DIM => "dim",
            DIM.. => "lit",
        };
        self.both(Part::Light, format_args!("{light}"))?;
        self.write_supplies(player)?;
        let Share { found, total } = game.treasure();
        if total > 0 {
            let needed = game.world().treasure_needed();
            let [short, long] = self.forms(Part::Treasure);
            write!(long, "{found} of {total} gold")?;
            match needed {
                0 => {}
                _ if found >= needed => long.push_str(", enough"),
                _ if needed == total => long.push_str(", all needed"),
                _ => write!(long, ", {needed} needed")?,
            }
            if found < needed && needed < total {
                write!(short, "{found}/{total} need {needed}")?;
            } else {
                write!(short, "{found}/{total} gold")?;
            }
        }
        Ok(())
    }

    /// Writes the alarm, and the kind of the nearest guard who has raised it.
    fn write_alarm(&mut self, game: &Game, player: &PlayerView) -> fmt::Result {
        let alarm = match game.alarm() {
            Alarm::Calm => return Ok(()),
            Alarm::Wary => "wary",
            Alarm::Raised => "ALARM",
        };
        let position = player.camera(FieldOfView::default()).position();
        let distance = |guard: &GuardView| guard.position.distance_squared(position);
        let guards = game.guards().filter(|guard| guard.mood.alarm() == game.alarm());
        let nearest = guards.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let [short, long] = self.forms(Part::Alarm);
        short.push_str(alarm);
        match nearest {
            Some(guard) => write!(long, "{alarm}: {}", guard.kind.name()),
            None => long.write_str(alarm),
        }
    }

    fn write_health(&mut self, health: Health, signs: HealthSigns) -> fmt::Result {
        let Health { points, most } = health;
        match signs {
            HealthSigns::Digits => self.both(Part::Health, format_args!("HP {points}/{most}")),
            HealthSigns::Hearts => (0..most).try_for_each(|index| {
                let heart = if index < points { '♥' } else { '♡' };
                self.both(Part::Health, format_args!("{heart}"))
            }),
        }
    }

    /// Writes what the player carries: the first letters, or the names.
    fn write_supplies(&mut self, player: &PlayerView) -> fmt::Result {
        let carried = Supply::ALL.map(|supply| (supply.name(), player.supplies(supply)));
        let [short, long] = self.forms(Part::Supplies);
        for (index, (name, count)) in carried.iter().filter(|(_, count)| *count > 0).enumerate() {
            let (blank, comma) = if index > 0 { (" ", ", ") } else { ("", "") };
            let letter = &name[..1];
            let name = if *count == 1 { &name[..name.len() - 1] } else { name };
            write!(short, "{blank}{count}{letter}")?;
            write!(long, "{comma}{count} {name}")?;
        }
        Ok(())
    }
}
