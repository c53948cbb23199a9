//! The built-in textures.
