//! Times as players read them: minutes and seconds, with or without tenths.

use std::fmt::{self, Display};

use crate::game::STEP;

/// Formats minutes and seconds.
pub fn whole_seconds(seconds: f64) -> impl Display {
    let seconds = seconds as u64;
    fmt::from_fn(move |f| write!(f, "{}:{:02}", seconds / 60, seconds % 60))
}

/// Formats minutes, seconds and tenths.
pub fn tenths(seconds: f64) -> String {
    let all = (seconds * 10.0) as u64;
    format!("{}:{:02}.{}", all / 600, all / 10 % 60, all % 10)
}

/// Formats the time of `steps` steps of a game as minutes, seconds and tenths.
pub fn of_steps(steps: u64) -> String {
    tenths(steps as f64 * STEP)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_minutes_seconds_and_tenths() {
        assert_eq!(tenths(0.0), "0:00.0");
        assert_eq!(tenths(61.26), "1:01.2");
        assert_eq!(tenths(3600.0), "60:00.0");
    }
}
