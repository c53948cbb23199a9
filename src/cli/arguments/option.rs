//! Options: each is described once, and parsed, completed and explained by that.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::builder::{PossibleValue, TypedValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, ArgAction, ArgMatches, Command, ValueHint, value_parser};

/// An option of whatever type, as far as its description goes.
pub(super) trait Described {
    /// What follows the two dashes.
    fn name(&self) -> &'static str;

    /// What has to follow it; `None` for an option that takes no value.
    fn takes(&self) -> Option<&'static str>;

    /// How it is written, such as `--size <COLSxROWS>`.
    fn usage(&self) -> String;

    /// What it does, and what holds without it.
    fn help(&self) -> String;

    /// The values, where a list can name them all.
    fn choices(&self) -> &'static [&'static str] {
        &[]
    }

    fn argument(&self) -> Arg;
}

/// An option that takes a value.
pub(super) struct Valued<T> {
    pub(super) name: &'static str,
    /// What stands for the value in help, such as `COLSxROWS`.
    pub(super) value: &'static str,
    /// What it takes, for the sentence on something else.
    pub(super) takes: &'static str,
    pub(super) help: &'static str,
    /// What holds without it, in the words of the help; may be empty.
    pub(super) default: &'static str,
    /// The values, where a list can name them all.
    pub(super) choices: &'static [&'static str],
    pub(super) read: Read<T>,
    /// Whether several values may be given, an option for each.
    pub(super) repeats: bool,
}

/// How a value is read.
#[derive(Clone)]
pub(super) enum Read<T> {
    /// `None` for a text that is not what the option takes.
    Plainly(fn(&str) -> Option<T>),
    /// The error says what is wrong with the text.
    Explaining(fn(&str) -> Result<T, String>),
}

impl<T> Valued<T>
where
    T: Clone + Send + Sync + 'static,
{
    /// The value that was given; the last one of several.
    pub(super) fn of(&self, matches: &mut ArgMatches) -> Option<T> {
        matches.remove_one(self.name)
    }

    /// All values that were given, in their order.
    pub(super) fn all_of(&self, matches: &mut ArgMatches) -> Vec<T> {
        matches.remove_many(self.name).map(Iterator::collect).unwrap_or_default()
    }
}

impl<T> Described for Valued<T>
where
    T: Clone + Send + Sync + 'static,
{
    fn name(&self) -> &'static str {
        self.name
    }

    fn takes(&self) -> Option<&'static str> {
        Some(self.takes)
    }

    fn usage(&self) -> String {
        format!("--{} <{}>", self.name, self.value)
    }

    fn help(&self) -> String {
        match self.default {
            "" => self.help.to_owned(),
            default => format!("{} [default: {default}]", self.help),
        }
    }

    fn choices(&self) -> &'static [&'static str] {
        self.choices
    }

    fn argument(&self) -> Arg {
        let action = if self.repeats { ArgAction::Append } else { ArgAction::Set };
        Arg::new(self.name)
            .long(self.name)
            .value_name(self.value)
            .help(self.help())
            .action(action)
            // A value may be negative; and what looks like an option is then told to be no value.
            .allow_hyphen_values(true)
            .value_parser(ValueReader {
                name: self.name,
                takes: self.takes,
                choices: self.choices,
                read: self.read.clone(),
            })
    }
}

/// Reads a value for clap.
#[derive(Clone)]
struct ValueReader<T> {
    name: &'static str,
    takes: &'static str,
    choices: &'static [&'static str],
    read: Read<T>,
}

impl<T> TypedValueParser for ValueReader<T>
where
    T: Clone + Send + Sync + 'static,
{
    type Value = T;

    fn parse_ref(
        &self,
        command: &Command,
        _: Option<&Arg>,
        value: &OsStr,
    ) -> Result<T, clap::Error> {
        let text = value.to_string_lossy();
        let Self { name, takes, .. } = self;
        let read = match self.read {
            Read::Plainly(read) => {
                read(&text).ok_or_else(|| format!("--{name} takes {takes}, not \"{text}\""))
            }
            Read::Explaining(read) => read(&text),
        };
        read.map_err(|sentence| {
            let mut error = clap::Error::new(ErrorKind::ValueValidation).with_cmd(command);
            error.insert(ContextKind::Custom, ContextValue::String(sentence));
            error
        })
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        if self.choices.is_empty() {
            return None;
        }
        Some(Box::new(self.choices.iter().map(PossibleValue::new)))
    }
}

/// An option that takes the name of a file.
pub(super) struct FileOption {
    pub(super) name: &'static str,
    pub(super) help: &'static str,
}

impl FileOption {
    /// The file that was given.
    pub(super) fn of(&self, matches: &mut ArgMatches) -> Option<PathBuf> {
        matches.remove_one(self.name)
    }
}

impl Described for FileOption {
    fn name(&self) -> &'static str {
        self.name
    }

    fn takes(&self) -> Option<&'static str> {
        Some("a file")
    }

    fn usage(&self) -> String {
        format!("--{} <FILE>", self.name)
    }

    fn help(&self) -> String {
        self.help.to_owned()
    }

    fn argument(&self) -> Arg {
        Arg::new(self.name)
            .long(self.name)
            .value_name("FILE")
            .value_hint(ValueHint::FilePath)
            .help(self.help)
            .allow_hyphen_values(true)
            .value_parser(value_parser!(PathBuf))
    }
}

/// An option that is given or not.
pub(super) struct Flag {
    pub(super) name: &'static str,
    pub(super) help: &'static str,
}

impl Flag {
    /// Whether it was given.
    pub(super) fn of(&self, matches: &ArgMatches) -> bool {
        matches.get_flag(self.name)
    }
}

impl Described for Flag {
    fn name(&self) -> &'static str {
        self.name
    }

    fn takes(&self) -> Option<&'static str> {
        None
    }

    fn usage(&self) -> String {
        format!("--{}", self.name)
    }

    fn help(&self) -> String {
        self.help.to_owned()
    }

    fn argument(&self) -> Arg {
        Arg::new(self.name).long(self.name).help(self.help).action(ArgAction::SetTrue)
    }
}
