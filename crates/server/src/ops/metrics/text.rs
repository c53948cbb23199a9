//! Prometheus' text format, version 0.0.4.

use std::fmt::{Display, Write};
use std::sync::atomic::Ordering;

use tokio::runtime::Handle;

use super::histogram::BOUNDS;
use super::{Histogram, Metrics, RoomFigures, process};
use crate::ssh::Counters;
use crate::ssh::admission::Refusal;

impl Metrics {
    /// All figures, with those of the transport and of this process.
    pub fn text(&self, transport: &Counters) -> String {
        let mut text = Text { host: self.host.get().map(|host| quoted(host)), ..Text::default() };
        text.transport(transport);
        text.rooms(self);
        text.each_room(self);
        text.sessions(self);
        text.process();
        text.text
    }
}

/// A figure of a room: its name, kind and description, and how to read it.
type RoomFigure = (&'static str, &'static str, &'static str, fn(&RoomFigures) -> i64);

const OF_EACH_ROOM: [RoomFigure; 5] = [
    ("room_members", "gauge", "Members of a room, on all hosts.", |it| it.members.get()),
    ("room_watchers", "gauge", "Visitors of this host who watch a room.", |it| it.watchers.get()),
    ("room_writes", "gauge", "Whether this host writes the log of a room.", |it| it.writes.get()),
    ("room_steps_total", "counter", "Steps that a room has taken on this host.", |it| {
        it.steps.get() as i64
    }),
    ("room_entries_total", "counter", "Entries of the log of a room.", |it| {
        it.entries.get() as i64
    }),
];

#[derive(Default)]
struct Text {
    text: String,
    /// The value of the label of the host, if lines have one.
    host: Option<String>,
}

/// The names and values of labels, which need no quoting.
type Labels<'a> = &'a [(&'a str, &'a str)];

impl Text {
    fn transport(&mut self, counters: &Counters) {
        let accepted = counters.accepted.load(Ordering::Relaxed);
        self.counter("connections_accepted", "Connections that were accepted.", accepted);
        let name = "connections_refused_total";
        self.head(name, "counter", "Connections that were refused.");
        for reason in Refusal::ALL {
            let count = counters.refused_for(reason);
            self.line(name, &[("reason", reason.name())], count);
        }
        let frames = counters.frames.load(Ordering::Relaxed);
        self.counter("frames", "Frames that were sent.", frames);
        let help = "Bytes of frames, before compression and encryption.";
        self.counter("frame_bytes", help, counters.frame_bytes.load(Ordering::Relaxed));
        let gauges = [
            ("connections", "Connections that are open.", &counters.connections),
            ("sessions", "Visitors whose session runs.", &counters.sessions),
            ("held_bytes", "Bytes of frames that wait for clients.", &counters.held),
        ];
        for (name, help, gauge) in gauges {
            self.gauge(name, help, gauge.load(Ordering::Relaxed));
        }
    }

    fn rooms(&mut self, metrics: &Metrics) {
        self.gauge("rooms", "Rooms that are open.", metrics.rooms.get());
        self.gauge("members", "Members of all rooms.", metrics.members.get());
        self.gauge("watchers", "Visitors who watch a room.", metrics.watchers.get());
        self.counter("log_entries", "Entries of the logs of all rooms.", metrics.entries.get());
        let name = "room_checks_total";
        self.head(name, "counter", "Checksums of rooms, compared with those of other hosts.");
        self.line(name, &[("result", "equal")], metrics.checks_equal.get());
        self.line(name, &[("result", "different")], metrics.checks_different.get());
        let help = "Steps of rooms that went on while the bus of the cluster did not answer.";
        self.counter("room_steps_alone", help, metrics.steps_alone.get());
        let help = "How late the steps of rooms are.";
        self.histogram("step_lateness_seconds", help, &metrics.step_lateness);
    }

    /// The figures of each room of a cluster; of none, if this host is in no cluster.
    fn each_room(&mut self, metrics: &Metrics) {
        let rooms = metrics.each_room.all();
        if rooms.is_empty() {
            return;
        }
        let rooms: Vec<(String, _)> =
            rooms.into_iter().map(|(room, figures)| (room.to_string(), figures)).collect();
        for (name, kind, help, figure) in OF_EACH_ROOM {
            self.head(name, kind, help);
            for (room, figures) in &rooms {
                self.line(name, &[("room", room)], figure(figures));
            }
        }
        let name = "each_room_checks_total";
        self.head(name, "counter", "Checksums of a room, compared with those of other hosts.");
        for (room, figures) in &rooms {
            self.line(name, &[("room", room), ("result", "equal")], figures.checks_equal.get());
            let different = figures.checks_different.get();
            self.line(name, &[("room", room), ("result", "different")], different);
        }
    }

    fn sessions(&mut self, metrics: &Metrics) {
        let help = "The time in which a frame is drawn and encoded.";
        self.histogram("frame_seconds", help, &metrics.frame_time);
        let help = "The time from a key to the departure of the next frame.";
        self.histogram("key_seconds", help, &metrics.key_time);
        let name = "results_total";
        self.head(name, "counter", "Results that were replayed, by what the replay says.");
        self.line(name, &[("verdict", "verified")], metrics.results_verified.get());
        self.line(name, &[("verdict", "refused")], metrics.results_refused.get());
        let help = "Results that wait for a store that is away.";
        self.gauge("results_waiting", help, metrics.results_waiting.get());
        self.counter("store_errors", "Calls of the store that failed.", metrics.store_errors.get());
    }

    /// The tasks of this runtime, and the process by the names that Prometheus' own clients use.
    fn process(&mut self) {
        if let Ok(runtime) = Handle::try_current() {
            let help = "Tasks: a few of the server, and some for each connection and room.";
            self.gauge("tasks", help, runtime.metrics().num_alive_tasks());
        }
        if let Some(time) = process::cpu_time() {
            let name = "process_cpu_seconds_total";
            self.head(name, "counter", "Processor time of all threads.");
            self.line(name, &[], time.as_secs_f64());
        }
        if let Some(bytes) = process::resident_bytes() {
            let name = "process_resident_memory_bytes";
            self.head(name, "gauge", "Memory in use.");
            self.line(name, &[], bytes);
        }
    }

    fn counter(&mut self, name: &str, help: &str, value: impl Display) {
        let name = format!("{name}_total");
        self.head(&name, "counter", help);
        self.line(&name, &[], value);
    }

    fn gauge(&mut self, name: &str, help: &str, value: impl Display) {
        self.head(name, "gauge", help);
        self.line(name, &[], value);
    }

    fn histogram(&mut self, name: &str, help: &str, histogram: &Histogram) {
        self.head(name, "histogram", help);
        let distribution = histogram.distribution();
        let bucket = format!("{name}_bucket");
        let bounds = BOUNDS.iter().map(|&bound| (bound as f64 / 1e6).to_string());
        for (bound, count) in bounds.chain(["+Inf".to_owned()]).zip(distribution.up_to) {
            self.line(&bucket, &[("le", &bound)], count);
        }
        self.line(&format!("{name}_sum"), &[], distribution.sum);
        self.line(&format!("{name}_count"), &[], distribution.up_to[BOUNDS.len()]);
    }

    fn head(&mut self, name: &str, kind: &str, help: &str) {
        let name = full(name);
        _ = writeln!(self.text, "# HELP {name} {help}\n# TYPE {name} {kind}");
    }

    fn line(&mut self, name: &str, labels: Labels<'_>, value: impl Display) {
        let host = self.host.as_deref().map(|host| ("host", host));
        let labels = host.iter().chain(labels).map(|(label, value)| format!("{label}=\"{value}\""));
        let labels: Vec<String> = labels.collect();
        let labels =
            if labels.is_empty() { String::new() } else { format!("{{{}}}", labels.join(",")) };
        _ = writeln!(self.text, "{}{labels} {value}", full(name));
    }
}

/// The value of a label, as it stands between quotation marks.
fn quoted(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n")
}

fn full(name: &str) -> String {
    if name.starts_with("process_") { name.to_owned() } else { format!("cellcaster_{name}") }
}
