//! Surfaces: walls, floors and skies, as the map writes them.

use std::ops::Range;

use super::files::{is_png, stays_inside};
use crate::color::Rgb;
use crate::fault::document::Entry;
use crate::fault::{Fault, nearest, quoted};
use crate::world::texture::builtin;

/// A surface as the map writes it.
pub(crate) struct Surface<'a> {
    pub(crate) source: Source<'a>,
    /// Its place in the map.
    pub(crate) place: Range<usize>,
}

/// The source of a surface.
pub(crate) enum Source<'a> {
    Color(Rgb),
    BuiltIn(&'a str),
    File(&'a str),
}

impl<'a> Surface<'a> {
    /// A surface of one colour, for maps that do not name any.
    pub(crate) fn plain(color: Rgb) -> Self {
        Self { source: Source::Color(color), place: 0..0 }
    }

    /// The walls that a door is set between.
    pub(crate) fn jamb() -> Self {
        Self::built_in("jamb")
    }

    /// The built-in texture of that name.
    pub(crate) fn built_in(name: &'static str) -> Self {
        Self { source: Source::BuiltIn(name), place: 0..0 }
    }

    /// Reads the surface in `entry`; reports a fault where there is none. `example` is a whole entry.
    pub(crate) fn read(entry: &Entry<'a, '_>, example: &str) -> Option<Self> {
        let text = entry.string(example)?;
        Self::from_source(Source::read(text, entry.value_place.clone()), entry)
    }

    /// Reads the panorama in `entry`, as [`Surface::read`].
    pub(crate) fn read_panorama(entry: &Entry<'a, '_>, example: &str) -> Option<Self> {
        let text = entry.string(example)?;
        let place = entry.value_place.clone();
        let source = if builtin::PANORAMAS.contains(&text) {
            Ok(Source::BuiltIn(text))
        } else if is_png(text) {
            Source::read(text, place)
        } else {
            Err(unknown_panorama(text, place))
        };
        Self::from_source(source, entry)
    }

    fn from_source(source: Result<Source<'a>, Fault>, entry: &Entry<'_, '_>) -> Option<Self> {
        match source {
            Ok(source) => Some(Self { source, place: entry.value_place.clone() }),
            Err(fault) => {
                entry.faults.push(fault);
                None
            }
        }
    }
}

impl Surface<'_> {
    /// Its place in the map.
    pub(crate) fn place(&self) -> Range<usize> {
        self.place.clone()
    }
}

impl<'a> Source<'a> {
    /// Reads `text`, written at `place`: a colour, a built-in texture or a PNG file. Does not check
    /// whether the file exists.
    fn read(text: &'a str, place: Range<usize>) -> Result<Self, Fault> {
        match text.parse() {
            Ok(color) => Ok(Self::Color(color)),
            Err(error) if text.starts_with('#') => {
                let message = format!("{} is not a colour", quoted(text));
                Err(Fault::new(place, message).help(format!("{error}")))
            }
            Err(_) if builtin::NAMES.contains(&text) => Ok(Self::BuiltIn(text)),
            Err(_) if !is_png(text) => Err(unknown_name(text, place)),
            Err(_) if !stays_inside(text) => {
                let message = format!("{} is not a file in the map's folder", quoted(text));
                let help = "copy the picture beside the map, and separate folders by /";
                Err(Fault::new(place, message).label("leads elsewhere").help(help))
            }
            Err(_) => Ok(Self::File(text)),
        }
    }
}

fn unknown_name(name: &str, place: Range<usize>) -> Fault {
    let fault = Fault::new(place, format!("there is no texture {}", quoted(name)));
    match nearest(name, builtin::NAMES) {
        Some(known) => fault.help(format!("the nearest built-in texture is {}", quoted(known))),
        None => fault.help(format!(
            "write a colour such as \"#a04030\", the name of a PNG beside the map, or one of {}",
            builtin::NAMES.join(", ")
        )),
    }
}

fn unknown_panorama(name: &str, place: Range<usize>) -> Fault {
    Fault::new(place, format!("there is no panorama {}", quoted(name))).help(format!(
        "write the name of a PNG beside the map, or one of {}",
        builtin::PANORAMAS.join(", ")
    ))
}
