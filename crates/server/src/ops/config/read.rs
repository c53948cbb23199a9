//! Parsing: from a file to a configuration.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use toml::de::{DeTable, DeValue};

use super::settings::{SETTINGS, Setting};
use super::{Config, standing};
use crate::ops::logging::{LogFilter, UnknownLogFilter};
use cellcaster::fault::document::{self, Entry, FaultList};
use cellcaster::fault::{Fault, Faults, quoted};

/// In characters: the longest message of the day.
const LONGEST_MESSAGE: usize = 200;
/// In characters: the longest name of a host.
const LONGEST_NAME: usize = 40;

impl Config {
    /// Parses a configuration file, which faults refer to as `name`.
    ///
    /// # Errors
    /// All faults of the file.
    pub fn parse(text: &str, name: &str) -> Result<Self, Faults> {
        let faults = FaultList::default();
        let document = document::parse(text, &faults);
        let mut config = Self::default();
        if faults.is_empty() {
            config.read(&document, &faults);
        }
        if faults.is_empty() { Ok(config) } else { Err(Faults::new(name, text, faults.take())) }
    }

    fn read(&mut self, document: &DeTable, faults: &FaultList) {
        for entry in document::entries(document, faults) {
            match entry.key {
                "listen" => set(&mut self.listen, address(&entry, LISTEN)),
                "name" => set(&mut self.name, name(&entry)),
                "message" => set(&mut self.message, message(&entry)),
                "log" => set(&mut self.log, log(&entry)),
                "maps" => set(&mut self.maps, folder(&entry).map(Some)),
                "metrics" => self.read_metrics(&entry),
                "room" => set(&mut self.standing, standing::read(&entry)),
                key => {
                    if let Some(setting) = SETTINGS.iter().find(|known| known.name == key) {
                        set_number(self, &entry, setting);
                    } else {
                        let names = SETTINGS.iter().map(|setting| setting.name);
                        let known: Vec<&str> = TEXTS.into_iter().chain(names).collect();
                        faults.push(entry.unknown_key("the configuration", &known));
                    }
                }
            }
        }
        self.check_room_count(document, faults);
    }

    fn check_room_count(&self, document: &DeTable, faults: &FaultList) {
        let (standing, most) = (self.standing.len(), self.rooms as usize);
        if let Some((key, _)) = document.get_key_value("room").filter(|_| standing > most) {
            let message = format!("{standing} standing rooms are more than the limit of rooms");
            let help = format!("write rooms = {standing} or more");
            faults.push(Fault::new(key.span(), message).help(help));
        }
    }

    fn read_metrics(&mut self, metrics: &Entry<'_, '_>) {
        let Some(table) = metrics.table("[metrics]") else { return };
        for entry in metrics.entries(table) {
            match entry.key {
                "listen" => self.metrics = address(&entry, METRICS_LISTEN),
                _ => entry.faults.push(entry.unknown_key("[metrics]", &["listen"])),
            }
        }
    }
}

const LISTEN: &str = "listen = \"127.0.0.1:2222\"";
const METRICS_LISTEN: &str = "listen = \"127.0.0.1:9464\"";

/// The settings that are no numbers.
const TEXTS: [&str; 7] = ["listen", "name", "message", "log", "maps", "metrics", "room"];

fn set_number(config: &mut Config, entry: &Entry<'_, '_>, setting: &Setting) {
    if let Some(value) = number(entry, setting) {
        (setting.set)(config, value);
    }
}

fn set<T>(target: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *target = value;
    }
}

fn address(entry: &Entry<'_, '_>, example: &str) -> Option<SocketAddr> {
    let text = entry.string(example)?;
    let address = text.parse().ok();
    if address.is_none() {
        let message = format!("{} is no address with a port", quoted(text));
        let help = format!("write {example}; [::] is all addresses of this machine");
        entry.faults.push(Fault::new(entry.value_place.clone(), message).help(help));
    }
    address
}

fn message(entry: &Entry<'_, '_>) -> Option<String> {
    let text = entry.string("message = \"Welcome\"")?;
    line(entry, text, "the message of the day", LONGEST_MESSAGE)
}

fn name(entry: &Entry<'_, '_>) -> Option<String> {
    let text = entry.string("name = \"Cellcaster\"")?;
    if text.trim().is_empty() {
        let message = "the name of the host is empty";
        let help = "leave the setting out for \"Cellcaster\"";
        entry.faults.push(Fault::new(entry.value_place.clone(), message).help(help));
        return None;
    }
    line(entry, text, "the name of the host", LONGEST_NAME)
}

/// `text`, if it is one line of at most `longest` characters. `what` it is goes to the fault.
fn line(entry: &Entry<'_, '_>, text: &str, what: &str, longest: usize) -> Option<String> {
    let is_line = text.chars().count() <= longest && !text.contains(char::is_control);
    if !is_line {
        let message = format!("{what} is one line of at most {longest} characters");
        entry.faults.push(Fault::new(entry.value_place.clone(), message));
    }
    is_line.then(|| text.to_owned())
}

fn folder(entry: &Entry<'_, '_>) -> Option<PathBuf> {
    const EXAMPLE: &str = "maps = \"/var/lib/cellcaster/maps\"";
    let path = Path::new(entry.string(EXAMPLE)?);
    // A service starts in a folder that nobody thinks of.
    if !path.is_absolute() {
        let message = format!("{} is not an absolute path", quoted(&path.to_string_lossy()));
        let fault = Fault::new(entry.value_place.clone(), message);
        entry.faults.push(fault.help(format!("write {EXAMPLE}")));
        return None;
    }
    Some(path.to_owned())
}

fn log(entry: &Entry<'_, '_>) -> Option<LogFilter> {
    const EXAMPLE: &str = "log = \"info,connections=warn\"";
    match entry.string(EXAMPLE)?.parse() {
        Ok(filter) => Some(filter),
        Err(UnknownLogFilter(part)) => {
            let message = format!("{} is no level of the log", quoted(&part));
            let fault = Fault::new(entry.value_place.clone(), message);
            entry.faults.push(fault.help(format!("write {EXAMPLE}; {}", LogFilter::GRAMMAR)));
            None
        }
    }
}

fn number(entry: &Entry<'_, '_>, setting: &Setting) -> Option<u32> {
    let &Setting { name, least, most, .. } = setting;
    let example = format!("{name} = {}", (setting.get)(&Config::default()));
    let DeValue::Integer(_) = entry.value else {
        entry.faults.push(entry.wrong_type("a whole number", &example));
        return None;
    };
    let in_range = |number: &f64| (f64::from(least)..=f64::from(most)).contains(number);
    let value = entry.number().filter(in_range).map(|number| number as u32);
    if value.is_none() {
        let message = format!("{} must be a whole number from {least} to {most}", quoted(name));
        let fault = Fault::new(entry.value_place.clone(), message);
        entry.faults.push(fault.help(format!("write {example}")));
    }
    value
}
