//! A network for one host: a kernel namespace (`ip-netns(8)`) with a link to the shared servers.
//!
//! While the link is down, packets vanish without a reply, as with an unplugged cable. Needs root and the
//! program `ip` from Debian's package `iproute2`.

use std::net::Ipv4Addr;
use std::process::Command;
use std::sync::atomic::{AtomicU8, Ordering};

/// A network namespace, deleted on drop.
pub(crate) struct Network {
    namespace: String,
    /// The name of the link's end outside of the namespace.
    link: String,
    /// The first three bytes of its addresses, unique among the networks of this process.
    addresses: [u8; 3],
}

impl Network {
    pub(crate) fn new() -> Self {
        static COUNT: AtomicU8 = AtomicU8::new(0);
        let (process, count) = (std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let network = Self {
            namespace: format!("cellcaster-{process}-{count}"),
            link: format!("cc{process}-{count}"),
            addresses: [10, process as u8, count],
        };
        let (namespace, link) = (&network.namespace, &network.link);
        ip(&format!("netns add {namespace}"));
        ip(&format!("link add {link} type veth peer name bus netns {namespace}"));
        // On the loopback interface, so that the address exists even while the link is down.
        ip(&format!("address add {}/32 dev lo", network.shared()));
        ip(&format!("-n {namespace} link set lo up"));
        ip(&format!("-n {namespace} link set bus up"));
        ip(&format!("-n {namespace} address add {}/32 dev bus", network.host()));
        ip(&format!("-n {namespace} route add default dev bus"));
        network.mend();
        network
    }

    /// The name of the namespace.
    pub(crate) fn namespace(&self) -> &str {
        &self.namespace
    }

    /// The address of the servers that the hosts share.
    pub(crate) fn shared(&self) -> Ipv4Addr {
        self.address(1)
    }

    /// The address of the host.
    pub(crate) fn host(&self) -> Ipv4Addr {
        self.address(2)
    }

    fn address(&self, last: u8) -> Ipv4Addr {
        let [first, second, third] = self.addresses;
        Ipv4Addr::new(first, second, third, last)
    }

    /// Takes the link down.
    pub(crate) fn cut(&self) {
        ip(&format!("link set {} down", self.link));
    }

    /// Brings the link up.
    pub(crate) fn mend(&self) {
        ip(&format!("link set {} up", self.link));
        ip(&format!("route add {}/32 dev {}", self.host(), self.link));
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        _ = command(&format!("address delete {}/32 dev lo", self.shared())).status();
        _ = command(&format!("netns delete {}", self.namespace)).status();
    }
}

fn ip(words: &str) {
    let output = command(words).output().expect("\"ip\" is installed");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "\"ip {words}\" needs root: {said}");
}

fn command(words: &str) -> Command {
    let mut command = Command::new("ip");
    command.args(words.split_whitespace());
    // The package installs the program in a directory that only root's path contains.
    command.env("PATH", format!("{}:/usr/sbin:/sbin", std::env::var("PATH").unwrap_or_default()));
    command
}
