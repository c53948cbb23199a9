//! Text mode: the game in lines of text, for screen readers and for pipes.
//!
//! The player types a command, such as `forward 3`. The game runs until the command is done, and then the
//! program prints what happened and what is near. Rules:
//!
//! - It is the same game, step by step: results count, games are saved, and scripts can be recorded.
//! - Time stands still while the player reads and types.
//! - A command ends early if something threatens: a guard comes into view or takes notice, or the player is hurt.
//! - A line is one sentence. Directions are relative to the player, and distances are in cells.
//! - The menus are the ones of the screen, with numbered entries.
//!
//! Rejected: time that runs on. A screen reader needs seconds for a sentence.

pub(crate) mod sentences;

use std::io::{self, BufRead, Read, Write};

use glam::DVec2;
use sentences::{Observation, StepEvent, Surroundings, sentence};

use crate::app::screen::AppScreen;
use crate::app::settings::Settings;
use crate::app::store::Store;
use crate::app::{App, ClosingLines, InitialState, MapDisplay, Recording};
use crate::game::{FRICTION, Intent, Intents, Look, STEP, STEPS_PER_SECOND};
use crate::world::FieldOfView;

/// Plays from `opening` by the commands in `input`, until the player leaves or the input ends.
///
/// # Errors
/// If the input cannot be read or the output cannot be written.
pub fn play_as_text(
    opening: InitialState,
    settings: Settings,
    store: Store,
    recording: Recording,
    mut input: impl BufRead,
    output: impl Write,
) -> io::Result<ClosingLines> {
    // No text speaks of the map on the screen.
    let settings =
        Settings { minimap: MapDisplay::Off, ..settings.preferring(&store.preferences()) };
    let mut app = App::opened(opening, settings, store);
    app.script = recording.script;
    let mut text = TextMode { app, output, runs: false, ducks: false, said: Vec::new() };
    text.introduce()?;
    while !text.app.has_left {
        // An answer ends with an empty line. A prompt would be one more thing to hear.
        writeln!(text.output)?;
        text.output.flush()?;
        let Some(line) = next_line(&mut input)? else { break };
        text.said.clear();
        text.obey(&line)?;
    }
    let TextMode { mut app, .. } = text;
    _ = app.leave_game();
    let trouble = app.store.trouble().map(str::to_owned);
    Ok(ClosingLines { done: app.left, trouble })
}

/// The maximum length of a line, in bytes. The rest of a longer line is another line.
const MAX_LINE: u64 = 1000;

/// The number of characters of an unknown command that are repeated.
const MAX_QUOTED: usize = 20;

/// The next line without its end; `None` at the end of the input.
fn next_line(input: &mut impl BufRead) -> io::Result<Option<String>> {
    let mut line = Vec::new();
    input.by_ref().take(MAX_LINE).read_until(b'\n', &mut line)?;
    Ok((!line.is_empty()).then(|| String::from_utf8_lossy(&line).trim().to_owned()))
}

/// A command.
#[derive(Clone, Copy, Debug, PartialEq)]
enum TextCommand {
    /// Walks in a direction by a number of cells.
    Walk(Intent),
    /// Turns by a number of degrees, clockwise if it is positive.
    Turn(f64),
    /// Turns towards a direction of the compass, in degrees.
    Face(f64),
    /// Does something once.
    Act(Intent),
    /// Lets a number of seconds pass.
    Wait,
    /// Runs or stops running from now on.
    Run,
    /// Ducks or stands up.
    Duck,
    /// Takes back the last seconds.
    TakeBack,
    Look,
    Status,
    /// Shows the menu.
    Menu,
    Help,
    Leave,
}

/// The commands: their words, and what they do. The help shows the first word.
const COMMANDS: [(&[&str], TextCommand, &str); 25] = [
    (&["forward", "f"], TextCommand::Walk(Intent::Forward), "walk 1 cell, or more: forward 3"),
    (&["back", "b"], TextCommand::Walk(Intent::Back), "walk backwards"),
    (
        &["sideleft", "sl"],
        TextCommand::Walk(Intent::StrafeLeft),
        "step to the left without turning",
    ),
    (
        &["sideright", "sr"],
        TextCommand::Walk(Intent::StrafeRight),
        "step to the right without turning",
    ),
    (
        &["left", "l"],
        TextCommand::Turn(-90.0),
        "turn left by 90 degrees, or by another angle: left 45",
    ),
    (&["right", "r"], TextCommand::Turn(90.0), "turn right"),
    (&["around", "u"], TextCommand::Turn(180.0), "turn around"),
    (&["east"], TextCommand::Face(0.0), "turn to the east"),
    (&["south"], TextCommand::Face(90.0), "turn to the south"),
    (&["west"], TextCommand::Face(180.0), "turn to the west"),
    (&["north"], TextCommand::Face(270.0), "turn to the north"),
    (
        &["open", "o", "use"],
        TextCommand::Act(Intent::Open),
        "open the door ahead, turn a lever, search a wall",
    ),
    (&["jump", "j"], TextCommand::Act(Intent::Jump), "jump"),
    (&["run"], TextCommand::Run, "run or walk from now on"),
    (&["duck", "d"], TextCommand::Duck, "duck or stand up"),
    (&["strike", "k"], TextCommand::Act(Intent::Strike), "strike a guard within reach"),
    (&["throw", "t"], TextCommand::Act(Intent::Throw), "throw a pebble ahead"),
    (&["shoot"], TextCommand::Act(Intent::Shoot), "shoot a dart ahead"),
    (&["smoke"], TextCommand::Act(Intent::Smoke), "throw a flask of smoke"),
    (&["lamp"], TextCommand::Act(Intent::Lamp), "light the lamp, or put it out"),
    (&["wait", "w"], TextCommand::Wait, "wait 1 second, or longer: wait 5"),
    (
        &["takeback"],
        TextCommand::TakeBack,
        "take back the last 10 seconds, as the difficulty allows",
    ),
    (&["look", ""], TextCommand::Look, "describe what is near; an empty line does the same"),
    (&["status", "s"], TextCommand::Status, "report your health, tools and time"),
    (&["menu", "m"], TextCommand::Menu, "open the menu: settings, restart, leave"),
];
/// The commands that work everywhere.
const ANYWHERE: [(&[&str], TextCommand, &str); 2] = [
    (&["help", "h", "?"], TextCommand::Help, "list the commands"),
    (&["quit", "q"], TextCommand::Leave, "leave"),
];

/// The largest numbers of cells, degrees and seconds in a command.
const MAX_CELLS: f64 = 100.0;
const MAX_DEGREES: f64 = 360.0;
const MAX_SECONDS: f64 = 60.0;
/// The number of steps without progress after which the player counts as stopped by an obstacle.
const STUCK_STEPS: u32 = 12;
/// The number of steps for which an action may show its effect.
const ACTION_STEPS: u32 = STEPS_PER_SECOND / 2;

struct TextMode<W> {
    app: App,
    output: W,
    runs: bool,
    ducks: bool,
    /// The events of the command. A sound that goes on is said once.
    said: Vec<String>,
}

impl<W: Write> TextMode<W> {
    /// Prints the level and the surroundings, or the menu if one is shown.
    fn introduce(&mut self) -> io::Result<()> {
        if self.app.screen() != AppScreen::Playing {
            return self.print_menu();
        }
        let title = self.app.game.title().to_owned();
        let goal = self.app.goal.text.clone();
        writeln!(self.output, "{title}, {}.", self.app.difficulty.name())?;
        writeln!(self.output, "{}", sentence(&goal))?;
        if self.app.game.grid().is_none() {
            writeln!(self.output, "A scene of bodies has no description in text.")?;
        }
        self.look()
    }

    /// Carries out a line that the player typed.
    fn obey(&mut self, line: &str) -> io::Result<()> {
        let mut words = line.split_whitespace();
        let word = words.next().unwrap_or_default().to_lowercase();
        let number = words.next();
        let plays = self.app.screen() == AppScreen::Playing;
        let commands = if plays { &COMMANDS[..] } else { &[] };
        let known = ANYWHERE.iter().chain(commands).find(|(words, ..)| words.contains(&&*word));
        match known {
            Some((_, TextCommand::Leave, _)) => {
                self.app.leave();
                Ok(())
            }
            Some((_, TextCommand::Help, _)) => self.print_help(),
            Some(&(_, command, _)) => self.carry_out(command, number),
            None if plays => {
                let word: String =
                    word.chars().take(MAX_QUOTED).filter(|it| !it.is_control()).collect();
                writeln!(self.output, "\"{word}\" is not a command. Type help for a list.")
            }
            None => self.choose(&word),
        }
    }

    fn print_help(&mut self) -> io::Result<()> {
        if self.app.screen() != AppScreen::Playing {
            writeln!(self.output, "Type the number of an entry, back or quit.")?;
            return self.print_menu();
        }
        for (words, _, about) in COMMANDS.iter().chain(&ANYWHERE) {
            let short = words.get(1).filter(|word| !word.is_empty());
            let short = short.map_or_else(String::new, |word| format!(" or {word}"));
            writeln!(self.output, "{}{short}: {about}.", words[0])?;
        }
        Ok(())
    }

    /// Chooses the menu entry with this number, or goes back. An empty line repeats the menu.
    fn choose(&mut self, word: &str) -> io::Result<()> {
        match word {
            "" => return self.print_menu(),
            "back" | "b" if !self.app.shows_result() && self.app.screen() != AppScreen::Title => {
                self.app.close();
                return self.introduce();
            }
            _ => {}
        }
        let entries = self.app.pages.menu.lines_of_entries().count();
        let number = word.parse().ok().filter(|number| (1..=entries).contains(number));
        let Some(number) = number else {
            return writeln!(self.output, "Type a number from 1 to {entries}.");
        };
        self.app.pages.menu.select(number - 1);
        self.app.choose();
        if self.app.has_left {
            return Ok(());
        }
        self.introduce()
    }

    /// Prints the menu, or returns to the screen before if there is none.
    fn print_menu(&mut self) -> io::Result<()> {
        if self.app.screen() == AppScreen::Help {
            self.app.close();
            return self.print_help();
        }
        let menu = &self.app.pages.menu;
        // The text above the settings is about keys and about what one sees.
        let lines = if self.app.screen() == AppScreen::Settings { 1 } else { usize::MAX };
        for line in menu.heading().take(lines) {
            writeln!(self.output, "{}", sentence(line))?;
        }
        for (number, line) in (1..).zip(menu.lines_of_entries()) {
            writeln!(self.output, "{number}. {}", sentence(&line))?;
        }
        Ok(())
    }

    fn carry_out(&mut self, command: TextCommand, number: Option<&str>) -> io::Result<()> {
        let (usual, most) = match command {
            TextCommand::Walk(_) => (1.0, MAX_CELLS),
            TextCommand::Turn(degrees) => (degrees.abs(), MAX_DEGREES),
            TextCommand::Wait => (1.0, MAX_SECONDS),
            _ => (1.0, 1.0),
        };
        let amount = number.map_or(Some(usual), |number| number.parse().ok());
        let Some(amount) = amount.filter(|amount| (0.0..=most).contains(amount)) else {
            return writeln!(self.output, "The number may be from 0 to {most}.");
        };
        match command {
            TextCommand::Walk(way) => self.walk(way, amount),
            TextCommand::Turn(degrees) => self.turn(amount.copysign(degrees)),
            TextCommand::Face(heading) => {
                let from = self.heading();
                self.turn((heading - from + 180.0).rem_euclid(360.0) - 180.0)
            }
            TextCommand::Act(intent) => self.pass(&[intent], 1, ACTION_STEPS),
            TextCommand::Wait => self.pass(&[], (amount / STEP) as u32, 0),
            TextCommand::Run => {
                self.runs = !self.runs;
                writeln!(self.output, "{}", if self.runs { "You run." } else { "You walk." })
            }
            TextCommand::Duck => {
                self.ducks = !self.ducks;
                writeln!(
                    self.output,
                    "{}",
                    if self.ducks { "You duck." } else { "You stand up." }
                )?;
                self.pass(&[], ACTION_STEPS, 0)
            }
            TextCommand::TakeBack => {
                self.app.take_back();
                self.introduce()
            }
            TextCommand::Look => self.look(),
            TextCommand::Status => {
                let Some(game) = self.app.game.grid() else { return Ok(()) };
                for sentence in sentences::status(game) {
                    writeln!(self.output, "{sentence}")?;
                }
                Ok(())
            }
            TextCommand::Menu => {
                self.app.open(AppScreen::Paused);
                self.print_menu()
            }
            TextCommand::Help | TextCommand::Leave => Ok(()),
        }
    }

    fn heading(&self) -> f64 {
        let game = self.app.game.grid();
        game.map_or(0.0, |game| game.camera(FieldOfView::default()).heading.degrees())
    }

    /// Prints the surroundings.
    fn look(&mut self) -> io::Result<()> {
        let Some(game) = self.app.game.grid() else { return Ok(()) };
        for sentence in Surroundings::of(game).sentences() {
            writeln!(self.output, "{sentence}")?;
        }
        Ok(())
    }

    /// Turns at once, as a pointer does.
    fn turn(&mut self, degrees: f64) -> io::Result<()> {
        let turn = (degrees * f64::from(Look::PER_DEGREE)).round();
        let half = (turn / 2.0).trunc();
        // Two halves, because a full turn exceeds the range of one.
        for turn in [half, turn - half] {
            let look = Look { turn: turn as i16, tilt: 0 };
            self.step(self.held(&[]).with_look(look))?;
        }
        self.look()
    }

    /// Walks until the player has covered `cells` or something stops them.
    fn walk(&mut self, way: Intent, cells: f64) -> io::Result<()> {
        let (Some(start), mut stuck) = (self.position(), 0) else { return Ok(()) };
        let mut before = start;
        let (mut covered, mut is_disturbed) = (0.0, false);
        while stuck < STUCK_STEPS && !is_disturbed {
            is_disturbed = self.step(self.held(&[way]))?;
            let Some(now) = self.position() else { break };
            let speed = now.distance(before) / STEP;
            before = now;
            covered = now.distance(start);
            stuck = if speed < 0.1 { stuck + 1 } else { 0 };
            // Friction alone covers the rest.
            if covered + speed / FRICTION >= cells {
                break;
            }
        }
        for _ in 0..ACTION_STEPS {
            if is_disturbed || self.app.screen() != AppScreen::Playing {
                break;
            }
            is_disturbed = self.step(self.held(&[]))?;
        }
        if self.app.screen() != AppScreen::Playing {
            return self.print_menu();
        }
        if stuck >= STUCK_STEPS {
            writeln!(self.output, "Something is in the way after {covered:.1} cells.")?;
        }
        self.look()
    }

    /// Plays `steps` steps with these intents and `more` steps without them, unless something disturbs.
    fn pass(&mut self, intents: &[Intent], steps: u32, more: u32) -> io::Result<()> {
        for step in 0..steps + more {
            let wanted = if step < steps { intents } else { &[] };
            let is_disturbed = self.step(self.held(wanted))?;
            if self.app.screen() != AppScreen::Playing {
                return self.print_menu();
            }
            if is_disturbed {
                break;
            }
        }
        self.look()
    }

    /// The intents of a step, with the lasting ones.
    fn held(&self, intents: &[Intent]) -> Intents {
        let lasting = [(self.runs, Intent::Run), (self.ducks, Intent::Duck)];
        let lasting = lasting.into_iter().filter(|(lasts, _)| *lasts).map(|(_, intent)| intent);
        intents.iter().copied().chain(lasting).collect()
    }

    fn position(&self) -> Option<DVec2> {
        let game = self.app.game.grid().filter(|_| self.app.screen() == AppScreen::Playing)?;
        Some(game.camera(FieldOfView::default()).position())
    }

    /// Plays a step, and prints what happens in it. Returns whether it should end a command.
    fn step(&mut self, intents: Intents) -> io::Result<bool> {
        let before = self.app.game.grid().map(Observation::of);
        self.app.game.step(intents);
        self.app.stepped(intents, 1);
        let after = self.app.game.grid().map(Observation::of);
        let (Some(before), Some(after)) = (before, after) else { return Ok(false) };
        let events = after.events_since(&before);
        let threatens = events.iter().any(|event| event.threatens);
        for StepEvent { sentence, .. } in events {
            if !self.said.contains(&sentence) {
                writeln!(self.output, "{sentence}")?;
                self.said.push(sentence);
            }
        }
        Ok(threatens)
    }
}
