//! The plot in characters: a letter for each method, and a legend below.

use std::io::{self, Write};

use super::Plot;

const COLUMNS: usize = 72;
const ROWS: usize = 20;

pub(super) fn write(plot: &Plot, output: &mut impl Write) -> io::Result<()> {
    let mut cells = vec![vec![' '; COLUMNS]; ROWS];
    let letters = || ('a'..='z').chain('A'..='Z');
    for (point, letter) in plot.points.iter().zip(letters()) {
        let column = plot.time.share(point.time) * (COLUMNS - 1) as f64;
        let row = (1.0 - plot.error.share(point.error)) * (ROWS - 1) as f64;
        let (column, row) = (column.round() as usize, row.round() as usize);
        // If the position is taken, the next free one to the right.
        let free = (column..COLUMNS).find(|&column| cells[row][column] == ' ');
        cells[row][free.unwrap_or(column)] = letter;
    }

    writeln!(output, "Relative error of the distance (rms) over nanoseconds a ray.\n")?;
    for (row, cells) in cells.iter().enumerate() {
        let label = label_of_row(plot, row).unwrap_or_default();
        writeln!(output, "{label:>7} |{}", cells.iter().collect::<String>().trim_end())?;
    }
    writeln!(output, "{:>7} +{}", "", "-".repeat(COLUMNS))?;
    writeln!(output, "{:>7}  {}", "", time_labels(plot))?;
    writeln!(output)?;
    for (point, letter) in plot.points.iter().zip(letters()) {
        let front = if point.is_on_front { "*" } else { "" };
        write!(output, "  {letter} {}{front}", point.label)?;
    }
    writeln!(output)
}

/// The power of ten that labels this row, if there is one.
fn label_of_row(plot: &Plot, row: usize) -> Option<String> {
    const MOST: usize = 10;
    let row_of = |power: i32| {
        let share = plot.error.share(10_f64.powi(power));
        ((1.0 - share) * (ROWS - 1) as f64).round() as usize
    };
    plot.error.powers(MOST).find(|&power| row_of(power) == row).map(|power| format!("1e{power}"))
}

fn time_labels(plot: &Plot) -> String {
    const MOST: usize = 8;
    let mut line = String::new();
    for power in plot.time.powers(MOST) {
        let column = (plot.time.share(10_f64.powi(power)) * (COLUMNS - 1) as f64) as usize;
        let padding = column.saturating_sub(line.len());
        line = format!("{line}{}1e{power}", " ".repeat(padding));
    }
    line
}
