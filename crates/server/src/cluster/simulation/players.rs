//! The players of a simulation.

use tokio::task::JoinHandle;

use super::super::Entrant;
use super::super::message::LogMessage;
use super::world::World;
use super::{ClusterRun, HOSTS, room_request};
use crate::accounts::AccountKey;
use crate::line::Line;
use crate::rooms::directory::{Place, RoomRefusal};
use crate::rooms::room::{Command, MemberId};
use crate::rooms::summary::RoomId;
use cellcaster::game::{Intent, Intents};

/// The first guest. All later players are guests, too.
const FIRST_GUEST: usize = 4;

pub(crate) struct SimulatedPlayer {
    pub(crate) host: usize,
    pub(crate) place: Option<Place>,
    pub(crate) entrant: Entrant,
    entering: Option<JoinHandle<Result<Arrived, RoomRefusal>>>,
    /// `true` if the player reconnects, and asks for the place in which they were.
    connects: bool,
    /// Places that another connection of the same player has taken.
    pub(crate) taken: Vec<(usize, Place)>,
}

/// A player who is in a room.
struct Arrived {
    place: Place,
    host: usize,
    is_return: bool,
}

impl SimulatedPlayer {
    pub(crate) fn new(index: usize) -> Self {
        let name = Line::of(&format!("p{index}"), 16).expect("a name");
        let key = (index < FIRST_GUEST).then(|| AccountKey::new([index as u8; 32]));
        Self {
            host: 0,
            place: None,
            entrant: Entrant { name, key },
            entering: None,
            connects: false,
            taken: Vec::new(),
        }
    }

    /// Leaves the host because it ends.
    pub(crate) fn part(&mut self) {
        if let Some(mut place) = self.place.take() {
            place.set_kept(true);
        }
        self.lose_host();
    }

    /// Loses the host, which sends nothing more.
    fn lose_host(&mut self) {
        std::mem::forget(self.place.take());
        self.entering = None;
        self.connects = true;
    }
}

impl ClusterRun {
    /// Lets a player act.
    pub(crate) async fn act(&mut self, index: usize) {
        self.arrive(index).await;
        let Self { chance, hosts, players, .. } = self;
        let player = &mut players[index];
        if hosts[player.host].is_killed {
            player.lose_host();
            player.host = chance.below(HOSTS);
            return;
        }
        match &player.place {
            None if player.entering.is_none() => self.enter(index),
            Some(_) if chance.one_in(60) => self.leave(index),
            Some(_) if chance.one_in(60) => self.connect_again(index),
            Some(place) => {
                let command = match chance.below(12) {
                    0 => Command::Say(Line::of("hello", 60).expect("a line")),
                    1 => Command::Again,
                    it => {
                        let intent = [Intent::Forward, Intent::TurnLeft, Intent::TurnRight][it % 3];
                        let intents: Intents = [intent].into_iter().collect();
                        Command::Intents { seen: 0, intents }
                    }
                };
                place.act(command);
            }
            None => {}
        }
    }

    /// Sends a player back to their place if they reconnect, or otherwise into a room.
    fn enter(&mut self, index: usize) {
        let Self { chance, hosts, players, .. } = self;
        let player = &mut players[index];
        player.host = chance.below(HOSTS);
        let (host, entrant) = (player.host, player.entrant.clone());
        let (shared, is_own) = (hosts[host].shared.clone(), chance.one_in(6));
        let room = hosts[host].rooms.summaries().borrow().first().map(|it| it.id);
        let key = entrant.key.filter(|_| std::mem::take(&mut player.connects));
        player.entering = Some(tokio::spawn(async move {
            if let Some(key) = key
                && let Some(at) = shared.place_of(key).await
                && let Ok(place) = shared.resume(key, at).await
            {
                return Ok(Arrived { place, host, is_return: true });
            }
            let place = match room.filter(|_| !is_own) {
                Some(room) => shared.enter(room, &entrant).await,
                None => shared.open(&room_request(), false, &entrant).await,
            };
            place.map(|place| Arrived { place, host, is_return: false })
        }));
    }

    fn leave(&mut self, index: usize) {
        let player = &mut self.players[index];
        player.place = None;
        if let Some(key) = player.entrant.key {
            let shared = self.hosts[player.host].shared.clone();
            tokio::spawn(async move { shared.forget_place(key).await });
        }
    }

    /// Connects a player a second time, and asks for their place.
    fn connect_again(&mut self, index: usize) {
        let Self { chance, hosts, players, .. } = self;
        let player = &mut players[index];
        let host = chance.below(HOSTS);
        let Some(key) = player.entrant.key.filter(|_| player.entering.is_none()) else { return };
        let shared = hosts[host].shared.clone();
        player.entering = Some(tokio::spawn(async move {
            let at = shared.place_of(key).await.ok_or(RoomRefusal::Gone)?;
            let place = shared.resume(key, at).await?;
            Ok(Arrived { place, host, is_return: true })
        }));
    }

    /// Notes that a player was let in.
    pub(crate) async fn arrive(&mut self, index: usize) {
        let player = &mut self.players[index];
        let Some(entering) = player.entering.take_if(|it| it.is_finished()) else { return };
        let Ok(Arrived { place, host, is_return }) = entering.await.expect("no panic") else {
            return;
        };
        if self.hosts[host].is_killed {
            // Nobody receives the answer.
            std::mem::forget(place);
            return;
        }
        let at = (place.room(), place.member_id().expect("a member"));
        if is_return {
            let name = &player.entrant.name;
            assert!(has_joined(&self.world, at, name), "player {index} returns to another member");
            self.returns += 1;
        } else {
            self.let_in.push(at);
        }
        let taken = player.place.replace(place);
        player.taken.extend(taken.map(|place| (player.host, place)));
        player.host = host;
    }
}

/// Returns true if the log says that a player of this name has become that member. The player may not
/// have heard of it.
fn has_joined(world: &World, (room, id): (RoomId, MemberId), who: &Line) -> bool {
    world.log(room).iter().any(|kept| {
        let message = LogMessage::parse(&kept.bytes).expect("a message");
        let mut joined = message.entries.iter().filter(|entry| entry.member == id);
        joined.any(|entry| matches!(&entry.command, Command::Join { name, .. } if name == who))
    })
}
