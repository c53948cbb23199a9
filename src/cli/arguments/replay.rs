//! The options of `replay`.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{ArgAction, ArgMatches, ValueHint};

use super::generated::{self, Generated};
use super::option::{FileOption, Flag};
use super::value::{self, FramesPerSecond, Size};
use super::{Command, Error, Positional, Subcommand, map};
use crate::color::palette::ColorDepth;
use crate::terminal::Fidelity;
use crate::world::FieldOfView;

/// Options of `replay`.
#[derive(Debug)]
pub(crate) struct Replay {
    pub(crate) script: PathBuf,
    pub(crate) map: Option<OsString>,
    /// The generated level instead of a map.
    pub(crate) generated: Option<Generated>,
    /// Whether to say what the script achieves instead of recording it.
    pub(crate) verifies: bool,
    /// The file of the recording; standard output if `None`.
    pub(crate) cast: Option<PathBuf>,
    pub(crate) size: Size,
    pub(crate) frames_per_second: FramesPerSecond,
    pub(crate) field_of_view: FieldOfView,
    pub(crate) depth: ColorDepth,
    pub(crate) fidelity: Fidelity,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "replay",
    about: "Play a script off screen, and write it as asciicast, or check what it achieves",
    details: "A script is lines such as \"2.5 s forward run\" or \"12 steps turn-left open\"; \"stand\" \
              is nothing, [walking] begins a section, and # a comment. Lines at its top may name the game: \
              \"level cellar\", \"difficulty hard\" and \"seed 7\"; a level may also be a map file, or \"floor 1\" \
              of an endless game, which goes on with the floors below. MAP takes precedence. play --record \
              writes such a script.",
    examples: "cellcaster replay walk.script > walk.cast\n\
               cellcaster replay walk.script my.toml --size 120x40 --cast walk.cast\n\
               cellcaster replay walk.script --verify",
    positionals: &[SCRIPT, map::OPTIONAL],
    options: &[
        &VERIFY,
        &CAST,
        &value::WINDOW_SIZE,
        &value::FRAMES_PER_SECOND,
        &value::FIELD_OF_VIEW,
        &value::COLORS,
        &value::FIDELITY,
        &generated::GENERATE,
        &generated::SEED,
        &generated::LEVEL_SIZE,
        &generated::START,
    ],
    surplus: "takes a script and one map",
    missing: MISSING,
    read,
};

const MISSING: &str = "replay takes a script, as in \"cellcaster replay walk.script\"";

fn read(mut matches: ArgMatches) -> Result<Command, Error> {
    let script: Option<OsString> = matches.remove_one(SCRIPT.name);
    let map = map::of(&mut matches);
    let generated = generated::of(&mut matches, map.as_deref())?;
    Ok(Command::Replay(Replay {
        script: script.ok_or_else(|| Error::mistake(MISSING))?.into(),
        map,
        generated,
        verifies: VERIFY.of(&matches),
        cast: CAST.of(&mut matches),
        size: value::WINDOW_SIZE.of(&mut matches).unwrap_or_default(),
        frames_per_second: value::FRAMES_PER_SECOND.of(&mut matches).unwrap_or_default(),
        field_of_view: value::FIELD_OF_VIEW.of(&mut matches).unwrap_or_default(),
        depth: value::COLORS.of(&mut matches).unwrap_or_default(),
        fidelity: value::FIDELITY.of(&mut matches).unwrap_or_default(),
    }))
}

const SCRIPT: Positional = Positional {
    name: "SCRIPT",
    help: "What is played",
    is_required: true,
    action: ArgAction::Set,
    hint: ValueHint::FilePath,
    choices: &[],
};

const VERIFY: Flag = Flag {
    name: "verify",
    help: "Say level, time, treasure and rank instead; the exit status is 0 if the \
           script reaches an exit, else 1",
};

const CAST: FileOption =
    FileOption { name: "cast", help: "Where to write [default: standard output]" };
