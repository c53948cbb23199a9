//! A server of HTTP/1.1 for one page.
//!
//! It reads at most 4 KB of a request within two seconds, answers, and closes the connection. Eight
//! connections are answered at a time, and further ones wait in the system's queue. A server library
//! was refused: what Prometheus asks for is one line.

use std::io;
use std::sync::Arc;
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

const MOST_BYTES: usize = 4096;
const MOST_CONNECTIONS: usize = 8;
const PATIENCE: Duration = Duration::from_secs(2);
/// The pause after a failed `accept`.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// Answers `GET /metrics` with what `text` returns, until the future is dropped.
pub async fn respond(listener: TcpListener, text: impl Fn() -> String + Send + Sync + 'static) {
    let text = Arc::new(text);
    let places = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    // Its tasks end with it.
    let mut tasks = JoinSet::new();
    loop {
        while tasks.try_join_next().is_some() {}
        let Ok(place) = places.clone().acquire_owned().await else { return };
        let Ok((stream, _)) = listener.accept().await else {
            sleep(ACCEPT_PAUSE).await;
            continue;
        };
        let text = text.clone();
        tasks.spawn(async move {
            _ = timeout(PATIENCE, answer(stream, &*text)).await;
            drop(place);
        });
    }
}

async fn answer(mut stream: TcpStream, text: &impl Fn() -> String) -> io::Result<()> {
    let request = request(&mut stream).await?;
    stream.write_all(response(&request, text).as_bytes()).await?;
    stream.shutdown().await?;
    // Closed with unread bytes, the connection would be reset, and the client might lose the answer.
    let mut rest = [0; MOST_BYTES];
    while stream.read(&mut rest).await? > 0 {}
    Ok(())
}

/// The head of a request, or its first [`MOST_BYTES`].
async fn request(stream: &mut TcpStream) -> io::Result<Vec<u8>> {
    let mut request = Vec::new();
    let mut buffer = [0; 1024];
    while !ends(&request) && request.len() < MOST_BYTES {
        let length = stream.read(&mut buffer).await?;
        if length == 0 {
            break;
        }
        request.extend(&buffer[..length]);
    }
    Ok(request)
}

fn ends(request: &[u8]) -> bool {
    request.windows(4).any(|end| end == b"\r\n\r\n")
}

fn response(request: &[u8], text: impl Fn() -> String) -> String {
    let line = request.split(|&byte| byte == b'\r').next().unwrap_or_default();
    let mut words = line.split(|&byte| byte == b' ');
    let (method, target, version) = (words.next(), words.next(), words.next());
    let is_http = version.is_some_and(|version| version.starts_with(b"HTTP/1."));
    let (status, body) = match (method, target) {
        _ if !ends(request) || !is_http => ("400 Bad Request", "no request of HTTP/1.1\n".into()),
        (Some(b"GET"), Some(b"/metrics")) => ("200 OK", text()),
        (Some(b"GET"), _) => ("404 Not Found", "the page is /metrics\n".into()),
        _ => ("405 Method Not Allowed", "the method is GET\n".into()),
    };
    let allow = if status.starts_with("405") { "Allow: GET\r\n" } else { "" };
    format!(
        "HTTP/1.1 {status}\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8\r\n\
         Content-Length: {}\r\n{allow}Connection: close\r\n\r\n{body}",
        body.len()
    )
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn status(request: &[u8]) -> String {
        let response = response(request, || "figures\n".to_owned());
        response.split(' ').nth(1).unwrap().to_owned()
    }

    #[test]
    fn one_page_is_served() {
        for (request, expected) in [
            ("GET /metrics HTTP/1.1\r\n\r\n", "200"),
            ("GET /metrics HTTP/1.0\r\nHost: x\r\n\r\n", "200"),
            ("GET / HTTP/1.1\r\n\r\n", "404"),
            ("GET /metrics/../x HTTP/1.1\r\n\r\n", "404"),
            ("POST /metrics HTTP/1.1\r\n\r\n", "405"),
            ("GET /metrics\r\n\r\n", "400"),
            ("GET /metrics HTTP/1.1\r\n", "400"),
            ("", "400"),
        ] {
            assert_eq!(status(request.as_bytes()), expected, "{request:?}");
        }
    }

    proptest! {
        #[test]
        fn any_request_has_an_answer(request in any::<Vec<u8>>()) {
            prop_assert!(["200", "400", "404", "405"].contains(&status(&request).as_str()));
        }
    }
}
