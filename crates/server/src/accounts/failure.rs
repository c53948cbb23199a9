//! Failures of a store, and refusals.

use thiserror::Error;

use super::{UnixTime, time_text};

/// A failure of the store, as a sentence.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum StoreFailure {
    /// The store did not answer.
    #[error("{0}")]
    Away(String),
    /// The disk of the store is full.
    #[error("{0}")]
    Full(String),
    /// Another failure. The same call would fail again.
    #[error("{0}")]
    Refused(String),
}

/// The reason why an account was not created or renamed.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum AccountRefusal {
    /// Another account has this name or a similar-looking one.
    #[error("This name, or one that looks like it, is taken.")]
    NameTaken,
    /// The name is banned.
    #[error("This name is not allowed here.")]
    NameBanned,
    /// The key already has an account.
    #[error("Your key already has an account.")]
    KeyKnown,
    /// There is no such account.
    #[error("This account does not exist.")]
    NoAccount,
    /// The current name is too recent.
    #[error("You can change a name seven days after you chose it.")]
    TooEarly {
        /// The earliest time at which the name can change.
        next: UnixTime,
    },
    /// The network of a new account has created too many.
    #[error("Your network has created too many accounts; try again in {}.", minutes(*seconds))]
    TooManyAccounts {
        /// The seconds until it can create the next account.
        seconds: u64,
    },
    /// The store failed.
    #[error("The host can't save this now; try again later.")]
    Failed(#[from] StoreFailure),
}

impl StoreFailure {
    pub(crate) fn new(sentence: impl Into<String>) -> Self {
        Self::Refused(sentence.into())
    }

    /// Returns true if the same call may succeed later.
    pub(crate) fn is_of_now(&self) -> bool {
        matches!(self, Self::Away(_) | Self::Full(_))
    }
}

/// The time until a network can create an account, rounded up to minutes.
fn minutes(seconds: u64) -> String {
    time_text(seconds.max(1).next_multiple_of(60))
}
