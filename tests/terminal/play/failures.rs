//! Each system call that loading and saving make in the data folder fails once, in a game that a
//! player wins, and in a game that a player continues and leaves.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::clock::{CLOCK, Typist};
use super::game::{ENVIRONMENT, PROGRAM, test_map};
use super::titles::folder;
use crate::strace::{Failure, Traced, failures};

/// The actions of a player from the start of the program to its end.
struct Visit {
    arguments: Vec<String>,
    play: fn(&Typist),
}

/// The stored data: the progress, and the scripts by their file names.
#[derive(Debug, PartialEq)]
struct Kept {
    progress: Option<String>,
    scripts: BTreeMap<String, String>,
}

/// The result of a visit.
struct Visited {
    /// The program's output after it has restored the terminal.
    said: String,
    process: u32,
}

fn play_map(map: &str, play: fn(&Typist)) -> Visit {
    let map = test_map(map).to_str().unwrap().to_owned();
    Visit { arguments: vec!["play".to_owned(), map], play }
}

fn win(typist: &Typist) {
    typist.wait_to_see("? help");
    typist.hold("w", 120);
    typist.wait_to_see("you found the way out");
    typist.send("\x03");
}

fn walk_and_leave(typist: &Typist) {
    typist.wait_to_see("? help");
    typist.hold("w", 60);
    typist.send("\x03");
}

/// Continues the saved game, if the program can read it.
fn go_on(typist: &Typist) {
    typist.wait_to_see("> ");
    if typist.text().contains("> Continue") {
        typist.tap("\r", 60);
        typist.wait_to_see("> Corridor on normal");
        typist.tap("\r", 60);
        typist.wait_until("went on", |emulator| {
            ["? help", "can't be read"].iter().any(|text| emulator.text().contains(text))
        });
        typist.hold("w", 60);
    }
    typist.send("\x03");
}

impl Visit {
    /// Plays with the data stored in `folder`, and leaves.
    #[track_caller]
    fn run(&self, folder: &Path, traced: Option<&Traced>) -> Visited {
        let data = ("CELLCASTER_DATA", folder.to_str().unwrap());
        let environment = [&ENVIRONMENT[..], &[CLOCK, data]].concat();
        let arguments = self.arguments.iter().map(String::as_str);
        let words = traced.map_or_else(Vec::new, Traced::words).into_iter();
        let words: Vec<&str> = words.chain([PROGRAM]).chain(arguments).collect();
        let mut typist = Typist::start(words[0], &words[1..], &environment);
        let process = typist.process();
        (self.play)(&typist);
        let ending = typist.wait_for_end();
        ending.assert_given_back();
        let said = typist.text().replace('\n', "");
        assert!(ending.status.success(), "{ending:?} {said}");
        Visited { said, process }
    }

    /// Makes each call fail that the visit makes in a folder that `fill` has filled.
    fn assert_keeps_all(&self, name: &str, fill: impl Fn(&Path)) {
        let filled = folder(&format!("{name}-before"));
        fill(&filled);
        let before = Kept::read(&filled);
        let name = format!("{name}-after");
        let prepare = || {
            let folder = folder(&name);
            before.write(&folder);
            folder
        };
        // The names of all files are known only after a visit.
        let played = prepare();
        self.run(&played, None);
        let after = Kept::read(&played);
        let played = prepare();
        let paths = paths(&played, &[&before, &after]);
        let traced = Traced::new(&played, &paths, None);
        let visited = self.run(&played, Some(&traced));
        assert!(after.is_in(&played) && after != before && !visited.said.contains("cellcaster: "));
        let counts = traced.counts(visited.process);
        assert!(["openat", "write", "fsync", "rename"].iter().all(|it| counts.contains_key(*it)));
        for failure in failures(&counts) {
            let played = prepare();
            let traced = Traced::new(&played, &paths, Some(&failure));
            let visited = self.run(&played, Some(&traced));
            assert!(traced.has_failed(visited.process), "{failure:?} of {counts:?}");
            assert_kept(&played, &visited.said, (&before, &after), &failure);
        }
    }
}

/// Either everything is stored, or a sentence gives the reason and all earlier data is still there.
#[track_caller]
fn assert_kept(folder: &Path, said: &str, (before, after): (&Kept, &Kept), failure: &Failure) {
    let sentences = said.matches("cellcaster: ").count();
    let now = || Kept::read(folder);
    if !after.is_in(folder) {
        assert!(before.is_in(folder), "{failure:?} lost something: {:?}", now());
        assert_eq!(sentences, 1, "{failure:?} was not said: {said}");
        let is_clear = ["not saved", "nothing is saved", "kept"].iter().any(|it| said.contains(it));
        assert!(is_clear && said.contains("can't be"), "{failure:?}: {said}");
    }
    assert!(sentences <= 1, "{failure:?}: {said}");
    let halves: Vec<_> = now().scripts.into_keys().filter(|name| name.contains(".new")).collect();
    assert!(halves.is_empty() && !folder.join("progress.toml.new").exists(), "{failure:?}");
}

impl Kept {
    fn read(folder: &Path) -> Self {
        let entries = fs::read_dir(folder.join("runs")).into_iter().flatten();
        let scripts = entries.map(|entry| {
            let entry = entry.unwrap();
            (entry.file_name().into_string().unwrap(), fs::read_to_string(entry.path()).unwrap())
        });
        let scripts = scripts.collect();
        Self { progress: fs::read_to_string(folder.join("progress.toml")).ok(), scripts }
    }

    fn write(&self, folder: &Path) {
        let Some(progress) = &self.progress else { return };
        fs::write(folder.join("progress.toml"), progress).unwrap();
        fs::create_dir(folder.join("runs")).unwrap();
        for (name, script) in &self.scripts {
            fs::write(folder.join("runs").join(name), script).unwrap();
        }
    }

    /// Returns whether the folder contains this data. An additional script does no harm.
    fn is_in(&self, folder: &Path) -> bool {
        let other = Self::read(folder);
        let has_script = |(name, script)| other.scripts.get(name) == Some(script);
        self.progress == other.progress && self.scripts.iter().all(has_script)
    }
}

/// All files that are opened in the folder on the way from one state to another.
fn paths(folder: &Path, states: &[&Kept]) -> Vec<PathBuf> {
    let runs = folder.join("runs");
    let scripts = states.iter().flat_map(|state| state.scripts.keys());
    let mut files: Vec<PathBuf> = scripts.map(|name| runs.join(name)).collect();
    files.push(folder.join("progress.toml"));
    let new = |file: &PathBuf| PathBuf::from(format!("{}.new", file.display()));
    let news: Vec<PathBuf> = files.iter().map(new).collect();
    let others = [folder.to_owned(), runs, folder.join("progress.lock")];
    files.into_iter().chain(news).chain(others).collect()
}

#[test]
#[ignore = "needs strace; .ci/run installs and runs it"]
fn the_first_result_is_kept_or_a_sentence_says_why_not() {
    play_map("way_out", win).assert_keeps_all("failures-first", |_| ());
}

#[test]
#[ignore = "needs strace; .ci/run installs and runs it"]
fn a_saved_game_is_kept_or_a_sentence_says_why_not() {
    let visit = Visit { arguments: vec!["play".to_owned()], play: go_on };
    visit.assert_keeps_all("failures-saved", |folder| {
        play_map("way_out", win).run(folder, None);
        play_map("corridor", walk_and_leave).run(folder, None);
    });
}
