//! HTTP/1: the head of a request, and its only answer on a connection.

use std::io;
use std::net::SocketAddr;
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncReadExt, AsyncWriteExt, copy, sink};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::timeout;

/// The time for an answer.
pub(crate) const ANSWER_TIMEOUT: Duration = Duration::from_secs(10);

/// The size of a socket's send buffer, in bytes. It holds about ten pictures.
pub(crate) const SEND_BUFFER: u32 = 64 << 10;
/// The maximum number of connections that wait to be accepted.
const BACKLOG: u32 = 128;
/// The most bytes of a head.
const MAX_HEAD: usize = 8 << 10;
/// The most headers. Browsers send about 20, and proxies add a few.
const MAX_HEADERS: usize = 64;
/// The end of a head.
const END: &[u8] = b"\r\n\r\n";

/// The parts of a request that matter.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Request {
    pub(crate) method: String,
    target: String,
    host: Option<String>,
    origin: Option<String>,
    /// Whether the client wants a WebSocket.
    pub(crate) is_upgrade: bool,
    /// The elements of `Sec-WebSocket-Protocol`, in order.
    pub(crate) protocols: Vec<String>,
    /// The elements of `X-Forwarded-For`, in order.
    pub(crate) forwarded: Vec<String>,
}

impl Request {
    /// The path of the target.
    pub(crate) fn path(&self) -> &str {
        self.target.split('?').next().unwrap_or_default()
    }

    /// A value of the target's query, as it is written.
    pub(crate) fn query(&self, name: &str) -> Option<&str> {
        let (_, query) = self.target.split_once('?')?;
        query.split('&').find_map(|part| part.strip_prefix(name)?.strip_prefix('='))
    }

    /// Returns true if `Origin` names the host of the request. Every browser sends it with a WebSocket.
    pub(crate) fn is_of_same_host(&self) -> bool {
        let origin = self.origin.as_deref().and_then(|it| it.split_once("://"));
        let (Some((_, origin)), Some(host)) = (origin, &self.host) else { return false };
        origin.eq_ignore_ascii_case(host)
    }
}

/// Listens for clients.
///
/// # Errors
/// Fails if the address cannot be bound.
pub(crate) fn listen(address: SocketAddr) -> io::Result<TcpListener> {
    super::listen(address, SEND_BUFFER, BACKLOG)
}

/// Reads a head. Returns the bytes that were read, which may be more, and the request if it is valid.
///
/// # Errors
/// Fails if the connection ends before the head.
pub(crate) async fn read(
    stream: &mut (impl AsyncRead + Unpin),
) -> io::Result<(Vec<u8>, Option<Request>)> {
    let mut bytes = Vec::with_capacity(1024);
    loop {
        let room = (MAX_HEAD - bytes.len()) as u64;
        let before = bytes.len();
        if stream.take(room).read_buf(&mut bytes).await? == 0 {
            return match bytes.len() {
                MAX_HEAD => Ok((bytes, None)),
                _ => Err(io::ErrorKind::UnexpectedEof.into()),
            };
        }
        let new = &bytes[before.saturating_sub(END.len() - 1)..];
        if new.windows(END.len()).any(|part| part == END) {
            let request = parse(&bytes);
            return Ok((bytes, request));
        }
    }
}

fn parse(bytes: &[u8]) -> Option<Request> {
    let mut headers = [httparse::EMPTY_HEADER; MAX_HEADERS];
    let mut head = httparse::Request::new(&mut headers);
    if !head.parse(bytes).ok()?.is_complete() {
        return None;
    }
    let mut request = Request {
        method: head.method?.to_owned(),
        target: head.path?.to_owned(),
        ..Request::default()
    };
    let mut is_ambiguous = false;
    for header in head.headers.iter() {
        let is = |name| header.name.eq_ignore_ascii_case(name);
        let value = str::from_utf8(header.value).unwrap_or_default();
        if is("host") {
            is_ambiguous |= request.host.replace(value.to_owned()).is_some();
        } else if is("origin") {
            is_ambiguous |= request.origin.replace(value.to_owned()).is_some();
        } else if is("upgrade") {
            request.is_upgrade |= value.eq_ignore_ascii_case("websocket");
        } else if is("x-forwarded-for") {
            request.forwarded.extend(elements(value));
        } else if is("sec-websocket-protocol") {
            request.protocols.extend(elements(value));
        }
    }
    (!is_ambiguous).then_some(request)
}

/// The elements of a list in a header.
fn elements(value: &str) -> impl Iterator<Item = String> {
    value.split(',').map(|part| part.trim().to_owned())
}

/// An answer, except for its headers that are always the same.
pub(crate) struct Answer {
    pub(crate) status: &'static str,
    pub(crate) kind: &'static str,
    /// Further headers, each with its line ending.
    pub(crate) headers: String,
    pub(crate) body: String,
}

impl Answer {
    pub(crate) fn text(status: &'static str, body: String) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", headers: String::new(), body }
    }

    pub(crate) fn bad_request() -> Self {
        let most = MAX_HEAD >> 10;
        let text = format!("this is not an HTTP/1 request of at most {most} KiB\n");
        Self::text("400 Bad Request", text)
    }

    pub(crate) fn other_method() -> Self {
        let answer = Self::text("405 Method Not Allowed", "use the method GET\n".to_owned());
        Self { headers: "Allow: GET\r\n".to_owned(), ..answer }
    }
}

/// Sends the answer and closes the connection.
pub(crate) async fn finish(mut socket: TcpStream, answer: Answer) -> io::Result<()> {
    let Answer { status, kind, headers, body } = answer;
    let text = head(status, kind, &headers, body.len() as u64) + &body;
    let sent = async {
        socket.write_all(text.as_bytes()).await?;
        close(socket).await
    };
    _ = timeout(ANSWER_TIMEOUT, sent).await;
    Ok(())
}

/// The head of an answer. `headers` are further ones, each with its line ending.
pub(crate) fn head(status: &str, kind: &str, headers: &str, length: u64) -> String {
    format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\n{headers}\
         Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
         Connection: close\r\n\r\n"
    )
}

/// Closes a connection whose answer is written.
pub(crate) async fn close(mut socket: TcpStream) -> io::Result<()> {
    socket.shutdown().await?;
    // If the connection were closed with unread bytes, it would be reset, and the client might lose the answer.
    copy(&mut socket, &mut sink()).await.map(drop)
}

#[cfg(test)]
mod tests {
    use futures_util::FutureExt;
    use proptest::prelude::*;

    use super::*;

    fn result(mut bytes: &[u8]) -> io::Result<Option<Request>> {
        Ok(read(&mut bytes).now_or_never().unwrap()?.1)
    }

    #[test]
    fn only_a_short_and_complete_head_is_a_request() {
        let head =
            b"GET /rooms?all HTTP/1.1\r\nHost: a\r\nX-Forwarded-For: 192.0.2.7, 10.0.0.1\r\n\
                     x-forwarded-for: 10.0.0.2\r\n\r\n";
        let request = result(head).unwrap().unwrap();
        assert_eq!((request.path(), request.query("all")), ("/rooms", None));
        assert_eq!(request.forwarded, ["192.0.2.7", "10.0.0.1", "10.0.0.2"]);
        assert!(!request.is_of_same_host() && !request.is_upgrade);
        assert!(result(&head[..40]).is_err());
        let long = [b"GET / HTTP/1.1\r\nX: ".as_slice(), &[b'x'; MAX_HEAD], END].concat();
        assert_eq!(result(&long).unwrap(), None);
        let many = [b"GET / HTTP/1.1\r\n".as_slice(), &b"X: x\r\n".repeat(65), b"\r\n"].concat();
        assert_eq!(result(&many).unwrap(), None);
        assert_eq!(result(b"PROXY TCP4 192.0.2.7 127.0.0.1 1 2\r\n\r\n").unwrap(), None);
        assert_eq!(result(b"GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n").unwrap(), None);
        assert_eq!(result(b"GET /\r\n\r\n").unwrap(), None);
        assert!(result(b"GET / HTTP/1.0\r\n\r\n").unwrap().is_some());
    }

    #[test]
    fn the_origin_must_name_the_host() {
        for (headers, is_same) in [
            ("Host: play.example.org\r\nOrigin: https://play.example.org", true),
            ("Host: Play.example.org\r\nOrigin: https://play.example.ORG", true),
            ("Host: localhost:8080\r\nOrigin: http://localhost:8080", true),
            ("Host: localhost:8080\r\nOrigin: http://localhost", false),
            ("Host: play.example.org\r\nOrigin: https://evil.example.org", false),
            ("Host: play.example.org\r\nOrigin: https://play.example.org.evil", false),
            ("Host: null\r\nOrigin: null", false),
            ("Origin: https://play.example.org", false),
            ("Host: play.example.org", false),
        ] {
            let head = format!("GET / HTTP/1.1\r\n{headers}\r\n\r\n");
            let request = result(head.as_bytes()).unwrap().unwrap();
            assert_eq!(request.is_of_same_host(), is_same, "{headers}");
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(start in prop::sample::select(vec![b"".as_slice(), b"GET / HTTP/1.1\r\n"]), bytes: Vec<u8>) {
            _ = result(&[start, &bytes, END].concat());
        }
    }
}
