//! Which standing rooms a host lists.

use std::time::Duration;

use tokio::runtime::Builder;
use tokio::time::sleep;

use super::super::Entrant;
use super::Run;
use crate::rooms::directory::RoomLimits;
use crate::sessions::line::Line;

/// Long enough for the configuration to be followed, and for a room to end on its host.
const WHILE: Duration = Duration::from_secs(12);

#[test]
fn a_standing_room_that_is_taken_out_is_listed_while_somebody_is_in_it() {
    let runtime = Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
    runtime.block_on(async {
        let run = Run::new(7);
        let listed = |host: usize| run.hosts[host].rooms.summaries().borrow().len();
        sleep(WHILE).await;
        assert_eq!([0, 1, 2].map(listed), [1; 3]);
        let [one, other] = [0, 1].map(|host| &run.hosts[host]);
        let id = one.rooms.summaries().borrow()[0].id;
        let limits = RoomLimits { standing: Vec::new(), ..one.rooms.limits() };
        one.shared.set_limits(limits);
        sleep(WHILE).await;
        // The other hosts have it in their configurations.
        assert_eq!([0, 1, 2].map(listed), [0, 1, 1]);
        let entrant = Entrant { name: Line::of("ada", 16).unwrap(), key: None };
        let place = other.shared.enter(id, &entrant).await.unwrap();
        sleep(WHILE).await;
        assert_eq!([0, 1, 2].map(listed), [1; 3]);
        drop(place);
        sleep(WHILE).await;
        assert_eq!([0, 1, 2].map(listed), [0, 1, 1]);
    });
}
