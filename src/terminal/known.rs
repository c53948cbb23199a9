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

/// The finest block glyphs that a terminal is known to draw well. Each includes those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BlockGlyphs {
    /// Half blocks, 1×2 pixels a cell.
    #[default]
    Half,
    /// Quadrants, 2×2 pixels.
    Quadrant,
    /// Sextants, 2×3 pixels.
    Sextant,
    /// Octants, 2×4 pixels.
    Octant,
}

/// What is known of a terminal from its name and version.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Known {
    pub(super) colors: Colors,
    pub(super) blocks: BlockGlyphs,
    pub(super) shades: ShadeInk,
    pub(super) is_tmux: bool,
}

/// What a name and version say about 24-bit colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Colors {
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
    colors: Colors,
    /// The first versions that draw quadrants, sextants and octants themselves.
    blocks: [Option<Version>; 3],
    shades: ShadeInk,
}

/// The first two numbers of a version.
type Version = (u32, u32);

const ALL: Option<Version> = Some((0, 0));

/// Every version of these that answers the query shows 24-bit colours, except xterm.
const TERMINALS: [Terminal; 13] = [
    // Octants: kitty's changelog, 0.40. Dots: measured with 0.26.
    terminal("kitty", [ALL, Some((0, 23)), Some((0, 40))], ShadeInk::Dots),
    // Octants: foot's changelog, 1.20.
    terminal("foot", [ALL, Some((1, 8)), Some((1, 20))], ShadeInk::Unknown),
    // Octants: ghostty's release notes, 1.2. Shades are an alpha: its `sprite` code.
    terminal("ghostty", [ALL, ALL, Some((1, 2))], ShadeInk::Flat),
    // VTE reports 7800 for 0.78, which has octants. Shades are an alpha: its `minifont`.
    terminal("vte", [ALL, Some((6200, 0)), Some((7800, 0))], ShadeInk::Flat),
    // Sextants in its last stable release; octants after it (WezTerm#6502).
    terminal("wezterm", [ALL, ALL, None], ShadeInk::Flat),
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
    Terminal { name, colors: Colors::True, blocks, shades }
}

/// What the name and version in `report` say, such as `kitty(0.42.1)` or `WezTerm 20240203-110809`.
pub(super) fn known(report: &str) -> Known {
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
    let kinds = [BlockGlyphs::Quadrant, BlockGlyphs::Sextant, BlockGlyphs::Octant];
    let drawn = kinds.into_iter().zip(terminal.blocks);
    let blocks = drawn.filter(|(_, since)| since.is_some_and(|since| version >= since));
    Known {
        colors: terminal.colors,
        blocks: blocks.map(|(kind, _)| kind).max().unwrap_or_default(),
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
            ("kitty(0.39.1)", BlockGlyphs::Sextant),
            ("kitty(0.40.0)", BlockGlyphs::Octant),
            ("kitty(1.0)", BlockGlyphs::Octant),
            ("foot(1.19.0)", BlockGlyphs::Sextant),
            ("foot(1.20.2)", BlockGlyphs::Octant),
            ("ghostty 1.1.3", BlockGlyphs::Sextant),
            ("ghostty 1.2.0-dev", BlockGlyphs::Octant),
            ("VTE(7006)", BlockGlyphs::Sextant),
            ("VTE(7800)", BlockGlyphs::Octant),
            ("WezTerm 20240203-110809-5046fc22", BlockGlyphs::Sextant),
            ("iTerm2 3.5.14", BlockGlyphs::Quadrant),
            ("Konsole 22.12.3", BlockGlyphs::Quadrant),
            ("XTerm(390)", BlockGlyphs::Half),
            ("tmux 3.3a", BlockGlyphs::Half),
            ("kitten(9)", BlockGlyphs::Half),
            ("", BlockGlyphs::Half),
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
