//! Columns of text.

use unicode_width::UnicodeWidthStr;

/// Rows below a line of titles, in columns as wide as they need. Characters that a terminal would obey
/// are replaced.
pub(crate) fn table<const N: usize>(
    titles: [&str; N],
    rows: impl Iterator<Item = [String; N]>,
) -> String {
    let rows: Vec<[String; N]> = [titles.map(str::to_owned)]
        .into_iter()
        .chain(rows.map(|row| row.map(|cell| cell.replace(char::is_control, "?"))))
        .collect();
    let mut widths = [0; N];
    for row in &rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = cell.width().max(*width);
        }
    }
    let mut text = String::new();
    for row in &rows {
        let mut line = String::new();
        for (width, cell) in widths.into_iter().zip(row) {
            line += cell;
            line.extend(std::iter::repeat_n(' ', width - cell.width() + 2));
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}

/// A time in its two largest units, such as `6d 23h`.
pub(crate) fn time(seconds: u64) -> String {
    let (minutes, hours, days) = (seconds / 60, seconds / 3600, seconds / 86_400);
    match (days, hours, minutes) {
        (0, 0, 0) => format!("{seconds}s"),
        (0, 0, _) => format!("{minutes}m {}s", seconds % 60),
        (0, _, _) => format!("{hours}h {}m", minutes % 60),
        _ => format!("{days}d {}h", hours % 24),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_they_need() {
        let rows = [["漢字", "1"], ["A\u{1b}", "22"]].map(|row| row.map(str::to_owned));
        assert_eq!(table(["name", "n"], rows.into_iter()), "name  n\n漢字  1\nA?    22\n");
    }

    #[test]
    fn a_time_has_two_units() {
        for (seconds, text) in
            [(59, "59s"), (61, "1m 1s"), (3661, "1h 1m"), (7 * 86_400 - 1, "6d 23h")]
        {
            assert_eq!(time(seconds), text);
        }
    }
}
