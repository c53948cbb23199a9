//! A proxy that cuts a connection at a statement.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// A proxy in front of a server. It cuts one connection.
pub(crate) struct Proxy {
    port: u16,
    cut: Arc<Mutex<Option<Cut>>>,
}

/// The point at which a connection is cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    /// At the first packet from the client with this text.
    pub(crate) at: &'static str,
    /// `true` if the server receives the packet, and does what it says. The client never receives
    /// the answer.
    pub(crate) is_passed_on: bool,
}

impl Proxy {
    pub(crate) fn before(server: u16) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let cut = Arc::new(Mutex::new(None));
        let of_connections = Arc::clone(&cut);
        thread::spawn(move || {
            for client in listener.incoming() {
                let (client, cut) = (client.unwrap(), Arc::clone(&of_connections));
                thread::spawn(move || join(client, server, &cut));
            }
        });
        Self { port, cut }
    }

    /// The address of the same database through the proxy.
    pub(crate) fn address(&self, address: &str, server: u16) -> String {
        address.replace(&format!(":{server}/"), &format!(":{}/", self.port))
    }

    /// Cuts the first connection that reaches `cut`.
    pub(crate) fn cut(&self, cut: Cut) {
        *self.cut.lock().unwrap() = Some(cut);
    }

    /// Returns true if the connection was cut.
    pub(crate) fn has_cut(&self) -> bool {
        self.cut.lock().unwrap().is_none()
    }
}

fn join(client: TcpStream, server: u16, cut: &Mutex<Option<Cut>>) {
    let Ok(server) = TcpStream::connect(("127.0.0.1", server)) else { return };
    let (mut answers, mut back) = (server.try_clone().unwrap(), client.try_clone().unwrap());
    thread::spawn(move || {
        _ = std::io::copy(&mut answers, &mut back);
        _ = back.shutdown(Shutdown::Both);
    });
    pass_on(client, server, cut);
}

/// Forwards packets until the connection is cut or ends.
fn pass_on(mut client: TcpStream, mut server: TcpStream, cut: &Mutex<Option<Cut>>) {
    let mut packet = [0; 1 << 13];
    while let Ok(count @ 1..) = client.read(&mut packet) {
        let packet = &packet[..count];
        let has = |at: &str| packet.windows(at.len()).any(|part| part == at.as_bytes());
        let found = cut.lock().unwrap().take_if(|cut| has(cut.at));
        if found.is_none_or(|cut| cut.is_passed_on) {
            // Close the client's side first, so that the client does not receive the answer.
            if found.is_some() {
                _ = client.shutdown(Shutdown::Both);
            }
            _ = server.write_all(packet);
        }
        if found.is_some() {
            // Give the server time to execute the packet before the connection ends.
            thread::sleep(Duration::from_millis(300));
            break;
        }
    }
    _ = client.shutdown(Shutdown::Both);
    _ = server.shutdown(Shutdown::Both);
}
