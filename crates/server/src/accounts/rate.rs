//! The limit on the accounts that a network may create: the generic cell rate algorithm (ITU-T I.371).
//!
//! The store keeps one time for each network: when it has its whole allowance again. Each account moves that time
//! later, and the store refuses an account that would move it too far. A time in the past means the same as none.
//!
//! Rejected: a list of the accounts of the last hour. It grows with the rate, and its limit has an edge.

use std::net::IpAddr;

use super::{AccountRefusal, AddressPrefix, UnixTime};

/// The number of accounts that a network may create.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccountRate {
    /// The most accounts in an hour, in the long run.
    pub per_hour: u32,
    /// The most accounts at once.
    pub at_once: u32,
}

/// The origin of a new account.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The network: a /24 of IPv4 or a /64 of IPv6.
    pub network: AddressPrefix,
    /// The number of accounts that it may create.
    pub rate: AccountRate,
}

/// In milliseconds.
const HOUR: i64 = 60 * 60 * 1000;

impl Origin {
    /// The origin of a visitor with this address, in a network with this rate.
    pub fn new(address: IpAddr, rate: AccountRate) -> Self {
        Self { network: AddressPrefix::network_of(address), rate }
    }

    /// Counts an account. `known` is the stored time. Returns the new one: when the network has its whole allowance
    /// again, in milliseconds since 1970.
    pub(crate) fn count(&self, known: Option<i64>, now: UnixTime) -> Result<i64, AccountRefusal> {
        let now = milliseconds(now);
        let pause = HOUR / i64::from(self.rate.per_hour.max(1));
        let most = pause * (i64::from(self.rate.at_once.max(1)) - 1);
        // A later time comes from a wrong clock or from another rate.
        let whole_at = known.unwrap_or(now).clamp(now, now + most + pause);
        let early = whole_at - now - most;
        if early > 0 {
            let seconds = (early as u64).div_ceil(1000);
            return Err(AccountRefusal::TooManyAccounts { seconds });
        }
        Ok(whole_at + pause)
    }
}

/// A time in milliseconds since 1970.
pub(crate) fn milliseconds(time: UnixTime) -> i64 {
    // Several thousand years.
    const LAST: u64 = 1 << 37;
    (time.seconds().min(LAST) * 1000) as i64
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn no_hour_exceeds_the_rate_plus_the_burst(
            per_hour in 1..40_u32, at_once in 1..9_u32,
            pauses in prop::collection::vec(0..900_u64, 1..200),
        ) {
            let origin = Origin::new([192, 0, 2, 7].into(), AccountRate { per_hour, at_once });
            let (mut known, mut now, mut made) = (None, UnixTime::new(1_795_300_000), Vec::new());
            for pause in pauses {
                now = now.after(pause);
                match origin.count(known, now) {
                    Ok(time) => {
                        known = Some(time);
                        made.push(now.seconds());
                    }
                    Err(AccountRefusal::TooManyAccounts { seconds }) => {
                        // A visitor who waits as long as told gets in, and not a second earlier.
                        prop_assert!(origin.count(known, now.after(seconds)).is_ok());
                        prop_assert!(origin.count(known, now.after(seconds - 1)).is_err());
                    }
                    Err(refusal) => prop_assert!(false, "{refusal:?}"),
                }
            }
            for (index, first) in made.iter().enumerate() {
                let in_an_hour = made[index..].iter().take_while(|it| *it - first < 3600).count();
                prop_assert!(in_an_hour as u32 <= per_hour + at_once);
            }
        }

        #[test]
        fn no_stored_time_blocks_a_network_for_long(known: i64, now: u64) {
            let rate = AccountRate { per_hour: 20, at_once: 20 };
            let origin = Origin::new([192, 0, 2, 7].into(), rate);
            if let Err(AccountRefusal::TooManyAccounts { seconds }) =
                origin.count(Some(known), UnixTime::new(now))
            {
                prop_assert!(seconds <= 180);
            }
        }
    }
}
