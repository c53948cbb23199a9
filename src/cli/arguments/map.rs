//! The argument MAP, which most subcommands take.

use std::ffi::OsString;

use clap::{ArgAction, ArgMatches, ValueHint};

use super::Positional;

/// What stands for the map that standard input holds.
pub(in crate::cli) const STANDARD_INPUT: &str = "-";

/// A map, or the first built-in level.
pub(super) const OPTIONAL: Positional = Positional {
    name: NAME,
    help: "A map file, \"-\" for standard input, or a built-in level: cellar, museum, citadel, cistern \
           or observatory",
    is_required: false,
    action: ArgAction::Set,
    hint: ValueHint::FilePath,
    choices: &[],
};

/// At least one map.
pub(super) const SEVERAL: Positional = Positional {
    help: "Map files, or \"-\" for standard input",
    is_required: true,
    action: ArgAction::Append,
    ..OPTIONAL
};

const NAME: &str = "MAP";

/// The map that was named.
pub(super) fn of(matches: &mut ArgMatches) -> Option<OsString> {
    matches.remove_one(NAME)
}

/// The maps that were named.
pub(super) fn all_of(matches: &mut ArgMatches) -> Vec<OsString> {
    matches.remove_many(NAME).map(Iterator::collect).unwrap_or_default()
}
