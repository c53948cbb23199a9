//! Private rooms of a cluster.

use super::Hosts;
use crate::play::private::{enter_by_code, open_private};

#[test]
fn the_code_of_a_private_room_leads_in_from_every_host() {
    let hosts = Hosts::start(2);
    let [mara, jon] = [0, 1].map(|host| hosts.running[host].0.visitor());
    let code = open_private(&mara, "Mara");
    enter_by_code(&jon, "Jon", &code);
    mara.wait_for("Jon has joined.");
    let rooms = hosts.running[1].0.admin_says(&["rooms"]);
    assert!(rooms.contains("2/8 Mara, Jon (private)"), "{rooms}");
}
