//! Today's daily level.

use cellcaster::map;
use cellcaster_server::accounts::{AccountKey, Day, HostStore, Name, UnixTime, verify};

use crate::running::Running;

/// A corridor in place of the daily level: the store keeps results, not levels.
const CORRIDOR: &str = "grid = '''\n#####\n#@.>#\n#####\n'''\n[tiles]\n\"#\" = { wall = \"brick\" }\n\
                        [things]\n\"@\" = { start = 0 }\n\">\" = { exit = true }\n";

fn record_run_of_mara(store: &mut HostStore) {
    let now = UnixTime::now();
    let key = AccountKey::new([7; 32]);
    let mara = store.create_account(None, &key, &Name::new("Mara").unwrap(), now).unwrap();
    let script = format!("level {}\n4 s forward\n", Day::of(now).level());
    let run = verify(&script, |level| map::parse(CORRIDOR, level, &map::NoFiles).ok());
    store.record(mara.id, &run.expect("a run"), now).unwrap();
}

#[test]
fn two_players_race_in_the_daily_level_of_today() {
    let today = format!("Daily {}", Day::of(UnixTime::now()));
    let server = Running::start_filled(record_run_of_mara);
    let [jon, kim] = ["Jon", "Kim"].map(|name| {
        let player = server.visitor();
        player.wait_for("Enter saves it");
        player.send(format!("\x15{name}\r"));
        player.wait_for("1. Mara");
        player
    });
    for (shown, key) in [(today.as_str(), "d"), ("until midnight", "2"), ("Go in", "\r")] {
        jon.wait_for(shown);
        jon.send(key);
    }
    jon.wait_for("Jon has joined.");
    jon.wait_for(&today);
    for (shown, key) in [(today.as_str(), "d"), ("until midnight", "1"), ("Here: Jon.", "\r")] {
        kim.wait_for(shown);
        kim.send(key);
    }
    jon.wait_for("Kim has joined.");
}
