//! One connection, from its socket to its end.

use std::borrow::Cow;
use std::io;
use std::net::{IpAddr, SocketAddr};
use std::pin::{Pin, pin};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use russh::keys::{Algorithm, EcdsaCurve, HashAlg};
use russh::server::{self, Handle};
use russh::{
    Disconnect, Error, MethodKind, MethodSet, Preferred, SshId, cipher, compression, kex, mac,
};
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::sync::{oneshot, watch};
use tokio::time::{Instant, sleep, sleep_until, timeout};

use super::client::{Begun, Client};
use super::outbox::Passage;
use super::wire::{ByteLimits, Line, Wire};
use super::{Counters, Host, Phase, explanation, locked};
use crate::ops::config::LiveConfig;
use crate::ops::logging::{ConnectionEvent, Throttle, events};
use crate::ssh::admission::{Admission, Outcome, VisitId};
use crate::ssh::host_key::HostKey;

/// What the connections of a server have in common.
pub(crate) struct Shared {
    pub(crate) config: LiveConfig,
    pub(crate) counters: Arc<Counters>,
    ssh: Arc<server::Config>,
    admission: Mutex<Admission>,
    logged: Mutex<Throttle>,
    begun: Instant,
    phases: watch::Receiver<Phase>,
}

/// A connection that was admitted.
pub(crate) struct Entry {
    pub(crate) visit: VisitId,
    /// That it is displaced, and what its client is told, if anything.
    pub(crate) displaced: oneshot::Receiver<Option<String>>,
}

/// The time for the first line of a client, its version, which no client has to think about.
const VERSION_TIME: Duration = Duration::from_secs(3);
/// The time that a session has for its end after its link has ended.
const AFTERWARDS: Duration = Duration::from_secs(5);
/// The least time between two looks whether a client has gone.
const LEAST_PAUSE: Duration = Duration::from_millis(50);
/// The time that a client has for closing the connection after its session has ended.
const FAREWELL: Duration = Duration::from_secs(2);
/// The messages that may wait for russh: a frame, three of the end, and questions whether the
/// client is there.
const MOST_MESSAGES: usize = 32;
/// In bytes: of what a client sends before russh tells it to go on.
const WINDOW: u32 = 32 << 10;

impl Shared {
    pub(crate) fn new(
        config: LiveConfig,
        key: &HostKey,
        counters: Arc<Counters>,
        phases: watch::Receiver<Phase>,
    ) -> Self {
        let ssh = Arc::new(ssh_config(key));
        let admission = Mutex::new(Admission::new(config.get().admission));
        let logged = Mutex::default();
        Self { config, counters, ssh, admission, logged, begun: Instant::now(), phases }
    }

    /// Logs an event of a client, at once or with the second.
    pub(crate) fn log(&self, event: ConnectionEvent, address: IpAddr) {
        locked(&self.logged, |logged| logged.log(event, address));
    }

    /// Logs the sums of the second that is over.
    pub(crate) fn end_second(&self) {
        locked(&self.logged, Throttle::end_second);
    }

    /// Acts on the admission, with the time since the server began.
    pub(crate) fn admission<T>(&self, act: impl FnOnce(&mut Admission, Duration) -> T) -> T {
        locked(&self.admission, |admission| act(admission, self.begun.elapsed()))
    }
}

/// Serves a connection until it has ended.
pub(crate) async fn serve<H: Host>(
    shared: Arc<Shared>,
    host: Arc<H>,
    socket: impl AsyncRead + AsyncWrite + Unpin + Send + 'static,
    peer: SocketAddr,
    Entry { visit, displaced }: Entry,
) {
    let _open = Counted::new(&shared.counters.connections);
    let config = shared.config.get();
    let limits =
        ByteLimits { before_login: config.login_bytes.into(), per_second: config.bytes_per_second };
    let passage = Arc::new(Passage::new(shared.counters.clone()));
    let line = Arc::new(Line::new(limits, passage));
    let (begin, begun) = oneshot::channel();
    let client = Client::new(shared.clone(), line.clone(), visit, peer, begin);
    let wire = Wire::new(socket, line.clone());
    let ssh = shared.ssh.clone();
    let (ready, mut handle) = oneshot::channel();
    let mut transport = pin!(async {
        // Unboxed, the handshake would keep its memory in this task as long as the connection lasts.
        let session = Box::pin(server::run_stream(ssh, wire, client)).await?;
        _ = ready.send(session.handle());
        session.await
    });
    let logged_in = tokio::select! {
        Ok(sentence) = displaced => {
            if let (Some(sentence), Ok(handle)) = (sentence, handle.try_recv()) {
                _ = timeout(FAREWELL, disconnect(&handle, sentence, transport.as_mut())).await;
            }
            Err(Outcome::Displaced)
        }
        logged_in = log_in(&shared, &line, transport.as_mut(), begun) => logged_in,
    };
    let outcome = match logged_in {
        Ok(begun) => {
            converse(&shared, &*host, &line, transport, begun).await;
            events::disconnected(peer.ip(), line.begun().elapsed().as_secs());
            Outcome::Served
        }
        Err(outcome) => {
            // Its task ends at once, and the stream with it.
            line.cut();
            shared.log(ConnectionEvent::Ended(outcome), peer.ip());
            outcome
        }
    };
    shared.admission(|admission, now| admission.leave(visit, outcome, now));
}

/// Tells the client why it has to go, if its key exchange is over, and waits until it has gone.
async fn disconnect(
    handle: &Handle,
    sentence: String,
    transport: Pin<&mut impl Future<Output = Result<(), Error>>>,
) {
    _ = handle.disconnect(Disconnect::TooManyConnections, sentence, String::new()).await;
    _ = transport.await;
}

/// Waits until the session begins.
async fn log_in(
    shared: &Shared,
    line: &Line,
    mut transport: Pin<&mut impl Future<Output = Result<(), Error>>>,
    mut begun: oneshot::Receiver<Begun>,
) -> Result<Begun, Outcome> {
    let mut phases = shared.phases.clone();
    loop {
        let config = shared.config.get();
        let time = match () {
            () if line.has_exchanged() => config.login,
            () if line.has_version() => config.handshake,
            () => config.handshake.min(VERSION_TIME),
        };
        let deadline = line.begun() + time;
        if Instant::now() >= deadline {
            let is_guilty = !line.is_logged_in();
            return Err(if is_guilty { Outcome::TimedOut } else { Outcome::Served });
        }
        tokio::select! {
            ended = &mut transport => return Err(outcome(&ended, line.is_logged_in())),
            started = &mut begun => {
                return match started {
                    Ok(begun) => Ok(begun),
                    Err(_) => Err(outcome(&transport.await, line.is_logged_in())),
                };
            }
            () = sleep_until(deadline) => {}
            _ = phases.changed() => return Err(Outcome::Served),
        }
    }
}

/// Lets the host serve the visitor, until either is done.
async fn converse<H: Host>(
    shared: &Shared,
    host: &H,
    line: &Line,
    mut transport: Pin<&mut impl Future<Output = Result<(), Error>>>,
    begun: Begun,
) {
    let Begun { visitor, link, inlet, handle, channel } = begun;
    let _session = Counted::new(&shared.counters.sessions);
    let peer = visitor.peer.ip();
    let mut session = pin!(host.serve(visitor, link));
    let mut lost = pin!(lost(&shared.config, line, &handle));
    let mut is_lost = false;
    let mut phases = shared.phases.clone();
    let departure = loop {
        tokio::select! {
            departure = &mut session => break departure,
            _ = &mut transport => {
                inlet.end();
                _ = timeout(AFTERWARDS, session).await;
                return;
            }
            () = &mut lost, if !is_lost => {
                is_lost = true;
                line.cut();
            }
            Ok(()) = phases.changed() => match *phases.borrow_and_update() {
                Phase::Open => {}
                Phase::Draining => inlet.drain(),
                Phase::Closing => line.cut(),
            },
        }
    };
    if let Some(reason) = departure.refusal {
        shared.counters.refuse(reason);
        shared.log(ConnectionEvent::Refused(reason), peer);
    }
    let farewell = async {
        _ = handle.exit_status_request(channel, u32::from(departure.status)).await;
        _ = handle.eof(channel).await;
        _ = handle.close(channel).await;
        _ = transport.as_mut().await;
    };
    if timeout(FAREWELL, farewell).await.is_err() {
        line.cut();
        _ = transport.await;
    }
}

/// Waits until the client has gone without a word, or takes nothing any more.
///
/// A client of which nothing is heard is asked something that it must answer (RFC 4254, section 4).
/// russh's own keep-alives were refused: they wait behind a frame that the socket does not take, and
/// they come while the user types a passphrase, where OpenSSH's client complains about them.
async fn lost(config: &LiveConfig, line: &Line, handle: &Handle) {
    let mut part = (line.passage.parts(), Instant::now());
    loop {
        let config = config.get();
        let pause = config.silence / 3;
        let now = Instant::now();
        let is_waiting = line.passage.is_waiting();
        if !is_waiting || line.passage.parts() != part.0 {
            part = (line.passage.parts(), now);
        }
        let silent = now.saturating_duration_since(line.last_sign());
        if now - part.1 >= config.stall || silent >= config.silence && !is_waiting {
            return;
        }
        if silent >= pause && !is_waiting {
            // No client forwards anything here, so it has nothing to cancel.
            let question = handle.cancel_forward_tcpip(String::new(), 0);
            _ = timeout(pause.min(config.silence.saturating_sub(silent)), question).await;
        }
        let silent = line.last_sign().elapsed();
        let end = config.silence.saturating_sub(silent).max(LEAST_PAUSE);
        sleep(pause.saturating_sub(silent).max(pause / 4).min(end)).await;
    }
}

/// What the end of russh's task says about the client.
fn outcome(ended: &Result<(), Error>, is_logged_in: bool) -> Outcome {
    match ended {
        _ if is_logged_in => Outcome::Served,
        Err(Error::IO(error)) if error.kind() == io::ErrorKind::QuotaExceeded => Outcome::TimedOut,
        Err(Error::IO(error)) if error.kind() == io::ErrorKind::FileTooLarge => {
            Outcome::BrokeProtocol
        }
        // An old client may have no method in common.
        Ok(())
        | Err(Error::IO(_) | Error::Disconnect | Error::HUP | Error::NoCommonAlgo { .. }) => {
            Outcome::LeftEarly
        }
        Err(_) => Outcome::BrokeProtocol,
    }
}

/// Algorithms and limits. Groups of Diffie-Hellman are not offered: the largest cost a tenth of a
/// second of processor time before authentication. Neither is `zlib`, which compresses before
/// authentication; `none` comes first in no client that is asked to compress. RSA keys are named so
/// that clients offer them, and their users can be told why they are guests. A fuzz target cannot encrypt, so
/// there the client may choose the null transport.
fn ssh_config(key: &HostKey) -> server::Config {
    const KEX: &[kex::Name] = &[
        kex::MLKEM768X25519_SHA256,
        kex::CURVE25519,
        kex::CURVE25519_PRE_RFC_8731,
        kex::EXTENSION_SUPPORT_AS_SERVER,
        kex::EXTENSION_OPENSSH_STRICT_KEX_AS_SERVER,
        #[cfg(fuzzing)]
        kex::NONE,
    ];
    const KEYS: &[Algorithm] = &[
        Algorithm::Ed25519,
        Algorithm::SkEd25519,
        Algorithm::Ecdsa { curve: EcdsaCurve::NistP256 },
        Algorithm::Ecdsa { curve: EcdsaCurve::NistP384 },
        Algorithm::Ecdsa { curve: EcdsaCurve::NistP521 },
        Algorithm::SkEcdsaSha2NistP256,
        Algorithm::Rsa { hash: Some(HashAlg::Sha512) },
        Algorithm::Rsa { hash: Some(HashAlg::Sha256) },
    ];
    const CIPHERS: &[cipher::Name] = &[
        cipher::CHACHA20_POLY1305,
        cipher::AES_256_GCM,
        cipher::AES_256_CTR,
        cipher::AES_128_CTR,
        #[cfg(fuzzing)]
        cipher::NONE,
    ];
    const MACS: &[mac::Name] = &[
        mac::HMAC_SHA256_ETM,
        mac::HMAC_SHA512_ETM,
        mac::HMAC_SHA256,
        #[cfg(fuzzing)]
        mac::NONE,
    ];
    const COMPRESSION: &[compression::Name] = &[compression::NONE, compression::ZLIB_LEGACY];
    let methods = [MethodKind::PublicKey, MethodKind::KeyboardInteractive];
    server::Config {
        server_id: SshId::Standard(Cow::Borrowed(explanation::VERSION)),
        methods: MethodSet::from(methods.as_slice()),
        // There is nothing to guess.
        auth_rejection_time: Duration::ZERO,
        auth_rejection_time_initial: None,
        keys: vec![key.private_key()],
        preferred: Preferred {
            kex: Cow::Borrowed(KEX),
            key: Cow::Borrowed(KEYS),
            cipher: Cow::Borrowed(CIPHERS),
            mac: Cow::Borrowed(MACS),
            compression: Cow::Borrowed(COMPRESSION),
            ..Preferred::DEFAULT
        },
        window_size: WINDOW,
        maximum_packet_size: WINDOW,
        channel_buffer_size: 1,
        event_buffer_size: MOST_MESSAGES,
        max_auth_attempts: 10,
        inactivity_timeout: None,
        keepalive_interval: None,
        ..server::Config::default()
    }
}

/// Counts one more as long as it lives.
struct Counted<'a>(&'a AtomicUsize);

impl<'a> Counted<'a> {
    fn new(count: &'a AtomicUsize) -> Self {
        count.fetch_add(1, Ordering::Relaxed);
        Self(count)
    }
}

impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}
