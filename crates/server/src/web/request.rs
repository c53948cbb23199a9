//! The head of a request.

use std::io;

use tokio::io::{AsyncRead, AsyncReadExt};

/// The most bytes of a head.
pub(crate) const MAX_HEAD: usize = 8 << 10;
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
    if !head.parse(bytes).ok()?.is_complete() || head.version != Some(1) {
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
        assert_eq!(result(b"GET / HTTP/1.0\r\n\r\n").unwrap(), None);
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
