//! Terminals by the names that they report (XTVERSION): their colours, and the glyphs that they draw
//! themselves, without a font.
//!
//! - A terminal draws glyphs of a kind from the version in the table on. Terminals before it, and
//!   those without an entry, are trusted with half blocks only.
//! - Shades (░▒▓) are dots or one flat colour. Where no source says which, they are unknown.
//! - A multiplexer answers for itself; its own name says nothing about the terminal around it.
//!
//! Rejected: the width of a glyph by a cursor report. It proves the width, never the ink.

use crate::color::palette::ShadeInk;
use crate::tui::GlyphSet;

/// The properties of a terminal, by its name and version.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Known {
    pub(crate) colors: Colors,
    /// The finest blocks that it is known to draw well.
    pub(crate) blocks: GlyphSet,
    pub(crate) shades: ShadeInk,
    pub(crate) is_tmux: bool,
}

/// Whether a terminal of some name and version shows 24-bit colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Colors {
    #[default]
    Unknown,
    /// The terminal shows them.
    True,
    /// The terminal is xterm, which is built with or without them and answers a further query. Other
    /// terminals print that query (blessed#382 names `QTerminal`, `PuTTY`, `ConEmu` and Apple's
    /// Terminal).
    Ask,
}

/// An entry of the table.
struct Terminal {
    /// The reported name, in lower case.
    name: &'static str,
    /// The first versions that draw quadrants, sextants and octants themselves.
    blocks: [Option<Version>; 3],
    shades: ShadeInk,
}

/// The first two numbers of a version.
type Version = (u32, u32);

const ALL: Option<Version> = Some((0, 0));

/// Every version of these that answers the query shows 24-bit colours, except xterm.
const TERMINALS: [Terminal; 13] = [
    // Octants: kitty's changelog, 0.40. Sextants and dots: seen with 0.26.
    terminal("kitty", [ALL, Some((0, 26)), Some((0, 40))], ShadeInk::Dots),
    // Octants: foot's changelog, 1.20.
    terminal("foot", [ALL, Some((1, 20)), Some((1, 20))], ShadeInk::Unknown),
    // Octants: ghostty's release notes, 1.2. Shades are an alpha: its `sprite` code.
    terminal("ghostty", [ALL, Some((1, 2)), Some((1, 2))], ShadeInk::Flat),
    // VTE reports 7800 for 0.78, which has octants. Shades are an alpha: its `minifont`.
    terminal("vte", [ALL, Some((7800, 0)), Some((7800, 0))], ShadeInk::Flat),
    // Octants come after its last stable release (WezTerm#6502).
    terminal("wezterm", [ALL, None, None], ShadeInk::Flat),
    // Sextants: alacritty#7534. It has no answer in most versions.
    terminal("alacritty", [ALL, ALL, None], ShadeInk::Flat),
    terminal("contour", [ALL, ALL, None], ShadeInk::Unknown),
    // Sextants: xterm.js#5467.
    terminal("xterm.js", [ALL, Some((6, 0)), None], ShadeInk::Unknown),
    // Sextants: terminal#20424, which is in no release that could be tested.
    terminal("windows terminal", [ALL, None, None], ShadeInk::Unknown),
    // Fonts draw the finer ones in these.
    terminal("iterm2", [ALL, None, None], ShadeInk::Unknown),
    terminal("mintty", [ALL, None, None], ShadeInk::Unknown),
    terminal("rio", [ALL, None, None], ShadeInk::Unknown),
    terminal("konsole", [ALL, None, None], ShadeInk::Unknown),
];

const fn terminal(name: &'static str, blocks: [Option<Version>; 3], shades: ShadeInk) -> Terminal {
    Terminal { name, blocks, shades }
}

/// The properties of the terminal that reports this name and version, such as `kitty(0.42.1)` or `WezTerm
/// 20240203-110809`.
pub(crate) fn known(report: &str) -> Known {
    let end = report.find(|letter: char| letter == '(' || letter.is_ascii_digit());
    let (name, version) = report.split_at(end.unwrap_or(report.len()));
    let name = name.trim().to_ascii_lowercase();
    match &*name {
        "tmux" => return Known { is_tmux: true, ..Known::default() },
        // Dots: measured with DejaVu. Its quadrants have gaps (notcurses#1517).
        "xterm" => {
            return Known { colors: Colors::Ask, shades: ShadeInk::Dots, ..Known::default() };
        }
        _ => {}
    }
    // iTerm2's name ends with a digit.
    let (name, version) = match version.strip_prefix('2') {
        Some(rest) if name == "iterm" => ("iterm2", rest),
        _ => (&*name, version),
    };
    let Some(terminal) = TERMINALS.iter().find(|terminal| terminal.name == name) else {
        return Known::default();
    };
    let version = numbers(version);
    let kinds = [GlyphSet::Quadrant, GlyphSet::Sextant, GlyphSet::Octant];
    let mut drawn = kinds.into_iter().zip(terminal.blocks);
    let blocks = drawn.rfind(|(_, since)| since.is_some_and(|since| version >= since));
    Known {
        colors: Colors::True,
        blocks: blocks.map_or(GlyphSet::Half, |(kind, _)| kind),
        shades: terminal.shades,
        is_tmux: false,
    }
}

/// The first two numbers of a version; missing ones are 0.
fn numbers(version: &str) -> Version {
    let mut numbers = version
        .trim_start_matches(|letter: char| !letter.is_ascii_digit())
        .split(|letter: char| !letter.is_ascii_digit())
        .map(|digits| digits.parse().unwrap_or_default());
    (numbers.next().unwrap_or_default(), numbers.next().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn block_glyphs_depend_on_the_version() {
        for (report, blocks) in [
            ("kitty(0.39.1)", GlyphSet::Sextant),
            ("kitty(0.40.0)", GlyphSet::Octant),
            ("kitty(1.0)", GlyphSet::Octant),
            ("foot(1.19.0)", GlyphSet::Quadrant),
            ("foot(1.20.2)", GlyphSet::Octant),
            ("ghostty 1.1.3", GlyphSet::Quadrant),
            ("ghostty 1.2.0-dev", GlyphSet::Octant),
            ("VTE(7006)", GlyphSet::Quadrant),
            ("VTE(7800)", GlyphSet::Octant),
            ("Alacritty 0.14.0", GlyphSet::Sextant),
            ("iTerm2 3.5.14", GlyphSet::Quadrant),
            ("Konsole 22.12.3", GlyphSet::Quadrant),
            ("XTerm(390)", GlyphSet::Half),
            ("tmux 3.3a", GlyphSet::Half),
            ("kitten(9)", GlyphSet::Half),
            ("", GlyphSet::Half),
        ] {
            assert_eq!(known(report).blocks, blocks, "{report}");
        }
    }

    #[test]
    fn only_listed_names_are_trusted_with_colours() {
        for report in ["kitty(0.26.5)", "foot(1.13.1)", "iTerm2 3.4", "VTE(6003)", "WezTerm 2022"] {
            assert_eq!(known(report).colors, Colors::True, "{report}");
        }
        for report in ["tmux 3.3a", "footer 1", "xterm 1.js", "(1.0)", "\u{9b}kitty(1)"] {
            assert_ne!(known(report).colors, Colors::True, "{report}");
        }
        assert_eq!(known("XTerm(379)").colors, Colors::Ask);
        assert!(known("tmux 3.5").is_tmux);
    }
}
