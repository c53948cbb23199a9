//! Days, and the daily level of each.
//!
//! - The daily level of a day is the first floor of the daily run at home. Its name is `daily-` and the date, such as
//!   `daily-2026-11-28`. Rooms, scripts, boards and logs know it by this name alone.
//! - A day begins at midnight in UTC. A result counts during its day and, because a run may last past midnight and
//!   hosts may have different clocks, for [`TOLERANCE`] before and after it.
//! - The store keeps the boards of the last [`KEPT_DAYS`] days.

use std::fmt;

use cellcaster::cli::machine::{SECONDS_PER_DAY, date};
use cellcaster::fault::Faults;
use cellcaster::generate::descent;
use cellcaster::world::World;
use serde::{Deserialize, Serialize};

use super::UnixTime;

/// The time before and after a day in which a result still counts, in seconds. A run takes at most 20 minutes.
const TOLERANCE: u64 = 60 * 60;
/// The number of days whose boards are kept, including today.
pub(crate) const KEPT_DAYS: u32 = 7;
/// The part of a daily level's name before the date.
const PREFIX: &str = "daily-";
/// The floor of the daily run that is the daily level.
const FLOOR: u32 = 1;

/// A day in UTC, from 1970-01-01 to 9999-12-31.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize,
)]
#[serde(try_from = "u32", into = "u32")]
pub struct Day(u32);

impl Day {
    /// 9999-12-31.
    const LAST: Self = Self(2_932_896);

    /// The day of a time. Times after the last day belong to the last day.
    pub fn of(time: UnixTime) -> Self {
        let days = u32::try_from(time.seconds() / SECONDS_PER_DAY).unwrap_or(u32::MAX);
        Self(days).min(Self::LAST)
    }

    /// The day of a daily level; `None` if `level` is not the name of a daily level.
    pub fn of_level(level: &str) -> Option<Self> {
        Self::parse(level.strip_prefix(PREFIX)?)
    }

    /// Parses a date such as `2026-11-28`.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let number = |digits: &str| -> Option<u32> { digits.parse().ok() };
        let (year, rest) = text.split_once('-')?;
        let (month, day) = rest.split_once('-')?;
        let (year, month, day) = (number(year)?, number(month)?, number(day)?);
        let is_in_range =
            (1970..=9999).contains(&year) && (1..=12).contains(&month) && (1..=31).contains(&day);
        let found = is_in_range.then(|| Self(days_before(year, month, day)))?;
        // The 31st of February is another day in another form, and so is a number with a sign.
        (found.to_string() == text).then_some(found)
    }

    /// The name of the daily level.
    pub fn level(self) -> String {
        format!("{PREFIX}{self}")
    }

    /// The title of the daily level.
    pub(crate) fn title(self) -> String {
        format!("Daily {self}")
    }

    /// Generates the daily level. This takes 1 to 9 ms.
    ///
    /// # Errors
    /// None in practice; see [`descent`].
    pub(crate) fn world(self) -> Result<World, Faults> {
        descent(date(self.0.into()).into(), FLOOR)
    }

    /// The day `days` days earlier, or the first day.
    pub(crate) fn before(self, days: u32) -> Self {
        Self(self.0.saturating_sub(days))
    }

    /// The next day (`true`) or the previous one, among the days whose boards are kept until `today`.
    pub(crate) fn neighbour(self, forward: bool, today: Self) -> Self {
        let next = if forward { Self(self.0 + 1) } else { self.before(1) };
        next.clamp(today.before(KEPT_DAYS - 1), today)
    }

    /// Returns true if a result of the day counts at `time`.
    pub(crate) fn counts_at(self, time: UnixTime) -> bool {
        let begins = u64::from(self.0) * SECONDS_PER_DAY;
        let ends = begins + SECONDS_PER_DAY + TOLERANCE;
        (begins.saturating_sub(TOLERANCE)..ends).contains(&time.seconds())
    }
}

/// The number of days between 1970-01-01 and a date. Source: Howard Hinnant, "chrono-Compatible Low-Level Date
/// Algorithms", `days_from_civil`, 2013.
fn days_before(year: u32, month: u32, day: u32) -> u32 {
    // Years begin in March here.
    let year = if month > 2 { year } else { year - 1 };
    let day_of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    let (era, year_of_era) = (year / 400, year % 400);
    let day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
    (era * 146_097 + day_of_era).saturating_sub(719_468)
}

impl fmt::Display for Day {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let date = date(self.0.into());
        write!(f, "{}-{:02}-{:02}", date / 10_000, date / 100 % 100, date % 100)
    }
}

impl From<Day> for u32 {
    fn from(day: Day) -> Self {
        day.0
    }
}

impl TryFrom<u32> for Day {
    type Error = &'static str;

    fn try_from(days: u32) -> Result<Self, Self::Error> {
        (days <= Self::LAST.0).then_some(Self(days)).ok_or("a day after the year 9999")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn day(text: &str) -> Day {
        Day::parse(text).unwrap()
    }

    #[test]
    fn every_date_has_one_name() {
        for number in (0..=Day::LAST.0).step_by(97).chain([58, 59, 11_016, 11_017, Day::LAST.0]) {
            assert_eq!(Day::of_level(&Day(number).level()), Some(Day(number)));
        }
        assert_eq!(Day::of(UnixTime::new(1_795_824_000)).level(), "daily-2026-11-28");
        assert_eq!(Day::of(UnixTime::new(u64::MAX)).level(), "daily-9999-12-31");
        for other in [
            "cellar",
            "daily-",
            "daily-2026-11-28-0123456789abcdef",
            "daily-2026-11-31",
            "daily-2026-2-29",
            "daily-2025-02-29",
            "daily-2026-00-10",
            "daily-+2026-11-28",
            "daily-1969-12-31",
            "daily-10000-01-01",
            "daily-99999999999-01-01",
        ] {
            assert_eq!(Day::of_level(other), None, "{other}");
        }
    }

    #[test]
    fn a_result_counts_on_its_day_and_an_hour_around_it() {
        let midnight = UnixTime::new(1_795_824_000);
        let at = |seconds: i64| UnixTime::new(midnight.seconds().saturating_add_signed(seconds));
        let (yesterday, today) = (day("2026-11-27"), day("2026-11-28"));
        for (seconds, counts) in [
            (-3601, [true, false]),
            (-3600, [true, true]),
            (0, [true, true]),
            (3599, [true, true]),
            (3600, [false, true]),
        ] {
            let [before, now] = [yesterday, today].map(|day| day.counts_at(at(seconds)));
            assert_eq!([before, now], counts, "{seconds}");
        }
    }

    #[test]
    fn the_level_is_the_first_floor_of_the_daily_run() {
        let world = day("2026-11-28").world().unwrap();
        let floor = descent(cellcaster::generate::daily_seed(2026, 11, 28).into(), 1).unwrap();
        assert_eq!(world, floor);
        assert!(world.has_exit() && !world.guards().is_empty());
    }
}
