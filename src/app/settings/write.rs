//! Printing: from a configuration to a file with the same content, with comments.

use std::fmt;

use super::Configuration;
use super::value::{self, DEPTHS, DISPLAYS, GLYPH_SETS, Names, Setting};
use crate::app::Bindings;
use crate::app::bindings::{Action, PRESETS};

impl fmt::Display for Configuration {
    /// Writes a complete file: each setting with its description, its default and its value. Keys
    /// of the preset are commented out, so that they follow the preset.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_setting(f, &value::PRESET, &quoted(self.preset))?;
        write_setting(f, &value::COLORS, &quoted(name(&DEPTHS, self.colors)))?;
        write_setting(f, &value::GLYPHS, &quoted(name(&GLYPH_SETS, self.glyphs)))?;
        write_setting(f, &value::FOV, &self.field_of_view.degrees().to_string())?;
        write_setting(f, &value::FPS, &self.frames_per_second.to_string())?;
        write_setting(f, &value::MOUSE, &self.mouse.to_string())?;
        write_setting(f, &value::MINIMAP, &quoted(name(&DISPLAYS, self.minimap)))?;
        let fidelity = self.fidelity.map(|fidelity| fidelity.to_string());
        let fidelity = fidelity.as_deref().unwrap_or(value::FIDELITY.default);
        write_setting(f, &value::FIDELITY, &quoted(fidelity))?;
        self.write_keys(f)
    }
}

impl Configuration {
    fn write_keys(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "# The keys of each action, in place of the preset's; those of the preset are comments."
        )?;
        writeln!(f, "# A key is one character or a name, such as \"up\", \"space\", \"f1\".")?;
        writeln!(f, "[keys]")?;
        let usual = PRESETS.iter().find(|&&(name, _)| name == self.preset).map(|&(_, make)| make());
        let usual = usual.unwrap_or_default();
        for (name, does, action) in Action::ALL {
            let keys = list(&self.bindings, action);
            let comment = if keys == list(&usual, action) { "# " } else { "" };
            writeln!(f, "{comment}{name} = {keys}  # {does}")?;
        }
        Ok(())
    }
}

fn write_setting(f: &mut fmt::Formatter<'_>, setting: &Setting, value: &str) -> fmt::Result {
    let Setting { name, meaning, default } = setting;
    meaning.lines().try_for_each(|line| writeln!(f, "# {line}"))?;
    writeln!(f, "# default: {default}")?;
    writeln!(f, "{name} = {value}\n")
}

/// The name of `value` in `names`.
fn name<T: PartialEq + Copy, const N: usize>(names: &Names<T, N>, value: T) -> &'static str {
    names.iter().find(|&&(_, named)| named == value).map_or("", |&(name, _)| name)
}

/// The keys of `action` as a TOML array.
fn list(bindings: &Bindings, action: Action) -> String {
    let keys: Vec<String> = bindings.keys(action).map(|key| quoted(&key.to_string())).collect();
    format!("[{}]", keys.join(", "))
}

/// `text` as a TOML string.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
