//! Properties of the terminal from the environment, besides its colours: whether the game can run
//! on it, and which characters it shows.
//!
//! Missing variables do not restrict the game: containers and `ssh` often set neither a locale nor
//! `TERM`, in terminals that show UTF-8 and know every sequence. A program that aborts there, or
//! that draws with letters, was refused.

/// Values of `TERM` for terminals that cannot move their cursors, all without `cup` in the database
/// of terminals: those that programs and systems set, and teletypes.
const TELETYPES: [&str; 12] = [
    "dumb", "unknown", "vanilla", "emacs", "glasstty", "printer", "lpr", "tty33", "tty35", "tty37",
    "tty40", "tty43",
];

/// The value of `TERM` in `environment`, which looks up variables by name, if it is that of a
/// terminal that cannot move its cursor.
pub(crate) fn teletype(environment: impl Fn(&str) -> Option<String>) -> Option<&'static str> {
    let term = environment("TERM")?;
    TELETYPES.into_iter().find(|&known| known == term)
}

/// The setting of the locale in `environment`, such as `LANG=C`, if it is not a setting for UTF-8.
/// `None` if it is, and without a setting, since most terminals show UTF-8.
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

#[cfg(test)]
mod tests {
    use super::*;

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
    fn only_terminals_without_cursor_motion_are_teletypes() {
        for term in ["TERM=dumb", "TERM=unknown", "TERM=tty33"] {
            assert!(teletype(environment(term)).is_some(), "{term}");
        }
        for term in ["", "TERM=", "TERM=xterm", "TERM=vt52", "TERM=dumber", "TERM=no-such"] {
            assert_eq!(teletype(environment(term)), None, "{term}");
        }
    }
}
