//! Texts about the program: the parts of the help that clap does not write, the manual page, and
//! shell completions.

use std::fmt::Write as _;
use std::io::{self, Write};

use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;

use super::Error;
use super::output_file::print;
use crate::app::Bindings;
use crate::map::builtin::LEVELS;

/// Write completions for a shell
#[derive(Args, Debug)]
#[command(after_long_help = "\
Examples:
  source <(cellcaster completions bash)
  cellcaster completions zsh > ~/.zfunc/_cellcaster
  cellcaster completions fish > ~/.config/fish/completions/cellcaster.fish")]
pub(crate) struct Completions {
    /// The shell
    shell: Shell,
}

/// Write the manual page
#[derive(Args, Debug)]
#[command(
    after_long_help = "Examples:\n  cellcaster man | man -l -\n  cellcaster man > ~/.local/share/man/man1/cellcaster.1"
)]
pub(crate) struct Manual;

impl Completions {
    /// Writes the completion script of `program`.
    pub(crate) fn run(&self, mut program: Command) -> Result<(), Error> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut program, "cellcaster", &mut script);
        print(&script)
    }
}

impl Manual {
    /// Writes the manual page in roff. There is one page for everything, because each separate page
    /// would have to be installed too.
    pub(crate) fn run(program: Command) -> Result<(), Error> {
        let page =
            page(program).map_err(|error| Error::machine(format!("no manual page: {error}")))?;
        print(&page)
    }
}

/// The width of the help in columns, whatever the width of the window.
pub(crate) const WIDTH: usize = 80;

/// The text before the options in the program's help.
pub(crate) fn about() -> String {
    let names: Vec<&str> = LEVELS.iter().map(|level| level.name).collect();
    format!("{ABOUT}{MAP}{}.", names.join(", "))
}

/// The text after the options in the program's help: the examples of `play`, the other commands,
/// and the keys.
pub(crate) fn more(play_examples: &str, commands: &Command) -> String {
    let mut text = format!("{play_examples}\n\n");
    for command in commands.get_subcommands().filter(|command| command.get_name() != "play") {
        let about = command.get_long_about().or(command.get_about()).cloned().unwrap_or_default();
        let examples = command.get_after_long_help().cloned().unwrap_or_default();
        let mut short = command
            .clone()
            .about(about)
            .after_help(examples)
            .disable_help_flag(true)
            .max_term_width(WIDTH)
            .help_template("{about}\n\n{all-args}{after-help}");
        let name = command.get_name();
        _ = writeln!(text, "cellcaster {name}:\n{}\n", short.render_help().to_string().trim_end());
    }
    text.push_str(OTHER_PROGRAMS);
    text.push_str("Keys:\n");
    for (keys, does) in Bindings::default().described() {
        _ = writeln!(text, "  {keys:<24}{does}");
    }
    text.push_str(EXIT_STATUS);
    text
}

const ABOUT: &str = "\
A raycaster game for the terminal, and a renderer for scripts.

You are a thief. Take the treasure that a level asks for, stay out of its guards' sight and hearing, \
and reach the exit, which the map shows as a green square. A level ends with its time, treasure, \
alarms and a rank, and your best results are kept.

Without MAP, the title screen offers saved games, a new game at one of three difficulties, the levels \
with your best results, the daily run, endless games, the maps in this folder, settings and help. With \
MAP, --generate or --endless, the game begins at once, but asks first if that level has a saved game. \
--daily asks before the try that counts.
";

const MAP: &str = "
MAP is a map file, a Tiled map (.tmx or .tmj), \"-\" for standard input, or a built-in level; \
--generate maze, cave or office makes one in its place. An option may also stand before the command. The built-in levels are ";

pub(crate) const WHERE_TO_READ_ON: &str = "\
\"cellcaster --help\" lists all commands with their options, keys and examples; \"cellcaster COMMAND \
--help\" describes one command.";

const OTHER_PROGRAMS: &str = "\
Other programs: cellcaster NAME runs cellcaster-NAME, which is beside this
program or on the PATH.
  cellcaster server       an SSH server in which people play together
  cellcaster lab          measurements: accuracy, bench, wire, load

";

const EXIT_STATUS: &str = "
Exit status: 0 for success; 2 for a mistake in the arguments, a map or a script;
1 for a system error, if replay --verify does not reach an exit, or if compare
finds a difference.";

fn page(program: Command) -> io::Result<Vec<u8>> {
    // The text after the options would repeat other sections of the page.
    let mut program = program.after_help(None).after_long_help(None);
    program.build();
    let subcommands: Vec<_> = program.get_subcommands().cloned().collect();
    let man = Man::new(program);
    let mut page = Vec::new();
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    for subcommand in subcommands {
        render_subcommand(subcommand, &mut page)?;
    }
    Ok(page)
}

/// Writes one section for a command. A separate page would have several.
fn render_subcommand(command: Command, page: &mut Vec<u8>) -> io::Result<()> {
    let name = command.get_name().to_uppercase();
    let man = Man::new(command);
    let mut sections = Vec::new();
    man.render_synopsis_section(&mut sections)?;
    man.render_description_section(&mut sections)?;
    man.render_options_section(&mut sections)?;
    man.render_extra_section(&mut sections)?;
    writeln!(page, ".SH {name}")?;
    page.append(&mut sections);
    Ok(())
}
