//! What a visitor's client says of their terminal.

use crate::ssh::Visitor;
use cellcaster::terminal::{Options, locale_without_utf8};

/// What is known of a visitor's terminal.
pub(crate) fn options(visitor: &Visitor) -> Options {
    Options {
        is_remote: true,
        is_ascii: ascii_locale(visitor).is_some(),
        ..Options::from_environment(|name| variable(visitor, name))
    }
}

/// The setting of the visitor's locale that restricts them to ASCII. `None` for UTF-8, and if their
/// client sends no locale.
pub(crate) fn ascii_locale(visitor: &Visitor) -> Option<String> {
    locale_without_utf8(|name| variable(visitor, name))
}

/// A sentence for a visitor whose terminal cannot show the game.
pub(crate) fn refusal(visitor: &Visitor) -> Option<String> {
    let term = options(visitor).teletype?;
    Some(format!(
        "TERM is {term}, a terminal that cannot move its cursor, which playing needs. Set it to what \
         you have, such as TERM=xterm-256color."
    ))
}

fn variable(visitor: &Visitor, name: &str) -> Option<String> {
    match name {
        "TERM" => Some(visitor.term.clone()),
        _ => visitor.environment.get(name).cloned(),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::net::SocketAddr;

    use super::*;
    use cellcaster::color::palette::ColorDepth;
    use cellcaster::terminal::WindowSize;

    fn visitor(term: &str, variables: &str) -> Visitor {
        let pairs = variables.split_whitespace().filter_map(|pair| pair.split_once('='));
        let environment: BTreeMap<String, String> =
            pairs.map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
        Visitor {
            peer: SocketAddr::from(([192, 0, 2, 1], 50_000)),
            key: None,
            notice: None,
            user: "ann".to_owned(),
            term: term.to_owned(),
            environment,
            size: WindowSize::of_cells(80, 24),
            compresses: false,
        }
    }

    #[test]
    fn the_locale_that_a_client_sends_decides_on_ascii() {
        for (variables, setting) in [
            ("", None),
            ("LANG=en_GB.UTF-8 LC_TIME=C", None),
            ("LANG=C", Some("LANG=C")),
            ("LANG=en_GB.UTF-8 LC_ALL=C", Some("LC_ALL=C")),
            ("LANG=C LC_CTYPE=C.UTF-8", None),
        ] {
            let visitor = visitor("xterm-256color", variables);
            assert_eq!(ascii_locale(&visitor).as_deref(), setting, "{variables}");
            assert_eq!(options(&visitor).is_ascii, setting.is_some(), "{variables}");
        }
    }

    #[test]
    fn only_terminals_without_cursor_motion_are_refused() {
        for term in ["dumb", "unknown", "tty33"] {
            assert!(refusal(&visitor(term, "")).is_some_and(|it| it.contains(term)), "{term}");
        }
        for term in ["", "linux", "vt100", "no-such", "xterm-256color"] {
            assert_eq!(refusal(&visitor(term, "")), None, "{term}");
        }
    }

    #[test]
    fn a_linux_console_is_queried_for_nothing_that_it_prints() {
        let options = options(&visitor("linux", ""));
        assert!(!options.probe_extensions && !options.ask_for_version && !options.is_ascii);
        assert_eq!(options.color_depth.depth(), ColorDepth::Indexed16);
    }
}
