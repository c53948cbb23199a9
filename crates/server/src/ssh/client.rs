//! A client on its way to a session.
//!
//! OpenSSH's client asks for the method `none` first, to learn which methods there are, and never
//! again. Answered with success, it would never show its keys, and everybody would be a guest. So the
//! first `none` is refused, unless it is for the user `guest`; a client without a key then comes to
//! `keyboard-interactive`, which succeeds without a question, or asks for `none` once more.

use std::collections::BTreeMap;
use std::mem;
use std::net::SocketAddr;
use std::sync::Arc;

use russh::server::{Handle, Session};
use russh::{ChannelId, Error};
use tokio::sync::oneshot;

use super::connection::Shared;
use super::inbound::{Inlet, inbound};
use super::visitor::{self, MOST_VARIABLES};
use super::wire::Line;
use super::{Departure, KeyData, Link, Outbox, Visitor};
use crate::ops::logging::{ConnectionEvent, events};
use crate::ssh::admission::{Refusal, VisitId};
use cellcaster::terminal::WindowSize;

/// A session that begins.
pub(crate) struct Begun {
    pub(crate) visitor: Visitor,
    pub(crate) link: Link,
    pub(crate) inlet: Inlet,
    pub(crate) handle: Handle,
    pub(crate) channel: ChannelId,
}

/// A client, as far as it has come.
pub(crate) struct Client {
    shared: Arc<Shared>,
    line: Arc<Line>,
    visit: VisitId,
    peer: SocketAddr,
    /// Until the session begins.
    begin: Option<oneshot::Sender<Begun>>,
    /// Whether it has asked for the method `none`.
    has_asked: bool,
    user: String,
    key: Option<KeyData>,
    has_rsa_key: bool,
    refusal: Option<Refusal>,
    channel: Option<ChannelId>,
    terminal: Option<(String, WindowSize)>,
    environment: BTreeMap<String, String>,
    inlet: Option<Inlet>,
}

/// The user who is a guest even with a key.
const GUEST: &str = "guest";
const NO_TERMINAL: &str = "This is a game for a terminal: connect with ssh -t.";
const NO_RSA: &str =
    "An RSA key is not an account here: make an ed25519 key with ssh-keygen -t ed25519.";
const STANDARD_ERROR: u32 = 1;

impl Client {
    pub(crate) fn new(
        shared: Arc<Shared>,
        line: Arc<Line>,
        visit: VisitId,
        peer: SocketAddr,
        begin: oneshot::Sender<Begun>,
    ) -> Self {
        Self {
            shared,
            line,
            visit,
            peer,
            begin: Some(begin),
            has_asked: false,
            user: String::new(),
            key: None,
            has_rsa_key: false,
            refusal: None,
            channel: None,
            terminal: None,
            environment: BTreeMap::new(),
            inlet: None,
        }
    }

    /// Whether the method `none` succeeds.
    pub(crate) fn is_guest(&mut self, user: &str) -> bool {
        mem::replace(&mut self.has_asked, true) || user == GUEST
    }

    /// The client has an RSA key, which is no account.
    pub(crate) fn offer_rsa(&mut self) {
        self.has_rsa_key = true;
    }

    /// The client has proved that it has `key`, or that it is a guest.
    pub(crate) fn accept(&mut self, user: &str, key: Option<KeyData>) {
        self.user = visitor::word(user);
        self.key = key;
    }

    /// The client is authenticated.
    pub(crate) fn log_in(&mut self) {
        self.line.log_in();
        let key = self.key.clone();
        let logged_in =
            self.shared.admission(|admission, now| admission.log_in(self.visit, key, now));
        events::authenticated(self.peer.ip(), self.key.as_ref().map(KeyData::fingerprint));
        if let Err(reason) = logged_in {
            self.shared.counters.refuse(reason);
            self.shared.log(ConnectionEvent::Refused(reason), self.peer.ip());
            self.refusal = Some(reason);
        }
    }

    /// Takes the first session channel.
    pub(crate) fn takes(&mut self, channel: ChannelId) -> bool {
        let is_first = self.channel.is_none();
        self.channel.get_or_insert(channel);
        is_first
    }

    /// Takes the first terminal.
    pub(crate) fn attach(&mut self, term: &str, size: WindowSize) -> bool {
        let is_first = self.terminal.is_none() && self.begin.is_some();
        if is_first {
            self.terminal = Some((visitor::word(term), size));
        }
        is_first
    }

    pub(crate) fn resize(&mut self, size: WindowSize) {
        match (&self.inlet, &mut self.terminal) {
            (Some(inlet), _) => inlet.resize(size),
            (None, Some((_, first))) => *first = size,
            (None, None) => {}
        }
    }

    pub(crate) fn has_begun(&self) -> bool {
        self.begin.is_none()
    }

    pub(crate) fn inlet(&self) -> Option<&Inlet> {
        self.inlet.as_ref()
    }

    /// Nothing can be sent any more.
    pub(crate) fn close(&self) {
        self.line.passage.close();
    }

    /// Starts the session, or says why not.
    pub(crate) fn begin(&mut self, channel: ChannelId, session: &mut Session) -> Result<(), Error> {
        if let Some(reason) = self.refusal {
            let sentence = reason.sentence(&self.shared.config.get().admission);
            return refuse(channel, &sentence, session);
        }
        let Some((term, size)) = self.terminal.take() else {
            return refuse(channel, NO_TERMINAL, session);
        };
        let Some(begin) = self.begin.take() else { return Ok(()) };
        let key = self.key.take();
        let notice = (self.has_rsa_key && key.is_none()).then_some(NO_RSA);
        let visitor = Visitor {
            peer: self.peer,
            key,
            notice,
            user: mem::take(&mut self.user),
            term,
            environment: mem::take(&mut self.environment),
            size,
            compresses: self.line.compresses(),
        };
        let handle = session.handle();
        let outbox = Outbox::new(handle.clone(), channel, self.line.passage.clone());
        let (inlet, inbound) = inbound(self.line.limits());
        self.inlet = Some(inlet.clone());
        let link = Link { inbound, outbox };
        // The connection may be closing.
        _ = begin.send(Begun { visitor, link, inlet, handle, channel });
        Ok(())
    }

    pub(crate) fn window(&self, cells: [u32; 2], pixels: [u32; 2]) -> WindowSize {
        let config = self.shared.config.get();
        visitor::window_size(cells, pixels, [config.columns, config.rows])
    }

    /// Keeps a variable if it is one that is kept, and returns whether it is.
    pub(crate) fn keep(&mut self, name: &str, value: &str) -> bool {
        let is_kept = visitor::is_kept(name)
            && (self.environment.len() < MOST_VARIABLES || self.environment.contains_key(name));
        if is_kept {
            self.environment.insert(name.to_owned(), visitor::word(value));
        }
        is_kept
    }
}

/// Ends the channel with a sentence.
fn refuse(channel: ChannelId, sentence: &str, session: &mut Session) -> Result<(), Error> {
    session.extended_data(channel, STANDARD_ERROR, format!("{sentence}\r\n").into_bytes())?;
    session.exit_status_request(channel, u32::from(Departure::REFUSED.status))?;
    session.eof(channel)?;
    session.close(channel)
}
