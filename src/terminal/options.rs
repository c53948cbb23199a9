//! What is known of a terminal at first, and how to use it.

use super::environment::teletype;
use super::{ColorSource, Detected, Fidelity, color_depth, color_source};

/// The properties of a terminal that are known at first, and how to use it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a question of its own")]
pub struct Options {
    /// The terminal's number of colours. If it is a guess, the terminal is queried.
    pub color_depth: Detected,
    /// The source of the colour depth.
    pub color_source: ColorSource,
    /// The terminal's name in `TERM`, if the terminal cannot move its cursor.
    pub teletype: Option<&'static str>,
    /// Whether the terminal shows only ASCII. Other characters are replaced by similar ones.
    pub is_ascii: bool,
    /// Whether to request reports of key releases.
    pub ask_for_key_releases: bool,
    /// Whether to ask if mouse positions can be in pixels.
    pub ask_for_mouse_pixels: bool,
    /// Whether to ask for the terminal's name and version.
    pub ask_for_version: bool,
    /// Whether the program runs in a tmux of this machine, which a [`Session`](super::Session) asks
    /// about the terminal around it.
    pub ask_tmux: bool,
    /// Whether the terminal is across a network. The first frame is then coarse; later frames make
    /// it exact.
    pub is_remote: bool,
    /// Whether to probe control sequences that make frames shorter (repeated characters and the
    /// palette), and to use those that work.
    pub probe_extensions: bool,
    /// The fidelity of frames; `None` for the best that the link allows.
    pub fidelity: Option<Fidelity>,
}

impl Options {
    /// Options from `environment`, which looks up variables by name.
    ///
    /// Control sequences that make frames shorter are not probed in a terminal multiplexer, nor in
    /// a terminal that is unknown or has no window.
    ///
    /// A multiplexer is not asked for key releases: those that support them lose some, and a key
    /// whose release is lost is held for ever. Nor is it asked for pixels, since it has none of its
    /// own.
    ///
    /// Apple's Terminal is not asked for pixels: it prints the last character of that query
    /// (DECRQM). A terminal that is unknown by its `TERM` is not asked for its version, since some
    /// would print that query.
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
        Self {
            color_depth: color_depth(&environment),
            color_source: color_source(&environment),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_terminal_is_not_asked_for_its_version() {
        let asks = |term: &'static str| {
            let environment = move |name: &str| (name == "TERM").then(|| term.to_owned());
            Options::from_environment(environment).ask_for_version
        };
        assert!(["xterm", "xterm-256color", "tmux-256color", "konsole"].into_iter().all(asks));
        assert!(!["", "ansi", "eterm-color", "unheard-of"].into_iter().any(asks));
    }

    #[test]
    fn a_terminal_that_prints_the_query_is_not_asked_for_pixels() {
        let asks = |name: &'static str, value: &'static str| {
            let environment = move |asked: &str| (asked == name).then(|| value.to_owned());
            Options::from_environment(environment).ask_for_mouse_pixels
        };
        assert!(!asks("TERM_PROGRAM", "Apple_Terminal"));
        assert!(asks("TERM_PROGRAM", "iTerm.app") && asks("TERM", "xterm-256color"));
    }

    #[test]
    fn a_network_is_known_by_the_variables_of_sshd() {
        let is_remote = |value: &'static str| {
            let environment =
                move |name: &str| (name == "SSH_CONNECTION").then(|| value.to_owned());
            Options::from_environment(environment).is_remote
        };
        assert!(is_remote("192.0.2.1 50000 192.0.2.2 22"));
        assert!(!is_remote(""));
    }

    fn asks_for_releases(name: &str, value: &str) -> bool {
        let environment = |asked: &str| (asked == name).then(|| value.to_owned());
        Options::from_environment(environment).ask_for_key_releases
    }

    #[test]
    fn only_terminals_in_windows_are_probed() {
        let probes = |term: &'static str, name: &'static str, value: &'static str| {
            let environment = move |asked: &str| match asked {
                "TERM" => Some(term.to_owned()),
                _ => (asked == name).then(|| value.to_owned()),
            };
            Options::from_environment(environment).probe_extensions
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
}
