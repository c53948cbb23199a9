//! Talk between visitors beyond a room, and what limits it.
//!
//! # Rules
//!
//! - The driver checks for a mute before a line or an emote of its visitor reaches a room, the lobby or another
//!   visitor. A room's log therefore contains no line of a muted member.
//! - The store contains the mutes. A host reads them at each login and every [`MUTES_INTERVAL`], so that a mute holds
//!   on all hosts that share the store. Rejected: a request to all hosts for each mute. A host that did not answer
//!   would not know of it.
//! - A visitor may send [`TALK_BURST`] lines at once, and after that one per second.
//! - A moderator is a visitor whose verified key is in the configuration, as of each act.

use std::sync::{Arc, Weak};
use std::time::Duration;

use tokio::sync::watch;
use tokio::time::sleep;

use super::Shared;
use super::login;
use super::visit::{Driver, Reply};
use crate::accounts::{
    Ban, BanScope, BanTarget, HostStore, Identity, Name, StoreFailure, UnixTime, time_text,
};
use crate::admin::{AdminRequest, Target};
use crate::line::Line;
use crate::logging;
use crate::operator::Operator;
use crate::rooms::directory::Place;
use crate::rooms::room::{Command, RoomView};
use crate::sessions::session::{Moderation, SessionEvent};
use crate::visitors::{Heard, VisitorRow, Visitors};

/// The interval at which a host looks for new mutes.
const MUTES_INTERVAL: Duration = Duration::from_secs(2);
/// The number of lines that a visitor may send at once.
pub(crate) const TALK_BURST: f64 = 5.0;
/// The number of lines that a visitor may send per second.
pub(crate) const TALK_RATE: f64 = 1.0;
/// The number of reports that a visitor may send at once.
pub(crate) const REPORT_BURST: f64 = 3.0;
/// The number of reports that a visitor may send per second.
pub(crate) const REPORT_RATE: f64 = 1.0 / 30.0;
/// The most players who are listed.
const MAX_PLAYERS: usize = 64;

const TOO_OFTEN: &str = "Not so fast: wait a second.";
const BUSY: &str = "The host is busy; try again.";

/// A moderator's act against a player.
struct PendingModeration {
    moderator: Name,
    player: Name,
    kind: Moderation,
    reason: String,
}

/// Requests about talk.
impl Driver {
    /// Submits a command to the room, unless it is talk and the visitor may not talk.
    pub(crate) fn act(&mut self, command: Command) {
        let is_talk = matches!(command, Command::Say(_) | Command::Emote(_));
        if is_talk && !self.may_talk() {
            return;
        }
        if matches!(command, Command::Again) && !self.talk.takes_one(self.shared.now()) {
            return self.advise(TOO_OFTEN.to_owned());
        }
        if let Some(place) = &self.place {
            place.act(command);
        }
    }

    /// Shows a line to everybody in the lobby.
    pub(crate) fn say_in_lobby(&mut self, text: &Line) {
        if self.place.is_none() && self.may_talk() {
            self.shared.visitors.tell_lobby(&self.line(text, false));
        }
    }

    /// Shows a line to one visitor, in a cluster also to a visitor of another host.
    pub(crate) fn tell(&mut self, to: Line, text: Line) {
        if !self.may_talk() {
            return;
        }
        let line = self.line(&text, true);
        let name = Name::kept(to.as_str());
        if self.shared.visitors.tell(&name, &line) > 0 {
            return self.notify(SessionEvent::Told { to, text });
        }
        if self.shared.cluster.is_none() {
            return self.advise(nobody(to.as_str()));
        }
        let Heard { from, text: said, .. } = line;
        let request = AdminRequest::Tell { from, to: name, text: said };
        let (operator, replies) = (self.shared.as_operator(), self.replies.clone());
        tokio::spawn(async move {
            let event = match operator.answer(&request).await.count {
                0 => SessionEvent::Advice(nobody(to.as_str())),
                _ => SessionEvent::Told { to, text },
            };
            _ = replies.send(Box::new(Reply::SessionEvent(event))).await;
        });
    }

    /// Lists the other visitors in the room or in the lobby.
    pub(crate) fn list_players(&mut self) {
        let view = self.place.as_mut().and_then(Place::view);
        let members = view.iter().flat_map(|view| view.members.iter());
        let mut names: Vec<Line> = members.map(|member| member.name.clone()).collect();
        let room = self.place.as_ref().map(|place| place.room().place());
        let visitors = self.shared.visitors.names_in(room.as_deref(), MAX_PLAYERS + 1);
        for name in visitors.iter().map(login::line) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let own = self.name.as_ref().map(login::line);
        names.retain(|name| Some(name) != own.as_ref());
        names.truncate(MAX_PLAYERS);
        self.notify(SessionEvent::Players { names: names.into(), moderates: self.moderates() });
    }

    /// Writes a report into the log, and shows it to the moderators on this host. `lines` are the last lines of the
    /// player that the visitor has seen.
    pub(crate) fn report(&mut self, player: &Line, reason: Option<&Line>, lines: Vec<String>) {
        let Some(own) = self.name.clone() else { return };
        let name = Name::kept(player.as_str());
        let present = self.shared.visitors.named(&name);
        let view = self.place.as_mut().and_then(Place::view);
        if present.is_none() && lines.is_empty() && !is_member(view.as_deref(), player) {
            return self.advise(nobody(player.as_str()));
        }
        if !self.reports.takes_one(self.shared.now()) {
            let sentence = "You have reported several players; wait half a minute.";
            return self.advise(sentence.to_owned());
        }
        let reason = reason.map_or(String::new(), Line::to_string);
        let text = match reason.as_str() {
            "" => format!("{own} reports {player}."),
            reason => format!("{own} reports {player}: {reason}"),
        };
        for moderator in &self.shared.config.get().moderators {
            self.shared.visitors.say_to(moderator, &text);
        }
        let (reporter, room) = ((own, self.key), self.place.as_ref().map(|it| it.room().place()));
        let key = present.and_then(|present| present.key);
        let player = player.to_string();
        self.call_store(move |store| {
            let account = || store.account_named(&name).ok().flatten().map(|account| account.key);
            let reported = (player.as_str(), key.or_else(account));
            let reporter = (reporter.0.as_str(), reporter.1);
            logging::reported(reporter, reported, room.as_deref(), &reason, &lines);
            let sentence = format!("You have reported {player} to this host.");
            Some(Reply::SessionEvent(SessionEvent::Advice(sentence)))
        });
    }

    /// Carries out an act of a moderator.
    pub(crate) fn moderate(&mut self, player: &Line, act: Moderation, reason: Option<&Line>) {
        let Some(moderator) = self.name.clone().filter(|_| self.moderates()) else {
            return self.advise("Only moderators of this host can do that.".to_owned());
        };
        if !self.talk.takes_one(self.shared.now()) {
            return self.advise(TOO_OFTEN.to_owned());
        }
        let player = Name::kept(player.as_str());
        let reason = reason.map_or(String::new(), Line::to_string);
        let act = PendingModeration { moderator, player, kind: act, reason };
        let (shared, replies) = (Arc::clone(&self.shared), self.replies.clone());
        tokio::spawn(async move {
            let sentence = shared.moderate(act).await.unwrap_or_else(|sentence| sentence);
            _ = replies.send(Box::new(Reply::SessionEvent(SessionEvent::Advice(sentence)))).await;
        });
    }

    fn moderates(&self) -> bool {
        self.key.is_some_and(|key| self.shared.config.get().moderators.contains(&key))
    }

    /// Returns true if the visitor may talk now. Otherwise, tells them why not.
    fn may_talk(&mut self) -> bool {
        if !self.talk.takes_one(self.shared.now()) {
            self.advise(TOO_OFTEN.to_owned());
            return false;
        }
        let (address, now) = (Some(self.address), UnixTime::now());
        let identity = Identity { address, key: self.key.as_ref(), name: self.name.as_ref() };
        let Some(mute) = self.shared.visitors.mute_of(&identity, now) else { return true };
        self.advise(muted(&mute, now));
        false
    }

    fn line(&self, text: &Line, is_private: bool) -> Heard {
        let from = self.name.as_ref().map_or(String::new(), Name::to_string);
        Heard { from, text: text.to_string(), is_private }
    }

    fn advise(&mut self, sentence: String) {
        self.notify(SessionEvent::Advice(sentence));
    }
}

impl Shared {
    /// An operator for requests that list no rooms and do not end the host.
    fn as_operator(&self) -> Operator {
        Operator::new(
            self.visitors.clone(),
            Vec::new,
            watch::Sender::default(),
            self.cluster.clone(),
        )
    }

    /// Carries out a moderator's act, and returns a sentence for the moderator: as an error, if the act had no effect.
    async fn moderate(&self, act: PendingModeration) -> Result<String, String> {
        let PendingModeration { moderator, player, kind, reason } = act;
        let found = self.find(&player).await;
        let (by, name) = (moderator.to_string(), player.to_string());
        match kind {
            Moderation::Kick => {
                let request = AdminRequest::Remove {
                    target: Target::Visitors(BanTarget::Name(player)),
                    reason: reason.clone(),
                    banned: false,
                    moderator: Some(by.clone()),
                };
                found.ok_or_else(|| nobody(&name))?;
                self.as_operator().answer(&request).await;
                logging::kicked(&by, &name, &reason);
                Ok(format!("The session of {name} has ended."))
            }
            Moderation::Mute(time) => {
                let found = found.map(|row| row.talker());
                let sentence = format!("{name} is muted for {}.", time_text(time.as_secs()));
                let ban = move |target, made_at: UnixTime| Ban {
                    scope: BanScope::Talk,
                    target,
                    until: Some(made_at.after(time.as_secs())),
                    reason,
                    by: Ban::by_moderator(&moderator),
                    made_at,
                };
                self.change_mutes(move |store| {
                    let Some(target) =
                        found.map_or_else(|| account(store, &player), |it| Ok(Some(it)))?
                    else {
                        return Ok(Err(nobody(player.as_str())));
                    };
                    logging::muted(&by, player.as_str(), &target, time.as_secs());
                    store.ban(&ban(target, UnixTime::now()))?;
                    Ok(Ok(sentence))
                })
                .await
            }
            Moderation::Unmute => {
                let found = found.map(|row| row.talker());
                self.change_mutes(move |store| {
                    let account = account(store, &player)?;
                    let named = Some(BanTarget::Name(player.clone()));
                    let mut is_ended = false;
                    for target in [found, account, named].into_iter().flatten() {
                        is_ended |= store.unban(BanScope::Talk, &target)?;
                    }
                    if !is_ended {
                        return Ok(Err(format!("{player} is not muted.")));
                    }
                    logging::unmuted(&by, player.as_str());
                    Ok(Ok(format!("{player} may talk again.")))
                })
                .await
            }
        }
    }

    /// Changes the mutes in the store, and reads them again.
    async fn change_mutes(
        &self,
        act: impl FnOnce(&mut HostStore) -> Result<Result<String, String>, StoreFailure>
        + Send
        + 'static,
    ) -> Result<String, String> {
        let visitors = self.visitors.clone();
        let answer = self.store.call(move |store| {
            let result = act(store)?;
            read_mutes(store, &visitors)?;
            Ok::<_, StoreFailure>(result)
        });
        match answer.await {
            Ok(Ok(result)) => result,
            Ok(Err(failure)) => {
                logging::store_failed(failure);
                Err(BUSY.to_owned())
            }
            Err(_) => Err(BUSY.to_owned()),
        }
    }

    /// The visitor with this name, in a cluster also on another host.
    async fn find(&self, name: &Name) -> Option<VisitorRow> {
        let own = self.visitors.named(name);
        if own.is_some() || self.cluster.is_none() {
            return own;
        }
        let is_called = |row: &VisitorRow| row.name.as_ref().is_some_and(|it| it.looks_like(name));
        let everybody = self.as_operator().answer(&AdminRequest::Who).await.visitors;
        everybody.into_iter().find(is_called)
    }
}

/// Reads the mutes in force from the store.
pub(crate) fn read_mutes(store: &mut HostStore, visitors: &Visitors) -> Result<(), StoreFailure> {
    visitors.set_mutes(store.bans(BanScope::Talk, UnixTime::now())?);
    Ok(())
}

/// Looks for new mutes for as long as the host exists.
pub(crate) async fn follow_mutes(shared: Weak<Shared>) {
    // The first login reads them, too.
    loop {
        sleep(MUTES_INTERVAL).await;
        // The host is not held while waiting: its last owner shuts down the store's thread.
        let Some(answer) = shared.upgrade().map(|shared| {
            let visitors = shared.visitors.clone();
            shared.store.call(move |store| {
                // If the store is away, the known mutes stay in force.
                _ = read_mutes(store, &visitors);
            })
        }) else {
            return;
        };
        _ = answer.await;
    }
}

/// The key of the account with a name, as the target of a mute.
fn account(store: &mut HostStore, name: &Name) -> Result<Option<BanTarget>, StoreFailure> {
    Ok(store.account_named(name)?.map(|account| BanTarget::Key(account.key)))
}

fn is_member(room: Option<&RoomView>, name: &Line) -> bool {
    room.is_some_and(|room| room.members.iter().any(|member| member.name == *name))
}

fn nobody(name: &str) -> String {
    format!("Nobody here is called {name}.")
}

/// The sentence for a muted visitor who tries to talk.
fn muted(mute: &Ban, now: UnixTime) -> String {
    let left = mute.until.map(|until| until.seconds().saturating_sub(now.seconds()));
    let time =
        left.map_or(String::new(), |left| format!(" for {}", time_text(left.next_multiple_of(60))));
    let author = mute.author();
    match Line::of(&mute.reason, 200) {
        Some(reason) => format!("The {author} has muted you{time}: {reason}"),
        None => format!("The {author} has muted you{time}."),
    }
}
