//! The options of `admin`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{ArgAction, ArgMatches, ValueHint};

use crate::cli::arguments::database::{Database, STORE};
use cellcaster::cli::arguments::option::{FileOption, Parser, ValueOption};
use cellcaster::cli::arguments::{Command, Error, Positional, Subcommand};
use crate::sessions::visitors::SessionId;
use crate::ops::admin::Target;
use crate::accounts::{AccountKey, AddressPrefix};

/// Options of `admin`.
#[derive(Debug)]
pub(crate) struct Admin {
    /// The data folder of the host; that of the program if `None`.
    pub(crate) data: Option<PathBuf>,
    pub(crate) store: Option<Database>,
    pub(crate) action: AdminAction,
}

/// What to do.
#[derive(Debug)]
pub(crate) enum AdminAction {
    Who,
    Rooms,
    Hosts,
    Kick {
        target: Target,
        reason: String,
    },
    /// For ever without a time.
    Ban {
        target: Target,
        time: Option<Duration>,
        reason: String,
    },
    Unban {
        target: Target,
    },
    Bans,
    Say {
        text: String,
    },
    Drain,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "admin",
    about: "See who plays on a host, kick, ban, and say something to all",
    details: "The actions who and rooms list what a running server has; kick ends the sessions of a \
              player, or the one that --session names, say shows a line to everybody, and drain ends the server as SIGTERM does. The \
              actions ban, unban and bans work without a server, too: bans are in its store. A player \
              is a name, --key or --address; a banned name is banned with the key of its account. In a cluster, \
              who, say, kick and ban are of all hosts; hosts lists them, and drain ends the one whose data \
              folder is given.",
    examples: "cellcaster admin who\n\
               cellcaster admin hosts\n\
               cellcaster admin say \"Back in five minutes\"\n\
               cellcaster admin kick ada --reason \"let others play\"\n\
               cellcaster admin kick --session 3f9a-7\n\
               cellcaster admin ban --address 203.0.113.0/24 --for 7d\n\
               cellcaster admin --data /var/lib/cellcaster bans",
    positionals: &[ACTION, WORD],
    options: &[&DATA, &STORE, &KEY, &ADDRESS, &SESSION, &FOR, &REASON],
    surplus: "takes an action and one name or text",
    missing: "admin takes one of who, rooms, hosts, kick, ban, unban, bans, say, drain, as in \"cellcaster admin who\"",
    read,
};

const ACTION: Positional = Positional {
    name: "ACTION",
    help: "What to do",
    is_required: true,
    action: ArgAction::Set,
    hint: ValueHint::Other,
    choices: &["who", "rooms", "hosts", "kick", "ban", "unban", "bans", "say", "drain"],
};

const WORD: Positional = Positional {
    name: "NAME",
    help: "The player to kick, ban or unban; the text to say",
    is_required: false,
    action: ArgAction::Set,
    hint: ValueHint::Other,
    choices: &[],
};

const DATA: FileOption = FileOption {
    name: "data",
    help: "The data folder of the host [default: cellcaster in the folder for data, or $CELLCASTER_DATA]",
};

const KEY: ValueOption<AccountKey> = ValueOption {
    name: "key",
    value: "FINGERPRINT",
    takes: "a fingerprint as ssh-keygen -l prints it, such as SHA256:...",
    help: "The player with this public key",
    default: "",
    choices: &[],
    read: Parser::Optional(AccountKey::parse),
    repeats: false,
};

const ADDRESS: ValueOption<AddressPrefix> = ValueOption {
    name: "address",
    value: "RANGE",
    takes: "an address, or a range such as 203.0.113.0/24 or 2001:db8::/64",
    help: "All players with this address, or an address in this range",
    default: "",
    choices: &[],
    read: Parser::Optional(AddressPrefix::parse),
    repeats: false,
};

const SESSION: ValueOption<SessionId> = ValueOption {
    name: "session",
    value: "ID",
    takes: "a session as \"cellcaster admin who\" lists it, such as 3f9a-7",
    help: "One session, to kick",
    default: "",
    choices: &[],
    read: Parser::Optional(SessionId::parse),
    repeats: false,
};

const FOR: ValueOption<Duration> = ValueOption {
    name: "for",
    value: "TIME",
    takes: "a number with m, h, d or w, such as 30m or 7d",
    help: "How long a ban is in force",
    default: "for ever",
    choices: &[],
    read: Parser::Optional(time),
    repeats: false,
};

const REASON: ValueOption<String> = ValueOption {
    name: "reason",
    value: "TEXT",
    takes: "a text",
    help: "Why, for the player to read",
    default: "",
    choices: &[],
    read: Parser::Optional(|text| Some(text.to_owned())),
    repeats: false,
};

/// The time of a text such as `7d`, up to a hundred years.
fn time(text: &str) -> Option<Duration> {
    const LONGEST: u64 = 100 * 365 * 24 * 60 * 60;
    let unit = text.chars().last()?;
    let seconds = match unit {
        'm' => 60,
        'h' => 60 * 60,
        'd' => 24 * 60 * 60,
        'w' => 7 * 24 * 60 * 60,
        _ => return None,
    };
    let number =
        text.strip_suffix(unit).filter(|text| text.bytes().all(|byte| byte.is_ascii_digit()))?;
    let seconds = number.parse::<u64>().ok()?.checked_mul(seconds)?;
    (1..=LONGEST).contains(&seconds).then(|| Duration::from_secs(seconds))
}

fn read(mut matches: ArgMatches) -> Result<Command, Error> {
    let action = ACTION.of(&mut matches).unwrap_or_default();
    let word = WORD.of(&mut matches).map(|word| word.to_string_lossy().into_owned());
    let mut words = Words {
        action: action.to_string_lossy().into_owned(),
        targets: word
            .into_iter()
            .map(Target::Name)
            .chain(KEY.of(&mut matches).map(|key| Target::Key(key.to_string())))
            .chain(ADDRESS.of(&mut matches).map(|range| Target::Address(range.to_string())))
            .chain(SESSION.of(&mut matches).map(|session| Target::Session(session.to_string())))
            .collect(),
        time: FOR.of(&mut matches),
        reason: REASON.of(&mut matches),
    };
    let action = words.action()?;
    Ok(Command::Admin(Admin { data: DATA.of(&mut matches), store: STORE.of(&mut matches), action }))
}

/// The arguments of an action.
struct Words {
    action: String,
    targets: Vec<Target>,
    time: Option<Duration>,
    reason: Option<String>,
}

impl Words {
    /// The action, with all arguments that it takes and no other.
    fn action(&mut self) -> Result<AdminAction, Error> {
        let action = match self.action.as_str() {
            "who" => AdminAction::Who,
            "hosts" => AdminAction::Hosts,
            "rooms" => AdminAction::Rooms,
            "bans" => AdminAction::Bans,
            "drain" => AdminAction::Drain,
            "say" => AdminAction::Say { text: self.text()? },
            "kick" => AdminAction::Kick { target: self.target(true)?, reason: self.reason() },
            "unban" => AdminAction::Unban { target: self.target(false)? },
            _ => {
                let (target, time) = (self.target(false)?, self.time.take());
                AdminAction::Ban { target, time, reason: self.reason() }
            }
        };
        let name = &self.action;
        let surplus = match (self.targets.first(), self.time, &self.reason) {
            (Some(Target::Name(name)), ..) => format!("\"{name}\""),
            (Some(Target::Key(_)), ..) => "--key".to_owned(),
            (Some(Target::Address(_)), ..) => "--address".to_owned(),
            (Some(Target::Session(_)), ..) => "--session".to_owned(),
            (None, Some(_), _) => "--for".to_owned(),
            (None, None, Some(_)) => "--reason".to_owned(),
            (None, None, None) => return Ok(action),
        };
        Err(Error::mistake(format!("admin {name} goes without {surplus}")))
    }

    /// The one target, which is a session for some actions only.
    fn target(&mut self, takes_session: bool) -> Result<Target, Error> {
        let name = &self.action;
        let ways = if takes_session {
            ["a name, --key, --address or --session", "a name, --key, --address and --session"]
        } else {
            ["a name, --key or --address", "a name, --key and --address"]
        };
        if self.targets.iter().any(|it| matches!(it, Target::Session(_))) && !takes_session {
            return Err(Error::mistake(format!("admin {name} goes without --session")));
        }
        match self.targets.len() {
            1 => Ok(self.targets.remove(0)),
            0 => Err(Error::mistake(format!(
                "admin {name} takes {}, as in \"cellcaster admin {name} ada\"",
                ways[0]
            ))),
            _ => Err(Error::mistake(format!("admin {name} takes one of {}", ways[1]))),
        }
    }

    fn text(&mut self) -> Result<String, Error> {
        match self.targets.iter().position(|target| matches!(target, Target::Name(_))) {
            Some(index) => match self.targets.remove(index) {
                Target::Name(text) => Ok(text),
                Target::Key(_) | Target::Address(_) | Target::Session(_) => Ok(String::new()),
            },
            None => Err(Error::mistake(
                "admin say takes a text, as in \"cellcaster admin say 'Back in five minutes'\"",
            )),
        }
    }

    fn reason(&mut self) -> String {
        self.reason.take().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_a_number_with_a_unit() {
        for (text, minutes) in
            [("30m", 30), ("1h", 60), ("7d", 7 * 24 * 60), ("2w", 2 * 7 * 24 * 60)]
        {
            assert_eq!(time(text), Some(Duration::from_secs(minutes * 60)), "{text}");
        }
        for text in [
            "",
            "7",
            "d",
            "0d",
            "-1d",
            "+1d",
            "1.5h",
            "7 d",
            "7ä",
            "99999999999999999999d",
            "36501d",
        ] {
            assert_eq!(time(text), None, "{text}");
        }
    }
}
