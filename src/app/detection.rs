//! What was found out about the terminal that makes the game look or feel worse than it could, why that
//! is so, and what helps: lines for the help, where people look.

use crate::color::palette::ColorDepth;
use crate::terminal::ColorSource;

/// What is known of the terminal.
#[derive(Clone, Debug, Default)]
pub(super) struct Detection {
    pub(super) depth: ColorDepth,
    /// What said how many colours there are; `None` for the command line or the configuration.
    pub(super) source: Option<ColorSource>,
    /// Whether it reports when keys are released; `None` where it has not said yet.
    pub(super) reports_releases: Option<bool>,
    /// The setting of the locale because of which everything is shown in ASCII.
    pub(super) ascii_locale: Option<String>,
}

impl Detection {
    /// A line for each thing that could be better.
    pub(super) fn lines(&self) -> impl Iterator<Item = String> {
        [self.colors(), self.releases(), self.characters()].into_iter().flatten()
    }

    /// Why there are not all colours.
    fn colors(&self) -> Option<String> {
        let count = match self.depth {
            ColorDepth::True => return None,
            ColorDepth::Indexed256 => "256 colours",
            ColorDepth::Indexed16 => "16 colours",
            ColorDepth::Mono => "no colours",
        };
        let reason = match self.source {
            None => "--colors or the configuration says so",
            Some(ColorSource::NoColor) => "NO_COLOR is set",
            Some(ColorSource::ForceColor) => "FORCE_COLOR or CLICOLOR_FORCE says so",
            Some(ColorSource::Term) => "TERM names no more; see docs/terminals.md",
            Some(ColorSource::ColorTerm | ColorSource::Answer | ColorSource::Nothing) => {
                "your terminal did not offer more; see docs/terminals.md"
            }
        };
        Some(format!("{count}: {reason}"))
    }

    /// That keys are guessed.
    fn releases(&self) -> Option<String> {
        (self.reports_releases == Some(false)).then(|| {
            "no key releases: keys are held while they repeat; see docs/keys.md".to_owned()
        })
    }

    /// Why there are no blocks and lines.
    fn characters(&self) -> Option<String> {
        let setting = self.ascii_locale.as_ref()?;
        Some(format!("ASCII only: {setting} is not UTF-8; try --glyphs half"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(detection: &Detection) -> Vec<String> {
        detection.lines().collect()
    }

    #[test]
    fn the_best_terminal_needs_no_line() {
        let best = Detection {
            depth: ColorDepth::True,
            source: Some(ColorSource::Answer),
            reports_releases: Some(true),
            ascii_locale: None,
        };
        assert_eq!(lines(&best), [""; 0]);
    }

    #[test]
    fn every_line_says_what_is_so_and_why() {
        let plain = Detection {
            depth: ColorDepth::Indexed256,
            source: Some(ColorSource::Nothing),
            reports_releases: Some(false),
            ascii_locale: Some("LANG=C".to_owned()),
        };
        insta::assert_snapshot!(lines(&plain).join("\n"), @r"
        256 colours: your terminal did not offer more; see docs/terminals.md
        no key releases: keys are held while they repeat; see docs/keys.md
        ASCII only: LANG=C is not UTF-8; try --glyphs half
        ");
        for (source, said) in [
            (None, "no colours: --colors or the configuration says so"),
            (Some(ColorSource::NoColor), "no colours: NO_COLOR is set"),
            (Some(ColorSource::Term), "no colours: TERM names no more; see docs/terminals.md"),
        ] {
            let mono = Detection { depth: ColorDepth::Mono, source, ..Detection::default() };
            assert_eq!(lines(&mono), [said]);
        }
    }
}
