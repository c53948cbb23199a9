//! SSH packets without encryption, built from choices, and a client that sends them to a server in
//! memory.

use std::cell::RefCell;

use allocation_counter::measure;
use cellcaster_server::fuzzing;
use tokio::io::{AsyncReadExt, AsyncWriteExt, duplex};
use tokio::runtime::{Builder, Runtime};

use crate::bytes::Bytes;

const MAX_PACKETS: usize = 48;
/// The largest number of bytes that the server keeps for a connection: its buffers, and its unsent
/// data.
const MAX_BYTES: u64 = 2 << 20;
/// The number of bytes allocated for a connection, for each of its packets, and for each byte.
const BYTES_OF_A_CONNECTION: u64 = 2 << 20;
const BYTES_OF_A_PACKET: u64 = 64 << 10;
const BYTES_OF_A_BYTE: u64 = 64;
/// The largest number of bytes sent back for a byte. The answer to an empty request is about 50
/// times as long as the request.
const ANSWER_OF_A_BYTE: usize = 16;
const ANSWER: usize = 16 << 10;

const VERSION: &[u8] = b"SSH-2.0-fuzz\r\n";
const KEXINIT: u8 = 20;
const SERVICE_REQUEST: u8 = 5;
const USERAUTH_REQUEST: u8 = 50;
const CHANNEL_OPEN: u8 = 90;
const CHANNEL_REQUEST: u8 = 98;
/// The number that the server assigns to the first channel.
const CHANNEL: u32 = 2;
/// The types of messages that a client sends, and two types that a server sends.
const TYPES: [u8; 24] =
    [1, 2, 3, 4, 5, 6, 7, 20, 21, 30, 31, 50, 60, 61, 80, 81, 90, 91, 93, 94, 95, 96, 97, 98];
const STRINGS: [&str; 32] = [
    "",
    "none",
    "curve25519-sha256",
    "mlkem768x25519-sha256",
    "ssh-ed25519",
    "chacha20-poly1305@openssh.com",
    "aes256-ctr",
    "hmac-sha2-256",
    "zlib@openssh.com,none",
    "zlib",
    "kex-strict-c-v00@openssh.com",
    "ext-info-c",
    "ssh-userauth",
    "ssh-connection",
    "guest",
    "Ada",
    "publickey",
    "keyboard-interactive",
    "password",
    "session",
    "direct-tcpip",
    "pty-req",
    "shell",
    "exec",
    "subsystem",
    "env",
    "window-change",
    "signal",
    "xterm-256color",
    "LANG",
    "rsa-sha2-512",
    "keepalive@openssh.com",
];
const NUMBERS: [u32; 8] = [0, 1, 2, 80, 24, 32 << 10, u32::MAX / 2, u32::MAX];

thread_local! {
    // If all tasks wait, time passes at once.
    static RUNTIME: RefCell<Runtime> = RefCell::new(
        Builder::new_current_thread().enable_time().start_paused(true).build().expect("a runtime"),
    );
}

/// The data that a client sends.
pub(crate) struct Stream {
    bytes: Vec<u8>,
    packets: u64,
}

impl Stream {
    /// A client that has sent its version.
    pub(crate) fn new() -> Self {
        Self { bytes: VERSION.to_vec(), packets: 0 }
    }

    /// A client that has begun a session without encryption.
    pub(crate) fn in_session() -> Self {
        let mut stream = Self::new();
        let mut lists = ["none"; 10];
        lists[1] = "ssh-ed25519";
        // After an exchange without keys, the server expects no message about new keys.
        stream.packet(&exchange(lists));
        stream.packet(&message(SERVICE_REQUEST, &["ssh-userauth"], &[]));
        stream.packet(&message(USERAUTH_REQUEST, &["guest", "ssh-connection", "none"], &[]));
        stream.packet(&message(CHANNEL_OPEN, &["session"], &[0, 1 << 20, 32 << 10]));
        let mut terminal = channel_request("pty-req");
        terminal.extend(message(0, &["xterm"], &[80, 24, 0, 0, 0]).split_off(1));
        stream.packet(&terminal);
        stream.packet(&channel_request("shell"));
        stream
    }

    /// Adds packets, as the choices select them.
    pub(crate) fn choose(mut self, choices: &mut Bytes) -> Self {
        for _ in 0..MAX_PACKETS {
            if choices.is_empty() {
                break;
            }
            match choices.below(8) {
                0 => {
                    let count = choices.below(64);
                    self.bytes.extend(choices.take(count));
                }
                1 => {
                    let lists = [(); 10].map(|()| choices.pick(&STRINGS));
                    self.packet(&exchange(lists));
                }
                2 => {
                    let kind = choices.pick(&STRINGS);
                    let mut request = channel_request(kind);
                    fields(&mut request, choices);
                    self.packet(&request);
                }
                _ => {
                    let mut payload = vec![choices.pick(&TYPES)];
                    fields(&mut payload, choices);
                    self.packet(&payload);
                }
            }
        }
        self
    }

    fn packet(&mut self, payload: &[u8]) {
        let padding = 8 - (5 + payload.len()) % 8;
        let padding = if padding < 4 { padding + 8 } else { padding };
        self.bytes.extend((1 + payload.len() as u32 + padding as u32).to_be_bytes());
        self.bytes.push(padding as u8);
        self.bytes.extend(payload);
        self.bytes.extend(vec![0; padding]);
        self.packets += 1;
    }

    /// Sends all packets to a server, and then the end of the stream. Returns the server's output.
    /// The server's work, its memory and its output are bounded.
    pub(crate) fn send(self) -> Vec<u8> {
        let mut answer = Vec::new();
        let count = self.bytes.len();
        let used = measure(|| {
            RUNTIME.with_borrow(|runtime| answer = runtime.block_on(converse(&self.bytes)));
        });
        assert!(used.bytes_max <= MAX_BYTES, "{} bytes at once", used.bytes_max);
        let most = BYTES_OF_A_CONNECTION
            + BYTES_OF_A_PACKET * self.packets
            + BYTES_OF_A_BYTE * count as u64;
        assert!(used.bytes_total <= most, "{} bytes for {count}", used.bytes_total);
        let most = ANSWER + ANSWER_OF_A_BYTE * count;
        assert!(answer.len() <= most, "{} bytes are sent for {count}", answer.len());
        answer
    }
}

async fn converse(bytes: &[u8]) -> Vec<u8> {
    let (client, server) = duplex(64 << 10);
    let (mut from, mut to) = tokio::io::split(client);
    let mut answer = Vec::new();
    let send = async {
        // The server may have ended the connection.
        _ = to.write_all(bytes).await;
        _ = to.shutdown().await;
    };
    let receive = async { _ = from.read_to_end(&mut answer).await };
    tokio::join!(fuzzing::serve(server), send, receive);
    answer
}

fn string(out: &mut Vec<u8>, text: &[u8]) {
    out.extend((text.len() as u32).to_be_bytes());
    out.extend(text);
}

fn message(kind: u8, strings: &[&str], numbers: &[u32]) -> Vec<u8> {
    let mut payload = vec![kind];
    strings.iter().for_each(|text| string(&mut payload, text.as_bytes()));
    payload.extend(numbers.iter().flat_map(|number| number.to_be_bytes()));
    payload
}

fn exchange(lists: [&str; 10]) -> Vec<u8> {
    let mut payload = vec![KEXINIT];
    payload.extend([7; 16]);
    lists.iter().for_each(|list| string(&mut payload, list.as_bytes()));
    payload.extend([0; 5]);
    payload
}

/// The beginning of a request to the first channel that asks for an answer.
fn channel_request(kind: &str) -> Vec<u8> {
    let mut payload = message(CHANNEL_REQUEST, &[], &[CHANNEL]);
    string(&mut payload, kind.as_bytes());
    payload.push(1);
    payload
}

/// Adds fields, as the choices select them.
fn fields(payload: &mut Vec<u8>, choices: &mut Bytes) {
    for _ in 0..choices.below(12) {
        match choices.below(6) {
            0 => payload.push(choices.byte()),
            1 => payload.extend(choices.pick(&NUMBERS).to_be_bytes()),
            2 => payload.extend(choices.double_word().to_be_bytes()),
            3 | 4 => string(payload, choices.pick(&STRINGS).as_bytes()),
            _ => {
                let count = choices.below(80);
                string(payload, choices.take(count));
            }
        }
    }
}
