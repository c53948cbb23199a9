use std::io;

use tokio::runtime::Builder;

use super::*;
use crate::logging::LogFormat;
use crate::logging::tests::logged;
use crate::metrics::Metrics;
use crate::rooms::room::{Entry, NAME_COLUMNS};
use crate::rooms::sequencer::Recording;
use cellcaster::game::PlayerColor;
use cellcaster::world::Difficulty;

impl Rooms {
    /// Closes a room, as a fault would.
    pub(crate) fn close(&self, id: RoomId, sentence: &str) {
        self.locked(|it| it.rooms[&id].interface.close(sentence));
    }
}

/// A recording that panics on the first entry.
struct Broken;

impl Recording for Broken {
    fn begin(&mut self, _: &Header) -> io::Result<()> {
        Ok(())
    }

    fn append(&mut self, _: &Entry) -> io::Result<()> {
        panic!("the log is broken")
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn room_request(mode: Mode) -> RoomRequest {
    RoomRequest { level: "museum".to_owned(), mode, difficulty: Difficulty::default() }
}

/// A directory whose first room is a standing one. The rooms in `broken` panic as soon as somebody joins.
fn rooms(broken: &'static [u32]) -> Rooms {
    let limits = RoomLimits {
        most: 4,
        most_watchers: 4,
        closes_after: Duration::ZERO,
        standing: vec![room_request(Mode::Roam)],
    };
    let recordings = Recordings::new(|id, _| {
        broken.contains(&id.0).then(|| -> Box<dyn Recording> { Box::new(Broken) })
    });
    let load = Arc::new(Load::new(Arc::<Metrics>::default()));
    Rooms::new(limits, Arc::new(Catalog::builtin()), recordings, load, Seeds { rooms: 7, codes: 8 })
}

/// Runs `act`; returns the log messages about rooms.
fn run(act: impl AsyncFnOnce()) -> String {
    let runtime = Builder::new_current_thread().enable_all().build().unwrap();
    logged(LogFormat::Text, "off,rooms=info", |_| runtime.block_on(act()))
}

fn name(text: &str) -> Line {
    Line::of(text, NAME_COLUMNS).unwrap()
}

async fn end_of(place: &mut Place) -> Arc<str> {
    loop {
        if let Some(sentence) = place.closed() {
            return sentence;
        }
        place.changed(Instant::now()).await;
    }
}

/// Waits until the lobby lists exactly these rooms.
async fn listed(rooms: &Rooms, ids: &[u32]) {
    let mut summaries = rooms.summaries();
    let is_right =
        |list: &Arc<[RoomSummary]>| list.iter().map(|room| room.id.0).eq(ids.iter().copied());
    summaries.wait_for(is_right).await.unwrap();
}

#[test]
fn a_panic_ends_only_its_own_room() {
    let text = run(async || {
        let rooms = rooms(&[2]);
        let mut ben = rooms.enter(RoomId(1), &name("Ben")).unwrap();
        let mut ada = rooms.open(&room_request(Mode::Tag), false, &name("Ada")).unwrap();
        let mut watcher = rooms.watch(RoomId(2)).unwrap();
        assert!(end_of(&mut ada).await.contains("error in this server"));
        assert!(end_of(&mut watcher).await.contains("error in this server"));
        assert!(ada.act(Command::Again));
        drop((ada, watcher));
        listed(&rooms, &[1]).await;
        assert_eq!(rooms.enter(RoomId(2), &name("Ada")).err(), Some(RoomRefusal::Gone));
        let before = ben.view().unwrap().step;
        ben.changed(Instant::now()).await;
        assert!(ben.view().unwrap().step > before);
        assert_eq!(
            rooms.open(&room_request(Mode::Tag), false, &name("Ada")).unwrap().room(),
            RoomId(3)
        );
    });
    let failed: Vec<&str> = text.lines().filter(|line| line.contains("failed")).collect();
    assert_eq!(failed.len(), 1, "{text}");
    assert!(failed[0].contains(r#"room=2 error="the log is broken""#), "{text}");
}

#[test]
fn a_standing_room_that_panics_is_reopened() {
    run(async || {
        let rooms = rooms(&[1]);
        let mut ada = rooms.enter(RoomId(1), &name("Ada")).unwrap();
        end_of(&mut ada).await;
        listed(&rooms, &[2]).await;
        let ada = rooms.enter(RoomId(2), &name("Ada")).unwrap();
        ada.changed(Instant::now()).await;
        assert_eq!(ada.closed(), None);
    });
}

/// Rooms that everybody has left are closed. Only the standing rooms remain.
#[test]
fn empty_rooms_are_closed_and_forgotten() {
    run(async || {
        let rooms = rooms(&[]);
        for _ in 0..20 {
            let places: Vec<Place> = (0..3)
                .map(|_| rooms.open(&room_request(Mode::Tag), false, &name("Ada")).unwrap())
                .collect();
            let full = rooms.open(&room_request(Mode::Tag), false, &name("Ben")).err();
            assert_eq!(full, Some(RoomRefusal::TooMany));
            drop(places);
            listed(&rooms, &[1]).await;
        }
        assert_eq!(rooms.locked(|it| it.rooms.len()), 1);
    });
}

#[test]
fn the_end_of_a_round_is_logged() {
    let text = run(async || {
        let rooms = rooms(&[]);
        let header = Header::new("museum", Mode::Hide, Difficulty::default(), 7);
        let mut room = Room::new(rooms.catalog(), header).unwrap();
        let (id, ..) = rooms.add(&room_request(Mode::Hide), false, None).unwrap();
        for (member, member_name) in [(1, "Ada"), (2, "Ben")] {
            let command = Command::Join { color: PlayerColor::ALL[0], name: name(member_name) };
            room.apply(&Entry { step: room.step(), member: MemberId(member), command });
        }
        while !matches!(room.phase(), Phase::Over { .. }) {
            room.advance();
            rooms.change(id, &room);
        }
        room.advance();
        rooms.change(id, &room);
    });
    let ended: Vec<&str> = text.lines().filter(|line| line.contains("round ended")).collect();
    assert_eq!(ended.len(), 1, "{text}");
    assert!(ended[0].contains("winner="), "{text}");
}

#[test]
fn a_member_who_returns_on_another_connection_gets_a_new_place() {
    use crate::rooms::room::{CHAT_COLUMNS, Room};
    use crate::simulation;

    let catalog = Arc::new(simulation::catalog(simulation::HALL));
    let header = Header::new("hall", Mode::Roam, Difficulty::Normal, 7);
    let room = Room::new(&catalog, header).unwrap();
    let interface = RoomInterface::new(&room, true, Duration::ZERO, None);
    let member = interface.inbox.join(&Line::of("Mara", NAME_COLUMNS).unwrap()).unwrap();
    let place = || Place::member(RoomId(1), member, Arc::clone(&interface));
    let first = place();
    assert!(first.closed().is_none());
    interface.inbox.dismiss(member);
    interface.inbox.admit(member, PlayerColor::ALL[0]);
    let second = place();
    assert!(first.closed().is_some() && second.closed().is_none());
    let hello = Command::Say(Line::of("hello", CHAT_COLUMNS).unwrap());
    assert!(!first.act(hello.clone()));
    drop(first);
    assert!(second.closed().is_none() && second.act(hello));
    drop(second);
    assert_eq!(interface.inbox.seated(), []);
}
