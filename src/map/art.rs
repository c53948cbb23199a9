//! A player's own art in place of the built-in art.

use std::collections::BTreeMap;
use std::num::NonZeroU32;
use std::path::Path;
use std::{fmt, fs, io};

use super::files::{Folder, TextureFiles};
use super::picture::{self, PictureError};
use crate::fault::{nearest, quoted};
use crate::world::art::{self, Art, Sheet};
use crate::world::{sprite, texture};

/// The most files of a folder that are looked at.
const MAX_FILES: usize = 4096;

/// Shows the PNG files of `folder` in place of the built-in art of the same names, in all worlds of this process that
/// are read from now on. A program calls it once, before it reads a map.
///
/// A file has the size of the built-in sheet in `maps/art`, or a whole multiple of it. Frames and facings are at the
/// same places. Maps remain valid, and games run as they would without it.
///
/// # Errors
/// The folder has no PNG file or cannot be read; a file has the name of no built-in sheet, is no picture or has
/// another shape; or art was replaced before.
pub fn replace_art(folder: &Path) -> Result<(), ArtError> {
    let names = names(folder)?;
    let files = Folder::of(&folder.join("any"));
    let mut budget = picture::PictureBudget::default();
    let mut sheets = BTreeMap::new();
    for name in &names {
        let file = folder.join(name);
        let (art, sheet) = sheet(name, &files, &mut budget)
            .map_err(|reason| ArtError(format!("{} {reason}", file.display())))?;
        sheets.insert(art.name, sheet);
    }
    if art::replace(sheets) {
        Ok(())
    } else {
        Err(ArtError("the built-in art can be replaced only once".to_owned()))
    }
}

/// The names of the PNG files in `folder`, in order.
fn names(folder: &Path) -> Result<Vec<String>, ArtError> {
    let unreadable = |error: io::Error| {
        ArtError(format!("the folder {} cannot be read: {}", folder.display(), error.kind()))
    };
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)?.take(MAX_FILES) {
        let name = entry.map_err(unreadable)?.file_name().to_string_lossy().into_owned();
        if Path::new(&name).extension().is_some_and(|extension| extension == "png") {
            names.push(name);
        }
    }
    if names.is_empty() {
        let folder = folder.display();
        return Err(ArtError(format!(
            "the folder {folder} has no PNG file: copy a sheet from maps/art into it, and edit the \
             copy"
        )));
    }
    names.sort();
    Ok(names)
}

/// The art that the file `name` replaces, and its sheet; or a reason why not, to follow the name of the file.
fn sheet(
    name: &str,
    files: &dyn TextureFiles,
    budget: &mut picture::PictureBudget,
) -> Result<(Art, Sheet), String> {
    let stem = name.trim_end_matches(".png");
    let Some(art) = all().find(|art| art.name == stem) else {
        let known: Vec<&str> = all().map(|art| art.name).collect();
        let meant = nearest(stem, &known).map_or(String::new(), |known| {
            format!(", and the nearest is {}", quoted(&format!("{known}.png")))
        });
        return Err(format!("is not named after a built-in picture{meant}: rename or remove it"));
    };
    let bytes = files.read(name).map_err(PictureError::Unreadable);
    let picture = bytes
        .and_then(|bytes| picture::decode(&bytes, budget))
        .map_err(|error| format!("{error}: {}", error.help("sheet")))?;
    let (size, wanted) = (picture.size(), art.built_in_size());
    let times = size[0].get() / wanted[0];
    if times == 0 || size.map(NonZeroU32::get) != wanted.map(|it| it.get() * times) {
        let [[width, height], [wanted_width, wanted_height]] = [size, wanted];
        return Err(format!(
            "is {width}×{height} texels: make it {wanted_width}×{wanted_height}, or a multiple of that"
        ));
    }
    Ok((art, Sheet::new(size, picture.texels().collect())))
}

/// All built-in art.
fn all() -> impl Iterator<Item = Art> {
    texture::builtin::sheets().chain(sprite::builtin::sheets())
}

/// The reason why art cannot replace the built-in art.
#[derive(Debug)]
pub struct ArtError(String);

impl fmt::Display for ArtError {
    /// Writes a sentence with the place and what to do.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ArtError {}
