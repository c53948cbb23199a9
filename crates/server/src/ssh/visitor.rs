//! Visitors, the limits on the data that they supply, and the host that serves them.

use std::collections::BTreeMap;
use std::future::Future;
use std::net::SocketAddr;

use super::inbound::Inbound;
use super::outbox::Outbox;
use crate::accounts::AccountKey;
use crate::admission::Refusal;
use cellcaster::terminal::WindowSize;

/// A connected client with a terminal.
#[derive(Clone, Debug)]
pub struct Visitor {
    /// The address from which they connect.
    pub peer: SocketAddr,
    /// The key that they have proved to own; `None` for a guest.
    pub key: Option<AccountKey>,
    /// A notice for a guest about their key.
    pub notice: Option<&'static str>,
    /// The user name sent by the client: printable, at most 64 characters. It proves nothing.
    pub user: String,
    /// `TERM`: printable, at most 64 characters.
    pub term: String,
    /// The environment variables that describe the terminal or the language.
    pub environment: BTreeMap<String, String>,
    /// The initial size of the window.
    pub size: WindowSize,
    /// Whether output to the visitor is compressed by the connection.
    pub compresses: bool,
}

/// A host: the sessions above the transport.
pub trait Host: Send + Sync + 'static {
    /// Serves `visitor` until they leave or `link` ends.
    ///
    /// The future is dropped five seconds after the end of the link.
    fn serve(&self, visitor: Visitor, link: Link) -> impl Future<Output = Departure> + Send;
}

/// Both directions of a visitor's channel.
pub struct Link {
    /// The visitor's input.
    pub inbound: Inbound,
    /// The frame on its way to the visitor.
    pub outbox: Outbox,
}

/// The end of a session.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Departure {
    /// The exit status of the visitor's `ssh`.
    pub status: u8,
    /// The limit that the visitor exceeded, if the server refused them.
    pub refusal: Option<Refusal>,
}

/// The maximum length of a user name, of `TERM`, and of a variable's value, in characters.
pub(crate) const MAX_WORD_BYTES: usize = 64;
/// The maximum number of variables.
pub(crate) const MAX_VARIABLES: usize = 16;

impl Departure {
    /// For a refused visitor, who has to change something or come back later.
    pub(crate) const REFUSED: Self = Self { status: 2, refusal: None };
    /// For a visitor that the host failed to serve.
    pub(crate) const FAILED: Self = Self { status: 1, refusal: None };
}

/// The first [`MAX_WORD_BYTES`] printable characters of `text`.
pub(crate) fn word(text: &str) -> String {
    text.chars().filter(|char| !char.is_control()).take(MAX_WORD_BYTES).collect()
}

/// Returns true if the variable with this name is kept.
pub(crate) fn is_kept(name: &str) -> bool {
    let is_locale = name.strip_prefix("LC_").is_some_and(|category| {
        (1..=32).contains(&category.len())
            && category.bytes().all(|byte| byte.is_ascii_uppercase() || byte == b'_')
    });
    is_locale || ["LANG", "COLORTERM", "TERM_PROGRAM", "NO_COLOR"].contains(&name)
}

/// The size of a window as stated by a client, clamped to 1 to `most` cells in each direction.
pub(crate) fn window_size(cells: [u32; 2], pixels: [u32; 2], most: [u16; 2]) -> WindowSize {
    let [columns, rows] =
        [0, 1].map(|axis| u16::try_from(cells[axis]).unwrap_or(u16::MAX).clamp(1, most[axis]));
    // The pixel size of a clamped window says nothing about the shape of a cell.
    let is_whole = [u32::from(columns), u32::from(rows)] == cells;
    let [width, height] =
        pixels.map(|pixels| if is_whole { u16::try_from(pixels).unwrap_or(0) } else { 0 });
    WindowSize::new((columns, rows), (width, height))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_bounded_and_have_no_control_characters() {
        assert_eq!(word("ann\u{1b}[31m\r\n\0"), "ann[31m");
        assert_eq!(word("\u{9b}31m"), "31m");
        assert_eq!(word(&"é".repeat(1000)).chars().count(), MAX_WORD_BYTES);
    }

    #[test]
    fn only_variables_about_terminals_and_languages_are_kept() {
        for name in ["LANG", "LC_ALL", "LC_CTYPE", "COLORTERM", "TERM_PROGRAM", "NO_COLOR"] {
            assert!(is_kept(name), "{name}");
        }
        for name in ["", "LC_", "LC_all", "LC_\u{1b}", "PATH", "LD_PRELOAD", "LANGUAGE", "lang"] {
            assert!(!is_kept(name), "{name}");
        }
        assert!(!is_kept(&format!("LC_{}", "A".repeat(33))));
    }

    #[test]
    fn window_sizes_are_bounded() {
        let size = |cells, pixels| window_size(cells, pixels, [500, 200]);
        for (cells, bounded) in [
            ([0, 0], (1, 1)),
            ([80, 24], (80, 24)),
            ([501, 200], (500, 200)),
            ([u32::MAX, u32::MAX], (500, 200)),
            ([65_536, 65_537], (500, 200)),
        ] {
            let size = size(cells, [u32::MAX, u32::MAX]);
            assert_eq!((size.columns, size.rows), bounded, "{cells:?}");
        }
    }

    #[test]
    fn pixel_sizes_count_only_if_the_window_fits() {
        let size = |cells, pixels| window_size(cells, pixels, [500, 200]).cell_aspect;
        assert_eq!(size([80, 24], [640, 384]), Some(2.0));
        assert_eq!(size([80, 24], [640, 70_000]), None);
        assert_eq!(size([1000, 24], [8000, 384]), None);
    }
}
