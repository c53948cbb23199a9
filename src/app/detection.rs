//! Limits of the terminal that degrade the picture or the controls, each with its reason and
//! remedy. The help page shows these lines, because users look for them there.

use crate::color::palette::ColorDepth;
use crate::terminal::{ColorSource, Protocol, TmuxClient};

/// The known properties of the terminal.
#[derive(Clone, Debug, Default)]
pub struct Detection {
    /// The colour depth.
    pub depth: ColorDepth,
    /// The source of the colour depth; `None` if the command line or the configuration sets it.
    pub source: Option<ColorSource>,
    /// `true` if the terminal is tmux.
    pub is_tmux: bool,
    /// The outer terminal of tmux, if tmux has named it.
    pub tmux: Option<TmuxClient>,
    /// `true` if the terminal reports key releases; `None` while that is unknown.
    pub reports_releases: Option<bool>,
    /// The locale setting that restricts output to ASCII.
    pub ascii_locale: Option<String>,
    /// `true` for a visitor without a command line, who makes these choices in the settings.
    pub is_visitor: bool,
}

impl Detection {
    /// Records what `protocol` has learned about the terminal. `is_chosen` means that the player
    /// chose `depth`.
    pub fn follow(&mut self, protocol: &Protocol, depth: ColorDepth, is_chosen: bool) {
        self.depth = depth;
        self.source = (!is_chosen).then(|| protocol.color_source());
        self.is_tmux = protocol.is_tmux();
        self.tmux = protocol.tmux_client().cloned();
    }

    /// One line for each limit.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        [self.colors(), self.releases(), self.characters()].into_iter().flatten()
    }

    /// The reason for a reduced colour depth.
    fn colors(&self) -> Option<String> {
        let count = match self.depth {
            ColorDepth::True if self.source == Some(ColorSource::Palette) => {
                return Some(
                    "24-bit colours in a palette of 232: your terminal did not offer more"
                        .to_owned(),
                );
            }
            ColorDepth::True => return None,
            ColorDepth::Indexed256 => "256 colours",
            ColorDepth::Indexed16 => "16 colours",
            ColorDepth::Mono => "no colours",
        };
        let reason = match self.source {
            None if self.is_visitor => "your settings say so",
            None => "--colors or the configuration says so",
            Some(ColorSource::NoColor) => "NO_COLOR is set",
            Some(ColorSource::ForceColor) => "FORCE_COLOR or CLICOLOR_FORCE says so",
            Some(ColorSource::Term) => "limited by TERM; see docs/terminals.md",
            Some(ColorSource::Tmux) => return Some(format!("{count}: {}", self.tmux())),
            Some(ColorSource::Nothing) if self.is_tmux => {
                "tmux did not report the outer terminal; see docs/terminals.md"
            }
            Some(
                ColorSource::ColorTerm
                | ColorSource::Answer
                | ColorSource::Palette
                | ColorSource::Nothing,
            ) => "your terminal did not offer more; see docs/terminals.md",
        };
        Some(format!("{count}: {reason}"))
    }

    /// The reason why tmux does not send 24-bit colours, and the remedy.
    fn tmux(&self) -> String {
        match self.tmux.as_ref().and_then(TmuxClient::remedy) {
            Some(remedy) => format!(
                "tmux sends your terminal no more. Add to ~/.tmux.conf: {remedy} (or run: tmux \
                 {remedy}), then detach and attach again"
            ),
            None => "tmux sends your terminal no more; see docs/terminals.md".to_owned(),
        }
    }

    /// The line about key releases that the terminal does not report.
    fn releases(&self) -> Option<String> {
        (self.reports_releases == Some(false)).then(|| {
            "no key releases: a key counts as held while it repeats; see docs/keys.md".to_owned()
        })
    }

    /// The reason why only ASCII is shown.
    fn characters(&self) -> Option<String> {
        let setting = self.ascii_locale.as_ref()?;
        let remedy =
            if self.is_visitor { "see Characters in the settings" } else { "try --glyphs half" };
        Some(format!("ASCII only: {setting} is not UTF-8; {remedy}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(detection: &Detection) -> Vec<String> {
        detection.lines().collect()
    }

    #[test]
    fn a_terminal_without_limits_has_no_lines() {
        let best = Detection {
            depth: ColorDepth::True,
            source: Some(ColorSource::Answer),
            is_tmux: false,
            tmux: None,
            reports_releases: Some(true),
            ascii_locale: None,
            is_visitor: false,
        };
        assert_eq!(lines(&best), [""; 0]);
    }

    #[test]
    fn the_tmux_line_says_how_to_get_more() {
        let said = |answer, depth, source| {
            let tmux = TmuxClient::parse(answer);
            let detection =
                Detection { depth, source, tmux, is_tmux: true, ..Detection::default() };
            lines(&detection).join("\n")
        };
        let few = ColorDepth::Indexed256;
        let tmux = Some(ColorSource::Tmux);
        insta::assert_snapshot!(said("title|kitty(0.42.1)|xterm-kitty", few, tmux), @"256 colours: tmux sends your terminal no more. Add to ~/.tmux.conf: set -as terminal-features ',xterm-kitty:RGB' (or run: tmux set -as terminal-features ',xterm-kitty:RGB'), then detach and attach again");
        insta::assert_snapshot!(said("title||vt340", few, tmux), @"256 colours: tmux sends your terminal no more; see docs/terminals.md");
        insta::assert_snapshot!(said("", few, Some(ColorSource::Nothing)), @"256 colours: tmux did not report the outer terminal; see docs/terminals.md");
        assert_eq!(said("RGB|iTerm2 3.5|xterm-256color", ColorDepth::True, tmux), "");
        let own = Some(ColorSource::Palette);
        insta::assert_snapshot!(said("", ColorDepth::True, own), @"24-bit colours in a palette of 232: your terminal did not offer more");
    }

    #[test]
    fn every_line_names_a_limit_and_its_reason() {
        let plain = Detection {
            depth: ColorDepth::Indexed256,
            source: Some(ColorSource::Nothing),
            is_tmux: false,
            tmux: None,
            reports_releases: Some(false),
            ascii_locale: Some("LANG=C".to_owned()),
            is_visitor: false,
        };
        insta::assert_snapshot!(lines(&plain).join("\n"), @r"
        256 colours: your terminal did not offer more; see docs/terminals.md
        no key releases: a key counts as held while it repeats; see docs/keys.md
        ASCII only: LANG=C is not UTF-8; try --glyphs half
        ");
        let visitor = Detection { source: None, is_visitor: true, ..plain };
        insta::assert_snapshot!(lines(&visitor).join("\n"), @r"
        256 colours: your settings say so
        no key releases: a key counts as held while it repeats; see docs/keys.md
        ASCII only: LANG=C is not UTF-8; see Characters in the settings
        ");
        for (source, said) in [
            (None, "no colours: --colors or the configuration says so"),
            (Some(ColorSource::NoColor), "no colours: NO_COLOR is set"),
            (Some(ColorSource::Term), "no colours: limited by TERM; see docs/terminals.md"),
        ] {
            let mono = Detection { depth: ColorDepth::Mono, source, ..Detection::default() };
            assert_eq!(lines(&mono), [said]);
        }
    }
}
