//! The options of `cast`.

use std::ffi::OsString;

use clap::ArgMatches;

use super::{Command, Error, Subcommand, map, value};

/// Options of `cast`.
#[derive(Debug)]
pub(crate) struct Cast {
    pub(crate) map: Option<OsString>,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "cast",
    about: "Rays from standard input, hits to standard output",
    details: r##"Reads one ray a line, "X Y DX DY", and writes one JSON object a line:

{"cell":[c,r],"side":"x","t":1.5,"u":0.25,"tile":"#"}  what the ray hits
{"escaped":true}   for a ray that leaves the map
{"error":"..."}    for a line that is not a ray; the exit status is then 2"##,
    examples: r#"echo "1.5 1.5 1 0" | cellcaster cast my.toml"#,
    positionals: &[map::OPTIONAL],
    options: &[&value::CASTER],
    surplus: "takes one map",
    missing: "",
    read,
};

fn read(mut matches: ArgMatches) -> Result<Command, Error> {
    let map = map::of(&mut matches);
    if map.as_ref().is_some_and(|map| map == map::STANDARD_INPUT) {
        return Err(Error::mistake(
            "cast reads rays from standard input, so the map can't come from there, too; \
             name a file",
        ));
    }
    Ok(Command::Cast(Cast { map }))
}
