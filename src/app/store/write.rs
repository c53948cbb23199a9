//! Writing: from a [`Progress`] to the text of `progress.toml`.

use std::fmt::{self, Write};

use super::progress::{Preferences, Progress, Save, SavedEntry};
use super::results::{Best, Reached};
use super::values::{COLORS, CORRECTIONS, GLYPHS, SAVES, VERSION, name_of};
use crate::game::{Rules, Share};
use crate::tui::Correction;

impl fmt::Display for Progress {
    /// Writes the whole file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# The progress of a player of Cellcaster. The game replaces this file.")?;
        writeln!(f, "version = {VERSION}")?;
        write_preferences(f, self.preferences)?;
        for (number, saved) in (1..).zip(&self.saves) {
            write_saved(f, number, saved)?;
        }
        if let Some(reached) = self.descent {
            writeln!(f, "\n[descent]")?;
            write_reached(f, reached)?;
        }
        for ((level, difficulty), best) in &self.bests {
            writeln!(f, "\n[best.{}.{}]", quoted(level), difficulty.name())?;
            write_best(f, best)?;
        }
        for (date, daily) in &self.dailies {
            writeln!(f, "\n[daily.{date}]")?;
            write_reached(f, daily.reached)?;
        }
        Ok(())
    }
}

fn write_preferences(f: &mut fmt::Formatter<'_>, preferences: Preferences) -> fmt::Result {
    let Preferences { crosshair, compass, bell, ghost, difficulty, .. } = preferences;
    writeln!(f, "\n[preferences]")?;
    writeln!(f, "crosshair = {crosshair}\ncompass = {compass}\nbell = {bell}\nghost = {ghost}")?;
    writeln!(f, "difficulty = {}", quoted(difficulty.name()))?;
    if let Some(glyphs) = preferences.glyphs {
        writeln!(f, "glyphs = {}", quoted(name_of(&GLYPHS, glyphs)))?;
    }
    if let Some(colors) = preferences.colors {
        writeln!(f, "colors = {}", quoted(name_of(&COLORS, colors)))?;
    }
    if preferences.correction != Correction::None {
        let correction = name_of(&CORRECTIONS, preferences.correction);
        writeln!(f, "correction = {}", quoted(correction))?;
    }
    match preferences.frames_per_second {
        Some(frames) => writeln!(f, "fps = {frames}"),
        None => Ok(()),
    }
}

fn write_saved(f: &mut fmt::Formatter<'_>, number: u64, saved: &SavedEntry) -> fmt::Result {
    let SavedEntry { save, script } = saved;
    let Save { level, file, rules: Rules { difficulty, seed }, descent, steps, checksum } = save;
    writeln!(f, "\n[{SAVES}.{number}]\nlevel = {}", quoted(level))?;
    if let Some(file) = file {
        writeln!(f, "file = {}", quoted(file))?;
    }
    writeln!(f, "difficulty = {}", quoted(difficulty.name()))?;
    writeln!(f, "seed = \"{seed}\"")?;
    if let Some(descent) = descent {
        writeln!(f, "descent = {}", quoted(descent.name()))?;
    }
    if let Some(steps) = steps {
        writeln!(f, "steps = {steps}")?;
    }
    if let Some(checksum) = checksum {
        writeln!(f, "checksum = \"{checksum:016x}\"")?;
    }
    // The last line is one without which there is no saved game, so that a file that was cut short has
    // none without a checksum.
    writeln!(f, "script = {}", quoted(script))
}

fn write_best(f: &mut fmt::Formatter<'_>, best: &Best) -> fmt::Result {
    let Best { tally, rank } = best;
    writeln!(f, "steps = {}", tally.steps)?;
    write_share(f, "treasure", tally.treasure)?;
    write_share(f, "secrets", tally.secrets)?;
    writeln!(f, "alarms = {}\ndeaths = {}", tally.alarms, tally.deaths)?;
    writeln!(f, "stunned = {}\nrank = {}", tally.stunned, quoted(rank.name()))
}

fn write_share(f: &mut fmt::Formatter<'_>, name: &str, share: Share) -> fmt::Result {
    writeln!(f, "{name} = [{}, {}]", share.found, share.total)
}

fn write_reached(f: &mut fmt::Formatter<'_>, reached: Reached) -> fmt::Result {
    let Reached { floors, treasure, steps } = reached;
    writeln!(f, "floors = {floors}\ntreasure = {treasure}\nsteps = {steps}")
}

/// `text` as a TOML string.
fn quoted(text: &str) -> String {
    let mut string = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => string.extend(['\\', character]),
            character if character.is_control() => {
                _ = write!(string, "\\u{:04x}", u32::from(character));
            }
            character => string.push(character),
        }
    }
    string.push('"');
    string
}
