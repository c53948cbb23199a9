//! What a client asks for, and the answers.
//!
//! OpenSSH's client asks for the method `none` first, to learn which methods there are, and never
//! again. Answered with success, it would never show its keys, and everybody would be a guest. So the
//! first `none` is refused, unless it is for the user `guest`; a client without a key then comes to
//! `keyboard-interactive`, which succeeds without a question, or asks for `none` once more.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::sync::Arc;

use russh::keys::Certificate;
use russh::server::{
    Auth, ChannelOpenHandle, Handle, Handler, Msg, Response, Session, VerifiedPublicKey,
};
use russh::{Channel, ChannelId, ChannelOpenFailure, Error, Pty};
use tokio::sync::oneshot;

use super::connection::Shared;
use super::inbound::{Inlet, inbound};
use super::visitor::{self, MOST_VARIABLES};
use super::wire::Line;
use super::{KeyData, Link, Outbox, Visitor};
use crate::server::{Refusal, VisitId};
use crate::terminal::WindowSize;

/// A session that begins.
pub(super) struct Begun {
    pub(super) visitor: Visitor,
    pub(super) link: Link,
    pub(super) inlet: Inlet,
    pub(super) handle: Handle,
    pub(super) channel: ChannelId,
}

/// A client, as far as it has come.
pub(super) struct Client {
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
    refusal: Option<Refusal>,
    channel: Option<ChannelId>,
    terminal: Option<(String, WindowSize)>,
    environment: BTreeMap<String, String>,
    inlet: Option<Inlet>,
}

/// The user who is a guest even with a key.
const GUEST: &str = "guest";
const NO_TERMINAL: &str = "This is a game for a terminal: connect with ssh -t.";
const TOO_MANY: &str = "You are connected too often with this key: end another game first.";
/// The exit status of a refused session.
const REFUSED: u32 = 2;
const STANDARD_ERROR: u32 = 1;

impl Client {
    pub(super) fn new(
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
            refusal: None,
            channel: None,
            terminal: None,
            environment: BTreeMap::new(),
            inlet: None,
        }
    }

    fn accept(&mut self, user: &str, key: Option<KeyData>) -> Auth {
        self.user = visitor::word(user);
        self.key = key;
        Auth::Accept
    }

    /// Starts the session, or says why not.
    fn begin(&mut self, channel: ChannelId, session: &mut Session) -> Result<(), Error> {
        if self.refusal == Some(Refusal::Key) {
            return refuse(channel, TOO_MANY, session);
        }
        let Some((term, size)) = self.terminal.take() else {
            return refuse(channel, NO_TERMINAL, session);
        };
        let Some(begin) = self.begin.take() else { return Ok(()) };
        let visitor = Visitor {
            peer: self.peer,
            key: self.key.take(),
            user: std::mem::take(&mut self.user),
            term,
            environment: std::mem::take(&mut self.environment),
            size,
            compresses: self.line.compresses(),
        };
        let handle = session.handle();
        let outbox = Outbox::new(handle.clone(), channel, self.line.passage.clone());
        let (inlet, inbound) = inbound();
        self.inlet = Some(inlet.clone());
        let link = Link { inbound, outbox };
        // The connection may be closing.
        _ = begin.send(Begun { visitor, link, inlet, handle, channel });
        Ok(())
    }

    fn window(&self, cells: [u32; 2], pixels: [u32; 2]) -> WindowSize {
        let config = &self.shared.config;
        visitor::window_size(cells, pixels, [config.columns, config.rows])
    }

    /// Keeps a variable if it is one that is kept, and returns whether it is.
    fn keep(&mut self, name: &str, value: &str) -> bool {
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
    session.exit_status_request(channel, REFUSED)?;
    session.eof(channel)?;
    session.close(channel)
}

fn answer(is_success: bool, channel: ChannelId, session: &mut Session) -> Result<(), Error> {
    if is_success { session.channel_success(channel) } else { session.channel_failure(channel) }
}

impl Handler for Client {
    type Error = Error;

    async fn auth_none(&mut self, user: &str) -> Result<Auth, Error> {
        if self.has_asked || user == GUEST {
            return Ok(self.accept(user, None));
        }
        self.has_asked = true;
        Ok(Auth::reject())
    }

    async fn auth_keyboard_interactive<'a>(
        &'a mut self,
        user: &str,
        _: &str,
        _: Option<Response<'a>>,
    ) -> Result<Auth, Error> {
        Ok(self.accept(user, None))
    }

    async fn auth_publickey(
        &mut self,
        user: &str,
        key: VerifiedPublicKey<'_>,
    ) -> Result<Auth, Error> {
        match KeyData::new(key.public_key.key_data()) {
            Some(key) => Ok(self.accept(user, Some(key))),
            None => Ok(Auth::reject()),
        }
    }

    async fn auth_openssh_certificate(&mut self, _: &str, _: &Certificate) -> Result<Auth, Error> {
        Ok(Auth::reject())
    }

    async fn auth_succeeded(&mut self, _: &mut Session) -> Result<(), Error> {
        self.line.log_in();
        let key = self.key.clone();
        let logged_in =
            self.shared.admission(|admission, now| admission.log_in(self.visit, key, now));
        self.refusal = logged_in.err();
        Ok(())
    }

    async fn channel_open_session(
        &mut self,
        channel: Channel<Msg>,
        reply: ChannelOpenHandle,
        _: &mut Session,
    ) -> Result<(), Error> {
        if self.channel.is_some() {
            reply.reject(ChannelOpenFailure::ResourceShortage).await;
        } else {
            self.channel = Some(channel.id());
            reply.accept().await;
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
            self.terminal =
                Some((visitor::word(term), self.window([columns, rows], [width, height])));
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
        let is_kept = self.keep(name, value);
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
        self.line.passage.close();
        Ok(())
    }
}
