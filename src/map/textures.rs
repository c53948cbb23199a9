//! Textures by name: built in, or a PNG beside the map.
//!
//! A texture is painted or decoded once, and only where the map uses it.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::{fmt, fs, io};

use super::picture;
use crate::fault::document::Entry;
use crate::fault::{Fault, nearest, quoted};
use crate::world::texture::builtin;
use crate::world::{Paint, Rgb, Texture, TextureId};

/// The most bytes that a PNG file may have.
const MAX_FILE_BYTES: usize = 16 << 20;

/// Where a map's own textures come from.
///
/// The folder of the map is a [`Folder`]; a program that has its pictures compiled in, or in an
/// archive, looks them up by name:
///
/// ```
/// use cellcaster::map::{TextureFileError, TextureFiles};
///
/// struct CompiledIn(&'static [(&'static str, &'static [u8])]);
///
/// impl TextureFiles for CompiledIn {
///     fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
///         let (_, bytes) =
///             self.0.iter().find(|(known, _)| *known == name).ok_or(TextureFileError::Missing)?;
///         Ok(bytes.to_vec())
///     }
/// }
/// ```
pub trait TextureFiles {
    /// The bytes of the PNG file `name`, which ends in `.png`, may lie in folders (`a/b.png`) and
    /// never leads out of them.
    ///
    /// # Errors
    /// Why there are none.
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError>;
}

/// Why a texture's file has no bytes.
#[derive(Debug)]
#[non_exhaustive]
pub enum TextureFileError {
    /// There is no such file.
    Missing,
    /// A link leads out of the map's folder.
    Outside,
    /// It is no regular file, but a folder or a device.
    NotAFile,
    /// It is larger than any PNG of an allowed size.
    TooLarge,
    /// It cannot be read.
    Unreadable(io::Error),
}

impl fmt::Display for TextureFileError {
    /// Writes what is true of the file, to follow its name.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("is not there"),
            Self::Outside => f.write_str("is a link out of the map's folder"),
            Self::NotAFile => f.write_str("is no file"),
            Self::TooLarge => write!(f, "is larger than {} MiB", MAX_FILE_BYTES >> 20),
            Self::Unreadable(error) => write!(f, "cannot be read: {}", error.kind()),
        }
    }
}

impl std::error::Error for TextureFileError {}

/// No files: every texture is built in.
#[derive(Clone, Copy, Debug)]
pub struct NoFiles;

impl TextureFiles for NoFiles {
    fn read(&self, _: &str) -> Result<Vec<u8>, TextureFileError> {
        Err(TextureFileError::Missing)
    }
}

/// The files of one folder and of those within it. Links that lead out of it are not followed.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// The folder that the map file at `map` lies in.
    pub fn of(map: &Path) -> Self {
        match map.parent() {
            Some(parent) if parent != Path::new("") => Self { path: parent.to_owned() },
            _ => Self { path: PathBuf::from(".") },
        }
    }

    fn real_path(&self, name: &str) -> Result<PathBuf, TextureFileError> {
        let folder = self.path.canonicalize()?;
        let file = folder.join(name).canonicalize()?;
        if !file.starts_with(&folder) {
            return Err(TextureFileError::Outside);
        }
        if !fs::metadata(&file)?.is_file() {
            return Err(TextureFileError::NotAFile);
        }
        Ok(file)
    }
}

impl TextureFiles for Folder {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let bytes = super::read_up_to(&self.real_path(name)?, MAX_FILE_BYTES + 1)?;
        if bytes.len() > MAX_FILE_BYTES {
            return Err(TextureFileError::TooLarge);
        }
        Ok(bytes)
    }
}

impl From<io::Error> for TextureFileError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::Missing,
            _ => Self::Unreadable(error),
        }
    }
}

/// How a surface is to look, as the map says it.
pub(super) struct Surface<'a> {
    source: Source<'a>,
    /// Where the map says it.
    place: Range<usize>,
}

/// What a surface's look is made from.
enum Source<'a> {
    Color(Rgb),
    BuiltIn(&'a str),
    File(&'a str),
}

impl<'a> Surface<'a> {
    /// A surface of one colour that the map does not mention.
    pub(super) fn plain(color: Rgb) -> Self {
        Self { source: Source::Color(color), place: 0..0 }
    }

    /// The surface that `entry` describes; where it describes none, that is added to `faults`. The
    /// `example` is a whole entry.
    pub(super) fn read(
        entry: &Entry<'a, '_>,
        example: &str,
        faults: &mut Vec<Fault>,
    ) -> Option<Self> {
        let text = entry.string(example, faults)?;
        Self::from_source(Source::read(text, entry.value_place.clone()), entry, faults)
    }

    /// As [`Surface::read`], for the picture of a sky.
    pub(super) fn read_panorama(
        entry: &Entry<'a, '_>,
        example: &str,
        faults: &mut Vec<Fault>,
    ) -> Option<Self> {
        let text = entry.string(example, faults)?;
        let place = entry.value_place.clone();
        let source = if builtin::PANORAMAS.contains(&text) {
            Ok(Source::BuiltIn(text))
        } else if is_png(text) {
            Source::read(text, place)
        } else {
            Err(unknown_panorama(text, place))
        };
        Self::from_source(source, entry, faults)
    }

    fn from_source(
        source: Result<Source<'a>, Fault>,
        entry: &Entry<'_, '_>,
        faults: &mut Vec<Fault>,
    ) -> Option<Self> {
        match source {
            Ok(source) => Some(Self { source, place: entry.value_place.clone() }),
            Err(fault) => {
                faults.push(fault);
                None
            }
        }
    }
}

impl Surface<'_> {
    /// Where the map says it.
    pub(super) fn place(&self) -> Range<usize> {
        self.place.clone()
    }
}

impl<'a> Source<'a> {
    /// What `text`, written at `place`, names: a colour, a built-in texture or a PNG file. Whether
    /// there is such a file is not asked yet.
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

pub(super) fn is_png(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"))
}

/// Whether `name` means the same file within a folder on every system.
pub(super) fn stays_inside(name: &str) -> bool {
    !name.contains(['\\', ':']) && name.split('/').all(|part| !matches!(part, "" | "." | ".."))
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

/// Why there is no picture: what is true of it, to follow its name, and what to do.
pub(super) struct SheetError {
    pub(super) why: String,
    pub(super) help: &'static str,
}

/// The textures that a map uses, each once.
pub(super) struct Textures<'f> {
    files: &'f dyn TextureFiles,
    list: Vec<Texture>,
    /// Which texture a name stands for; `None` where it had a fault.
    known: BTreeMap<String, Option<TextureId>>,
}

impl<'f> Textures<'f> {
    pub(super) fn new(files: &'f dyn TextureFiles) -> Self {
        Self { files, list: Vec::new(), known: BTreeMap::new() }
    }

    /// The paint for `surface`. Where its texture cannot be had, that is added to `faults`, once
    /// for each texture.
    pub(super) fn paint(
        &mut self,
        surface: &Surface<'_>,
        faults: &mut Vec<Fault>,
    ) -> Option<Paint> {
        match surface.source {
            Source::Color(color) => Some(Paint::Color(color)),
            Source::BuiltIn(name) | Source::File(name) => {
                self.texture(name, surface, faults).map(Paint::Texture)
            }
        }
    }

    fn texture(
        &mut self,
        name: &str,
        surface: &Surface<'_>,
        faults: &mut Vec<Fault>,
    ) -> Option<TextureId> {
        match self.known.get(name) {
            Some(id) => *id,
            None => self.add(name, surface, faults),
        }
    }

    fn add(
        &mut self,
        name: &str,
        surface: &Surface<'_>,
        faults: &mut Vec<Fault>,
    ) -> Option<TextureId> {
        let id = match self.make(name, surface) {
            Ok(texture) => {
                self.list.push(texture);
                Some(TextureId(self.list.len() as u16 - 1))
            }
            Err(fault) => {
                faults.push(fault);
                None
            }
        };
        self.known.insert(name.to_owned(), id);
        id
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

    /// The picture in the file `name`, as it is: for sprites.
    pub(super) fn sheet(&self, name: &str) -> Result<Texture, SheetError> {
        let bytes = self.files.read(name).map_err(|error| SheetError {
            why: error.to_string(),
            help: "a sprite is a PNG file beside the map",
        })?;
        picture::decode(&bytes)
            .map_err(|error| SheetError { why: error.to_string(), help: error.help() })
    }

    /// The texture of the walls that a door is set between.
    pub(super) fn jamb(&mut self) -> Paint {
        let surface = Surface { source: Source::BuiltIn("jamb"), place: 0..0 };
        // It is built in, so no fault is found with it.
        self.paint(&surface, &mut Vec::new()).unwrap_or(Paint::Color(Rgb::BLACK))
    }

    /// A texture that [`Textures::paint`] has given out.
    pub(super) fn get(&self, id: TextureId) -> &Texture {
        &self.list[usize::from(id.0)]
    }

    pub(super) fn into_list(self) -> Vec<Texture> {
        self.list
    }
}
