//! The costs of the program itself: start-up time, size on disk, and memory.

use std::env;
use std::fs;
use std::io::{self, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use ratatui::backend::Backend;
use ratatui::layout::Size;

use super::showcase;
use crate::report::{Row, Table, Value, headings, median};
use cellcaster::cli::Error;
use cellcaster::cli::replay::SHOWCASE;
use cellcaster::game::{Intents, STEPS_PER_SECOND};
use cellcaster::terminal::CellWriter;

/// The window of the first picture.
const FIRST_WINDOW: Size = Size::new(80, 24);
/// The window in which memory is measured.
const GAME_WINDOW: Size = Size::new(120, 40);
/// The number of times that the program is started.
const STARTS: usize = 9;

/// Measures the game's program beside this one, and a game in this process, which must not have
/// done anything else before. A figure is missing if there is no such program, or if the system
/// does not report it.
pub(crate) fn measure_footprint() -> Result<Table, Error> {
    const MEBIBYTE: f64 = (1 << 20) as f64;
    play()?;
    let memory = peak_memory().map(|bytes| bytes as f64 / MEBIBYTE);
    let path = env::current_exe().ok().map(|path| path.with_file_name("cellcaster"));
    let program = path.as_deref().and_then(|path| Some(fs::metadata(path).ok()?.len()));
    let program = program.map(|bytes| bytes as f64 / MEBIBYTE);
    let starts = path.map(|path| (0..STARTS).map_while(|_| start_up(&path).ok()).collect());
    let starts = starts.filter(|starts: &Vec<f64>| !starts.is_empty());
    let start = starts.map(|starts| median(starts) * 1e3);
    let row = |name: &str, figure| Row::new([name, "", ""], vec![Value::maybe(figure)]);
    let window = |size: Size| format!("{}x{}", size.width, size.height);
    Ok(Table {
        name: "footprint",
        title: format!(
            "The time until `cellcaster snapshot` of {} cells writes its first byte, the median of\n\
             {STARTS}; the size of the program; and the peak memory of a game of {} in the\n\
             laboratory",
            window(FIRST_WINDOW),
            window(GAME_WINDOW)
        ),
        keys: ["figure", "", ""],
        columns: headings(["value"]),
        rows: vec![
            row("start, ms to the first frame", start),
            row("size of the program, MiB", program),
            row("peak memory, MiB", memory),
        ],
        diagrams: Vec::new(),
    })
}

/// Plays the showcase as a player's process does.
fn play() -> Result<(), Error> {
    const STEPS_A_FRAME: usize = STEPS_PER_SECOND as usize / 30;
    let script = SHOWCASE.script()?;
    let steps: Vec<Intents> = script.iter().map(|(_, intents)| intents).collect();
    let mut replay = showcase(GAME_WINDOW)?;
    let mut writer = CellWriter::new(io::sink(), GAME_WINDOW);
    for steps in steps.chunks(STEPS_A_FRAME) {
        for &intents in steps {
            replay.step(intents);
        }
        writer.draw_frame(|screen| replay.draw(screen));
        // Writing to a sink cannot fail.
        _ = Backend::flush(&mut writer);
    }
    Ok(())
}

/// The time until the program at `path` writes the first byte of a picture, in seconds.
fn start_up(path: &Path) -> io::Result<f64> {
    let size = format!("{}x{}", FIRST_WINDOW.width, FIRST_WINDOW.height);
    let start = Instant::now();
    let mut child = Command::new(path)
        .args(["snapshot", SHOWCASE.level, "--format", "ansi", "--size", &size])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    let mut output = child.stdout.take().ok_or(io::ErrorKind::BrokenPipe)?;
    output.read_exact(&mut [0])?;
    let elapsed = start.elapsed();
    io::copy(&mut output, &mut io::sink())?;
    child.wait()?;
    Ok(elapsed.as_secs_f64())
}

/// The peak memory of this process in bytes, on Linux; `None` on other systems.
fn peak_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = peak.trim().strip_suffix("kB")?.trim_end().parse().ok()?;
    kibibytes.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn linux_reports_the_peak_memory() {
        let mebibytes = peak_memory().unwrap() >> 20;
        assert!((1..1 << 20).contains(&mebibytes), "{mebibytes}");
    }
}
