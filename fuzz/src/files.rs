//! Texture files in memory.

use cellcaster::map::{TextureFileError, TextureFiles};

/// The same bytes under every name except `missing.png`.
pub(crate) struct OneFile<'a>(pub(crate) &'a [u8]);

impl TextureFiles for OneFile<'_> {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        if name == "missing.png" { Err(TextureFileError::Missing) } else { Ok(self.0.to_vec()) }
    }
}
