//! The number of colours that the terminal shows, as far as its environment says it.
//!
//! The user's choice comes first (`NO_COLOR`, `FORCE_COLOR`, `CLICOLOR_FORCE`), then the terminal's
//! own claims (`COLORTERM`, `TERM`), then a guess that a query may raise. A database of terminals
//! was refused: half of the machines lack it, and it has wrong numbers of colours on others.

use crate::color::palette::ColorDepth;

/// The colour depth that an environment implies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detected {
    /// A depth that no answer of the terminal would change.
    Certain(ColorDepth),
    /// The greatest safe depth until the terminal has been queried.
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
    /// The answer of tmux about the terminal around it.
    Tmux,
    /// No evidence; the depth is that of most terminals.
    Nothing,
}

/// The colour depth that `environment` implies, which looks up variables by name.
pub fn color_depth(environment: impl Fn(&str) -> Option<String>) -> Detected {
    detect(environment).0
}

/// The evidence for the [`color_depth`] in `environment`.
pub fn color_source(environment: impl Fn(&str) -> Option<String>) -> ColorSource {
    detect(environment).1
}

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
        // tmux passes on the variable of the terminal in which it began, and knows better itself.
        let is_certain = variable("TMUX").is_none();
        let depth = if is_certain { Detected::Certain } else { Detected::Guess };
        return (depth(ColorDepth::True), ColorTerm);
    }
    let named = variable("TERM").map_or(Detected::Guess(ColorDepth::Indexed256), |term| of(&term));
    // In tmux, TERM may be `screen`, whatever tmux sends.
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
        // It forwards the query to the terminal around it, whose answer does not apply to it.
        Detected::Certain(ColorDepth::Indexed256)
    } else {
        Detected::Guess(ColorDepth::Indexed256)
    }
}

#[cfg(test)]
mod tests {
    use super::ColorDepth::{Indexed16, Indexed256, Mono, True};
    use super::Detected::{Certain, Guess};
    use super::*;

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
            assert_eq!(color_depth(environment), expected, "{variables}");
        }
    }
}
