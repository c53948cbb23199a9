//! The text of a configuration file.

use std::fmt;

use super::Config;
use super::settings::SETTINGS;
use crate::ops::logging::LogFilter;

impl fmt::Display for Config {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# the address and port to listen at")?;
        writeln!(f, "listen = \"{}\"", self.listen)?;
        writeln!(f, "\n# the name of the host, which the lobby shows")?;
        writeln!(f, "name = {}", string(&self.name))?;
        writeln!(f, "\n# the message of the day, which the lobby shows")?;
        writeln!(f, "message = {}", string(&self.message))?;
        writeln!(f, "\n# what is logged: {}", LogFilter::GRAMMAR)?;
        writeln!(f, "log = \"{}\"", self.log)?;
        writeln!(f, "\n# the folder of the host's own maps; none without this line")?;
        match &self.maps {
            Some(folder) => writeln!(f, "maps = {}", string(&folder.to_string_lossy()))?,
            None => writeln!(f, "# maps = \"/var/lib/cellcaster/maps\"")?,
        }
        if self.standing.is_empty() {
            writeln!(f, "\n# no standing rooms\nroom = []")?;
        }
        for setting in &SETTINGS {
            if !setting.meaning.is_empty() {
                writeln!(f, "\n# {}", setting.meaning.replace('\n', "\n# "))?;
            }
            writeln!(f, "{} = {}", setting.name, (setting.get)(self))?;
        }
        writeln!(f, "\n# where Prometheus reads metrics; nowhere without this line\n[metrics]")?;
        match self.metrics {
            Some(address) => writeln!(f, "listen = \"{address}\"")?,
            None => writeln!(f, "# listen = \"127.0.0.1:9464\"")?,
        }
        if !self.standing.is_empty() {
            writeln!(f, "\n# the rooms that are always there")?;
        }
        self.standing.iter().try_for_each(|room| write!(f, "{room}"))
    }
}

/// A basic string of TOML.
fn string(text: &str) -> String {
    let escaped = text.chars().flat_map(|char| match char {
        '"' | '\\' => vec!['\\', char],
        char if char.is_control() => format!("\\u{:04x}", u32::from(char)).chars().collect(),
        char => vec![char],
    });
    ['"'].into_iter().chain(escaped).chain(['"']).collect()
}
