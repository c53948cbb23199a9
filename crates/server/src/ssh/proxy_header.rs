//! The header with which a proxy names the visitor of a connection that it passes on: the PROXY protocol,
//! versions 1 and 2 (<https://www.haproxy.org/download/3.0/doc/proxy-protocol.txt>).
//!
//! Only connections from the configured proxies begin with a header. All other connections are never searched
//! for one, so nobody else can name an address.
//!
//! A header is read byte for byte up to its end, so nothing of the client's first line is read with it. Fields
//! after the addresses are skipped; a checksum among them is not verified.
//!
//! Rejected: the crates `ppp` and `proxy-header`. Both parse a whole buffer, so the loops below would still be
//! needed, and have 3100 and 2400 lines.

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

use tokio::io::{AsyncRead, AsyncReadExt};

/// The first bytes of version 2.
const SIGNATURE: [u8; 12] = *b"\r\n\r\n\0\r\nQUIT\n";
/// The most bytes of a header of version 1, with the line ending.
const MAX_LINE: usize = 107;
/// The most bytes of a header of version 2 after its length. Addresses take 36; proxies add names and
/// certificates.
const MAX_FIELDS: usize = 4096;

/// Reads a header, and returns the visitor's address. `None` stands for the proxy's own: the proxy connects for
/// itself, or does not know the address.
///
/// # Errors
/// `InvalidData` if the stream does not begin with a header of at most 4112 bytes.
pub(crate) async fn read(stream: &mut (impl AsyncRead + Unpin)) -> io::Result<Option<SocketAddr>> {
    let mut start = [0; SIGNATURE.len()];
    stream.read_exact(&mut start).await?;
    let visitor =
        if start == SIGNATURE { binary(stream).await? } else { text(stream, &start).await? };
    visitor.ok_or_else(|| io::ErrorKind::InvalidData.into())
}

/// The visitor in a valid header; `None` inside for the proxy's own address.
type ProxiedAddress = Option<Option<SocketAddr>>;

async fn text(stream: &mut (impl AsyncRead + Unpin), start: &[u8]) -> io::Result<ProxiedAddress> {
    let mut line = start.to_vec();
    while !line.ends_with(b"\r\n") {
        if !line.starts_with(b"PROXY ") || line.len() == MAX_LINE {
            return Ok(None);
        }
        line.push(stream.read_u8().await?);
    }
    Ok(str::from_utf8(&line).ok().and_then(of_line))
}

fn of_line(line: &str) -> ProxiedAddress {
    let words: Vec<&str> = line.strip_suffix("\r\n")?.split(' ').collect();
    let address = |text: &str, is_v4: bool| {
        let address: IpAddr = text.parse().ok()?;
        (address.is_ipv4() == is_v4).then_some(address)
    };
    match words[..] {
        ["PROXY", "UNKNOWN", ..] => Some(None),
        ["PROXY", family @ ("TCP4" | "TCP6"), from, to, port, to_port] => {
            let is_v4 = family == "TCP4";
            address(to, is_v4)?;
            to_port.parse::<u16>().ok()?;
            Some(Some(SocketAddr::new(address(from, is_v4)?, port.parse().ok()?)))
        }
        _ => None,
    }
}

async fn binary(stream: &mut (impl AsyncRead + Unpin)) -> io::Result<ProxiedAddress> {
    let [command, family] = [stream.read_u8().await?, stream.read_u8().await?];
    let length = usize::from(stream.read_u16().await?);
    if length > MAX_FIELDS {
        return Ok(None);
    }
    let mut fields = vec![0; length];
    stream.read_exact(&mut fields).await?;
    Ok(of_fields(command, family, &fields))
}

fn of_fields(command: u8, family: u8, fields: &[u8]) -> ProxiedAddress {
    const LOCAL: u8 = 0x20;
    const PROXY: u8 = 0x21;
    const UNSPECIFIED: u8 = 0x00;
    const TCP4: u8 = 0x11;
    const TCP6: u8 = 0x21;
    const UNIX: u8 = 0x31;
    match (command, family) {
        (LOCAL, _) | (PROXY, UNSPECIFIED | UNIX) => Some(None),
        (PROXY, TCP4) => {
            let (address, ports) = split::<4>(fields)?;
            Some(Some(SocketAddr::new(Ipv4Addr::from(address).into(), ports)))
        }
        (PROXY, TCP6) => {
            let (address, ports) = split::<16>(fields)?;
            Some(Some(SocketAddr::new(Ipv6Addr::from(address).into(), ports)))
        }
        _ => None,
    }
}

/// The source and its port, from two addresses of `N` bytes and two ports.
fn split<const N: usize>(fields: &[u8]) -> Option<([u8; N], u16)> {
    let (source, rest) = fields.split_first_chunk::<N>()?;
    let (_, rest) = rest.split_first_chunk::<N>()?;
    let ports: &[u8; 4] = rest.first_chunk()?;
    Some((*source, u16::from_be_bytes([ports[0], ports[1]])))
}

#[cfg(test)]
mod tests {
    use futures_util::FutureExt;
    use proptest::prelude::*;

    use super::*;

    const CLIENT: &[u8] = b"SSH-2.0-test\r\n";

    /// The result for a stream of `header` and the client's version, and the unread bytes. The stream never waits.
    fn result(header: &[u8]) -> (io::Result<Option<SocketAddr>>, Vec<u8>) {
        let bytes = [header, CLIENT].concat();
        let mut stream = bytes.as_slice();
        let result = read(&mut stream).now_or_never().unwrap();
        (result, stream.to_vec())
    }

    fn header(command: u8, family: u8, fields: &[u8]) -> Vec<u8> {
        let length = (fields.len() as u16).to_be_bytes();
        [&SIGNATURE as &[u8], &[command, family], &length, fields].concat()
    }

    fn fields(addresses: &[u8]) -> Vec<u8> {
        [addresses, &[0xc0, 0, 0, 22], b"\x03\0\x04crc!"].concat()
    }

    #[test]
    fn a_header_names_the_visitor_and_leaves_the_clients_bytes() {
        let v6 = Ipv6Addr::new(0x2001, 0xdb8, 0, 0, 0, 0, 0, 7).octets();
        for (header, visitor) in [
            (b"PROXY TCP4 192.0.2.7 10.0.0.5 49152 22\r\n".to_vec(), Some("192.0.2.7:49152")),
            (b"PROXY TCP6 2001:db8::7 ::1 49152 22\r\n".to_vec(), Some("[2001:db8::7]:49152")),
            (b"PROXY UNKNOWN\r\n".to_vec(), None),
            (b"PROXY UNKNOWN ffff::1 ffff::2 1 2\r\n".to_vec(), None),
            (header(0x21, 0x11, &fields(&[192, 0, 2, 7, 10, 0, 0, 5])), Some("192.0.2.7:49152")),
            (header(0x21, 0x21, &fields(&[v6, [1; 16]].concat())), Some("[2001:db8::7]:49152")),
            (header(0x20, 0, &[]), None),
            (header(0x20, 0x11, &[]), None),
            (header(0x21, 0, &[1, 2, 3]), None),
            (header(0x21, 0x31, &[0; 216]), None),
        ] {
            let (result, rest) = result(&header);
            assert_eq!(result.unwrap(), visitor.map(|it| it.parse().unwrap()), "{header:?}");
            assert_eq!(rest, CLIENT);
        }
    }

    #[test]
    fn anything_else_is_rejected() {
        let long = [b"PROXY UNKNOWN ".to_vec(), vec![b'x'; MAX_LINE]].concat();
        for header in [
            CLIENT,
            b"PROXY TCP4 192.0.2.7 10.0.0.5 49152\r\n",
            b"PROXY TCP4 192.0.2.7 10.0.0.5 49152 22 1\r\n",
            b"PROXY TCP4 2001:db8::7 ::1 49152 22\r\n",
            b"PROXY TCP6 192.0.2.7 10.0.0.5 49152 22\r\n",
            b"PROXY TCP4 192.0.2.7 10.0.0.5 65536 22\r\n",
            b"PROXY TCP4 host 10.0.0.5 49152 22\r\n",
            b"PROXY UDP4 192.0.2.7 10.0.0.5 49152 22\r\n",
            b"PROXY TCP4 192.0.2.7 10.0.0.5 49152 22\n",
            b"PROXY \xff\xff\xff\xff\xff\xff\r\n",
            &long,
            &header(0x31, 0x11, &fields(&[0; 8])),
            &header(0x22, 0x11, &fields(&[0; 8])),
            &header(0x21, 0x12, &fields(&[0; 8])),
            &header(0x21, 0x11, &[0; 11]),
            &header(0x21, 0x21, &[0; 35]),
            &header(0x21, 0x11, &[0; MAX_FIELDS + 1]),
        ] {
            assert!(result(header).0.is_err(), "{header:?}");
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(start in prop::sample::select(vec![b"" as &[u8], b"PROXY ", b"PROXY TCP4 ", &SIGNATURE]), bytes: Vec<u8>) {
            let (result, rest) = result(&[start, &bytes].concat());
            prop_assert!(result.is_err() || rest.ends_with(CLIENT));
        }
    }
}
