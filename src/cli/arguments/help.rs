//! The help texts that clap does not generate from the descriptions.

use std::fmt::Write;

use super::option::OptionSpec;
use super::{SUBCOMMANDS, Subcommand, play};
use crate::app::Bindings;
use crate::map::builtin::LEVELS;

/// The width of help in columns, in windows of any width.
pub(crate) const WIDTH: usize = 80;

/// The text before the options of the game.
pub(crate) fn about() -> String {
    let names: Vec<&str> = LEVELS.iter().map(|level| level.name).collect();
    format!("{ABOUT}{MAP}{}.", names.join(", "))
}

const ABOUT: &str = "\
A raycaster game in the terminal, and its pictures in scripts.

You are a thief. Take the treasure that a level asks for, keep out of sight and hearing of its guards, \
and reach the exit, which the map shows as a green square. A level ends with its time, treasure, \
alarms and a rank, and your best results are kept.

Without MAP the title screen offers the saved games, a new game at one of three difficulties, the levels \
with your best results, the daily run, endless games, the maps in this folder, settings and help. With \
MAP, --generate or --endless the game begins at once, and asks first only if a game in that level is \
saved. --daily asks before the try that counts.
";

const MAP: &str = "
MAP is a map file, \"-\" for standard input, or a built-in level; --generate maze, cave or office makes \
one in its place. An option may also stand before the command. The built-in levels are ";

pub(crate) const WHERE_TO_READ_ON: &str = "\
\"cellcaster --help\" has all commands with their options, keys and examples; \"cellcaster COMMAND \
--help\" tells of one command.";

/// The text after the options of the game: options of other commands, keys, and examples.
pub(crate) fn more() -> String {
    let mut text = String::new();
    for subcommand in SUBCOMMANDS.iter().filter(|it| it.name != play::SUBCOMMAND.name) {
        push_details(&mut text, subcommand);
    }
    text.push_str(OTHER_PROGRAMS);
    push_keys(&mut text);
    text.push_str("Examples:\n");
    for line in SUBCOMMANDS.iter().flat_map(|subcommand| subcommand.examples.lines()) {
        _ = writeln!(text, "  {line}");
    }
    text.push_str(EXIT_STATUS);
    text
}

/// The text after the options of a command.
pub(crate) fn examples(subcommand: &Subcommand) -> String {
    let lines: Vec<String> =
        subcommand.examples.lines().map(|line| format!("  {line}\n")).collect();
    format!("Examples:\n{}", lines.concat())
}

const OTHER_PROGRAMS: &str = "\
Other programs: cellcaster NAME runs cellcaster-NAME, which is beside this
program or on the PATH.
  cellcaster server       an SSH server in which people play together;
                          also as serve, admin and scores
  cellcaster lab          measurements: accuracy, bench, wire, load

";

const EXIT_STATUS: &str = "
Exit status: 0; 2 for a mistake in the arguments, a map or a script; 1 where the
machine refuses something, or where replay --verify does not reach an exit.";

/// The details of a command, if there are more than its one line.
fn push_details(text: &mut String, subcommand: &Subcommand) {
    if subcommand.details.is_empty() && subcommand.options.is_empty() {
        return;
    }
    _ = writeln!(text, "cellcaster {}:", subcommand.name);
    for line in subcommand.details.lines() {
        push_wrapped(text, "  ".to_owned(), 2, line);
    }
    push_options(text, subcommand);
    text.push('\n');
}

/// The options of a command that `play` does not have, and the names of the others.
fn push_options(text: &mut String, subcommand: &Subcommand) {
    let options = subcommand.options.iter();
    let (shared, own): (Vec<&&dyn OptionSpec>, Vec<&&dyn OptionSpec>) =
        options.partition(|option| is_as_in_play(**option));
    for option in own {
        let choices = match option.choices() {
            [] => String::new(),
            choices => format!(" [possible values: {}]", choices.join(", ")),
        };
        push_row(text, &option.usage(), &(option.help() + &choices));
    }
    if !shared.is_empty() {
        let names: Vec<String> =
            shared.iter().map(|option| format!("--{}", option.name())).collect();
        push_row(text, "as above", &names.join(", "));
    }
}

/// Whether the game has an option of the same name that means the same.
fn is_as_in_play(option: &dyn OptionSpec) -> bool {
    let mut options = play::SUBCOMMAND.options.iter();
    options.any(|known| known.usage() == option.usage() && known.help() == option.help())
}

fn push_keys(text: &mut String) {
    text.push_str("Keys:\n");
    for (keys, does) in Bindings::default().described() {
        push_row(text, &keys, does);
    }
    text.push('\n');
}

/// A row of two columns, the second of which is wrapped.
fn push_row(text: &mut String, first: &str, second: &str) {
    const SECOND: usize = 26;
    let mut line = format!("  {first:<width$}", width = SECOND - 2);
    if line.len() > SECOND {
        _ = writeln!(text, "{}", line.trim_end());
        line = " ".repeat(SECOND);
    }
    push_wrapped(text, line, SECOND, second);
}

/// Appends `words` to `line`, and wraps to the column `indent` of the next line.
fn push_wrapped(text: &mut String, mut line: String, indent: usize, words: &str) {
    for word in words.split(' ') {
        if line.chars().count() + word.chars().count() > WIDTH {
            _ = writeln!(text, "{}", line.trim_end());
            line = " ".repeat(indent);
        }
        line.push_str(word);
        line.push(' ');
    }
    _ = writeln!(text, "{}", line.trim_end());
}
