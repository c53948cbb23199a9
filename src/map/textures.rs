//! Textures by name: built in, or a PNG file beside the map.
//!
//! A texture is computed or decoded once, and only if the map uses it.

mod files;
mod surface;

use std::collections::BTreeMap;

use super::picture;
use crate::fault::{Fault, quoted};
use crate::world::texture::builtin;
use crate::world::{Paint, Texture, TextureId};
pub use files::{Folder, NoFiles, TextureFileError, TextureFiles};
pub(super) use files::{is_png, stays_inside};
use surface::Source;
pub(super) use surface::Surface;

/// Why there is no picture: the reason, to follow its name, and what to do.
pub(super) struct SheetError {
    pub(super) why: String,
    pub(super) help: &'static str,
}

/// The textures that a map uses, each once.
pub(super) struct Textures<'f> {
    files: &'f dyn TextureFiles,
    list: Vec<Texture>,
    /// The texture of a name; `None` where it has a fault.
    known: BTreeMap<String, Option<TextureId>>,
}

impl<'f> Textures<'f> {
    pub(super) fn new(files: &'f dyn TextureFiles) -> Self {
        Self { files, list: Vec::new(), known: BTreeMap::new() }
    }

    /// The paint for `surface`. Reports a fault where its texture is missing, once for each
    /// texture.
    pub(super) fn paint(&mut self, surface: &Surface<'_>) -> Result<Paint, Option<Fault>> {
        match surface.source {
            Source::Color(color) => Ok(Paint::Color(color)),
            Source::BuiltIn(name) | Source::File(name) => {
                self.texture(name, surface).map(Paint::Texture)
            }
        }
    }

    fn texture(&mut self, name: &str, surface: &Surface<'_>) -> Result<TextureId, Option<Fault>> {
        if let Some(id) = self.known.get(name) {
            return id.ok_or(None);
        }
        let made = self.make(name, surface).map(|texture| {
            self.list.push(texture);
            TextureId(self.list.len() as u16 - 1)
        });
        self.known.insert(name.to_owned(), made.as_ref().ok().copied());
        made.map_err(Some)
    }

    fn make(&self, name: &str, surface: &Surface<'_>) -> Result<Texture, Fault> {
        if let Some(texture) = builtin::named(name).or_else(|| builtin::panorama(name)) {
            return Ok(texture);
        }
        let fault = |why: String| {
            Fault::new(surface.place.clone(), format!("the texture {} {why}", quoted(name)))
        };
        let bytes = self.files.read(name).map_err(|error| {
            fault(error.to_string()).help("a texture is a PNG file beside the map")
        })?;
        picture::decode(&bytes).map_err(|error| fault(error.to_string()).help(error.help()))
    }

    /// The picture in the file `name`, for sprites.
    pub(super) fn sheet(&self, name: &str) -> Result<Texture, SheetError> {
        let bytes = self.files.read(name).map_err(|error| SheetError {
            why: error.to_string(),
            help: "a sprite is a PNG file beside the map",
        })?;
        picture::decode(&bytes)
            .map_err(|error| SheetError { why: error.to_string(), help: error.help() })
    }

    /// A texture that [`Textures::paint`] returned.
    pub(super) fn get(&self, id: TextureId) -> &Texture {
        &self.list[usize::from(id.0)]
    }

    pub(super) fn into_list(self) -> Vec<Texture> {
        self.list
    }
}
