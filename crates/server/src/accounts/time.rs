//! Time as a store has it: seconds since 1970, and dates.

use std::fmt;

use cellcaster::generate::daily_seed;

/// Seconds since 1970-01-01, in UTC.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct UnixTime(u64);

/// A date.
///
/// ```
/// use cellcaster_server::accounts::Day;
///
/// let day = Day::parse("2026-11-22").unwrap();
/// assert_eq!((day.number(), day.to_string()), (20261122, "2026-11-22".to_owned()));
/// assert_eq!(Day::parse("2026-02-29"), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Day(u32);

impl UnixTime {
    /// The time that many seconds after 1970 began. Later times than a database holds are its last.
    pub const fn new(seconds: u64) -> Self {
        const LAST: u64 = i64::MAX as u64;
        Self(if seconds < LAST { seconds } else { LAST })
    }

    /// The seconds since 1970.
    pub const fn seconds(self) -> u64 {
        self.0
    }

    /// The time that many seconds later.
    #[must_use]
    pub const fn after(self, seconds: u64) -> Self {
        Self::new(self.0.saturating_add(seconds))
    }
}

impl Day {
    /// The date with this number, such as 20261122.
    pub fn from_number(number: u32) -> Option<Self> {
        let (year, month, day) = (number / 10_000, number / 100 % 100, number % 100);
        let is_leap =
            year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
        let days = match month {
            2 if is_leap => 29,
            2 => 28,
            4 | 6 | 9 | 11 => 30,
            1..=12 => 31,
            _ => 0,
        };
        ((1970..=9999).contains(&year) && (1..=days).contains(&day)).then_some(Self(number))
    }

    /// The date of a text such as 2026-11-22.
    pub fn parse(text: &str) -> Option<Self> {
        let mut parts = text.split('-');
        let mut part = |length: usize| {
            let part = parts.next()?;
            let is_number = part.len() == length && part.bytes().all(|byte| byte.is_ascii_digit());
            part.parse::<u32>().ok().filter(|_| is_number)
        };
        let (year, month, day) = (part(4)?, part(2)?, part(2)?);
        Self::from_number(daily_seed(year, month, day)).filter(|_| parts.next().is_none())
    }

    /// The number, such as 20261122, which is the seed of the daily run.
    pub const fn number(self) -> u32 {
        self.0
    }
}

impl fmt::Display for Day {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04}-{:02}-{:02}", self.0 / 10_000, self.0 / 100 % 100, self.0 % 100)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_day_is_a_date_of_the_calendar() {
        for text in ["2024-02-29", "2000-02-29", "2026-12-31", "1970-01-01"] {
            assert_eq!(Day::parse(text).map(|day| day.to_string()).as_deref(), Some(text));
        }
        for text in [
            "2026-02-29",
            "2100-02-29",
            "2026-13-01",
            "2026-00-01",
            "2026-01-00",
            "",
            "-",
            "2026-04-31",
            "2026-4-3",
            "+026-04-03",
            "2026-04-03-1",
            "1969-12-31",
            "20261122",
        ] {
            assert_eq!(Day::parse(text), None, "{text}");
        }
        assert_eq!(UnixTime::new(u64::MAX).after(9), UnixTime::new(i64::MAX as u64));
    }
}
