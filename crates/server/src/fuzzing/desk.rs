//! The socket of operators without a socket.

use std::future::Future;
use std::net::{IpAddr, Ipv4Addr};
use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Poll, Waker};

use tokio::sync::Notify;

use crate::accounts::AccountKey;
use crate::ops::admin::socket;
use crate::ops::admin::{Operator, RoomRow};
use crate::sessions::visitors::{Presence, Visitors};

/// An operator's host with three visitors.
pub struct Desk {
    operator: Operator,
    _visitors: Vec<Presence>,
}

impl Default for Desk {
    fn default() -> Self {
        let all = Visitors::default();
        let visitors = (0..3).zip(["Ada", "Bo", "字"]).map(|(number, name)| {
            let address = IpAddr::from(Ipv4Addr::new(10, 0, 0, number));
            let visitor = all.arrive(address, Some(AccountKey::new([number; 32])));
            visitor.set_name(name);
            visitor
        });
        let visitors = visitors.collect();
        let operator = Operator::new(all, Vec::<RoomRow>::new, Arc::new(Notify::new()));
        Self { operator, _visitors: visitors }
    }
}

impl Desk {
    /// What a connection answers on which `bytes` arrive and then the end.
    ///
    /// # Panics
    /// If the answer fails or waits.
    pub fn answer(&self, bytes: &[u8]) -> Vec<u8> {
        let mut stream = tokio::io::join(bytes, Vec::new());
        let answered = {
            let answer = pin!(socket::answer(&mut stream, &self.operator));
            answer.poll(&mut Context::from_waker(Waker::noop()))
        };
        assert!(matches!(answered, Poll::Ready(Ok(()))), "{answered:?}");
        stream.into_inner().1
    }
}
