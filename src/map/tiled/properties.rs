//! Custom properties in Tiled, which are keys of a map file.

use std::collections::BTreeMap;
use std::rc::Rc;

use serde_json::Value;
use toml::de::DeValue;

use super::model::beside;
use crate::fault::document::{self, FaultList, toml_string};
use crate::fault::{Fault, quoted};

/// The keys whose value may be a table or a list. Tiled has none, so they are text there.
pub(crate) const WITH_TABLES: [&str; 4] = ["floor", "ceiling", "sky", "fog"];
/// The key for the character of a tile or a thing in a map file.
pub(crate) const CHARACTER: &str = "character";

/// The largest number of properties of one thing, more than there are keys.
const MAX_PROPERTIES: usize = 64;

/// The properties of something, by name.
#[derive(Clone, Default)]
pub(crate) struct Properties(pub(crate) BTreeMap<String, Property>);

#[derive(Clone)]
pub(crate) enum Property {
    /// A text, without quotes.
    Text(String),
    /// A number, a truth value or a table, as TOML.
    Toml(String),
    /// The number of an object.
    Object(u64),
}

impl Properties {
    /// Reads the properties in `list` of the thing at `origin`. Files are named from `folder`.
    pub(crate) fn read(list: &[Value], folder: &str, origin: &Rc<str>) -> Result<Self, Fault> {
        if list.len() > MAX_PROPERTIES {
            let message = format!("there are more than {MAX_PROPERTIES} properties");
            return Err(Fault::at(&**origin, message).help("leave some out"));
        }
        let mut properties = BTreeMap::new();
        for property in list {
            let text = |key: &str| property.get(key).and_then(Value::as_str).unwrap_or_default();
            let name = text("name");
            let value = property.get("value").unwrap_or(&Value::Null);
            if let Some(read) = Property::read(name, text("type"), value, folder, origin)? {
                properties.insert(name.to_owned(), read);
            }
        }
        Ok(Self(properties))
    }

    /// The character for a map file, if the properties name one.
    pub(crate) fn character(&self) -> Option<char> {
        let Some(Property::Text(text)) = self.0.get(CHARACTER) else { return None };
        let mut characters = text.chars();
        let character = characters.next().filter(|it| !it.is_control() && !['.', ' '].contains(it));
        character.filter(|_| characters.next().is_none())
    }
}

impl Property {
    /// Reads the property `name` with a type of Tiled's; `None` if it has no value.
    fn read(
        name: &str,
        kind: &str,
        value: &Value,
        folder: &str,
        origin: &Rc<str>,
    ) -> Result<Option<Self>, Fault> {
        let written = match value {
            Value::String(text) => text.clone(),
            value => value.to_string(),
        };
        let fault = |message: String, help: &str| Fault::at(&**origin, message).help(help);
        let property = match kind {
            "bool" => Self::Toml((written == "true").to_string()),
            "int" | "float" => {
                let number = written.trim().parse::<f64>().ok().filter(|number| number.is_finite());
                let message = || format!("the property {} is not a number", quoted(name));
                let number = number.ok_or_else(|| fault(message(), "write a number"))?;
                Self::Toml(number.to_string())
            }
            "object" => match written.trim().parse() {
                Ok(0) | Err(_) => return Ok(None),
                Ok(id) => Self::Object(id),
            },
            // A colour in Tiled begins with its opacity.
            "color" => match (written.len(), written.get(3..)) {
                (0, _) => return Ok(None),
                (9, Some(color)) => Self::Text(format!("#{color}")),
                _ => Self::Text(written),
            },
            "file" if written.is_empty() => return Ok(None),
            "file" => Self::Text(beside(folder, &written).unwrap_or(written)),
            "class" => {
                let message = format!("the property {} is a class of its own", quoted(name));
                return Err(fault(message, "give its values as properties of their own"));
            }
            _ if WITH_TABLES.contains(&name) && written.trim_start().starts_with('{') => {
                let message = format!("the property {} is not a TOML table", quoted(name));
                let table = table(&written).ok_or_else(|| {
                    fault(message, r#"write, for example, { checker = ["tile", "marble"] }"#)
                })?;
                Self::Toml(table)
            }
            _ => Self::Text(written),
        };
        Ok(Some(property))
    }

    /// The value in a map file.
    pub(crate) fn to_toml(&self) -> String {
        match self {
            Self::Text(text) => toml_string(text),
            Self::Toml(toml) => toml.clone(),
            Self::Object(id) => id.to_string(),
        }
    }
}

/// `text` as one TOML value on one line; `None` if it is none.
fn table(text: &str) -> Option<String> {
    let text = format!("table = {text}");
    let faults = FaultList::default();
    let document = document::parse(&text, &faults);
    let mut entries = document.iter();
    let (_, value) = entries.next()?;
    (faults.is_empty() && entries.next().is_none()).then(|| toml_value(value.get_ref()))
}

/// A value as TOML, on one line.
pub(crate) fn toml_value(value: &DeValue<'_>) -> String {
    let joined = |parts: Vec<String>| parts.join(", ");
    match value {
        DeValue::String(text) => toml_string(text),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(integer) => integer.to_string(),
            Err(_) => integer.as_str().to_owned(),
        },
        DeValue::Float(float) => float.as_str().to_owned(),
        DeValue::Boolean(boolean) => boolean.to_string(),
        DeValue::Datetime(time) => time.to_string(),
        DeValue::Array(list) => {
            format!("[{}]", joined(list.iter().map(|it| toml_value(it.get_ref())).collect()))
        }
        DeValue::Table(table) => {
            let entries = table.iter().map(|(key, value)| {
                format!("{} = {}", toml_key(key.get_ref()), toml_value(value.get_ref()))
            });
            format!("{{ {} }}", joined(entries.collect()))
        }
    }
}

/// A key as TOML.
pub(crate) fn toml_key(key: &str) -> String {
    let is_bare = |it: char| it.is_ascii_alphanumeric() || "-_".contains(it);
    if !key.is_empty() && key.chars().all(is_bare) { key.to_owned() } else { toml_string(key) }
}
