//! The user's machine: the folders for data and configuration, and the date.

use std::env;
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

use etcetera::base_strategy::choose_native_strategy;
use etcetera::{BaseStrategy, choose_base_strategy};

use super::{Error, config};
use crate::app::Configuration;
use crate::app::store::{Preferences, Store};
use crate::generate::daily_seed;

/// The folder `cellcaster` in the platform's data folder, or the folder in `CELLCASTER_DATA`.
/// `None` if there is no such folder.
pub fn data_folder() -> Option<PathBuf> {
    let named = env::var_os("CELLCASTER_DATA").filter(|name| !name.is_empty());
    named.map(PathBuf::from).or_else(|| {
        let folder = choose_native_strategy().ok()?.data_dir();
        Some(folder.join("cellcaster"))
    })
}

/// The player's store in [`data_folder`], or one in memory. Also returns a sentence if the store is
/// damaged or unusable.
pub(crate) fn open_store() -> (Store, Option<String>) {
    data_folder().map_or_else(|| (Store::in_memory(), None), |folder| Store::open(&folder))
}

/// The player's preferences and the settings in the configuration file, for programs that show the game on this machine.
///
/// # Errors
/// If the configuration file has faults.
pub fn own_settings() -> Result<(Preferences, Configuration), Error> {
    let configuration = config::load(None)?.configuration;
    let mut preferences = open_store().0.preferences();
    preferences.glyphs = preferences.glyphs.or(configuration.glyphs);
    preferences.colors = preferences.colors.or(configuration.colors);
    Ok((preferences, configuration))
}

/// The path of the file `name` in the folder `cellcaster` in the platform's configuration folder.
pub fn configuration_file(name: &str) -> Option<PathBuf> {
    let folder = choose_base_strategy().ok()?.config_dir();
    Some(folder.join("cellcaster").join(name))
}

/// The current date in UTC as a number, such as 20261122, and the seconds since 1970.
pub fn today() -> (u32, u64) {
    let elapsed = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    (date(elapsed.as_secs() / SECONDS_PER_DAY), elapsed.as_secs())
}

/// The number of seconds in a day.
pub const SECONDS_PER_DAY: u64 = 24 * 60 * 60;

/// The date `days` days after 1970-01-01, as a number such as 20261122, for years up to 9999. Source: Howard Hinnant, "chrono-Compatible Low-Level Date
/// Algorithms", `civil_from_days`, 2013.
pub fn date(days: u64) -> u32 {
    let days = days + 719_468;
    let era = days / 146_097;
    let day_of_era = days % 146_097;
    let year_of_era =
        (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    // Years begin in March here.
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    daily_seed(year as u32, month as u32, day as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_convert_to_dates() {
        for (days, expected) in [
            (0, 19_700_101),
            (58, 19_700_228),
            (59, 19_700_301),
            (11_016, 20_000_229),
            (11_017, 20_000_301),
            (20_779, 20_261_122),
            (20_818, 20_261_231),
            (20_819, 20_270_101),
        ] {
            assert_eq!(date(days), expected, "day {days}");
        }
    }
}
