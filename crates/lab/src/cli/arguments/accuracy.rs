//! The options of `accuracy`.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::ArgMatches;

use cellcaster::cli::arguments::option::{FileOption, Parser, ValueOption};
use cellcaster::cli::arguments::{Command, Subcommand, map, value};
use crate::accuracy::Part;
use crate::casters::Method;

/// Options of `accuracy`.
#[derive(Debug)]
pub(crate) struct Accuracy {
    pub(crate) map: Option<OsString>,
    /// All parts if empty.
    pub(crate) parts: Vec<Part>,
    pub(crate) set: Option<String>,
    /// All methods if empty.
    pub(crate) methods: Vec<Method>,
    /// The number of rays in each scene.
    pub(crate) rays: Option<usize>,
    pub(crate) seed: Option<u64>,
    pub(crate) rounds: Option<usize>,
    /// Per second.
    pub(crate) friction: Option<f64>,
    pub(crate) steps_per_second: Option<f64>,
    pub(crate) format: ReportFormat,
    /// The page whose tables are replaced.
    pub(crate) page: Option<PathBuf>,
}

/// The format of a report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum ReportFormat {
    #[default]
    Table,
    Markdown,
    Json,
    Csv,
    Svg,
    Png,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "accuracy",
    about: "Errors of everything that has a truth, against what it costs",
    details: "Casts rays by every method, draws pictures with every filter and integrates motions, \
              and compares each with an exact or a finer calculation. Without MAP and --set it takes \
              four scenes, and then every stiff and extreme set. All formats have the same figures. \
              Only times differ from run to run.",
    examples: r#"cellcaster accuracy --caster exact --caster dda --set "through corners"
cellcaster accuracy --part pictures citadel
cellcaster accuracy --part rays --format svg > rays.svg"#,
    positionals: &[map::OPTIONAL],
    options: &[
        &PART,
        &CASTER,
        &SET,
        &RAYS,
        &SEED,
        &ROUNDS,
        &FRICTION,
        &STEPS_PER_SECOND,
        &FORMAT,
        &PAGE,
    ],
    surplus: "takes one map",
    missing: "",
    read: |matches| Ok(Command::Accuracy(read(matches))),
};

fn read(mut matches: ArgMatches) -> Accuracy {
    Accuracy {
        map: map::of(&mut matches),
        parts: PART.all_of(&mut matches),
        set: SET.of(&mut matches),
        methods: CASTER.all_of(&mut matches),
        rays: RAYS.of(&mut matches),
        seed: SEED.of(&mut matches),
        rounds: ROUNDS.of(&mut matches),
        friction: FRICTION.of(&mut matches),
        steps_per_second: STEPS_PER_SECOND.of(&mut matches),
        format: FORMAT.of(&mut matches).unwrap_or_default(),
        page: PAGE.of(&mut matches),
    }
}

const PART: ValueOption<Part> = ValueOption {
    name: "part",
    value: "PART",
    takes: "rays, pictures, motion or features",
    help: "Report on this part; may be repeated",
    default: "all",
    choices: &["rays", "pictures", "motion", "features"],
    read: Parser::Optional(|text| Part::ALL.into_iter().find(|part| part.name() == text)),
    repeats: true,
};

const CASTER: ValueOption<Method> = ValueOption {
    help: "Report on this method; may be repeated: exact, dda, dda32, accumulate, fixed:BITS, \
           table:ANGLES or march:STEP",
    default: "all",
    repeats: true,
    ..value::CASTER
};

const SET: ValueOption<String> = ValueOption {
    name: "set",
    value: "NAME",
    takes: "the name of a set",
    help: "Cast the rays of one set, such as \"through corners\"",
    default: "",
    choices: &[],
    read: Parser::Optional(|text| Some(text.to_owned())),
    repeats: false,
};

const RAYS: ValueOption<usize> = ValueOption {
    name: "rays",
    value: "N",
    takes: "a whole number from 1 to 1000000",
    help: "How many rays each scene has, from 1 to 1000000",
    default: "2000",
    choices: &[],
    read: Parser::Optional(|text| text.parse().ok().filter(|rays| (1..=1_000_000).contains(rays))),
    repeats: false,
};

const SEED: ValueOption<u64> = ValueOption {
    name: "seed",
    value: "N",
    takes: "a whole number",
    help: "Where chance begins",
    default: "1",
    choices: &[],
    read: Parser::Optional(|text| text.parse().ok()),
    repeats: false,
};

const ROUNDS: ValueOption<usize> = ValueOption {
    name: "rounds",
    value: "N",
    takes: "a whole number from 0 to 1000",
    help: "How often each candidate is timed; with 0 there are no times, and every run writes the same",
    default: "15",
    choices: &[],
    read: Parser::Optional(|text| text.parse().ok().filter(|&rounds| rounds <= 1000)),
    repeats: false,
};

const FRICTION: ValueOption<f64> = ValueOption {
    name: "friction",
    value: "RATE",
    takes: "a number from 0.001 to 1000000000",
    help: "The player's friction per second, for the motion",
    default: "12",
    choices: &[],
    read: Parser::Optional(|text| text.parse().ok().filter(|rate| (1e-3..=1e9).contains(rate))),
    repeats: false,
};

const STEPS_PER_SECOND: ValueOption<f64> = ValueOption {
    name: "steps-per-second",
    value: "N",
    takes: "a number from 0.1 to 10000",
    help: "The steps of the game in a second, for the motion",
    default: "60",
    choices: &[],
    read: Parser::Optional(|text| text.parse().ok().filter(|steps| (0.1..=1e4).contains(steps))),
    repeats: false,
};

const PAGE: FileOption = FileOption {
    name: "update",
    help: "Replace the tables between the marks of this page, and the plots in docs/ beside it",
};

const FORMAT: ValueOption<ReportFormat> = ValueOption {
    name: "format",
    value: "FORMAT",
    takes: "table, markdown, json, csv, svg or png",
    help: "How the report is written",
    default: "table",
    choices: &["table", "markdown", "json", "csv", "svg", "png"],
    read: Parser::Optional(|text| match text {
        "table" => Some(ReportFormat::Table),
        "markdown" => Some(ReportFormat::Markdown),
        "json" => Some(ReportFormat::Json),
        "csv" => Some(ReportFormat::Csv),
        "svg" => Some(ReportFormat::Svg),
        "png" => Some(ReportFormat::Png),
        _ => None,
    }),
    repeats: false,
};
