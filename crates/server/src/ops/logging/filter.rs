//! What is logged: a level for each topic.

use std::fmt;
use std::str::FromStr;

use tracing_subscriber::filter::{LevelFilter, Targets};

/// The topics of events.
pub(crate) const TOPICS: [&str; 5] = ["host", "connections", "rooms", "results", "admin"];

/// The beginning of targets without a topic: the paths of modules.
const PROGRAM: &str = env!("CARGO_CRATE_NAME");

/// The least level of events that are logged, and that of some topics.
///
/// ```
/// use cellcaster_server::ops::logging::LogFilter;
///
/// let filter: LogFilter = "info,connections=warn".parse()?;
/// assert_eq!(filter.to_string(), "info,connections=warn");
/// assert!("info,conections=warn".parse::<LogFilter>().is_err());
/// # Ok::<(), cellcaster_server::ops::logging::UnknownLogFilter>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogFilter {
    level: LevelFilter,
    topics: Vec<(&'static str, LevelFilter)>,
}

/// A part of a text that is no part of a filter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownLogFilter(pub String);

impl LogFilter {
    /// The grammar in a sentence.
    pub const GRAMMAR: &str = "off, error, warn, info, debug or trace, and others for the topics host, \
                               connections, rooms, results and admin";

    /// The filter for a subscriber. Events of this program without a topic count as those of `host`, and
    /// events of libraries are not logged.
    pub(crate) fn targets(&self) -> Targets {
        let of_topic = |topic| {
            let own = self.topics.iter().find(|(other, _)| *other == topic);
            own.map_or(self.level, |(_, level)| *level)
        };
        let topics = TOPICS.map(|topic| (topic, of_topic(topic)));
        Targets::new().with_targets(topics).with_target(PROGRAM, of_topic("host"))
    }
}

impl Default for LogFilter {
    /// `info` for all.
    fn default() -> Self {
        Self { level: LevelFilter::INFO, topics: Vec::new() }
    }
}

impl FromStr for LogFilter {
    type Err = UnknownLogFilter;

    fn from_str(text: &str) -> Result<Self, UnknownLogFilter> {
        let mut filter = Self::default();
        for part in text.split(',').map(str::trim) {
            let unknown = || UnknownLogFilter(part.to_owned());
            match part.split_once('=') {
                None => filter.level = level(part).ok_or_else(unknown)?,
                Some((topic, name)) => {
                    let known = TOPICS.into_iter().find(|known| *known == topic);
                    let topic = known.ok_or_else(unknown)?;
                    filter.topics.retain(|(other, _)| *other != topic);
                    filter.topics.push((topic, level(name).ok_or_else(unknown)?));
                }
            }
        }
        Ok(filter)
    }
}

fn level(name: &str) -> Option<LevelFilter> {
    Some(match name {
        "off" => LevelFilter::OFF,
        "error" => LevelFilter::ERROR,
        "warn" => LevelFilter::WARN,
        "info" => LevelFilter::INFO,
        "debug" => LevelFilter::DEBUG,
        "trace" => LevelFilter::TRACE,
        _ => return None,
    })
}

impl fmt::Display for LogFilter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.level)?;
        self.topics.iter().try_for_each(|(topic, level)| write!(f, ",{topic}={level}"))
    }
}

impl fmt::Display for UnknownLogFilter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} is no level of the log; a filter is {}", self.0, LogFilter::GRAMMAR)
    }
}

impl std::error::Error for UnknownLogFilter {}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_filter_is_a_level_and_others_for_topics() {
        for (text, written) in [
            ("warn", "warn"),
            ("rooms=debug", "info,rooms=debug"),
            ("off, admin=info", "off,admin=info"),
            ("info,rooms=off,rooms=warn", "info,rooms=warn"),
        ] {
            assert_eq!(text.parse::<LogFilter>().unwrap().to_string(), written);
        }
        for text in ["", "INFO!", "lobby=info", "rooms=loud", "rooms", "=info", "info,"] {
            assert!(text.parse::<LogFilter>().is_err(), "{text}");
        }
    }

    proptest! {
        #[test]
        fn a_filter_that_is_written_is_read(text in "((off|warn|debug|rooms|admin|x)[,=]?){0,6}") {
            if let Ok(filter) = text.parse::<LogFilter>() {
                prop_assert_eq!(filter.to_string().parse(), Ok(filter));
            }
        }
    }
}
