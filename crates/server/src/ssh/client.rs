//! A client on its way to a session: its requests, and the answers to them.
//!
//! OpenSSH's client begins with the method `none`, to learn which methods there are. If that succeeded, it
//! would never offer its keys, and everybody would be a guest. The first `none` is therefore rejected, except
//! for the user `guest`. A client without a key then tries `keyboard-interactive`, which succeeds without a
//! question, or tries `none` once more.

use std::collections::BTreeMap;
use std::mem;
use std::net::SocketAddr;
use std::sync::Arc;

use russh::keys::{Algorithm, HashAlg};
use russh::server::{
    Auth, ChannelOpenHandle, Handle, Handler, Msg, PublicKeyOffer, Response, Session,
    VerifiedPublicKey,
};
use russh::{Channel, ChannelId, ChannelOpenFailure, Error, Pty};
use tokio::sync::oneshot;

use super::gate::Gate;
use super::inbound::{InboundSender, inbound};
use super::outbox::Outbox;
use super::visitor::{self, Departure, Link, MAX_VARIABLES, Visitor};
use super::wire::ConnectionState;
use crate::accounts::AccountKey;
use crate::admission::{ConnectionId, Refusal};
use crate::logging;
use cellcaster::terminal::WindowSize;

/// A session that is about to begin.
pub(crate) struct PendingSession {
    pub(crate) visitor: Visitor,
    pub(crate) link: Link,
    pub(crate) inlet: InboundSender,
    pub(crate) handle: Handle,
    pub(crate) channel: ChannelId,
}

/// The state of a client until its session begins.
pub(crate) struct Client {
    gate: Arc<Gate>,
    line: Arc<ConnectionState>,
    visit: ConnectionId,
    peer: SocketAddr,
    /// Taken when the session begins.
    begin: Option<oneshot::Sender<PendingSession>>,
    /// Whether the client has tried the method `none`.
    has_asked: bool,
    user: String,
    key: Option<AccountKey>,
    has_rsa_key: bool,
    refusal: Option<Refusal>,
    channel: Option<ChannelId>,
    terminal: Option<(String, WindowSize)>,
    environment: BTreeMap<String, String>,
    inlet: Option<InboundSender>,
}

/// The user name that is a guest even with a key.
const GUEST: &str = "guest";
const NO_TERMINAL: &str = "This is a game for a terminal: connect with ssh -t.";
const NO_RSA: &str =
    "RSA keys have no account here: create an ed25519 key with ssh-keygen -t ed25519.";
const STANDARD_ERROR: u32 = 1;

impl Client {
    pub(crate) fn new(
        gate: Arc<Gate>,
        line: Arc<ConnectionState>,
        visit: ConnectionId,
        peer: SocketAddr,
        begin: oneshot::Sender<PendingSession>,
    ) -> Self {
        Self {
            gate,
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

    /// Records the user and the key of an authenticated client; no key for a guest.
    fn accept(&mut self, user: &str, key: Option<AccountKey>) -> Auth {
        self.user = visitor::word(user);
        self.key = key;
        Auth::Accept
    }

    /// Starts the session, or closes the channel with the reason why not.
    fn begin(&mut self, channel: ChannelId, session: &mut Session) -> Result<(), Error> {
        if let Some(reason) = self.refusal {
            return refuse(channel, &self.gate.sentence(reason), session);
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
        let outbox = Outbox::new(handle.clone(), channel, self.line.progress.clone());
        let (inlet, inbound) = inbound(self.line.limits);
        self.inlet = Some(inlet.clone());
        let link = Link { inbound, outbox };
        // This fails only if the connection is closing.
        _ = begin.send(PendingSession { visitor, link, inlet, handle, channel });
        Ok(())
    }

    fn window(&self, cells: [u32; 2], pixels: [u32; 2]) -> WindowSize {
        let config = self.gate.config.get();
        visitor::window_size(cells, pixels, [config.columns, config.rows])
    }
}

impl Handler for Client {
    type Error = Error;

    async fn auth_none(&mut self, user: &str) -> Result<Auth, Error> {
        let is_guest = mem::replace(&mut self.has_asked, true) || user == GUEST;
        Ok(if is_guest { self.accept(user, None) } else { Auth::reject() })
    }

    async fn auth_keyboard_interactive<'a>(
        &'a mut self,
        user: &str,
        _: &str,
        _: Option<Response<'a>>,
    ) -> Result<Auth, Error> {
        Ok(self.accept(user, None))
    }

    async fn auth_publickey_offered(
        &mut self,
        _: &str,
        offer: PublicKeyOffer<'_>,
    ) -> Result<Auth, Error> {
        let is_rsa = matches!(offer.algorithm, Algorithm::Rsa { .. });
        self.has_rsa_key |= is_rsa;
        Ok(if is_rsa { Auth::reject() } else { Auth::Accept })
    }

    async fn auth_publickey(
        &mut self,
        user: &str,
        key: VerifiedPublicKey<'_>,
    ) -> Result<Auth, Error> {
        let fingerprint = key.public_key.fingerprint(HashAlg::Sha256).sha256();
        let key = fingerprint.map(AccountKey::new);
        Ok(if key.is_some() { self.accept(user, key) } else { Auth::reject() })
    }

    async fn auth_succeeded(&mut self, _: &mut Session) -> Result<(), Error> {
        self.line.log_in();
        logging::authenticated(self.peer.ip(), self.key);
        self.refusal = self.gate.log_in(self.visit, self.key, self.peer.ip()).err();
        Ok(())
    }

    async fn channel_open_session(
        &mut self,
        channel: Channel<Msg>,
        reply: ChannelOpenHandle,
        _: &mut Session,
    ) -> Result<(), Error> {
        if self.channel.is_none() {
            self.channel = Some(channel.id());
            reply.accept().await;
        } else {
            reply.reject(ChannelOpenFailure::ResourceShortage).await;
        }
        Ok(())
    }

    async fn pty_request(
        &mut self,
        channel: ChannelId,
        term: &str,
        columns: u32,
        rows: u32,
        width: u32,
        height: u32,
        _: &[(Pty, u32)],
        session: &mut Session,
    ) -> Result<(), Error> {
        let is_first = self.terminal.is_none() && self.begin.is_some();
        if is_first {
            let size = self.window([columns, rows], [width, height]);
            self.terminal = Some((visitor::word(term), size));
        }
        answer(is_first, channel, session)
    }

    async fn env_request(
        &mut self,
        channel: ChannelId,
        name: &str,
        value: &str,
        session: &mut Session,
    ) -> Result<(), Error> {
        let has_room =
            self.environment.len() < MAX_VARIABLES || self.environment.contains_key(name);
        let is_kept = visitor::is_kept(name) && has_room;
        if is_kept {
            self.environment.insert(name.to_owned(), visitor::word(value));
        }
        answer(is_kept, channel, session)
    }

    async fn shell_request(
        &mut self,
        channel: ChannelId,
        session: &mut Session,
    ) -> Result<(), Error> {
        let is_first = self.begin.is_some();
        answer(is_first, channel, session)?;
        if is_first { self.begin(channel, session) } else { Ok(()) }
    }

    async fn exec_request(
        &mut self,
        channel: ChannelId,
        _: &[u8],
        session: &mut Session,
    ) -> Result<(), Error> {
        session.channel_failure(channel)
    }

    async fn subsystem_request(
        &mut self,
        channel: ChannelId,
        _: &str,
        session: &mut Session,
    ) -> Result<(), Error> {
        session.channel_failure(channel)
    }

    async fn x11_request(
        &mut self,
        channel: ChannelId,
        _: bool,
        _: &str,
        _: &str,
        _: u32,
        session: &mut Session,
    ) -> Result<(), Error> {
        session.channel_failure(channel)
    }

    async fn window_change_request(
        &mut self,
        _: ChannelId,
        columns: u32,
        rows: u32,
        width: u32,
        height: u32,
        _: &mut Session,
    ) -> Result<(), Error> {
        let size = self.window([columns, rows], [width, height]);
        match (&self.inlet, &mut self.terminal) {
            (Some(inlet), _) => inlet.resize(size),
            (None, Some((_, first))) => *first = size,
            (None, None) => {}
        }
        Ok(())
    }

    async fn data(&mut self, _: ChannelId, data: &[u8], _: &mut Session) -> Result<(), Error> {
        if let Some(inlet) = &self.inlet {
            inlet.bytes(data).await;
        }
        Ok(())
    }

    async fn channel_eof(&mut self, _: ChannelId, _: &mut Session) -> Result<(), Error> {
        if let Some(inlet) = &self.inlet {
            inlet.end();
        }
        Ok(())
    }

    async fn channel_close(&mut self, _: ChannelId, _: &mut Session) -> Result<(), Error> {
        if let Some(inlet) = &self.inlet {
            inlet.end();
        }
        self.line.progress.close();
        Ok(())
    }
}

fn answer(is_success: bool, channel: ChannelId, session: &mut Session) -> Result<(), Error> {
    if is_success { session.channel_success(channel) } else { session.channel_failure(channel) }
}

/// Closes the channel with a sentence on standard error.
fn refuse(channel: ChannelId, sentence: &str, session: &mut Session) -> Result<(), Error> {
    session.extended_data(channel, STANDARD_ERROR, format!("{sentence}\r\n").into_bytes())?;
    session.exit_status_request(channel, u32::from(Departure::REFUSED.status))?;
    session.eof(channel)?;
    session.close(channel)
}
