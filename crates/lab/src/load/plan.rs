//! The options of a load.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

use super::server::Usage;

/// Play in real SSH sessions on one or more servers, and print their cost
#[derive(Args, Clone, Debug)]
pub(crate) struct Load {
    /// The number of sessions that play
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub(crate) sessions: usize,
    /// The number of further sessions that never read
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) silent: usize,
    /// The number of browsers that watch a room first, for as long as the players are then measured alone
    #[arg(long, value_name = "N", default_value_t = 0, conflicts_with_all = ["hosts", "table", "soak", "rooms"])]
    pub(crate) browsers: usize,
    /// How long to measure, in seconds
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub(crate) seconds: u64,
    /// The server's program [default: the one beside this program]
    #[arg(long, value_name = "FILE")]
    server: Option<PathBuf>,
    /// How long each client waits before it answers a query of the server, in milliseconds
    #[arg(long, value_name = "MS", default_value_t = 0)]
    answer_delay: u64,
    /// The server's limit of frames a second
    #[arg(long = "fps", value_name = "N", default_value_t = 30)]
    frames_per_second: u32,
    /// The server's limit of bytes a second to each player [default: the server's own]
    #[arg(long = "bytes", value_name = "N")]
    bytes_per_second: Option<u32>,
    /// Print a table of the cost of 50 to 400 players at 20 frames a second, of 100 to 800 at 10, and of silent ones
    #[arg(long, conflicts_with_all = ["sessions", "silent", "frames_per_second", "hosts", "rooms", "soak"])]
    pub(crate) table: bool,
    /// Replace the marked table in this page, instead of printing it
    #[arg(long = "update", value_name = "FILE", requires = "table")]
    pub(crate) page: Option<PathBuf>,
    /// The number of hosts in a cluster; more than one needs --cluster and --store
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) hosts: usize,
    /// Measure the bus of a cluster alone, with this number of rooms
    #[arg(long = "bus", value_name = "ROOMS")]
    pub(crate) rooms: Option<usize>,
    /// The NATS servers of the cluster
    #[arg(long, value_name = "URL")]
    pub(crate) cluster: Option<String>,
    /// The database of the cluster
    #[arg(long, value_name = "URL")]
    pub(crate) store: Option<String>,
    /// Also measure this process, such as the NATS server; may be repeated
    #[arg(long, value_name = "PID")]
    beside: Vec<u32>,
    /// Let clients come, walk, talk, resize their windows and leave, until the time is over
    #[arg(long)]
    pub(crate) soak: bool,
    /// The seed of a soak
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
}

impl Load {
    /// The same plan, with this number of sessions at this number of frames a second.
    pub(crate) fn with(&self, sessions: usize, frames_per_second: u32) -> Self {
        Self { sessions, frames_per_second, ..self.clone() }
    }

    /// The program that is measured.
    pub(crate) fn program(&self) -> String {
        let beside =
            || std::env::current_exe().unwrap_or_default().with_file_name("cellcaster-server");
        self.server.clone().unwrap_or_else(beside).display().to_string()
    }

    /// The time before a client answers a query.
    pub(crate) fn answer_delay(&self) -> Duration {
        Duration::from_millis(self.answer_delay)
    }

    /// Lines for the server's configuration.
    pub(crate) fn configuration(&self) -> String {
        let rate = format!("frames-per-second = {}\n", self.frames_per_second);
        let budget = self.bytes_per_second.map(|it| format!("player-bytes-per-second = {it}\n"));
        let most = self.browsers.max(1);
        let web = format!("web-watchers = {most}\nweb-watchers-per-address = {most}\n");
        rate + &budget.unwrap_or_default() + &web
    }

    /// The options for each server.
    pub(crate) fn server_options(&self) -> Vec<String> {
        let named = [("--cluster", &self.cluster), ("--store", &self.store)];
        let given = named.iter().filter_map(|(name, value)| Some([*name, value.as_deref()?]));
        given.flatten().map(str::to_owned).collect()
    }

    /// The resources of each of the other processes.
    pub(crate) fn others(&self) -> Vec<Usage> {
        self.beside.iter().map(|&process| Usage::of(process)).collect()
    }

    /// Prints the time that the other processes have used.
    pub(crate) fn print_others(&self, times: &[Duration]) {
        for (process, time) in self.beside.iter().zip(times) {
            let share = time.as_secs_f64() / self.seconds as f64;
            println!("process {process:<6}{:.1} % of a core", share * 100.0);
        }
    }
}
