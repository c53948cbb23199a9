//! A single connection, from its socket to its end.

use std::borrow::Cow;
use std::io;
use std::pin::{Pin, pin};
use std::sync::Arc;
use std::time::Duration;

use prometheus_client::metrics::gauge::Gauge;
use russh::keys::{Algorithm, EcdsaCurve, HashAlg};
use russh::server::{self, Handle};
use russh::{
    Disconnect, Error, MethodKind, MethodSet, Preferred, SshId, cipher, compression, kex, mac,
};
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::sync::oneshot;
use tokio::time::{Instant, sleep, sleep_until, timeout};

use super::client::{Client, PendingSession};
use super::gate::{AdmittedConnection, Gate, ShutdownPhase, VERSION};
use super::host_key::HostKey;
use super::outbox::FrameProgress;
use super::visitor::Host;
use super::wire::{ByteLimits, ConnectionState, Stage, Wire};
use crate::admission::Outcome;
use crate::config::LiveConfig;
use crate::logging::{self, ConnectionEvent};

/// The time limit for a client's first line, the version. A client sends it without input from its user.
pub(crate) const VERSION_TIMEOUT: Duration = Duration::from_secs(3);
/// How long a session may take to finish after its link has ended.
const FINISH_TIMEOUT: Duration = Duration::from_secs(5);
/// The shortest pause between two checks whether a client is gone.
const MIN_INTERVAL: Duration = Duration::from_millis(50);
/// The time limit for a client to close the connection after its session has ended.
const CLOSE_TIMEOUT: Duration = Duration::from_secs(2);
/// The maximum number of messages queued for russh: a frame, the three closing messages, and keep-alive questions.
const MAX_MESSAGES: usize = 32;
/// The channel's receive window, in bytes.
const WINDOW: u32 = 32 << 10;

/// Serves a connection until it ends.
pub(crate) async fn serve<H: Host>(
    gate: Arc<Gate>,
    ssh: Arc<server::Config>,
    host: Arc<H>,
    socket: impl AsyncRead + AsyncWrite + Unpin + Send + 'static,
    AdmittedConnection { visit, peer, displaced }: AdmittedConnection,
) {
    let _open = GaugeGuard::new(&gate.metrics.connections);
    let config = gate.config.get();
    let limits =
        ByteLimits { before_login: config.login_bytes.into(), per_second: config.bytes_per_second };
    let progress = Arc::new(FrameProgress::new(gate.metrics.clone()));
    let line = Arc::new(ConnectionState::new(limits, progress));
    let (begin, begun) = oneshot::channel();
    let client = Client::new(gate.clone(), line.clone(), visit, peer, begin);
    let wire = Wire::new(socket, line.clone());
    let (ready, mut handle) = oneshot::channel();
    let mut transport = pin!(async {
        // Boxed: otherwise this task would hold the memory of the handshake for as long as the connection lasts.
        let session = Box::pin(server::run_stream(ssh, wire, client)).await?;
        _ = ready.send(session.handle());
        session.await
    });
    let logged_in = tokio::select! {
        Ok(sentence) = displaced => {
            if let (Some(sentence), Ok(handle)) = (sentence, handle.try_recv()) {
                _ = timeout(CLOSE_TIMEOUT, disconnect(&handle, sentence, transport.as_mut())).await;
            }
            Err(Outcome::Displaced)
        }
        logged_in = log_in(&gate, &line, transport.as_mut(), begun) => logged_in,
    };
    let outcome = match logged_in {
        Ok(begun) => {
            converse(&gate, &*host, &line, transport, begun).await;
            logging::disconnected(peer.ip(), line.begun.elapsed().as_secs());
            Outcome::Served
        }
        Err(outcome) => {
            // The transport is dropped right after this, which closes the stream.
            line.cut();
            gate.log(ConnectionEvent::Ended(outcome), peer.ip());
            outcome
        }
    };
    gate.leave(visit, peer.ip(), outcome);
}

/// Sends the client the reason for the disconnection, if its key exchange is complete, and waits until it has gone.
async fn disconnect(
    handle: &Handle,
    sentence: String,
    transport: Pin<&mut impl Future<Output = Result<(), Error>>>,
) {
    _ = handle.disconnect(Disconnect::TooManyConnections, sentence, String::new()).await;
    _ = transport.await;
}

/// Waits until the session begins, or the deadline of the client's stage passes.
async fn log_in(
    gate: &Gate,
    line: &ConnectionState,
    mut transport: Pin<&mut impl Future<Output = Result<(), Error>>>,
    mut begun: oneshot::Receiver<PendingSession>,
) -> Result<PendingSession, Outcome> {
    loop {
        let config = gate.config.get();
        let time = match line.stage() {
            Stage::Version => config.handshake.min(VERSION_TIMEOUT),
            Stage::Offer | Stage::Exchange => config.handshake,
            Stage::Done => config.login,
        };
        let deadline = line.begun + time;
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
            () = gate.stopped() => return Err(Outcome::Served),
        }
    }
}

/// Lets the host serve the visitor until the session or the connection ends.
async fn converse<H: Host>(
    gate: &Gate,
    host: &H,
    line: &ConnectionState,
    mut transport: Pin<&mut impl Future<Output = Result<(), Error>>>,
    begun: PendingSession,
) {
    let PendingSession { visitor, link, inlet, handle, channel } = begun;
    let _session = GaugeGuard::new(&gate.metrics.sessions);
    let peer = visitor.peer.ip();
    let mut session = pin!(host.serve(visitor, link));
    let mut lost = pin!(lost(&gate.config, line, &handle));
    let mut is_lost = false;
    let mut phases = gate.phases();
    let departure = loop {
        tokio::select! {
            departure = &mut session => break departure,
            _ = &mut transport => {
                inlet.end();
                _ = timeout(FINISH_TIMEOUT, session).await;
                return;
            }
            () = &mut lost, if !is_lost => {
                is_lost = true;
                line.cut();
            }
            Ok(()) = phases.changed() => match *phases.borrow_and_update() {
                ShutdownPhase::Open => {}
                ShutdownPhase::Draining => inlet.drain(),
                ShutdownPhase::Closing => line.cut(),
            },
        }
    };
    if let Some(reason) = departure.refusal {
        gate.refuse(reason, peer);
    }
    let farewell = async {
        _ = handle.exit_status_request(channel, u32::from(departure.status)).await;
        _ = handle.eof(channel).await;
        _ = handle.close(channel).await;
        _ = transport.as_mut().await;
    };
    if timeout(CLOSE_TIMEOUT, farewell).await.is_err() {
        line.cut();
        _ = transport.await;
    }
}

/// Returns when the client is gone without closing the connection, or no longer reads.
///
/// A silent client gets a question that it must answer (RFC 4254, section 4). Rejected: russh's own
/// keep-alives. They queue behind a frame that the socket does not accept, and they arrive while the user
/// types a passphrase, which makes OpenSSH's client complain.
async fn lost(config: &LiveConfig, line: &ConnectionState, handle: &Handle) {
    let mut part = (line.progress.parts(), Instant::now());
    loop {
        let config = config.get();
        let pause = config.silence / 3;
        let now = Instant::now();
        let is_waiting = line.progress.is_waiting();
        if !is_waiting || line.progress.parts() != part.0 {
            part = (line.progress.parts(), now);
        }
        let silent = now.saturating_duration_since(line.last_sign());
        if now - part.1 >= config.stall || silent >= config.silence && !is_waiting {
            return;
        }
        if silent >= pause && !is_waiting {
            // No client can have forwarded a port, so there is nothing to cancel.
            let question = handle.cancel_forward_tcpip(String::new(), 0);
            _ = timeout(pause.min(config.silence.saturating_sub(silent)), question).await;
        }
        let silent = line.last_sign().elapsed();
        let end = config.silence.saturating_sub(silent).max(MIN_INTERVAL);
        sleep(pause.saturating_sub(silent).max(pause / 4).min(end)).await;
    }
}

/// The outcome for the client, from the result of russh's task.
fn outcome(ended: &Result<(), Error>, is_logged_in: bool) -> Outcome {
    match ended {
        _ if is_logged_in => Outcome::Served,
        Err(Error::IO(error)) if error.kind() == io::ErrorKind::QuotaExceeded => Outcome::TimedOut,
        Err(Error::IO(error)) if error.kind() == io::ErrorKind::FileTooLarge => {
            Outcome::BrokeProtocol
        }
        // An old client may have no algorithm in common with the server.
        Ok(())
        | Err(Error::IO(_) | Error::Disconnect | Error::HUP | Error::NoCommonAlgo { .. }) => {
            Outcome::LeftEarly
        }
        Err(_) => Outcome::BrokeProtocol,
    }
}

/// The algorithms and limits. Diffie-Hellman groups are not offered, because the largest costs a tenth of a
/// second of processor time before authentication. `zlib` is not offered, because it compresses before
/// authentication. Listing `none` first does no harm: the client's order decides, and a client that is asked
/// to compress does not list `none` first. RSA keys are listed so that clients offer them, and their users
/// can be told why they are guests. A fuzz target cannot encrypt, so it may choose the null transport.
pub(crate) fn ssh_config(key: &HostKey) -> server::Config {
    const KEX: &[kex::Name] = &[
        kex::MLKEM768X25519_SHA256,
        kex::CURVE25519,
        kex::CURVE25519_PRE_RFC_8731,
        kex::EXTENSION_SUPPORT_AS_SERVER,
        kex::EXTENSION_OPENSSH_STRICT_KEX_AS_SERVER,
        #[cfg(feature = "fuzzing")]
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
        #[cfg(feature = "fuzzing")]
        cipher::NONE,
    ];
    const MACS: &[mac::Name] = &[
        mac::HMAC_SHA256_ETM,
        mac::HMAC_SHA512_ETM,
        mac::HMAC_SHA256,
        #[cfg(feature = "fuzzing")]
        mac::NONE,
    ];
    const COMPRESSION: &[compression::Name] = &[compression::NONE, compression::ZLIB_LEGACY];
    let methods = [MethodKind::PublicKey, MethodKind::KeyboardInteractive];
    server::Config {
        server_id: SshId::Standard(Cow::Borrowed(VERSION)),
        methods: MethodSet::from(methods.as_slice()),
        // There is no secret to guess, so a rejection needs no delay.
        auth_rejection_time: Duration::ZERO,
        auth_rejection_time_initial: None,
        keys: vec![key.key.clone()],
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
        event_buffer_size: MAX_MESSAGES,
        max_auth_attempts: 10,
        inactivity_timeout: None,
        keepalive_interval: None,
        ..server::Config::default()
    }
}

/// Increments a gauge for as long as it lives.
struct GaugeGuard<'a>(&'a Gauge);

impl<'a> GaugeGuard<'a> {
    fn new(count: &'a Gauge) -> Self {
        count.inc();
        Self(count)
    }
}

impl Drop for GaugeGuard<'_> {
    fn drop(&mut self) {
        self.0.dec();
    }
}
