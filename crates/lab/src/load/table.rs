//! The table of a server's cost: more and more players at two frame rates, and visitors who never read.

use std::error::Error;

use super::plan::Load;
use super::{Measured, play_all};
use crate::report::{Format, Report, Row, Table, Value, headings, update_page};

/// The numbers of players, by the limit of frames a second.
const PLAYERS: [(u32, [usize; 4]); 2] = [(20, [50, 100, 200, 400]), (10, [100, 200, 400, 800])];
/// The number of visitors who never read.
const SILENT: usize = 200;

/// Measures, and prints the table or writes it to a page.
pub(crate) fn run(plan: &Load) -> Result<(), Box<dyn Error>> {
    let mut rows = Vec::new();
    for (rate, numbers) in PLAYERS {
        for players in numbers {
            let measured = play_all(&plan.with(players, rate))?;
            let memory = (measured.megabytes[2] - measured.megabytes[0]) / players as f64;
            rows.push(row("hold keys", rate, players, &measured, memory));
        }
    }
    let mut silent = plan.with(0, 20);
    silent.silent = SILENT;
    let measured = play_all(&silent)?;
    let memory = (measured.megabytes[2] - measured.megabytes[0]) / SILENT as f64;
    rows.push(row("never read", 20, SILENT, &measured, memory));
    let table = Table {
        name: "players",
        title: "Players on one core of a server, at 80x24 cells in true colour".to_owned(),
        keys: ["players who", "limit, frames/s", "players"],
        columns: headings([
            "time: frames/s each",
            "time: key to frame, median, ms",
            "time: 99th percentile, ms",
            "time: kB/s each",
            "time: µs a frame, all told",
            "time: share of the core",
            "memory each, MB",
        ]),
        rows,
        diagrams: Vec::new(),
    };
    match &plan.page {
        Some(page) => update_page(page, "load", &[table])?,
        None => Report::print(&[table], Format::Markdown)?,
    }
    Ok(())
}

fn row(who: &str, rate: u32, players: usize, measured: &Measured, megabytes: f64) -> Row {
    let figures = &measured.figures;
    let plays = figures.sessions > 0;
    let rounded = |value: f64| if plays { Value::Number(value.round()) } else { Value::None };
    let values = vec![
        if plays { Value::Number(to_tenths(figures.frames)) } else { Value::None },
        rounded(figures.key_time[0]),
        rounded(figures.key_time[1]),
        rounded(figures.kilobytes),
        rounded(figures.micros_a_frame()),
        Value::Share(figures.busy()),
        Value::Number(megabytes),
    ];
    Row::new([who, &rate.to_string(), &players.to_string()], values)
}

fn to_tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}
