//! The text of a Tiled file as one tree, in the form of Tiled's JSON format. An XML file becomes
//! the tree that the same file would be as JSON, except that its numbers are still text.

use std::ops::Range;

use quick_xml::XmlVersion;
use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;
use serde_json::{Map, Value};

use crate::fault::{Fault, Faults};

/// The largest depth of elements, which is enough for groups in groups.
const MAX_DEPTH: usize = 100;

/// The tree of the file `name`. Its root is the map or the tileset.
///
/// # Errors
/// The text is neither XML nor JSON.
pub(crate) fn parse(text: &str, name: &str) -> Result<Value, Faults> {
    let (parsed, format) = if text.trim_start_matches('\u{feff}').trim_start().starts_with('<') {
        (xml(text), "XML")
    } else {
        (json(text), "JSON")
    };
    parsed.map_err(|(at, reason)| {
        let at = text.floor_char_boundary(at.min(text.len()));
        let fault = Fault::new(Range { start: at, end: at }, format!("this is not valid {format}"));
        let help = "save the map with Tiled, as .tmx or .tmj";
        Faults::new(name, text, vec![fault.label(reason).help(help)])
    })
}

/// A place in the text, and the reason why it is malformed.
type Malformed = (usize, String);

fn json(text: &str) -> Result<Value, Malformed> {
    serde_json::from_str(text).map_err(|error| {
        let lines = text.split_inclusive('\n').take(error.line().saturating_sub(1));
        let start: usize = lines.map(str::len).sum();
        let reason = error.to_string();
        let reason = reason.split(" at line ").next().unwrap_or_default();
        (start + error.column().saturating_sub(1), reason.to_owned())
    })
}

/// An element that is not closed yet.
#[derive(Default)]
struct Element {
    name: String,
    fields: Map<String, Value>,
    text: String,
}

fn xml(text: &str) -> Result<Value, Malformed> {
    let mut reader = Reader::from_str(text);
    let mut root = Element::default();
    let mut open: Vec<Element> = Vec::new();
    loop {
        let at = reader.buffer_position() as usize;
        let malformed = |reason: &dyn ToString| (at, reason.to_string());
        match reader.read_event().map_err(|error| malformed(&error))? {
            Event::Start(tag) => {
                if open.len() >= MAX_DEPTH {
                    return Err(malformed(&"elements are nested too deeply"));
                }
                open.push(Element::of(&tag).map_err(|error| malformed(&error))?);
            }
            Event::Empty(tag) => {
                let element = Element::of(&tag).map_err(|error| malformed(&error))?;
                element.close_in(open.last_mut().unwrap_or(&mut root));
            }
            Event::End(_) => {
                if let Some(element) = open.pop() {
                    element.close_in(open.last_mut().unwrap_or(&mut root));
                }
            }
            Event::Text(content) => {
                let element = open.last_mut().unwrap_or(&mut root);
                element.text.push_str(&content.xml10_content());
            }
            Event::CData(content) => {
                let element = open.last_mut().unwrap_or(&mut root);
                element.text.push_str(&content.xml10_content());
            }
            Event::GeneralRef(entity) => {
                let element = open.last_mut().unwrap_or(&mut root);
                match entity.resolve_char_ref().map_err(|error| malformed(&error))? {
                    Some(character) => element.text.push(character),
                    None => element.text.push_str(
                        resolve_predefined_entity(&entity)
                            .ok_or_else(|| malformed(&"this entity is not defined"))?,
                    ),
                }
            }
            Event::Eof if !open.is_empty() => return Err(malformed(&"the file ends too early")),
            Event::Eof => break,
            Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => {}
        }
    }
    let roots = ["maps", "tilesets"].into_iter().filter_map(|list| root.fields.remove(list));
    let first = roots.filter_map(|list| match list {
        Value::Array(list) => list.into_iter().next(),
        _ => None,
    });
    { first }.next().ok_or((0, "there is no map and no tileset".to_owned()))
}

impl Element {
    fn of(tag: &BytesStart<'_>) -> Result<Self, quick_xml::Error> {
        let mut fields = Map::new();
        // Without these checks, many attributes take quadratic time. The last of a name counts.
        for attribute in tag.attributes().with_checks(false) {
            let attribute = attribute?;
            let value = attribute.normalized_value(XmlVersion::Implicit1_0)?;
            let name = attribute.key.as_ref();
            fields.insert(name.to_owned(), Value::String(value.into_owned()));
        }
        Ok(Self { name: tag.name().as_ref().to_owned(), fields, text: String::new() })
    }

    /// Adds the whole element to the one around it, where the JSON format has it.
    fn close_in(mut self, around: &mut Self) {
        let list = match (self.name.as_str(), around.name.as_str()) {
            ("map", _) => "maps",
            ("tileset", _) => "tilesets",
            ("tile", "tileset" | "data") => "tiles",
            ("object", _) => "objects",
            ("property", _) => "properties",
            ("layer" | "objectgroup" | "group" | "imagelayer", "map" | "group") => "layers",
            ("properties", _) => {
                around.take(&mut self, "properties");
                return;
            }
            ("image", _) => {
                if let Some(source) = self.fields.remove("source") {
                    around.fields.insert("image".to_owned(), source);
                }
                return;
            }
            ("data", _) => {
                around.take(&mut self, "encoding");
                around.take(&mut self, "compression");
                if !self.fields.contains_key("tiles") {
                    self.fields.insert("data".to_owned(), Value::String(self.text));
                    self.text = String::new();
                }
                around.take(&mut self, "data");
                around.take(&mut self, "tiles");
                return;
            }
            ("polyline" | "polygon", _) => {
                let points = self.fields.remove("points").unwrap_or_default();
                around.fields.insert(self.name, points);
                return;
            }
            ("text", "object") => {
                around.fields.insert(self.name, Value::Bool(true));
                return;
            }
            _ => return,
        };
        if list == "layers" {
            let kind = if self.name == "layer" { "tilelayer" } else { &self.name };
            self.fields.insert("type".to_owned(), Value::String(kind.to_owned()));
        }
        if list == "properties" && !self.fields.contains_key("value") {
            self.fields.insert("value".to_owned(), Value::String(self.text));
        }
        let entry = around.fields.entry(list).or_insert_with(|| Value::Array(Vec::new()));
        if let Value::Array(elements) = entry {
            elements.push(Value::Object(self.fields));
        }
    }

    /// Moves the field `key` of `inner` into this element.
    fn take(&mut self, inner: &mut Self, key: &str) {
        if let Some(value) = inner.fields.remove(key) {
            self.fields.insert(key.to_owned(), value);
        }
    }
}
