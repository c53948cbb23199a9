//! Races with ghosts.

use cellcaster_server::accounts::{AccountKey, HostStore, Name, UnixTime, verify};

use crate::running::Running;

/// A run that goes straight on for its first seven seconds.
const RUN: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/scripts/archive.normal.script"));

fn record_run_of_mara(store: &mut HostStore) {
    let now = UnixTime::new(1_000);
    let key = AccountKey::new([7; 32]);
    let mara = store.create_account(None, &key, &Name::new("Mara").unwrap(), now).unwrap();
    let run = verify(RUN, |_| None).expect("a run");
    store.record(mara.id, &run, now).unwrap();
}

#[test]
fn the_best_run_of_the_board_walks_along_in_a_race() {
    let server = Running::start_filled(record_run_of_mara);
    let jon = server.visitor();
    jon.wait_for("Enter saves it");
    jon.send("\x15Jon\r");
    for (shown, key) in
        [("Open a room", "3"), ("Campaign together", "4"), ("The Archive", "6"), ("Go in", "\r")]
    {
        jon.wait_for(shown);
        jon.send(key);
    }
    jon.wait_for("Jon has joined.");
    jon.wait_for("Mara's best");
}
