//! The definitions of a map that is being edited: reading them, and changing them in the text.
//!
//! `toml_edit` makes the changed text, and only the range in which it differs is taken from it, because `toml_edit` drops
//! the carriage returns of Windows. A map whose text it would order or write in another way, such as dotted keys that are
//! mixed with others, keeps its definitions.

use std::collections::BTreeMap;
use std::ops::Range;

use toml_edit::{Document, DocumentMut, InlineTable, Item, Key, Table, TableLike, Value};

use super::history::common_ends;
use crate::map::keys::CharacterTable;

/// The definition of a character.
#[derive(Clone, Debug)]
pub struct Definition {
    /// The character in the grid.
    pub character: char,
    /// `true` for a thing, `false` for a tile.
    pub is_thing: bool,
    /// The definition as TOML without the braces, such as `wall = "brick"`.
    pub text: String,
    /// The bytes of the definition in the map.
    pub(crate) place: Range<usize>,
    pub(crate) properties: InlineTable,
}

/// The keys of tiles that are not open floor.
const NOT_FLOOR: [&str; 9] =
    ["wall", "door", "mask", "glass", "mirror", "pillar", "diagonal", "thin", "secret"];

impl Definition {
    /// Returns true if the tile is open floor, on which a thing can stand.
    pub(crate) fn is_floor(&self) -> bool {
        !self.is_thing && NOT_FLOOR.iter().all(|key| !self.properties.contains_key(key))
    }

    /// The character of the floor below a thing.
    pub(crate) fn support(&self) -> char {
        let named = self.properties.get("on").and_then(Value::as_str);
        named.and_then(|name| name.chars().next()).unwrap_or('.')
    }

    /// The key with the direction in which the thing looks, and the direction in degrees.
    pub(crate) fn heading(&self) -> Option<(&'static str, f64)> {
        let degrees = |key| {
            let value = self.properties.get(key)?;
            value.as_float().or(value.as_integer().map(|whole| whole as f64))
        };
        match self.properties.contains_key("start") {
            true => Some(("start", degrees("start")?)),
            false if ["guard", "sprite"].iter().any(|key| self.properties.contains_key(key)) => {
                Some(("heading", degrees("heading").unwrap_or(0.0)))
            }
            false => None,
        }
    }

    /// The waypoints of a guard's patrol.
    pub(crate) fn patrol(&self) -> &str {
        self.properties.get("patrol").and_then(Value::as_str).unwrap_or_default()
    }

    /// The same properties with another value, or without that key.
    pub(crate) fn with(&self, key: &str, value: Option<Value>) -> InlineTable {
        let mut changed = self.properties.clone();
        match value {
            Some(value) => set_in_inline(&mut changed, key, value),
            None => _ = changed.remove(key),
        }
        changed.fmt();
        changed
    }

    /// Returns true if both define the same.
    pub(crate) fn means(&self, properties: &InlineTable) -> bool {
        by_key(&self.properties) == by_key(properties)
    }
}

fn by_key(properties: &InlineTable) -> BTreeMap<String, String> {
    properties
        .iter()
        .map(|(key, value)| (key.to_owned(), value.to_string().trim().to_owned()))
        .collect()
}

/// The definitions in the map `text`, which is valid TOML, in their order. Leaves out faulty ones.
pub(crate) fn read(text: &str) -> Vec<Definition> {
    let Ok(document) = Document::parse(text) else { return Vec::new() };
    let tables = [(CharacterTable::Tiles, false), (CharacterTable::Things, true)];
    let tables = tables.into_iter().filter_map(|(table, is_thing)| {
        Some((document.get(name_of(table))?.as_table_like()?, is_thing))
    });
    tables.flat_map(|(table, is_thing)| definitions(table, text, is_thing)).collect()
}

fn definitions(table: &dyn TableLike, text: &str, is_thing: bool) -> Vec<Definition> {
    let of_key = |(name, item): (&str, &Item)| {
        let mut characters = name.chars();
        let (Some(character), None) = (characters.next(), characters.next()) else { return None };
        let properties = properties_of(item, text)?;
        let places = [table.key(name).and_then(Key::span), item.span()];
        let ends = || places.iter().flatten().flat_map(|place| [place.start, place.end]);
        let place = ends().min()?..ends().max()?;
        Some(Definition { character, is_thing, text: inside(&properties), place, properties })
    };
    table.iter().filter_map(of_key).collect()
}

/// The properties in `item` of the map `text`, in one line.
fn properties_of(item: &Item, text: &str) -> Option<InlineTable> {
    // Values of a parsed document refer to its text, which this one need not.
    let mut properties = InlineTable::new();
    for (key, value) in item.as_table_like()?.iter() {
        let value = match value.as_value().and_then(|value| text.get(value.span()?)) {
            Some(written) => written.parse().ok()?,
            None => value.clone().into_value().ok()?.to_string().parse().ok()?,
        };
        properties.insert(key, value);
    }
    properties.fmt();
    Some(properties)
}

/// `properties` without the braces.
fn inside(properties: &InlineTable) -> String {
    let text = properties.to_string();
    let text = text.trim();
    text.strip_prefix('{').and_then(|text| text.strip_suffix('}')).unwrap_or(text).trim().to_owned()
}

/// Reads properties that the user writes without the braces.
///
/// # Errors
/// A sentence.
pub(crate) fn properties(text: &str) -> Result<InlineTable, String> {
    let value: Value = format!("{{ {text} }}").parse().map_err(|error| not_toml(text, &error))?;
    match value {
        Value::InlineTable(properties) if !properties.is_empty() => Ok(properties),
        _ => Err("a definition has at least one key, as in wall = \"brick\"".to_owned()),
    }
}

/// Reads a value that the user writes.
///
/// # Errors
/// A sentence.
pub(crate) fn value(text: &str) -> Result<Value, String> {
    text.trim().parse().map_err(|error| not_toml(text, &error))
}

fn not_toml(text: &str, error: &toml_edit::TomlError) -> String {
    format!("{} is not TOML: {}", text.trim(), error.message().lines().next().unwrap_or_default())
}

/// The name of a table in a map.
fn name_of(table: CharacterTable) -> &'static str {
    table.name().trim_matches(['[', ']'])
}

/// The map `text` in which `character` has these properties.
///
/// # Errors
/// A sentence.
pub(crate) fn with_definition(
    text: &str,
    table: CharacterTable,
    character: char,
    properties: InlineTable,
) -> Result<String, String> {
    let name = character.to_string();
    changed(text, |document| {
        let table = document.entry(name_of(table)).or_insert_with(|| Item::Table(Table::new()));
        match table.as_table_like_mut().and_then(|table| table.get_mut(&name)) {
            Some(Item::Value(value)) => {
                let mut changed = Value::InlineTable(properties);
                *changed.decor_mut() = value.decor().clone();
                *value = changed;
            }
            Some(Item::Table(known)) => {
                known.retain(|key, _| properties.contains_key(key));
                for (key, mut value) in properties {
                    value.decor_mut().clear();
                    set_in_table(known, &key, value);
                }
            }
            _ => {
                let key: Key = Value::from(name).to_string().trim().parse().ok()?;
                let value = Value::InlineTable(properties);
                if let Item::Table(table) = table {
                    table.insert_formatted(&key, Item::Value(value));
                } else {
                    table.as_inline_table_mut()?.insert_formatted(&key, value);
                }
            }
        }
        Some(())
    })
}

/// The map `text` in which a property of `character` has another value. `None` removes it.
///
/// # Errors
/// A sentence.
pub(crate) fn with_property(
    text: &str,
    table: CharacterTable,
    character: char,
    (key, value): (&str, Option<Value>),
) -> Result<String, String> {
    changed(text, |document| {
        let table = document.get_mut(name_of(table))?.as_table_like_mut()?;
        match table.get_mut(&character.to_string())? {
            Item::Value(Value::InlineTable(properties)) => match value {
                Some(value) => set_in_inline(properties, key, value),
                None => remove_from_inline(properties, key),
            },
            Item::Table(properties) => match value {
                Some(value) => set_in_table(properties, key, value),
                None => _ = properties.remove(key),
            },
            _ => return None,
        }
        Some(())
    })
}

/// The map `text` in which a key of the whole map has this value.
///
/// # Errors
/// A sentence.
pub(crate) fn with_key(text: &str, key: &str, value: Value) -> Result<String, String> {
    changed(text, |document| {
        set_in_table(document.as_table_mut(), key, value);
        Some(())
    })
}

fn set_in_table(table: &mut Table, key: &str, mut value: Value) {
    match table.get_mut(key) {
        Some(Item::Value(old)) => {
            *value.decor_mut() = old.decor().clone();
            *old = value;
        }
        _ => _ = table.insert(key, Item::Value(value)),
    }
}

fn set_in_inline(table: &mut InlineTable, key: &str, mut value: Value) {
    if let Some(old) = table.get_mut(key) {
        *value.decor_mut() = old.decor().clone();
        *old = value;
        return;
    }
    if let Some((_, last)) = table.iter_mut().last() {
        last.decor_mut().set_suffix("");
    }
    table.insert(key, value);
}

fn remove_from_inline(table: &mut InlineTable, key: &str) {
    let suffix = table.iter().last().and_then(|(_, last)| last.decor().suffix().cloned());
    table.remove(key);
    if let (Some((_, last)), Some(suffix)) = (table.iter_mut().last(), suffix) {
        last.decor_mut().set_suffix(suffix);
    }
}

/// The sentence about a map whose definitions stay as they are.
const UNCHANGEABLE: &str = "the editor cannot change these definitions without changing others: change them in the map file";

/// What some editors write at the beginning of a file. `toml_edit` would drop it.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// The map `text` after `change`. Only the range in which it differs changes.
fn changed(
    text: &str,
    change: impl FnOnce(&mut DocumentMut) -> Option<()>,
) -> Result<String, String> {
    let (mark, text) = text.split_at(text.len() - text.trim_start_matches(BYTE_ORDER_MARK).len());
    let mut plain = text.replace("\r\n", "\n");
    if !plain.ends_with('\n') {
        plain.push('\n');
    }
    let unchangeable = || UNCHANGEABLE.to_owned();
    let mut document: DocumentMut = plain.parse().map_err(|_| unchangeable())?;
    if document.to_string() != plain {
        return Err(unchangeable());
    }
    change(&mut document).ok_or_else(unchangeable)?;
    Ok(mark.to_owned() + &grafted(text, &plain, &document.to_string()))
}

/// `text`, of which `plain` is the form with plain line ends, after the change from `plain` to `changed`.
fn grafted(text: &str, plain: &str, changed: &str) -> String {
    let (head, tail) = common_ends(plain, changed);
    let inserted = &changed[head..changed.len() - tail];
    let is_windows = text.contains("\r\n");
    let inserted = if is_windows { inserted.replace('\n', "\r\n") } else { inserted.to_owned() };
    let end_is_missing = head == plain.len() && !text.ends_with('\n');
    let line_end = if end_is_missing { line_end(text) } else { "" };
    let (start, end) = (place_in(text, head), place_in(text, plain.len() - tail));
    [&text[..start], line_end, &inserted, &text[end..]].concat()
}

/// The line end of `text`.
pub(crate) fn line_end(text: &str) -> &'static str {
    if text.contains("\r\n") { "\r\n" } else { "\n" }
}

/// The byte of `text` that is the byte `at` of its form with plain line ends.
fn place_in(text: &str, at: usize) -> usize {
    let mut left = at;
    let mut lines = text.split_inclusive('\n');
    let mut passed = 0;
    loop {
        let Some(line) = lines.next() else { return text.len() };
        let plain = line.len() - usize::from(line.ends_with("\r\n"));
        if left < plain {
            return passed + left;
        }
        left -= plain;
        passed += line.len();
    }
}
