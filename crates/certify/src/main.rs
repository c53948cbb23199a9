//! The command `cellcaster-certify`.

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use cellcaster::game::{Game, Script};
use cellcaster::map::{self, builtin};
use cellcaster::render::FrameSize;
use cellcaster::world::{Camera, FieldOfView, Heading, World};
use cellcaster_certify::{Counts, compare, draw};
use clap::Parser;

/// Compare every pixel of recorded games with an independent calculation
///
/// Plays each script and each recording of a room, and compares a frame of every second and player. Of a map file,
/// compares what the player sees from the start in eight directions. A frame has 80x48 pixels. The status is 1 if a pixel
/// is wrong, and 2 if a file cannot be read.
#[derive(Parser)]
#[command(
    version = cellcaster::VERSION,
    after_long_help = "\
Examples:
  cellcaster-certify maps/scripts/museum.hard.script
  cellcaster-certify --maps /var/lib/cellcaster/maps room-7.log
  cellcaster-certify --every 600 maps/scripts/*.script maps/*.toml"
)]
struct Options {
    /// A script of a game, with its level in its header; the log of a room; or a map file
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The number of steps from one compared frame to the next; a second has 60
    #[arg(long, value_name = "STEPS", default_value = "60", value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// The map file or the folder of maps, if rooms used the host's own maps
    #[cfg(feature = "rooms")]
    #[arg(long, value_name = "PATH")]
    maps: Option<PathBuf>,
}

fn main() -> ExitCode {
    let options = Options::parse();
    let mut total = Counts::default();
    for file in &options.files {
        match of_file(&options, file) {
            Ok(counts) => {
                println!("{}: {counts}", file.display());
                total += counts;
            }
            Err(error) => {
                eprintln!("{error}");
                return ExitCode::from(2);
            }
        }
    }
    println!("all: {total}");
    if total.wrong > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Compares the frames of a script, of a room's log or of a map, and prints the first wrong pixel of each frame.
fn of_file(options: &Options, file: &Path) -> Result<Counts, Box<dyn Error>> {
    let (name, field_of_view) = (file.display().to_string(), FieldOfView::default());
    let size = FrameSize::new(80, 48).ok_or("a frame has pixels")?;
    let mut total = Counts::default();
    let mut add = |world: &World, camera: &Camera| {
        let (counts, wrong) = compare(world, camera, &draw(world, camera, size));
        if let Some(wrong) = wrong {
            println!("{name}: frame {}: {} wrong, such as {wrong}", total.frames, counts.wrong);
        }
        total += counts;
    };
    let mut steps = 0;
    let mut look = |game: &Game| {
        if steps % options.every == 0 {
            let views = game.players().filter_map(|player| game.seen_by(player));
            views.for_each(|view| add(game.world(), &view.camera(field_of_view)));
        }
        steps += 1;
    };
    match file.extension().and_then(OsStr::to_str) {
        Some("script") => {
            let content = fs::read(file).map_err(|error| format!("{name}: {error}"))?;
            let script = Script::from_bytes(content, &name)?;
            let mut game = Game::with_rules(level_of(&script, file)?, script.header().rules());
            for (_, intents) in script.iter() {
                look(&game);
                game.step(intents);
            }
        }
        #[cfg(feature = "rooms")]
        Some("log") => cellcaster_server::cli::games(file, options.maps.as_deref(), &mut look)?,
        _ => {
            // A game puts the guards into the world.
            let game = Game::new(map::load(file)?);
            let mut camera = game.camera(field_of_view);
            for degrees in (11..360).step_by(45) {
                camera.heading = Heading::from_degrees(degrees.into()).unwrap_or_default();
                add(game.world(), &camera);
            }
        }
    }
    Ok(total)
}

/// The level that `script` names: a built-in one, or a map file beside it.
fn level_of(script: &Script, file: &Path) -> Result<World, Box<dyn Error>> {
    let level = script.header().level.as_ref().filter(|level| level.floor().is_none());
    let missing = "a script names its level in a line at its top, such as \"level museum\"";
    let level = level.ok_or_else(|| format!("{}: {missing}", file.display()))?;
    Ok(match builtin::LEVELS.iter().find(|it| it.name == level.as_str()) {
        Some(level) => level.world()?,
        None => map::load(&file.with_file_name(level.as_str()))?,
    })
}
