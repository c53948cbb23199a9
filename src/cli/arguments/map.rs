//! The argument MAP of most subcommands.

use std::ffi::OsString;

use clap::{ArgAction, ArgMatches, ValueHint};

use super::Positional;

/// The name for a map on standard input.
pub(crate) const STANDARD_INPUT: &str = "-";

/// A map, or the first built-in level.
pub(crate) const OPTIONAL: Positional = Positional {
    name: NAME,
    help: "A map file, \"-\" for standard input, or a built-in level, as \"cellcaster levels\" lists them",
    is_required: false,
    action: ArgAction::Set,
    hint: ValueHint::FilePath,
    choices: &[],
};

/// One or more maps.
pub(crate) const SEVERAL: Positional = Positional {
    help: "Map files, or \"-\" for standard input",
    is_required: true,
    action: ArgAction::Append,
    ..OPTIONAL
};

const NAME: &str = "MAP";

/// The named map.
pub(crate) fn of(matches: &mut ArgMatches) -> Option<OsString> {
    matches.remove_one(NAME)
}

/// The named maps.
pub(crate) fn all_of(matches: &mut ArgMatches) -> Vec<OsString> {
    matches.remove_many(NAME).map(Iterator::collect).unwrap_or_default()
}
