//! The subcommands about the command itself: `completions`, `man` and `help`.

use clap::{ArgAction, ArgMatches, ValueHint};
use clap_complete::Shell;

use super::{Command, Error, Positional, Subcommand, description, mistake};

pub(crate) const COMPLETIONS: Subcommand = Subcommand {
    name: "completions",
    about: "Write completions for a shell",
    details: "",
    examples: "source <(cellcaster completions bash)\n\
               cellcaster completions zsh > ~/.zfunc/_cellcaster\n\
               cellcaster completions fish > ~/.config/fish/completions/cellcaster.fish",
    positionals: &[SHELL],
    options: &[],
    surplus: "takes one shell",
    missing: "completions takes bash, zsh or fish, as in \"cellcaster completions bash\"",
    read: |matches| Ok(Command::Completions(shell(matches))),
};

pub(crate) const MAN: Subcommand = Subcommand {
    name: "man",
    about: "Write the manual page",
    details: "",
    examples: "cellcaster man | man -l -\n\
               cellcaster man > ~/.local/share/man/man1/cellcaster.1",
    positionals: &[],
    options: &[],
    surplus: "takes no map",
    missing: "",
    read: |_| Ok(Command::Manual),
};

pub(crate) const HELP: Subcommand = Subcommand {
    name: "help",
    about: "Explain the program, or a command",
    details: "",
    examples: "cellcaster help snapshot",
    positionals: &[COMMAND],
    options: &[],
    surplus: "takes one command",
    missing: "",
    read: help,
};

const SHELL: Positional = Positional {
    name: "SHELL",
    help: "The shell",
    is_required: true,
    action: ArgAction::Set,
    hint: ValueHint::Other,
    choices: &["bash", "zsh", "fish"],
};

const COMMAND: Positional = Positional {
    name: "COMMAND",
    help: "The command",
    is_required: false,
    action: ArgAction::Set,
    hint: ValueHint::Other,
    choices: &[],
};

fn shell(mut matches: ArgMatches) -> Shell {
    let shell = SHELL.of(&mut matches).unwrap_or_default();
    // clap has refused other values.
    shell.to_str().and_then(|name| name.parse().ok()).unwrap_or(Shell::Bash)
}

fn help(mut matches: ArgMatches) -> Result<Command, Error> {
    let mut program = description();
    program.build();
    let text = match COMMAND.of(&mut matches) {
        None => program.render_long_help(),
        Some(name) => {
            let command = name.to_str().and_then(|name| program.find_subcommand_mut(name));
            let no_command = || mistake::no_command(&name.to_string_lossy());
            command.ok_or_else(no_command)?.render_long_help()
        }
    };
    Ok(Command::Text(text.to_string()))
}
