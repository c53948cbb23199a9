//! The command line of the laboratory.

mod accuracy;
mod arguments;
mod bench;
mod plot;
mod wire;

use std::ffi::OsString;
use std::process::ExitCode;

use arguments::{Arguments, Command};
use cellcaster::cli::{Error, exit_code, parse, run_with_caster};

use crate::casters::Method;
#[cfg(target_os = "linux")]
use crate::load;

/// Runs the command that `words` request, and returns the exit status. The first word is the program's own name.
pub fn run(words: impl IntoIterator<Item = OsString>) -> ExitCode {
    let words = caster_last(words.into_iter().collect());
    let command = match parse::parse::<Arguments>(words) {
        Ok(Some(arguments)) => arguments.command,
        Ok(None) => return ExitCode::SUCCESS,
        Err(error) => return exit_code(Err(error)),
    };
    exit_code(match command {
        Command::Accuracy(options) => accuracy::run(&options),
        Command::Bench(options) => bench::run(&options),
        Command::Wire(options) => wire::run(&options),
        #[cfg(target_os = "linux")]
        Command::Load(options) => load::run(&options),
        Command::Cast(words) => return forward("cast", words.words),
        Command::Snapshot(words) => return forward("snapshot", words.words),
        Command::Play(words) => return forward("play", words.words),
    })
}

/// The words with the command first, as in `--caster dda snapshot`, and `play` where none is named.
fn caster_last(mut words: Vec<OsString>) -> Vec<OsString> {
    let is_caster =
        |word: &OsString| word.to_str().is_some_and(|word| word.starts_with("--caster"));
    if !words.get(1).is_some_and(is_caster) {
        return words;
    }
    let count = if words[1] == "--caster" { 2 } else { 1 };
    let caster: Vec<OsString> = words.drain(1..words.len().min(1 + count)).collect();
    let is_command = |word: &OsString| ["cast", "snapshot", "play"].iter().any(|name| word == name);
    if !words.get(1).is_some_and(is_command) {
        words.insert(1, "play".into());
    }
    words.extend(caster);
    words
}

/// Runs a command of the game with the caster that the words name.
fn forward(command: &str, words: Vec<OsString>) -> ExitCode {
    let (method, words) = match without_caster(words) {
        Ok(parts) => parts,
        Err(error) => return exit_code(Err(error)),
    };
    let words = ["cellcaster", command].into_iter().map(OsString::from).chain(words);
    run_with_caster(words, &method.caster())
}

/// The method that the last `--caster` names, and the other words.
fn without_caster(words: Vec<OsString>) -> Result<(Method, Vec<OsString>), Error> {
    let (mut method, mut others) = (Method::default(), Vec::new());
    let mut words = words.into_iter();
    while let Some(word) = words.next() {
        let value = match word.to_str() {
            Some("--") => {
                others.push(word);
                others.extend(words);
                break;
            }
            Some("--caster") => words.next().unwrap_or_default(),
            Some(text) => {
                if let Some(value) = text.strip_prefix("--caster=") {
                    value.into()
                } else {
                    others.push(word);
                    continue;
                }
            }
            None => {
                others.push(word);
                continue;
            }
        };
        let value = value.to_string_lossy();
        method =
            value.parse().map_err(|error| Error::mistake(format!("--caster {value}: {error}")))?;
    }
    Ok((method, others))
}
