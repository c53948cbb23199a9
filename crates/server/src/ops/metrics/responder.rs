//! A server of HTTP/1.1 for one page.
//!
//! It reads at most 4 KB of a request within two seconds, answers, and closes the connection.
//!
//! Rejected: a server library. A request of Prometheus is one line.

use std::io;
use std::sync::Arc;
use std::time::Duration;

use prometheus_client::encoding::prometheus_text::CONTENT_TYPE;
use tokio::io::{AsyncBufReadExt, AsyncReadExt, AsyncWriteExt, BufReader, copy, sink};
use tokio::net::{TcpListener, TcpStream};

use super::Metrics;
use crate::ops::serve_each;

const MOST_BYTES: u64 = 4096;
const TIMEOUT: Duration = Duration::from_secs(2);

/// Answers `GET /metrics` with the figures, until the future is dropped.
pub async fn respond(listener: TcpListener, metrics: Arc<Metrics>) {
    let answer = |stream| answer(stream, Arc::clone(&metrics));
    serve_each(|context| listener.poll_accept(context), TIMEOUT, answer).await;
}

async fn answer(mut stream: TcpStream, metrics: Arc<Metrics>) -> io::Result<()> {
    let request = request(&mut stream).await?;
    stream.write_all(response(&request, || metrics.text()).as_bytes()).await?;
    stream.shutdown().await?;
    // Closed with unread bytes, the connection would be reset, and the client might lose the answer.
    copy(&mut stream, &mut sink()).await?;
    Ok(())
}

/// The head of a request, or its first [`MOST_BYTES`].
async fn request(stream: &mut TcpStream) -> io::Result<Vec<u8>> {
    let mut stream = BufReader::new(stream.take(MOST_BYTES));
    let mut request = Vec::new();
    while !ends(&request) && stream.read_until(b'\n', &mut request).await? > 0 {}
    Ok(request)
}

fn ends(request: &[u8]) -> bool {
    request.ends_with(b"\r\n\r\n")
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
        "HTTP/1.1 {status}\r\nContent-Type: {CONTENT_TYPE}\r\n\
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
