//! The text of a configuration file.

use std::fmt;

use super::Config;
use super::settings::SETTINGS;

impl fmt::Display for Config {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# the address and port to listen at")?;
        writeln!(f, "listen = \"{}\"", self.listen)?;
        for setting in &SETTINGS {
            if !setting.meaning.is_empty() {
                writeln!(f, "\n# {}", setting.meaning.replace('\n', "\n# "))?;
            }
            writeln!(f, "{} = {}", setting.name, (setting.get)(self))?;
        }
        Ok(())
    }
}
