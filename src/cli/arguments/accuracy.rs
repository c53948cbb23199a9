//! What `accuracy` is asked for.

use std::ffi::OsString;

use lexopt::{Arg, Parser};

use super::value::{self, Valued};
use super::{Command, Error, next, unexpected};
use crate::cast::Method;

/// Options of `accuracy`.
#[derive(Debug)]
pub(in crate::cli) struct Accuracy {
    pub(in crate::cli) map: Option<OsString>,
    pub(in crate::cli) set: Option<String>,
    /// None for all.
    pub(in crate::cli) methods: Vec<Method>,
    /// Rays in each scene.
    pub(in crate::cli) rays: usize,
    pub(in crate::cli) seed: u64,
    pub(in crate::cli) format: ReportFormat,
}

/// How a report is written.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) enum ReportFormat {
    Table,
    Json,
    Csv,
    Svg,
    Png,
}

pub(super) fn parse(mut parser: Parser) -> Result<Command, Error> {
    let mut accuracy = Accuracy {
        map: None,
        set: None,
        methods: Vec::new(),
        rays: 2000,
        seed: 1,
        format: ReportFormat::Table,
    };
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(map) if accuracy.map.is_none() => accuracy.map = Some(map),
            Arg::Long("set") => accuracy.set = Some(SET.value(&mut parser)?),
            Arg::Long("caster") => accuracy.methods.push(value::method(&mut parser)?),
            Arg::Long("rays") => accuracy.rays = RAYS.value(&mut parser)?,
            Arg::Long("seed") => accuracy.seed = SEED.value(&mut parser)?,
            Arg::Long("format") => accuracy.format = REPORT_FORMAT.value(&mut parser)?,
            other => return Err(unexpected("accuracy", &OPTIONS, other)),
        }
    }
    Ok(Command::Accuracy(accuracy))
}

const OPTIONS: [&str; 5] = ["--caster", "--format", "--rays", "--seed", "--set"];

const SET: Valued<String> =
    Valued { name: "--set", takes: "the name of a set", read: |text| Some(text.to_owned()) };

const RAYS: Valued<usize> = Valued {
    name: "--rays",
    takes: "a whole number from 1 to 10000000",
    read: |text| text.parse().ok().filter(|rays| (1..=10_000_000).contains(rays)),
};

const SEED: Valued<u64> =
    Valued { name: "--seed", takes: "a whole number", read: |text| text.parse().ok() };

const REPORT_FORMAT: Valued<ReportFormat> = Valued {
    name: "--format",
    takes: "table, json, csv, svg or png",
    read: |text| match text {
        "table" => Some(ReportFormat::Table),
        "json" => Some(ReportFormat::Json),
        "csv" => Some(ReportFormat::Csv),
        "svg" => Some(ReportFormat::Svg),
        "png" => Some(ReportFormat::Png),
        _ => None,
    },
};
