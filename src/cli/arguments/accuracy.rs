//! The options of `accuracy`.

use std::ffi::OsString;

use clap::ArgMatches;

use super::option::{Parser, ValueOption};
use super::{Command, Subcommand, map, value};
use crate::lab::casters::Method;

/// Options of `accuracy`.
#[derive(Debug)]
pub(in crate::cli) struct Accuracy {
    pub(in crate::cli) map: Option<OsString>,
    pub(in crate::cli) set: Option<String>,
    /// All methods if empty.
    pub(in crate::cli) methods: Vec<Method>,
    /// The number of rays in each scene.
    pub(in crate::cli) rays: usize,
    pub(in crate::cli) seed: u64,
    pub(in crate::cli) format: ReportFormat,
}

/// The format of a report.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::cli) enum ReportFormat {
    #[default]
    Table,
    Json,
    Csv,
    Svg,
    Png,
}

pub(super) const SUBCOMMAND: Subcommand = Subcommand {
    name: "accuracy",
    about: "Error against run time, for every way to cast",
    details: "Casts rays by every method, and compares what they hit with rational arithmetic. Without \
              MAP and --set it takes three scenes, and then every stiff and extreme set.",
    examples: r#"cellcaster accuracy --caster exact --caster dda --set "through corners"
cellcaster accuracy --format svg > accuracy.svg"#,
    positionals: &[map::OPTIONAL],
    options: &[&CASTER, &SET, &RAYS, &SEED, &FORMAT],
    surplus: "takes one map",
    missing: "",
    read: |matches| Ok(Command::Accuracy(read(matches))),
};

fn read(mut matches: ArgMatches) -> Accuracy {
    Accuracy {
        map: map::of(&mut matches),
        set: SET.of(&mut matches),
        methods: CASTER.all_of(&mut matches),
        rays: RAYS.of(&mut matches).unwrap_or(2000),
        seed: SEED.of(&mut matches).unwrap_or(1),
        format: FORMAT.of(&mut matches).unwrap_or_default(),
    }
}

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

const FORMAT: ValueOption<ReportFormat> = ValueOption {
    name: "format",
    value: "FORMAT",
    takes: "table, json, csv, svg or png",
    help: "How the report is written",
    default: "table",
    choices: &["table", "json", "csv", "svg", "png"],
    read: Parser::Optional(|text| match text {
        "table" => Some(ReportFormat::Table),
        "json" => Some(ReportFormat::Json),
        "csv" => Some(ReportFormat::Csv),
        "svg" => Some(ReportFormat::Svg),
        "png" => Some(ReportFormat::Png),
        _ => None,
    }),
    repeats: false,
};
