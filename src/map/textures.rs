//! Textures by name: built in, or a PNG file beside the map.
//!
//! A texture is computed or decoded once, and only if the map uses it.

mod files;
mod surface;

use std::collections::BTreeMap;

use super::picture::{self, Picture, PictureError};
use crate::fault::{Fault, quoted};
use crate::world::texture::builtin;
use crate::world::{Paint, Texture, TextureId};
pub use files::{Folder, NoFiles, TextureFileError, TextureFiles};
pub(crate) use files::{is_png, stays_inside};
use surface::Source;
pub(crate) use surface::Surface;

/// The textures that a map uses, each once.
pub(crate) struct Textures<'f> {
    files: &'f dyn TextureFiles,
    /// `None` after a picture exceeded it.
    budget: Option<picture::Budget>,
    list: Vec<Texture>,
    /// The texture of a name; `None` where it has a fault.
    known: BTreeMap<String, Option<TextureId>>,
}

impl<'f> Textures<'f> {
    pub(crate) fn new(files: &'f dyn TextureFiles) -> Self {
        let budget = Some(picture::Budget::default());
        Self { files, budget, list: Vec::new(), known: BTreeMap::new() }
    }

    /// The paint for `surface`. Reports a fault where its texture is missing, once for each
    /// texture.
    pub(crate) fn paint(&mut self, surface: &Surface<'_>) -> Result<Paint, Option<Fault>> {
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
        made
    }

    fn make(&mut self, name: &str, surface: &Surface<'_>) -> Result<Texture, Option<Fault>> {
        if let Some(texture) = builtin::named(name).or_else(|| builtin::panorama(name)) {
            return Ok(texture);
        }
        let picture = self.picture(name).map_err(|error| {
            let error = error?;
            let message = format!("the texture {} {error}", quoted(name));
            let help = error.help("a texture is a PNG file beside the map");
            Some(Fault::new(surface.place.clone(), message).help(help))
        })?;
        Ok(picture.texture())
    }

    /// Decodes the picture in the file `name`. The error is `None` after a picture has exceeded the
    /// budget, which is reported once.
    pub(crate) fn picture(&mut self, name: &str) -> Result<Picture, Option<PictureError>> {
        let budget = self.budget.as_mut().ok_or(None)?;
        let bytes = self.files.read(name).map_err(PictureError::from)?;
        let picture = picture::decode(&bytes, budget);
        if let Err(PictureError::OneTooMany) = picture {
            self.budget = None;
        }
        Ok(picture?)
    }

    /// A texture that [`Textures::paint`] returned.
    pub(crate) fn get(&self, id: TextureId) -> &Texture {
        &self.list[usize::from(id.0)]
    }

    pub(crate) fn into_list(self) -> Vec<Texture> {
        self.list
    }
}
