//! Options before the subcommand: `cellcaster --colors 256 snapshot` is `cellcaster snapshot
//! --colors 256`.
//!
//! In clap they would have to be options of the program, which every subcommand would then accept.

use std::ffi::OsString;

use super::{SUBCOMMANDS, Subcommand, named};

/// The same words with the subcommand directly after the program's own name; and the subcommand, if
/// one is named.
pub(crate) fn subcommand_first(
    mut words: Vec<OsString>,
) -> (Vec<OsString>, Option<&'static Subcommand>) {
    let Some((index, subcommand)) = find(&words) else { return (words, None) };
    let name = words.remove(index);
    words.insert(1, name);
    (words, Some(subcommand))
}

/// The index of the subcommand. Only options precede it.
fn find(words: &[OsString]) -> Option<(usize, &'static Subcommand)> {
    let mut index = 1;
    loop {
        let word = words.get(index)?.to_str()?;
        if let Some(subcommand) = named(word) {
            return Some((index, subcommand));
        }
        let is_option = word.starts_with('-') && !["-", "--", "-V", "--version"].contains(&word);
        if !is_option {
            return None;
        }
        index += if takes_the_next_word(word) { 2 } else { 1 };
    }
}

/// Whether `word` is an option of any subcommand whose value is the next word.
fn takes_the_next_word(word: &str) -> bool {
    let options = SUBCOMMANDS.iter().flat_map(|subcommand| subcommand.options);
    let mut valued = options.filter(|option| option.takes().is_some());
    word.strip_prefix("--").is_some_and(|name| valued.any(|option| option.name() == name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ordered(line: &str) -> String {
        let words = line.split(' ').map(OsString::from).collect();
        let (words, subcommand) = subcommand_first(words);
        let words: Vec<&str> = words.iter().map(|word| word.to_str().unwrap()).collect();
        format!("{}: {}", subcommand.map_or("none", |it| it.name), words.join(" "))
    }

    #[test]
    fn only_options_may_stand_before_the_subcommand() {
        for (line, expected) in [
            ("c", "none: c"),
            ("c snapshot --fov 9", "snapshot: c snapshot --fov 9"),
            ("c --fov 9 snapshot m", "snapshot: c snapshot --fov 9 m"),
            ("c --fov=9 --explain snapshot", "snapshot: c snapshot --fov=9 --explain"),
            ("c -h check", "check: c check -h"),
            ("c --record cast cast", "cast: c cast --record cast"),
            ("c --fov snapshot", "none: c --fov snapshot"),
            ("c m snapshot", "none: c m snapshot"),
            ("c - snapshot", "none: c - snapshot"),
            ("c -- snapshot", "none: c -- snapshot"),
            ("c -V snapshot", "none: c -V snapshot"),
        ] {
            assert_eq!(ordered(line), expected, "{line}");
        }
    }
}
