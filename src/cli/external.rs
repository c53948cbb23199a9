//! Commands in other programs: `cellcaster NAME` runs `cellcaster-NAME`, as git and cargo do.
//!
//! A program in the same folder takes precedence over one on the `PATH`.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::Error;

/// The other programs of this project, and the command that installs each.
const INSTALLED: [(&str, &str); 2] =
    [("server", "cargo install cellcaster-server"), ("lab", "cargo install --path crates/lab")];

/// A command in another program.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct External {
    /// The part of the program's name after `cellcaster-`.
    program: String,
    arguments: Vec<OsString>,
}

impl External {
    /// The command that `words` name, if it is in another program; `None` if it is in this one. The
    /// first word is the name of this program.
    pub(crate) fn of(words: &[OsString]) -> Option<Self> {
        let (_, arguments) = words.split_first()?;
        let (name, rest) = arguments.split_first()?;
        let name = name.to_str()?;
        let is_ours = INSTALLED.iter().any(|(program, _)| *program == name);
        (is_ours || installed(name).is_some()).then(|| Self::new(name, rest.to_vec()))
    }

    fn new(program: &str, arguments: Vec<OsString>) -> Self {
        Self { program: program.to_owned(), arguments }
    }

    /// The command `words`, to be run by the laboratory, which contains the other casters.
    pub(crate) fn laboratory(words: Vec<OsString>) -> Self {
        Self::new("lab", words)
    }

    /// The command that replays a recording of a room.
    pub(crate) fn room_replay(arguments: impl IntoIterator<Item = OsString>) -> Self {
        Self::new("server", ["replay".into()].into_iter().chain(arguments).collect())
    }

    /// Runs the other program in place of this one.
    ///
    /// # Errors
    /// If the program is not installed, cannot be started, or ends with a failure.
    pub(crate) fn run(self) -> Result<(), Error> {
        let Self { program, arguments } = self;
        let Some(path) = installed(&program) else {
            let known = INSTALLED.iter().find(|(name, _)| *name == program);
            let install = known.map_or("install it", |(_, command)| command);
            return Err(Error::mistake(format!(
                "this needs the program cellcaster-{program}, which is neither beside this one nor on the \
                 PATH; \"{install}\" installs it"
            )));
        };
        let mut command = Command::new(&path);
        command.args(arguments);
        let cannot_start =
            |error| Error::machine(format!("{} can't be started: {error}", path.display()));
        #[cfg(unix)]
        {
            use std::os::unix::process::CommandExt;
            Err(cannot_start(command.exec()))
        }
        #[cfg(not(unix))]
        match command.status().map_err(cannot_start)? {
            status if status.success() => Ok(()),
            _ => Err(Error::failed()),
        }
    }
}

/// The path of `cellcaster-NAME`, in the folder of this program or on the `PATH`.
fn installed(name: &str) -> Option<PathBuf> {
    let is_name = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-';
    if name.is_empty() || name.starts_with('-') || !name.bytes().all(is_name) {
        return None;
    }
    let file = format!("cellcaster-{name}{}", env::consts::EXE_SUFFIX);
    let own = env::current_exe().ok();
    let beside = own.as_deref().and_then(Path::parent).map(Path::to_owned);
    let path = env::var_os("PATH").unwrap_or_default();
    beside
        .into_iter()
        .chain(env::split_paths(&path))
        .map(|folder| folder.join(&file))
        .find(|it| it.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn external(line: &str) -> String {
        let words: Vec<OsString> = line.split(' ').map(OsString::from).collect();
        External::of(&words).map_or("here".to_owned(), |External { program, arguments }| {
            let arguments: Vec<_> = arguments.iter().map(|word| word.to_str().unwrap()).collect();
            format!("{program}: {}", arguments.join(" "))
        })
    }

    #[test]
    fn unknown_commands_run_other_programs() {
        for (line, expected) in [
            ("c", "here"),
            ("c cellar", "here"),
            ("c maps/cellar.toml", "here"),
            ("c server --listen [::]:2222", "server: --listen [::]:2222"),
            ("c server admin who", "server: admin who"),
            ("c lab accuracy", "lab: accuracy"),
        ] {
            assert_eq!(external(line), expected, "{line}");
        }
    }
}
