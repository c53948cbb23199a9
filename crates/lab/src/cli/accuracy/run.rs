//! Where a report comes from: machine, program, command and date.

use std::env;
use std::fs;
use std::thread::available_parallelism;

use cellcaster::cli::machine::today;

/// The origin of a report.
pub(crate) struct Run {
    pub(crate) machine: String,
    /// The version, and the commit if the build was told it.
    pub(crate) program: String,
    pub(crate) command: String,
    /// As in 2026-11-22, in UTC.
    pub(crate) date: String,
}

impl Run {
    /// The origin of a report of this process.
    pub(crate) fn this() -> Self {
        let version = env!("CARGO_PKG_VERSION");
        let commit = option_env!("CELLCASTER_COMMIT").unwrap_or("unknown");
        let (date, _) = today();
        let (year, month, day) = (date / 10_000, date / 100 % 100, date % 100);
        Self {
            machine: machine(),
            program: format!("{version}, commit {commit}"),
            command: command(env::args().skip(1)),
            date: format!("{year}-{month:02}-{day:02}"),
        }
    }

    /// The names and the values of all parts.
    pub(crate) fn parts(&self) -> [(&'static str, &str); 4] {
        [
            ("machine", &self.machine),
            ("program", &self.program),
            ("command", &self.command),
            ("date", &self.date),
        ]
    }

    /// All of it in a sentence.
    pub(crate) fn sentence(&self) -> String {
        let Self { machine, program, command, date } = self;
        format!("Measured on {date} by `{command}`, Cellcaster {program}, on {machine}.")
    }
}

/// The processor, if the system says so, the number of its cores, and the platform.
fn machine() -> String {
    let cores = available_parallelism().map_or(1, Into::into);
    let information = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model =
        information.lines().find_map(|line| line.strip_prefix("model name")?.split(": ").nth(1));
    let processor = model.unwrap_or("unknown processor").trim();
    let cores = if cores == 1 { "1 core".to_owned() } else { format!("{cores} cores") };
    format!("{processor}, {cores}, {} {}", env::consts::OS, env::consts::ARCH)
}

/// The command line with these arguments.
fn command(arguments: impl Iterator<Item = String>) -> String {
    let quoted = |argument: String| {
        if argument.contains(' ') { format!("\"{argument}\"") } else { argument }
    };
    let mut words = vec!["cellcaster".to_owned()];
    words.extend(arguments.map(quoted));
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_can_be_repeated() {
        let arguments = ["accuracy", "--set", "through corners"].map(str::to_owned);
        assert_eq!(command(arguments.into_iter()), "cellcaster accuracy --set \"through corners\"");
    }

    #[test]
    fn a_machine_has_cores() {
        assert!(machine().contains(" core"));
    }
}
