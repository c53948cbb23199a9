//! The reader: what all stages after the definitions share.

use std::collections::BTreeMap;

use super::textures::{Surface, TextureFiles, Textures};
use crate::color::Rgb;
use crate::fault::document::FaultList;
use crate::world::{Paint, Sprite};

/// A map's text, the faults found in it, and the textures that it uses.
pub(crate) struct Reader<'m> {
    pub(crate) text: &'m str,
    pub(crate) faults: &'m FaultList,
    pub(crate) textures: Textures<'m>,
    /// The sprite of a sheet by its name and its numbers of frames and of facings; `None` where it
    /// has a fault.
    pub(crate) sheets: BTreeMap<(String, Option<u32>, Option<u32>), Option<Sprite>>,
}

impl<'m> Reader<'m> {
    /// A reader of `text` whose textures come from `files` where they are not built in.
    pub(crate) fn new(text: &'m str, faults: &'m FaultList, files: &'m dyn TextureFiles) -> Self {
        Self { text, faults, textures: Textures::new(files), sheets: BTreeMap::new() }
    }

    /// The paint for `surface`. Where its texture cannot be had, that is reported, once
    /// for each texture.
    pub(crate) fn paint(&mut self, surface: &Surface<'_>) -> Option<Paint> {
        self.textures.paint(surface).map_err(|fault| self.faults.extend(fault)).ok()
    }

    /// The texture of the walls that a door is set between.
    pub(crate) fn jamb(&mut self) -> Paint {
        // It is built in, so no fault is found with it.
        self.paint(&Surface::jamb()).unwrap_or(Paint::Color(Rgb::BLACK))
    }
}
