//! The arguments of `check`.

use clap::ArgMatches;

use super::{Command, Error, Subcommand, map};

pub(super) const SUBCOMMAND: Subcommand = Subcommand {
    name: "check",
    about: "Say everything that is wrong with maps",
    details: "Names every fault of every map, each with its place and what to write instead. The exit \
              status is 0 where all maps are right, and 2 where one is not.",
    examples: "cellcaster check maps/*.toml",
    positionals: &[map::SEVERAL],
    options: &[],
    surplus: "",
    missing: "check takes at least one map, as in \"cellcaster check my.toml\"",
    read,
};

fn read(mut matches: ArgMatches) -> Result<Command, Error> {
    let maps = map::all_of(&mut matches);
    if maps.iter().filter(|map| *map == map::STANDARD_INPUT).count() > 1 {
        return Err(Error::mistake("standard input holds one map, and \"-\" stands there twice"));
    }
    Ok(Command::Check(maps))
}
