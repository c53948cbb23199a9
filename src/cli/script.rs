//! Which script a command is about.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::Error;
use crate::game::Script;

/// In bytes: more than a week of play takes. What is longer is not read to its end.
const LONGEST: u64 = 1 << 26;

/// A walk through the level in which there is most to see, for who brings no script.
pub(super) const SHOWCASE: Showcase =
    Showcase { level: "citadel", script: include_str!("../../maps/showcase.script") };

/// A script that is compiled in, and the built-in level that it is made for.
pub(super) struct Showcase {
    pub(super) level: &'static str,
    script: &'static str,
}

impl Showcase {
    /// What the script says.
    pub(super) fn script(&self) -> Result<Script, Error> {
        Ok(Script::parse(self.script, "showcase.script")?)
    }
}

/// The script in a file.
pub(super) fn load(path: &Path) -> Result<Script, Error> {
    let name = path.display().to_string();
    let mut text = String::new();
    let read = File::open(path).and_then(|file| file.take(LONGEST).read_to_string(&mut text));
    match read {
        Err(error) => Err(Error::mistake(format!("{name} can't be read: {error}"))),
        Ok(length) if length as u64 == LONGEST => {
            Err(Error::mistake(format!("{name} is too long for a script")))
        }
        Ok(_) => Ok(Script::parse(&text, &name)?),
    }
}
