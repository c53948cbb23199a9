//! Requests of sessions to their drivers, and the answers of the store.

use std::sync::Arc;

use tokio::sync::mpsc;

use super::account::{self, choose_name};
use super::results;
use super::stay::Way;
use super::visit::Visit;
use crate::accounts::{Account, AccountSettings, Name, Origin};
use crate::lock::locked;
use crate::ops::logging::events;
use crate::rooms::directory::{Place, RoomRefusal};
use crate::rooms::room::Command;
use crate::rooms::sequencer::{CommandRefusal, FinishedRun};
use crate::sessions::session::{Request, SessionEvent};
use cellcaster::world::Difficulty;

/// What the store has answered.
pub(crate) enum Reply {
    /// A name, with the account that has it now; `None` for a guest.
    Named(Name, Result<Option<Account>, String>),
    SessionEvent(SessionEvent),
    /// A place in a room of the cluster.
    Place(Result<Place, RoomRefusal>),
    /// The place in which the visitor was before.
    Returned(Result<Place, RoomRefusal>),
}

/// The most answers that wait for a session. Further ones are dropped, as those to a flood of wishes.
const MOST_REPLIES: usize = 16;

pub(crate) fn replies() -> (mpsc::Sender<Reply>, mpsc::Receiver<Reply>) {
    mpsc::channel(MOST_REPLIES)
}

impl Visit {
    /// Does what the session requests.
    pub(crate) fn run_requests(&mut self) {
        loop {
            let requests = self.session.requests();
            if requests.is_empty() {
                return;
            }
            for ask in requests {
                self.run_request(ask);
            }
        }
    }

    fn run_request(&mut self, ask: Request) {
        match ask {
            Request::Name(text) => self.choose_name(&text),
            Request::Rooms => {
                self.in_lobby = true;
                let rooms = self.rooms.borrow_and_update().clone();
                self.notify(SessionEvent::Rooms(rooms));
            }
            Request::Enter { room, watches: true } => self.go(Way::Watch(room)),
            Request::Enter { room, watches: false } => self.go(Way::Enter(room)),
            Request::Open(wish) => self.go(Way::Open(wish)),
            Request::Command(command) => self.act(command),
            Request::Leave => self.leave(),
            Request::Board { level, difficulty } => self.show_board(level, difficulty),
            Request::Ghosts { level, difficulty } => self.show_ghosts(level, difficulty),
            Request::Save(settings) => self.save(settings),
        }
    }

    /// Records an answer of the store.
    pub(crate) fn hear(&mut self, reply: Reply) {
        let event = match reply {
            Reply::SessionEvent(event) => event,
            Reply::Named(name, Ok(account)) => self.take_name(name, account),
            Reply::Named(_, Err(sentence)) => SessionEvent::Named(Err(sentence)),
            Reply::Place(place) => return self.enter(place),
            Reply::Returned(place) => return self.returned(place),
        };
        self.notify(event);
    }

    /// Has a run verified and recorded.
    pub(crate) fn submit(&mut self, run: FinishedRun) {
        let Some(account) = self.account.clone() else {
            let sentence = "A guest's result does not rank: come with a public key.";
            return self.notify(SessionEvent::Result(sentence.to_owned()));
        };
        let (replies, recorder) = (self.replies.clone(), self.shared.recorder.clone());
        let is_accepted = self.shared.store.run(move |store| {
            let sentence = recorder.record(store, &account, &run);
            _ = replies.try_send(Reply::SessionEvent(SessionEvent::Result(sentence)));
        });
        if !is_accepted {
            self.notify(SessionEvent::Result("The host can't check your result now.".to_owned()));
        }
    }

    pub(crate) fn notify(&mut self, event: SessionEvent) {
        let now = self.shared.now();
        self.session.notify(event, now);
    }

    fn choose_name(&mut self, text: &str) {
        let offered =
            (self.key.is_none() && text == self.offer.as_str()).then(|| self.offer.clone());
        let name = match offered.map_or_else(|| Name::new(text), Ok) {
            Ok(name) => name,
            Err(fault) => return self.notify(SessionEvent::Named(Err(fault.to_string()))),
        };
        if self.name.as_ref() == Some(&name) {
            return self.notify(SessionEvent::Named(Ok(account::line(&name))));
        }
        let (key, account) = (self.key, self.account.as_ref().map(|account| account.id));
        let origin = Origin::new(self.address, self.shared.config.get().accounts);
        let replies = self.replies.clone();
        let is_accepted = self.shared.store.run(move |store| {
            let result = choose_name(store, &origin, key, account, &name);
            _ = replies.try_send(Reply::Named(name, result));
        });
        if !is_accepted {
            self.notify(SessionEvent::Named(Err("The host is busy; try again.".to_owned())));
        }
    }

    fn take_name(&mut self, name: Name, account: Option<Account>) -> SessionEvent {
        if account.is_none() {
            self.guest_name = None;
            self.guest_name = self.shared.names.reserve(&name);
            if self.guest_name.is_none() {
                return SessionEvent::Named(Err(
                    "Somebody here has this name; take another.".to_owned()
                ));
            }
        }
        let line = account::line(&name);
        self.presence.set_name(name.as_str());
        events::named(self.key.as_ref(), name.as_str());
        self.account = account.or(self.account.take());
        self.name = Some(name);
        SessionEvent::Named(Ok(line))
    }

    fn act(&mut self, command: Command) {
        let Some(place) = &self.place else { return };
        if place.act(command) == Err(CommandRefusal::TooOften) {
            self.notify(SessionEvent::Result("Not so fast: wait a second.".to_owned()));
        }
    }

    fn show_board(&mut self, level: String, difficulty: Difficulty) {
        let own = self.account.as_ref().map(|account| account.id);
        let replies = self.replies.clone();
        self.shared.store.run(move |store| {
            let rows = results::board(store, &level, difficulty, own).into();
            _ = replies.try_send(Reply::SessionEvent(SessionEvent::Board {
                level,
                difficulty,
                rows,
            }));
        });
    }

    /// Has the best runs of a level played, for this visitor alone: who else is in the room may want
    /// other ones.
    fn show_ghosts(&mut self, level: String, difficulty: Difficulty) {
        let own = self.account.as_ref().map(|account| account.id);
        let (replies, runs) = (self.replies.clone(), Arc::clone(&self.shared.runs));
        let catalog = Arc::clone(self.shared.rooms.catalog());
        self.shared.store.run(move |store| {
            let board = (level.as_str(), difficulty);
            let ghosts = locked(&runs, |runs| runs.ghosts(store, &catalog, board, own));
            match ghosts {
                Ok(ghosts) => {
                    let ghosts = ghosts.into();
                    _ = replies.try_send(Reply::SessionEvent(SessionEvent::Ghosts {
                        level,
                        difficulty,
                        ghosts,
                    }));
                }
                Err(failure) => events::store_failed(failure),
            }
        });
    }

    fn save(&mut self, settings: AccountSettings) {
        let Some(account) = self.account.as_ref().map(|account| account.id) else { return };
        self.shared.store.run(move |store| {
            if let Err(failure) = store.set_settings(account, &settings) {
                events::store_failed(failure);
            }
        });
    }
}
