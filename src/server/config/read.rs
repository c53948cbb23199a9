//! Parsing: from a file to a configuration.

use std::net::SocketAddr;

use toml::de::{DeTable, DeValue};

use super::Config;
use super::settings::{SETTINGS, Setting};
use crate::fault::document::{self, Entry, FaultList};
use crate::fault::{Fault, Faults, quoted};

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
            if entry.key == "listen" {
                if let Some(address) = address(&entry) {
                    self.listen = address;
                }
            } else if let Some(setting) = SETTINGS.iter().find(|known| known.name == entry.key) {
                if let Some(value) = number(&entry, setting) {
                    (setting.set)(self, value);
                }
            } else {
                let names = SETTINGS.iter().map(|setting| setting.name);
                let known: Vec<&str> = ["listen"].into_iter().chain(names).collect();
                faults.push(entry.unknown_key("the configuration", &known));
            }
        }
    }
}

fn address(entry: &Entry<'_, '_>) -> Option<SocketAddr> {
    const EXAMPLE: &str = "listen = \"127.0.0.1:2222\"";
    let text = entry.string(EXAMPLE)?;
    let address = text.parse().ok();
    if address.is_none() {
        let message = format!("{} is no address with a port", quoted(text));
        let help = format!("write {EXAMPLE}, or \"[::]:2222\" for all addresses of this machine");
        entry.faults.push(Fault::new(entry.value_place.clone(), message).help(help));
    }
    address
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
