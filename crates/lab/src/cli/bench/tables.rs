//! The report as tables.

use super::footprint::{FIRST_WINDOW, GAME_WINDOW, STARTS};
use super::{LINKS, Report, frames_per_second, milliseconds, share_of_stock};
use crate::cli::table::Table;
use crate::speed::{CROWDS, Ground, Measured, SIDES, USUAL_SIDE, Vista};

/// All tables, in reading order.
pub(crate) fn of(report: &Report) -> Vec<Table> {
    vec![
        drawing(report),
        rays(report),
        maps(report),
        crowds(report),
        pipeline(report),
        footprint(report),
    ]
}

fn drawing(report: &Report) -> Table {
    let rows = report.drawing.iter().map(|row| {
        vec![
            row.scene.name().to_owned(),
            format!("{}x{}", row.size.width, row.size.height),
            format!("{:.2}", row.ours),
            format!("{:.2}", row.classic),
            format!("{:.3}", row.fill),
            format!("{:.1}", row.classic / row.ours),
            format!("{:.1}", row.ours / row.fill),
            row.threads.to_string(),
            format!("{:.1}", row.ours / row.by_threads),
        ]
    });
    Table {
        title: "Drawing",
        about:
            "nanoseconds a pixel on one thread, beside the loop that tutorials teach and a fill;\n\
             the threads that the renderer uses by default, and how many times faster they are."
                .to_owned(),
        columns: words([
            "scene",
            "picture",
            "ours",
            "classic",
            "fill",
            "classic/ours",
            "ours/fill",
            "threads",
            "faster",
        ]),
        labels: 2,
        rows: rows.collect(),
    }
}

fn rays(report: &Report) -> Table {
    let rows = SIDES.map(|side| {
        let rays = Ground::ALL.map(|ground| {
            let row =
                report.growth.maps.iter().find(|row| (row.ground, row.side) == (ground, side));
            times(row.map(|row| row.ray), 1e9)
        });
        labelled(&side, rays.as_flattened())
    });
    Table {
        title: "Rays",
        about: format!(
            "nanoseconds a ray, by the number of cells that it crosses, in an empty hall and on a plain\n\
             with a pillar in one cell of 4096. Ratios are to {USUAL_SIDE} cells."
        ),
        columns: words(["cells", "hall", "ratio", "plain", "ratio"]),
        labels: 1,
        rows: rows.into(),
    }
}

fn maps(report: &Report) -> Table {
    let rows = SIDES.map(|side| {
        let of = |ground| {
            report.growth.maps.iter().find(move |row| (row.ground, row.side) == (ground, side))
        };
        let frames = Ground::ALL.map(|ground| times(of(ground).map(|row| row.frame), 1e6));
        let plain = of(Ground::Plain);
        let loading = known(plain.map(|row| format!("{:.1}", milliseconds(row.loading))));
        let bytes = known(plain.map(|row| format!("{:.2}", row.bytes_a_cell)));
        labelled(&side, &[frames.as_flattened(), &[loading, bytes]].concat())
    });
    Table {
        title: "Maps",
        about: format!(
            "microseconds a frame of 160x90 with a view across the map, by the cells along its side.\n\
             Ratios are to {USUAL_SIDE}. For the plain: milliseconds to read it, and bytes a cell of its grid."
        ),
        columns: words(["side", "hall", "ratio", "plain", "ratio", "reading", "bytes"]),
        labels: 1,
        rows: rows.into(),
    }
}

fn crowds(report: &Report) -> Table {
    let rows = CROWDS.map(|count| {
        let frames = Vista::ALL.map(|vista| {
            let row =
                report.growth.crowds.iter().find(|row| (row.vista, row.count) == (vista, count));
            times(row.map(|row| row.frame), 1e6)
        });
        labelled(&count, frames.as_flattened())
    });
    Table {
        title: "Things",
        about: format!(
            "microseconds a frame of 160x90, by the number of things on the map, some sixty of them in\n\
             view, in a straight hall and in a diagonal one. Ratios are to {}.",
            CROWDS[0]
        ),
        columns: words(["things", "straight", "ratio", "diagonal", "ratio"]),
        labels: 1,
        rows: rows.into(),
    }
}

fn pipeline(report: &Report) -> Table {
    let rows = report.pipeline.iter().map(|row| {
        let rates = LINKS.map(|link| format!("{:.1}", frames_per_second(row, link)));
        let figures = [
            format!("{}x{}", row.size.width, row.size.height),
            row.encoder.clone(),
            format!("{:.0}", row.time.as_secs_f64() * 1e6),
            format!("{:.2}", share_of_stock(report, row)),
            format!("{:.0}", row.bytes),
        ];
        figures.into_iter().chain(rates).collect()
    });
    let [first, second, third] = LINKS;
    let links = LINKS.map(|link| format!("{link} Mbit/s"));
    let columns = words(["window", "encoder", "µs", "ratio", "bytes"]).into_iter().chain(links);
    Table {
        title: "Pipeline",
        about: format!(
            "microseconds and bytes a frame from the player's intents to bytes, compared with ratatui's\n\
             own encoder (stock); frames a second over a link of {first}, {second} and {third} Mbit/s."
        ),
        columns: columns.collect(),
        labels: 2,
        rows: rows.collect(),
    }
}

fn footprint(report: &Report) -> Table {
    let footprint = &report.footprint;
    let window = |size: ratatui::layout::Size| format!("{}x{}", size.width, size.height);
    let start_up = |time| format!("{:.1} ms", milliseconds(time));
    let row = |what: &str, is: Option<String>| vec![what.to_owned(), known(is)];
    Table {
        title: "Footprint",
        about: format!(
            "start is the time until `cellcaster snapshot` of {} cells writes its first byte, the\n\
             median of {STARTS}; memory is the peak of a game of {}.",
            window(FIRST_WINDOW),
            window(GAME_WINDOW)
        ),
        columns: words(["what", "is"]),
        labels: 1,
        rows: vec![
            row("start, to the first frame", footprint.start_up.map(start_up)),
            row("size of the program", footprint.program.map(mebibytes)),
            row("peak memory", footprint.memory.map(mebibytes)),
        ],
    }
}

fn words<const COUNT: usize>(words: [&str; COUNT]) -> Vec<String> {
    words.map(str::to_owned).to_vec()
}

fn labelled(label: &impl ToString, figures: &[String]) -> Vec<String> {
    [&[label.to_string()], figures].concat()
}

/// A time in a fraction of a second, and its ratio.
fn times(measured: Option<Measured>, parts: f64) -> [String; 2] {
    let time = measured.map(|Measured { seconds, .. }| format!("{:.0}", seconds * parts));
    let ratio = measured.map(|Measured { ratio, .. }| format!("{ratio:.2}"));
    [known(time), known(ratio)]
}

/// The figure, or a dash if it is unknown.
fn known(figure: Option<String>) -> String {
    figure.unwrap_or_else(|| "–".to_owned())
}

fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}
