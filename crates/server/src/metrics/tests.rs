use std::collections::BTreeMap;
use std::time::Duration;

use super::*;
use crate::admission::Refusal;

/// Parses the samples of a text, and checks its format.
fn samples(text: &str) -> BTreeMap<String, f64> {
    let mut samples = BTreeMap::new();
    let mut name = "";
    for line in text.lines() {
        if let Some(help) = line.strip_prefix("# HELP ") {
            name = help.split(' ').next().unwrap();
        } else if let Some(kind) = line.strip_prefix("# TYPE ") {
            assert!(kind.starts_with(&format!("{name} ")), "{line}");
        } else {
            let (sample, value) = line.rsplit_once(' ').unwrap();
            assert!(sample.starts_with(name), "{line}");
            assert!(samples.insert(sample.to_owned(), value.parse().unwrap()).is_none(), "{line}");
        }
    }
    samples
}

#[test]
fn each_figure_has_a_sample() {
    let metrics = Metrics::default();
    metrics.rooms.set(3);
    metrics.members.set(5);
    metrics.results(false).inc();
    metrics.entries.inc_by(4096);
    metrics.accepted.inc_by(9);
    metrics.refused(Refusal::Penalty).inc_by(2);
    let samples = samples(&metrics.text());
    for (name, value) in [
        ("cellcaster_rooms", 3.0),
        ("cellcaster_members", 5.0),
        ("cellcaster_results_total{verdict=\"refused\"}", 1.0),
        ("cellcaster_results_total{verdict=\"verified\"}", 0.0),
        ("cellcaster_log_entries_total", 4096.0),
        ("cellcaster_connections_accepted_total", 9.0),
        ("cellcaster_connections_refused_total{reason=\"penalty\"}", 2.0),
        ("cellcaster_connections_refused_total{reason=\"full\"}", 0.0),
    ] {
        assert_eq!(samples.get(name), Some(&value), "{name}");
    }
    if cfg!(target_os = "linux") {
        assert!(samples["process_resident_memory_bytes"] > 1e6);
        assert!(samples["process_cpu_seconds_total"] > 0.0);
    }
}

#[test]
fn samples_are_labelled_with_the_host() {
    let metrics = Metrics::default();
    metrics.host.set("a \"b\"\\".to_owned()).unwrap();
    let text = metrics.text();
    let lines = samples(&text);
    let host = "host=\"a \\\"b\\\"\\\\\"";
    assert!(lines.keys().all(|line| line.contains(host)), "{text}");
    assert_eq!(lines.get(&format!("cellcaster_rooms{{{host}}}")), Some(&0.0));
}

#[test]
fn a_duration_counts_in_every_bucket_from_its_bound() {
    let metrics = Metrics::default();
    for microseconds in [0, 100, 16_667, 2_500_001] {
        metrics.key_time.observe(Duration::from_micros(microseconds));
    }
    metrics.key_time.observe(Duration::from_nanos(100_001));
    let samples = samples(&metrics.text());
    let sample = |end: &str| samples[&format!("cellcaster_key_seconds_{end}")];
    for (end, count) in [
        ("bucket{le=\"0.0001\"}", 2.0),
        ("bucket{le=\"0.00025\"}", 3.0),
        ("bucket{le=\"0.016667\"}", 4.0),
        ("bucket{le=\"2.5\"}", 4.0),
        ("bucket{le=\"+Inf\"}", 5.0),
        ("count", 5.0),
    ] {
        assert_eq!(sample(end), count, "{end}");
    }
    assert!((sample("sum") - 2.516_868_001).abs() < 1e-9);
}
