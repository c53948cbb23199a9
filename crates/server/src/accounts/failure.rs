//! Why a store did not do something.

use std::fmt;

use super::UnixTime;

/// A failure of the store, as a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StoreFailure {
    sentence: String,
    cause: Cause,
}

/// Why a call failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cause {
    /// The store did not answer.
    Away,
    /// Its disk is full.
    Full,
    /// Something else, which the same call meets again.
    Refused,
}

/// Why an account was not created or renamed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// Another account has this name, or one that looks like it.
    NameTaken,
    /// The name is banned.
    NameBanned,
    /// The key has an account.
    KeyKnown,
    /// There is no such account.
    NoAccount,
    /// The name was chosen not long ago.
    TooEarly {
        /// When it can be changed.
        next: UnixTime,
    },
    /// The network of a new account has made too many.
    TooManyAccounts {
        /// After how many seconds it can make the next one.
        seconds: u64,
    },
    /// The store failed.
    Failed(StoreFailure),
}

impl StoreFailure {
    pub(crate) fn new(sentence: impl Into<String>) -> Self {
        Self { sentence: sentence.into(), cause: Cause::Refused }
    }

    /// That of a store whose disk is full.
    pub(crate) fn full(sentence: impl Into<String>) -> Self {
        Self { sentence: sentence.into(), cause: Cause::Full }
    }

    /// That of a store that does not answer.
    pub(crate) fn away(sentence: impl Into<String>) -> Self {
        Self { sentence: sentence.into(), cause: Cause::Away }
    }

    /// Whether the store did not answer.
    pub fn is_away(&self) -> bool {
        self.cause == Cause::Away
    }

    /// Whether the disk of the store is full.
    pub fn is_full(&self) -> bool {
        self.cause == Cause::Full
    }

    /// Whether every call fails for now, and the same call may succeed later.
    pub(crate) fn is_of_now(&self) -> bool {
        self.is_away() || self.is_full()
    }
}

impl fmt::Display for StoreFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

impl fmt::Display for Refusal {
    /// Writes a sentence for the player.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooManyAccounts { seconds } => {
                let minutes = seconds.div_ceil(60).max(1);
                let unit = if minutes == 1 { "minute" } else { "minutes" };
                return write!(
                    f,
                    "Your network makes too many accounts; try again in {minutes} {unit}."
                );
            }
            Self::NameTaken => "Somebody has this name, or one that looks like it.",
            Self::NameBanned => "This name is not allowed here.",
            Self::KeyKnown => "Your key has an account.",
            Self::NoAccount => "There is no such account.",
            Self::TooEarly { .. } => "A name can be changed after seven days.",
            Self::Failed(_) => "The host can't keep this now; try again later.",
        })
    }
}

impl std::error::Error for StoreFailure {}

impl std::error::Error for Refusal {}

impl From<StoreFailure> for Refusal {
    fn from(failure: StoreFailure) -> Self {
        Self::Failed(failure)
    }
}
