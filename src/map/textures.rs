//! Textures and sheets of sprites by name, either built in or a PNG file beside the map.
//!
//! Each is computed or decoded once, and only if the map uses it.

use std::collections::BTreeMap;
use std::ops::Range;

use super::files::TextureFiles;
use super::picture::{self, Picture, PictureError};
use crate::color::Rgb;
use crate::fault::document::FaultList;
use crate::fault::{Fault, quoted};
use crate::world::texture::builtin;
use crate::world::{Paint, Sprite, Texture, TextureId};

/// The name of a sheet, and its numbers of frames and facings.
type SheetKey = (String, Option<u32>, Option<u32>);

/// The textures that a map uses, each once, and the faults found in the map.
pub(crate) struct Textures<'m> {
    pub(crate) faults: &'m FaultList,
    files: &'m dyn TextureFiles,
    /// `None` after a picture exceeded it.
    budget: Option<picture::PictureBudget>,
    list: Vec<Texture>,
    /// The texture for each name; `None` if it has a fault.
    known: BTreeMap<String, Option<TextureId>>,
    /// The sprite for each sheet; `None` if it has a fault.
    sheets: BTreeMap<SheetKey, Option<Sprite>>,
}

/// A surface as the map writes it.
pub(crate) struct SurfaceText<'a> {
    pub(crate) source: PaintText<'a>,
    /// Its place in the map.
    pub(crate) place: Range<usize>,
}

/// The source of a surface.
pub(crate) enum PaintText<'a> {
    Color(Rgb),
    /// The name of a built-in texture or of a file.
    Texture(&'a str),
}

impl<'m> Textures<'m> {
    /// Creates an empty list. Textures that are not built in come from `files`.
    pub(crate) fn new(faults: &'m FaultList, files: &'m dyn TextureFiles) -> Self {
        let (budget, list) = (Some(picture::PictureBudget::default()), Vec::new());
        Self { faults, files, budget, list, known: BTreeMap::new(), sheets: BTreeMap::new() }
    }

    /// The paint for `surface`. Reports a fault if its texture is missing, once for each texture.
    pub(crate) fn paint(&mut self, surface: &SurfaceText<'_>) -> Option<Paint> {
        let name = match surface.source {
            PaintText::Color(color) => return Some(Paint::Color(color)),
            PaintText::Texture(name) => name,
        };
        if let Some(known) = self.known.get(name) {
            return known.map(Paint::Texture);
        }
        let texture = builtin::named(name).or_else(|| builtin::panorama(name));
        let texture =
            texture.or_else(|| Some(self.picture("texture", name, &surface.place)?.texture()));
        let id = texture.map(|texture| {
            self.list.push(texture);
            TextureId(self.list.len() as u16 - 1)
        });
        self.known.insert(name.to_owned(), id);
        id.map(Paint::Texture)
    }

    /// The sprite of the sheet `key`, made by `cut`. The picture is decoded once for all sprites
    /// that divide it in the same way.
    pub(crate) fn sheet(
        &mut self,
        key: SheetKey,
        place: &Range<usize>,
        cut: impl FnOnce(&Picture, &FaultList) -> Option<Sprite>,
    ) -> Option<Sprite> {
        if let Some(known) = self.sheets.get(&key) {
            return known.clone();
        }
        let sheet = self.picture("sprite", &key.0, place);
        let sprite = sheet.and_then(|sheet| cut(&sheet, self.faults));
        self.sheets.insert(key, sprite.clone());
        sprite
    }

    /// Decodes the picture in the file `name`, which the map uses as a `use_of_file`. Of the pictures
    /// that exceed the budget, only the first is reported.
    fn picture(&mut self, use_of_file: &str, name: &str, place: &Range<usize>) -> Option<Picture> {
        let budget = self.budget.as_mut()?;
        let bytes = self.files.read(name).map_err(PictureError::Unreadable);
        let picture = bytes.and_then(|bytes| picture::decode(&bytes, budget));
        let error = match picture {
            Ok(picture) => return Some(picture),
            Err(error) => error,
        };
        if let PictureError::OneTooMany = error {
            self.budget = None;
        }
        let message = format!("the {use_of_file} {} {error}", quoted(name));
        self.faults.push(Fault::new(place.clone(), message).help(error.help(use_of_file)));
        None
    }

    /// A texture that [`Textures::paint`] returned.
    pub(crate) fn get(&self, id: TextureId) -> &Texture {
        &self.list[usize::from(id.0)]
    }

    pub(crate) fn into_list(self) -> Vec<Texture> {
        self.list
    }
}
