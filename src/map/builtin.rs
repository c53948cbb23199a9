//! The built-in levels, compiled in from `maps/`.

/// A built-in level.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// What it is asked for by.
    pub name: &'static str,
    /// Its map, for [`parse_str`](super::parse_str): every texture is built in.
    pub text: &'static str,
}

/// The built-in levels, in playing order.
pub const LEVELS: &[Level] =
    &[Level { name: "cellar", text: include_str!("../../maps/cellar.toml") }];
