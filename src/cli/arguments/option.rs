//! Options: one description for parsing, completion and help.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::builder::{PossibleValue, TypedValueParser, ValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, ArgAction, ArgMatches, Command, ValueHint, value_parser};

/// The description of an option of any type.
pub(crate) trait OptionSpec {
    /// The name after the two dashes.
    fn name(&self) -> &'static str;

    /// The required value; `None` for an option without a value.
    fn takes(&self) -> Option<&'static str>;

    /// The usage, such as `--size <COLSxROWS>`.
    fn usage(&self) -> String;

    /// The effect, and the default.
    fn help(&self) -> String;

    /// The possible values, if they are a fixed list.
    fn choices(&self) -> &'static [&'static str] {
        &[]
    }

    fn argument(&self) -> Arg;
}

/// An option with a value.
pub(crate) struct ValueOption<T> {
    pub(crate) name: &'static str,
    /// The placeholder of the value in help, such as `COLSxROWS`.
    pub(crate) value: &'static str,
    /// The valid values, for the sentence about an invalid one.
    pub(crate) takes: &'static str,
    pub(crate) help: &'static str,
    /// The default in the words of the help; may be empty.
    pub(crate) default: &'static str,
    /// The possible values, if they are a fixed list.
    pub(crate) choices: &'static [&'static str],
    pub(crate) read: Parser<T>,
}

/// A parser of values.
#[derive(Clone)]
pub(crate) enum Parser<T> {
    /// A function that returns `None` for an invalid text.
    Optional(fn(&str) -> Option<T>),
    /// A function that returns the reason why a text is invalid.
    Fallible(fn(&str) -> Result<T, String>),
}

impl<T> ValueOption<T>
where
    T: Clone + Send + Sync + 'static,
{
    /// The given value; the last one if there are several.
    pub(crate) fn of(&self, matches: &mut ArgMatches) -> Option<T> {
        matches.remove_one(self.name)
    }
}

impl<T> OptionSpec for ValueOption<T>
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
        usage(self.name, self.value)
    }

    fn help(&self) -> String {
        help(self.help, self.default)
    }

    fn choices(&self) -> &'static [&'static str] {
        self.choices
    }

    fn argument(&self) -> Arg {
        let Self { name, takes, choices, .. } = *self;
        let reader = ValueReader { name, takes, choices, read: self.read.clone() };
        argument(name, self.value, self.help(), ValueParser::new(reader))
    }
}

/// An argument with a value of any type. It is apart from [`ValueOption`], so that there is one copy of it.
#[inline(never)]
fn argument(name: &'static str, value: &'static str, help: String, parser: ValueParser) -> Arg {
    Arg::new(name)
        .long(name)
        .value_name(value)
        .help(help)
        .action(ArgAction::Set)
        // A value may be negative. A text that looks like an option is then refused as a value.
        .allow_hyphen_values(true)
        .value_parser(parser)
}

/// The usage of an option with a value.
#[inline(never)]
fn usage(name: &str, value: &str) -> String {
    format!("--{name} <{value}>")
}

/// The help of an option with this default, which may be empty.
#[inline(never)]
fn help(help: &str, default: &str) -> String {
    match default {
        "" => help.to_owned(),
        default => format!("{help} [default: {default}]"),
    }
}

/// The error of a value that was refused with this sentence.
#[inline(never)]
fn refused(sentence: String, command: &Command) -> clap::Error {
    let mut error = clap::Error::new(ErrorKind::ValueValidation).with_cmd(command);
    error.insert(ContextKind::Custom, ContextValue::String(sentence));
    error
}

/// Parses a value for clap.
#[derive(Clone)]
struct ValueReader<T> {
    name: &'static str,
    takes: &'static str,
    choices: &'static [&'static str],
    read: Parser<T>,
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
            Parser::Optional(read) => {
                read(&text).ok_or_else(|| format!("--{name} takes {takes}, not \"{text}\""))
            }
            Parser::Fallible(read) => read(&text),
        };
        read.map_err(|sentence| refused(sentence, command))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        if self.choices.is_empty() {
            return None;
        }
        Some(Box::new(self.choices.iter().map(PossibleValue::new)))
    }
}

/// An option whose value is the name of a file.
pub(crate) struct FileOption {
    pub(crate) name: &'static str,
    pub(crate) help: &'static str,
}

impl FileOption {
    /// The given file.
    pub(crate) fn of(&self, matches: &mut ArgMatches) -> Option<PathBuf> {
        matches.remove_one(self.name)
    }
}

impl OptionSpec for FileOption {
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

/// An option without a value.
pub(crate) struct Flag {
    pub(crate) name: &'static str,
    pub(crate) help: &'static str,
}

impl Flag {
    /// Whether it was given.
    pub(crate) fn of(&self, matches: &ArgMatches) -> bool {
        matches.get_flag(self.name)
    }
}

impl OptionSpec for Flag {
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
