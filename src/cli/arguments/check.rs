//! The arguments of `check`.

use std::ffi::OsString;

use clap::ArgMatches;

use super::option::{Parser, ValueOption};
use super::{Command, Error, Subcommand, map};

/// Options of `check`.
#[derive(Debug)]
pub(crate) struct Check {
    pub(crate) maps: Vec<OsString>,
    /// Whether a remark counts as a fault.
    pub(crate) deny_remarks: bool,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "check",
    about: "Say everything that is wrong with maps",
    details: "Names every fault of every map, each with its place and what to write instead. The exit \
              status is 0 if all maps are right, and 2 if one is not. Remarks on a level without an \
              exit, or with one that nobody can reach, leave it at 0.",
    examples: "cellcaster check maps/*.toml\n\
               cellcaster check --deny remarks my.toml",
    positionals: &[map::SEVERAL],
    options: &[&DENY],
    surplus: "",
    missing: "check takes at least one map, as in \"cellcaster check my.toml\"",
    read,
};

const DENY: ValueOption<()> = ValueOption {
    name: "deny",
    value: "KIND",
    takes: "remarks",
    help: "End with status 2 after a remark, too",
    default: "",
    choices: &["remarks"],
    read: Parser::Optional(|text| (text == "remarks").then_some(())),
};

fn read(mut matches: ArgMatches) -> Result<Command, Error> {
    let maps = map::all_of(&mut matches);
    if maps.iter().filter(|map| *map == map::STANDARD_INPUT).count() > 1 {
        return Err(Error::mistake("standard input holds one map, and \"-\" stands there twice"));
    }
    let deny_remarks = DENY.of(&mut matches).is_some();
    Ok(Command::Check(Check { maps, deny_remarks }))
}
