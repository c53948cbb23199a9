//! The bytes that arrive on a connection to `admin.sock`.
//!
//! There is exactly one answer, a line that parses as a reply. Writing a request and reading it
//! again returns the same request. The work is bounded by the number of bytes.

use allocation_counter::measure;
use cellcaster_server::admin::{AdminReply, AdminRequest};
use cellcaster_server::fuzzing::FuzzedHost;

thread_local! {
    static DESK: FuzzedHost = FuzzedHost::default();
}

/// Answers the bytes.
pub fn run(data: &[u8]) {
    let mut line = Vec::new();
    let used = measure(|| line = DESK.with(|desk| desk.answer(data)));
    let most = 64 * 1024 + 64 * data.len() as u64;
    assert!(used.bytes_total <= most, "{} bytes for {}", used.bytes_total, data.len());
    assert_eq!(line.iter().position(|&byte| byte == b'\n'), Some(line.len() - 1));
    let reply: AdminReply = serde_json::from_slice(&line).expect("it is a reply");
    let written = serde_json::to_vec(&reply).expect("it is plain data");
    assert_eq!(written, line[..line.len() - 1]);
    if let Ok(request) = serde_json::from_slice::<AdminRequest>(data) {
        let written = serde_json::to_string(&request).expect("it is plain data");
        assert_eq!(serde_json::from_str::<AdminRequest>(&written).ok(), Some(request));
    }
}
