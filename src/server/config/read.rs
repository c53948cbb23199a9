//! Parsing: from a file to a configuration.

use std::net::SocketAddr;

use toml::de::{DeTable, DeValue};

use super::Config;
use super::settings::{SETTINGS, Setting};
use crate::fault::document::{self, Entry, FaultList};
use crate::fault::{Fault, Faults, quoted};
use crate::server::logging::{LogFilter, UnknownLogFilter};

/// In characters: the longest message of the day.
const LONGEST_MESSAGE: usize = 200;

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
                "message" => set(&mut self.message, message(&entry)),
                "log" => set(&mut self.log, log(&entry)),
                "metrics" => self.read_metrics(&entry),
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
const TEXTS: [&str; 4] = ["listen", "message", "log", "metrics"];

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
    let is_line = text.chars().count() <= LONGEST_MESSAGE && !text.contains(char::is_control);
    if !is_line {
        let message =
            format!("the message of the day is one line of at most {LONGEST_MESSAGE} characters");
        entry.faults.push(Fault::new(entry.value_place.clone(), message));
    }
    is_line.then(|| text.to_owned())
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
