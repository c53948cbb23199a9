//! What a run does, by the arguments of this process.

use std::error::Error;
use std::time::Duration;

use crate::process::Usage;

/// What to do.
pub(crate) struct Plan {
    pub(crate) sessions: usize,
    /// Sessions that never read.
    pub(crate) silent: usize,
    pub(crate) uses_sshd: bool,
    pub(crate) seconds: u64,
    /// The program of the servers.
    pub(crate) server: String,
    pub(crate) answer_delay: Duration,
    pub(crate) hosts: usize,
    /// The rooms of a load on the bus alone.
    pub(crate) rooms: Option<usize>,
    /// For each server, as they are.
    pub(crate) options: Vec<String>,
    /// Further processes that are measured.
    pub(crate) beside: Vec<u32>,
}

impl Plan {
    /// What the arguments say.
    pub(crate) fn parse() -> Result<Self, Box<dyn Error>> {
        let mut plan = Self {
            sessions: 20,
            silent: 0,
            uses_sshd: false,
            seconds: 10,
            server: "target/release/cellcaster".to_owned(),
            answer_delay: Duration::ZERO,
            hosts: 1,
            rooms: None,
            options: Vec::new(),
            beside: Vec::new(),
        };
        let mut arguments = std::env::args().skip(1);
        while let Some(name) = arguments.next() {
            if name == "--sshd" {
                plan.uses_sshd = true;
                continue;
            }
            let value = arguments.next().ok_or_else(|| format!("{name} needs a value"))?;
            match name.as_str() {
                "--sessions" => plan.sessions = value.parse()?,
                "--silent" => plan.silent = value.parse()?,
                "--seconds" => plan.seconds = value.parse()?,
                "--server" => plan.server = value,
                "--answer-delay" => plan.answer_delay = Duration::from_millis(value.parse()?),
                "--bus" => plan.rooms = Some(value.parse()?),
                "--hosts" => plan.hosts = value.parse()?,
                "--cluster" | "--store" => plan.options.extend([name, value]),
                "--beside" => plan.beside.push(value.parse()?),
                _ => return Err(format!("there is no option {name}").into()),
            }
        }
        if plan.hosts > 1 && plan.options.len() != 4 {
            return Err("several hosts need --cluster and --store".into());
        }
        Ok(plan)
    }

    /// What an option for the servers says.
    pub(crate) fn option(&self, name: &str) -> Option<&str> {
        let pair = self.options.chunks(2).find(|pair| pair[0] == name)?;
        Some(&pair[1])
    }

    /// What each of the other processes has used so far.
    pub(crate) fn others(&self) -> Vec<Usage> {
        self.beside.iter().map(|&process| Usage::of(process)).collect()
    }

    /// Prints the time that the other processes have used.
    pub(crate) fn print_others(&self, times: &[Duration]) {
        for (process, time) in self.beside.iter().zip(times) {
            let share = time.as_secs_f64() / self.seconds as f64;
            println!("process {process:<6}{:.1} % of a processor", share * 100.0);
        }
    }
}
