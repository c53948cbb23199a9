//! The properties of a terminal, from its environment and from the name that it reports, and the ways to use it.
//!
//! For the colours, the user's choice comes first (`NO_COLOR`, `FORCE_COLOR`, `CLICOLOR_FORCE`), then the terminal's
//! own claims (`COLORTERM`, `TERM`), then a guess that a query may raise.
//!
//! Missing variables do not restrict the game. Containers and `ssh` often set neither a locale nor `TERM`, although the
//! terminal shows UTF-8 and understands every sequence.
//!
//! Rejected: a database of terminals. Half of the machines lack it, and on others its numbers of colours are wrong.
//! Rejected: aborting, or drawing with letters, without a locale or `TERM`.
//!
//! The reported name (XTVERSION) implies the colours, and the glyphs that the terminal draws itself, without a font:
//!
//! - A terminal draws a kind of glyph itself from the version in the table on. Earlier versions, and terminals without
//!   an entry, are trusted with half blocks only.
//! - Shades (░▒▓) are dots or one flat colour. If no source tells which, they are unknown.
//! - A multiplexer answers for itself. Its name says nothing about the terminal around it.
//!
//! Rejected: measuring the width of a glyph with a cursor report. The report proves the width, but not that the glyph
//! has ink.

use crate::color::palette::{ColorDepth, ShadeInk};
use crate::terminal::Fidelity;
use crate::tui::GlyphSet;

/// The properties of a terminal that are known at the start, and the ways to use it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a question of its own")]
pub struct SessionOptions {
    /// The terminal's number of colours. If it is a guess, the terminal is queried.
    pub color_depth: Detected,
    /// The source of the colour depth.
    pub color_source: ColorSource,
    /// The value of `TERM`, if it names a terminal that cannot move its cursor.
    pub teletype: Option<&'static str>,
    /// Whether the terminal shows only ASCII. If so, other characters are replaced by similar ones.
    pub is_ascii: bool,
    /// Whether to request reports of key releases.
    pub ask_for_key_releases: bool,
    /// Whether to ask if the terminal can report mouse positions in pixels.
    pub ask_for_mouse_pixels: bool,
    /// Whether to ask for the terminal's name and version.
    pub ask_for_version: bool,
    /// Whether the program runs in a tmux on this machine. If so, a [`Session`](super::Session) asks tmux about the
    /// terminal around it.
    pub ask_tmux: bool,
    /// Whether the terminal is across a network. The first frame is then coarse; later frames make
    /// it exact.
    pub is_remote: bool,
    /// Whether to probe control sequences that make frames shorter (repeated characters and the palette), and to use
    /// the sequences that work.
    pub probe_extensions: bool,
    /// The fidelity of frames; `None` for the best that the link allows.
    pub fidelity: Option<Fidelity>,
}

impl SessionOptions {
    /// Options from `environment`, which looks up variables by name.
    ///
    /// Control sequences that make frames shorter are not probed in a terminal multiplexer, nor in
    /// a terminal that is unknown or has no window.
    ///
    /// A multiplexer is not asked for key releases. The multiplexers that support them lose some, and a key whose
    /// release is lost is held forever. A multiplexer is not asked for pixels either, because it has none of its own.
    ///
    /// Apple's Terminal is not asked for pixels, because it prints the last character of that query (DECRQM). A
    /// terminal with an unknown `TERM` is not asked for its version, because some terminals would print that query.
    pub fn from_environment(environment: impl Fn(&str) -> Option<String>) -> Self {
        /// Terminals that ignore unknown control sequences.
        const KNOWN: [&str; 14] = [
            "xterm",
            "vte",
            "gnome",
            "konsole",
            "mintty",
            "iterm",
            "st-",
            "tmux",
            "rxvt-unicode",
            "foot",
            "alacritty",
            "contour",
            "ghostty",
            "wezterm",
        ];
        let is_set = |name| environment(name).is_some_and(|value| !value.is_empty());
        let term = environment("TERM").unwrap_or_default();
        let multiplexed = is_set("TMUX")
            || is_set("STY")
            || ["tmux", "screen"].iter().any(|name| term.starts_with(name));
        let is_plain = ["", "dumb", "linux", "unknown"].contains(&&*term) || term.starts_with("vt");
        let (color_depth, color_source) = detect(&environment);
        Self {
            color_depth,
            color_source,
            teletype: teletype(&environment),
            is_ascii: false,
            ask_for_key_releases: !multiplexed,
            ask_for_mouse_pixels: !multiplexed
                && environment("TERM_PROGRAM").as_deref() != Some("Apple_Terminal"),
            ask_for_version: KNOWN.iter().any(|name| term.starts_with(name)),
            ask_tmux: is_set("TMUX"),
            is_remote: ["SSH_CONNECTION", "SSH_CLIENT", "SSH_TTY"].into_iter().any(is_set),
            probe_extensions: !multiplexed && !is_plain,
            fidelity: None,
        }
    }
}

/// The colour depth that an environment implies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detected {
    /// A depth that no answer from the terminal would change.
    Certain(ColorDepth),
    /// The greatest safe depth, until the terminal has been queried.
    Guess(ColorDepth),
}

impl Detected {
    /// The depth to start with.
    pub fn depth(self) -> ColorDepth {
        match self {
            Self::Certain(depth) | Self::Guess(depth) => depth,
        }
    }
}

/// The evidence for the colour depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorSource {
    /// The variable `NO_COLOR`.
    NoColor,
    /// The variable `FORCE_COLOR`, or `CLICOLOR_FORCE`.
    ForceColor,
    /// The variable `COLORTERM`.
    ColorTerm,
    /// The variable `TERM`.
    Term,
    /// The terminal's answer to a query.
    Answer,
    /// The terminal shows 256 colours, and lets the program define them.
    Palette,
    /// The answer from tmux about the terminal around it.
    Tmux,
    /// No evidence; most terminals have this depth.
    Nothing,
}

/// The colour depth that `environment` implies, and the evidence for it. `environment` looks up variables by name.
fn detect(environment: impl Fn(&str) -> Option<String>) -> (Detected, ColorSource) {
    use ColorSource::{ColorTerm, ForceColor, NoColor, Nothing, Term};
    let certain = |depth, source| (Detected::Certain(depth), source);
    let variable = |name| environment(name).filter(|value| !value.is_empty());
    if variable("NO_COLOR").is_some() {
        return certain(ColorDepth::Mono, NoColor);
    }
    let forced = match environment("FORCE_COLOR").as_deref() {
        Some("0" | "false") => return certain(ColorDepth::Mono, ForceColor),
        Some("1") => return certain(ColorDepth::Indexed16, ForceColor),
        Some("2") => return certain(ColorDepth::Indexed256, ForceColor),
        Some("3") => return certain(ColorDepth::True, ForceColor),
        Some(_) => true,
        None => variable("CLICOLOR_FORCE").is_some_and(|value| value != "0"),
    };
    if matches!(variable("COLORTERM").as_deref(), Some("truecolor" | "24bit")) {
        // tmux passes on the variable of the terminal in which it was started, and its own answer is better.
        let is_certain = variable("TMUX").is_none();
        let depth = if is_certain { Detected::Certain } else { Detected::Guess };
        return (depth(ColorDepth::True), ColorTerm);
    }
    let named = variable("TERM").map_or(Detected::Guess(ColorDepth::Indexed256), |term| of(&term));
    // In tmux, TERM may be `screen`, whatever number of colours tmux sends.
    let is_tmux = variable("TMUX").is_some() && variable("STY").is_none();
    match named {
        Detected::Certain(depth @ ColorDepth::Indexed256) if is_tmux => {
            (Detected::Guess(depth), Nothing)
        }
        Detected::Certain(ColorDepth::Mono) if forced => certain(ColorDepth::Indexed16, ForceColor),
        Detected::Certain(depth) => certain(depth, Term),
        Detected::Guess(depth) => (Detected::Guess(depth), Nothing),
    }
}

/// The depth that `term`, a value of `TERM`, implies.
fn of(term: &str) -> Detected {
    const TRUE: [&str; 9] = [
        "alacritty",
        "contour",
        "foot",
        "ghostty",
        "rio",
        "wezterm",
        "xterm-direct",
        "xterm-ghostty",
        "xterm-kitty",
    ];
    const SIXTEEN: [&str; 5] = ["ansi", "cygwin", "linux", "rxvt", "xterm-16color"];
    const MONO: [&str; 7] = ["dumb", "unknown", "vt52", "vt100", "vt102", "vt220", "xterm-mono"];
    let is = |known: &&str| {
        term.strip_prefix(*known).is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
    };
    if TRUE.iter().any(is) || term.ends_with("-direct") {
        Detected::Certain(ColorDepth::True)
    } else if MONO.contains(&term) {
        Detected::Certain(ColorDepth::Mono)
    } else if SIXTEEN.contains(&term) {
        Detected::Certain(ColorDepth::Indexed16)
    } else if is(&"screen") {
        // screen forwards the query to the terminal around it, and the answer does not apply to screen.
        Detected::Certain(ColorDepth::Indexed256)
    } else {
        Detected::Guess(ColorDepth::Indexed256)
    }
}

/// Values of `TERM` for terminals that cannot move their cursor: values that programs and systems set, and teletypes.
/// None of them has `cup` in the database of terminals.
const TELETYPES: [&str; 12] = [
    "dumb", "unknown", "vanilla", "emacs", "glasstty", "printer", "lpr", "tty33", "tty35", "tty37",
    "tty40", "tty43",
];

/// The value of `TERM` in `environment`, if it names a terminal that cannot move its cursor. `environment` looks up
/// variables by name.
fn teletype(environment: impl Fn(&str) -> Option<String>) -> Option<&'static str> {
    let term = environment("TERM")?;
    TELETYPES.into_iter().find(|&known| known == term)
}

/// The locale setting in `environment`, such as `LANG=C`, if it does not select UTF-8. `None` if it does, or if there
/// is no setting, because most terminals show UTF-8.
///
/// The first non-empty variable of `LC_ALL`, `LC_CTYPE` and `LANG` counts, as in POSIX. A locale
/// without a character set is not UTF-8.
///
/// ```
/// use cellcaster::terminal::locale_without_utf8;
///
/// let environment = |name: &str| (name == "LANG").then(|| "de_DE.ISO-8859-1".to_owned());
/// assert_eq!(locale_without_utf8(environment).as_deref(), Some("LANG=de_DE.ISO-8859-1"));
/// ```
pub fn locale_without_utf8(environment: impl Fn(&str) -> Option<String>) -> Option<String> {
    let setting = |name| Some((name, environment(name).filter(|value| !value.is_empty())?));
    let (name, value) = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(setting)?;
    let lower = value.to_ascii_lowercase();
    let is_utf8 = lower.contains("utf-8") || lower.contains("utf8");
    (!is_utf8).then(|| format!("{name}={value}"))
}

/// The properties of a terminal, derived from its name and version.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TerminalProperties {
    pub(crate) colors: TrueColorSupport,
    /// The finest blocks that the terminal is known to draw well.
    pub(crate) blocks: GlyphSet,
    pub(crate) shades: ShadeInk,
    pub(crate) is_tmux: bool,
}

/// The support for 24-bit colours that a terminal's name and version imply.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum TrueColorSupport {
    #[default]
    Unknown,
    /// The terminal shows 24-bit colours.
    True,
    /// The terminal is xterm, which is built with or without 24-bit colours and answers a further query. Other
    /// terminals print that query (blessed#382 names `QTerminal`, `PuTTY`, `ConEmu` and Apple's Terminal).
    Ask,
}

/// An entry of [`TERMINALS`].
struct Terminal {
    /// The reported name, in lower case.
    name: &'static str,
    /// The first versions that draw quadrants, sextants and octants themselves. `None` if no version does.
    blocks: [Option<Version>; 3],
    shades: ShadeInk,
}

/// The first two numbers of a version.
type Version = (u32, u32);

const ALL: Option<Version> = Some((0, 0));

/// The known terminals. Every version that answers the query shows 24-bit colours. xterm has no entry, because it may
/// lack them.
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
    // Sextants: alacritty#7534. Most versions do not answer the query.
    terminal("alacritty", [ALL, ALL, None], ShadeInk::Flat),
    terminal("contour", [ALL, ALL, None], ShadeInk::Unknown),
    // Sextants: xterm.js#5467.
    terminal("xterm.js", [ALL, Some((6, 0)), None], ShadeInk::Unknown),
    // Sextants: terminal#20424, which is in no release that could be tested.
    terminal("windows terminal", [ALL, None, None], ShadeInk::Unknown),
    // In the following terminals, fonts draw the finer blocks.
    terminal("iterm2", [ALL, None, None], ShadeInk::Unknown),
    terminal("mintty", [ALL, None, None], ShadeInk::Unknown),
    terminal("rio", [ALL, None, None], ShadeInk::Unknown),
    terminal("konsole", [ALL, None, None], ShadeInk::Unknown),
];

const fn terminal(name: &'static str, blocks: [Option<Version>; 3], shades: ShadeInk) -> Terminal {
    Terminal { name, blocks, shades }
}

/// The properties of the terminal that reports this name and version, such as `kitty(0.42.1)` or
/// `WezTerm 20240203-110809`.
pub(crate) fn known(report: &str) -> TerminalProperties {
    let end = report.find(|letter: char| letter == '(' || letter.is_ascii_digit());
    let (name, version) = report.split_at(end.unwrap_or(report.len()));
    let name = name.trim().to_ascii_lowercase();
    match &*name {
        "tmux" => return TerminalProperties { is_tmux: true, ..TerminalProperties::default() },
        // Dots: measured with DejaVu. Its quadrants have gaps (notcurses#1517).
        "xterm" => {
            return TerminalProperties {
                colors: TrueColorSupport::Ask,
                shades: ShadeInk::Dots,
                ..TerminalProperties::default()
            };
        }
        _ => {}
    }
    // iTerm2's name ends with a digit.
    let (name, version) = match version.strip_prefix('2') {
        Some(rest) if name == "iterm" => ("iterm2", rest),
        _ => (&*name, version),
    };
    let Some(terminal) = TERMINALS.iter().find(|terminal| terminal.name == name) else {
        return TerminalProperties::default();
    };
    let version = numbers(version);
    let kinds = [GlyphSet::Quadrant, GlyphSet::Sextant, GlyphSet::Octant];
    let mut drawn = kinds.into_iter().zip(terminal.blocks);
    let blocks = drawn.rfind(|(_, since)| since.is_some_and(|since| version >= since));
    TerminalProperties {
        colors: TrueColorSupport::True,
        blocks: blocks.map_or(GlyphSet::Half, |(kind, _)| kind),
        shades: terminal.shades,
        is_tmux: false,
    }
}

/// The first two numbers of a version. Missing ones are 0.
fn numbers(version: &str) -> Version {
    let mut numbers = version
        .trim_start_matches(|letter: char| !letter.is_ascii_digit())
        .split(|letter: char| !letter.is_ascii_digit())
        .map(|digits| digits.parse().unwrap_or_default());
    (numbers.next().unwrap_or_default(), numbers.next().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::ColorDepth::{Indexed16, Indexed256, Mono, True};
    use super::Detected::{Certain, Guess};
    use super::*;

    #[test]
    fn an_unknown_terminal_is_not_asked_for_its_version() {
        let asks = |term: &'static str| {
            let environment = move |name: &str| (name == "TERM").then(|| term.to_owned());
            SessionOptions::from_environment(environment).ask_for_version
        };
        assert!(["xterm", "xterm-256color", "tmux-256color", "konsole"].into_iter().all(asks));
        assert!(!["", "ansi", "eterm-color", "unheard-of"].into_iter().any(asks));
    }

    #[test]
    fn a_terminal_that_prints_the_query_is_not_asked_for_pixels() {
        let asks = |name: &'static str, value: &'static str| {
            let environment = move |asked: &str| (asked == name).then(|| value.to_owned());
            SessionOptions::from_environment(environment).ask_for_mouse_pixels
        };
        assert!(!asks("TERM_PROGRAM", "Apple_Terminal"));
        assert!(asks("TERM_PROGRAM", "iTerm.app") && asks("TERM", "xterm-256color"));
    }

    #[test]
    fn sshd_variables_reveal_a_network() {
        let is_remote = |value: &'static str| {
            let environment =
                move |name: &str| (name == "SSH_CONNECTION").then(|| value.to_owned());
            SessionOptions::from_environment(environment).is_remote
        };
        assert!(is_remote("192.0.2.1 50000 192.0.2.2 22"));
        assert!(!is_remote(""));
    }

    fn asks_for_releases(name: &str, value: &str) -> bool {
        let environment = |asked: &str| (asked == name).then(|| value.to_owned());
        SessionOptions::from_environment(environment).ask_for_key_releases
    }

    #[test]
    fn only_graphical_terminals_are_probed() {
        let probes = |term: &'static str, name: &'static str, value: &'static str| {
            let environment = move |asked: &str| match asked {
                "TERM" => Some(term.to_owned()),
                _ => (asked == name).then(|| value.to_owned()),
            };
            SessionOptions::from_environment(environment).probe_extensions
        };
        assert!(probes("xterm-256color", "", "") && probes("xterm-kitty", "TMUX", ""));
        for term in ["", "dumb", "linux", "screen", "screen-256color", "tmux-256color"] {
            assert!(!probes(term, "", ""), "{term}");
        }
        assert!(!probes("xterm-256color", "TMUX", "/tmp/tmux-1000/default,1,0"));
        assert!(!probes("xterm-256color", "STY", "1.pts-0.host"));
    }

    #[test]
    fn multiplexers_are_not_asked_for_releases() {
        for (name, value) in [
            ("TMUX", "/tmp/tmux-1000/default,1,0"),
            ("STY", "1.pts-0.host"),
            ("TERM", "screen"),
            ("TERM", "screen-256color"),
            ("TERM", "tmux-256color"),
        ] {
            assert!(!asks_for_releases(name, value), "{name}={value}");
        }
        for (name, value) in [("TERM", "xterm-kitty"), ("TMUX", ""), ("TERM", "")] {
            assert!(asks_for_releases(name, value), "{name}={value}");
        }
    }

    #[test]
    fn the_environment_is_read_in_the_documented_order() {
        let cases: [(&str, Detected); 32] = [
            ("", Guess(Indexed256)),
            ("TERM=xterm-256color", Guess(Indexed256)),
            ("TERM=tmux-256color", Guess(Indexed256)),
            ("TERM=screen-256color", Certain(Indexed256)),
            ("TERM=screen", Certain(Indexed256)),
            ("TERM=screen TMUX=socket", Guess(Indexed256)),
            ("TERM=screen TMUX=socket STY=1", Certain(Indexed256)),
            ("TERM=xterm", Guess(Indexed256)),
            ("TERM=xterm-kitty", Certain(True)),
            ("TERM=alacritty", Certain(True)),
            ("TERM=alacritty-direct", Certain(True)),
            ("TERM=foot-extra", Certain(True)),
            ("TERM=footloose", Guess(Indexed256)),
            ("TERM=konsole-direct", Certain(True)),
            ("TERM=linux", Certain(Indexed16)),
            ("TERM=dumb", Certain(Mono)),
            ("TERM=vt100", Certain(Mono)),
            ("TERM=linux COLORTERM=truecolor", Certain(True)),
            ("TERM=xterm COLORTERM=24bit", Certain(True)),
            ("TERM=xterm COLORTERM=yes", Guess(Indexed256)),
            ("TERM=xterm-kitty NO_COLOR=1", Certain(Mono)),
            ("TERM=xterm-kitty NO_COLOR=", Certain(True)),
            ("NO_COLOR=1 FORCE_COLOR=3", Certain(Mono)),
            ("COLORTERM=truecolor FORCE_COLOR=0", Certain(Mono)),
            ("COLORTERM=truecolor FORCE_COLOR=1", Certain(Indexed16)),
            ("TERM=dumb FORCE_COLOR=2", Certain(Indexed256)),
            ("TERM=dumb FORCE_COLOR=3", Certain(True)),
            ("TERM=dumb FORCE_COLOR=", Certain(Indexed16)),
            ("TERM=dumb FORCE_COLOR=true", Certain(Indexed16)),
            ("TERM=dumb CLICOLOR_FORCE=1", Certain(Indexed16)),
            ("TERM=dumb CLICOLOR_FORCE=0", Certain(Mono)),
            ("TERM=xterm-kitty CLICOLOR_FORCE=1", Certain(True)),
        ];
        for (variables, expected) in cases {
            let environment = |name: &str| {
                variables
                    .split_whitespace()
                    .filter_map(|pair| pair.split_once('='))
                    .find(|(known, _)| *known == name)
                    .map(|(_, value)| value.to_owned())
            };
            assert_eq!(detect(environment).0, expected, "{variables}");
        }
    }

    fn environment(variables: &str) -> impl Fn(&str) -> Option<String> {
        move |name| {
            let pairs = variables.split_whitespace().filter_map(|pair| pair.split_once('='));
            pairs.into_iter().find(|(known, _)| *known == name).map(|(_, value)| value.to_owned())
        }
    }

    #[test]
    fn the_first_setting_of_the_locale_counts() {
        for (variables, said) in [
            ("", None),
            ("LANG=", None),
            ("LANG=en_GB.UTF-8", None),
            ("LANG=C.utf8", None),
            ("LC_CTYPE=UTF-8", None),
            ("LANG=C", Some("LANG=C")),
            ("LANG=en_US", Some("LANG=en_US")),
            ("LANG=ru_RU.KOI8-R", Some("LANG=ru_RU.KOI8-R")),
            ("LANG=C.UTF-8 LC_ALL=POSIX", Some("LC_ALL=POSIX")),
            ("LANG=C LC_ALL=C.UTF-8", None),
            ("LANG=C LC_CTYPE=de_DE.UTF-8 LC_ALL=", None),
            ("LANG=C.UTF-8 LC_CTYPE=C", Some("LC_CTYPE=C")),
            ("LANG=C.UTF-8 LC_MESSAGES=C", None),
        ] {
            let found = locale_without_utf8(environment(variables));
            assert_eq!(found.as_deref(), said, "{variables}");
        }
    }

    #[test]
    fn only_terminals_without_cursor_motion_count_as_teletypes() {
        for term in ["TERM=dumb", "TERM=unknown", "TERM=tty33"] {
            assert!(teletype(environment(term)).is_some(), "{term}");
        }
        for term in ["", "TERM=", "TERM=xterm", "TERM=vt52", "TERM=dumber", "TERM=no-such"] {
            assert_eq!(teletype(environment(term)), None, "{term}");
        }
    }

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
            assert_eq!(known(report).colors, TrueColorSupport::True, "{report}");
        }
        for report in ["tmux 3.3a", "footer 1", "xterm 1.js", "(1.0)", "\u{9b}kitty(1)"] {
            assert_ne!(known(report).colors, TrueColorSupport::True, "{report}");
        }
        assert_eq!(known("XTerm(379)").colors, TrueColorSupport::Ask);
        assert!(known("tmux 3.5").is_tmux);
    }
}
