//! The script of a command.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::Error;
use crate::game::Script;

/// The largest size of a script in bytes, more than a week of play. A larger file is not read to
/// its end.
const LONGEST: u64 = 1 << 26;

/// A walk through the built-in level with the most features, for commands without a script.
pub const SHOWCASE: Showcase =
    Showcase { level: "citadel", script: include_str!("../../maps/showcase.script") };

/// A compiled-in script, and its built-in level.
pub struct Showcase {
    /// The built-in level that it is played in.
    pub level: &'static str,
    script: &'static str,
}

impl Showcase {
    /// The parsed script.
    pub fn script(&self) -> Result<Script, Error> {
        Ok(Script::parse(self.script, "showcase.script")?)
    }
}

/// The script in a file.
pub fn load(path: &Path) -> Result<Script, Error> {
    let name = path.display().to_string();
    let mut content = Vec::new();
    let read = File::open(path).and_then(|file| file.take(LONGEST).read_to_end(&mut content));
    match read {
        Err(error) => Err(Error::mistake(format!("{name} can't be read: {error}"))),
        Ok(length) if length as u64 == LONGEST => {
            Err(Error::mistake(format!("{name} is too long for a script")))
        }
        Ok(_) => Ok(Script::from_bytes(content, &name)?),
    }
}
