//! `cellcaster-server replay`: shows a recorded room in the terminal, or prints its rounds and draws what a member saw.

use std::fmt::{Display, Write as _};
use std::io::{self, ErrorKind, Write as _};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use cellcaster::app::parts::of_steps;
use cellcaster::app::store::private;
use cellcaster::cli::animation::{Frames, TooManyFrames};
use cellcaster::cli::machine::own_settings;
use cellcaster::cli::{Error, ROOM_RECORDING};
use cellcaster::fault::printable_path;
use cellcaster::game::{Game, STEP, STEPS_PER_SECOND};

use super::arguments::Replay;
use crate::rooms::directory::CAST;
use crate::rooms::maps::HostMaps;
use crate::rooms::replayed::{MAX_RECORDED_BYTES, RoomRecord, replayed};
use crate::rooms::room::{Catalog, MemberId, MemberView, Room, RoomView, is_of_other_version};
use crate::sessions::home::watch;
use crate::sessions::session::replayed::ReplayedScreen;

/// Shows the recording. If `options` say so, prints each round with its standings and its checksum instead, and draws
/// the animated PNG.
///
/// # Errors
/// If the file is not a recording of a room, or is damaged or too long, or if the animated PNG cannot be drawn.
pub(crate) fn run(options: &Replay) -> Result<(), Error> {
    let (text, catalog) = read(&options.file, options.maps.as_deref())?;
    if !options.verify && options.png.is_none() {
        let record = RoomRecord::parse(&text, &catalog);
        let record = record.map_err(|fault| cannot(&options.file, &fault))?;
        return Ok(watch(record, catalog, own_settings()?)?);
    }
    let mut animation =
        options.png.as_ref().map(|_| MemberAnimation::new(options, &catalog)).transpose()?;
    let look = &mut |room: &Room| animation.as_mut().map_or(Ok(()), |it| it.look_at(room));
    let rounds = replayed(&text, &catalog, look).map_err(|fault| cannot(&options.file, &fault))?;
    if let Some((animation, path)) = animation.zip(options.png.as_ref()) {
        animation.write(path)?;
    }
    let mut lines = String::new();
    for round in rounds {
        // Writing to a string cannot fail.
        let (mode, level) = (round.mode.title(), catalog.title(&round.level));
        let time = of_steps(round.steps);
        _ = writeln!(lines, "round {}: {mode} in {level}, {time}", round.round);
        for (name, points) in round.standings {
            _ = writeln!(lines, "  {name}  {points}");
        }
        _ = writeln!(lines, "  state {:016x}", round.checksum);
    }
    io::stdout().write_all(lines.as_bytes()).map_err(|error| Error::of_output(&error))
}

/// Passes the game of a recorded room to `look` before each step. `maps` is the map file or the folder of the host's maps.
///
/// # Errors
/// If the file is not a recording of a room, or is damaged or too long, or if a map cannot be read.
pub fn games(file: &Path, maps: Option<&Path>, look: &mut dyn FnMut(&Game)) -> Result<(), Error> {
    let (text, catalog) = read(file, maps)?;
    let rounds = replayed(&text, &catalog, &mut |room| {
        look(room.game());
        Ok(())
    });
    rounds.map(drop).map_err(|fault| cannot(file, &fault))
}

/// The text of a recording, and the levels that its rounds can use.
fn read(file: &Path, maps: Option<&Path>) -> Result<(String, Arc<Catalog>), Error> {
    let text = private::read_text(file, MAX_RECORDED_BYTES);
    let text = text.map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => {
            cannot(file, &format!("it has more than {MAX_RECORDED_BYTES} bytes"))
        }
        _ => cannot(file, &error),
    })?;
    if !text.starts_with(ROOM_RECORDING) {
        return Err(cannot(file, &"it is not a recording of a room"));
    }
    if is_of_other_version(&text) {
        return Err(cannot(file, &other_version(file)));
    }
    let maps = maps.map(HostMaps::read).transpose();
    let maps = maps.map_err(|faults| Error::report_of(&faults))?.unwrap_or_default();
    Ok((text, Arc::new(Catalog::with(&maps))))
}

fn cannot(file: &Path, reason: &dyn Display) -> Error {
    Error::mistake(format!("{} cannot be replayed: {reason}", printable_path(file)))
}

/// The reason why a recording of another version is not replayed, and what shows it nevertheless.
fn other_version(file: &Path) -> String {
    let cast = file.with_extension(CAST);
    let what = "it was recorded by another version of Cellcaster: replay it with that version";
    if cast.is_file() {
        let cast = printable_path(&cast);
        format!("{what}, or watch the room from above with \"asciinema play {cast}\"")
    } else {
        what.to_owned()
    }
}

/// The animated PNG of what one member saw.
struct MemberAnimation<'o> {
    options: &'o Replay,
    catalog: Arc<Catalog>,
    frames: Frames,
    /// The member and their screen, once they are in the room.
    screen: Option<(MemberId, ReplayedScreen)>,
    /// The number of steps up to now.
    steps: u64,
    /// The number of the next frame.
    next: u64,
}

impl<'o> MemberAnimation<'o> {
    fn new(options: &'o Replay, catalog: &Arc<Catalog>) -> Result<Self, Error> {
        let (catalog, frames) = (Arc::clone(catalog), Frames::new(&options.excerpt)?);
        Ok(Self { options, catalog, frames, screen: None, steps: 0, next: 0 })
    }

    /// Draws the frames that are due before the next step of `room`. Frames before the part are drawn, too, because
    /// the map shows what the member has seen.
    fn look_at(&mut self, room: &Room) -> Result<(), String> {
        let frames_per_second = u64::from(self.options.excerpt.frames_per_second.get());
        let due = self.steps * frames_per_second / u64::from(STEPS_PER_SECOND);
        while self.next <= due {
            if !self.frames.end_before(self.next) {
                self.draw(&room.view()).map_err(|error| error.to_string())?;
            }
            self.next += 1;
        }
        self.steps += 1;
        Ok(())
    }

    /// Draws a frame, if the member is in the room.
    fn draw(&mut self, room: &RoomView) -> Result<(), TooManyFrames> {
        let Self { options: Replay { member: name, excerpt, .. }, screen, .. } = self;
        let is_named = |it: &&MemberView| name.as_ref().is_none_or(|name| it.name.as_str() == name);
        if screen.is_none()
            && let Some(member) = room.members.iter().find(is_named)
        {
            let catalog = Arc::clone(&self.catalog);
            let new = ReplayedScreen::new(member.id, member.name.clone(), catalog, excerpt.size);
            *screen = Some((member.id, new));
        }
        match screen {
            Some((id, screen)) if room.member(*id).is_some() => {
                let now = Duration::from_secs_f64(self.steps as f64 * STEP);
                self.frames.push(self.next, screen.draw(room, now))
            }
            _ => Ok(()),
        }
    }

    fn write(&self, path: &Path) -> Result<(), Error> {
        match &self.options.member {
            Some(name) if self.screen.is_none() => Err(Error::mistake(format!(
                "no member called \"{name}\" is in that part of the recording"
            ))),
            _ => self.frames.write(path),
        }
    }
}
