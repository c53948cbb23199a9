//! The command `cellcaster-certify`.

use std::error::Error;
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
/// Plays each script and compares a frame of every second of it. Of a map file, compares what the player sees from the
/// start in eight directions. A frame has 80x48 pixels. The status is 1 if a pixel is wrong, and 2 if a file cannot be
/// read.
#[derive(Parser)]
#[command(
    version = cellcaster::VERSION,
    after_long_help = "\
Examples:
  cellcaster-certify maps/scripts/museum.hard.script
  cellcaster-certify --every 600 maps/scripts/*.script maps/*.toml"
)]
struct Options {
    /// A script of a game, with its level in its header, or a map file
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The number of steps from one compared frame to the next; a second has 60
    #[arg(long, value_name = "STEPS", default_value = "60", value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
}

fn main() -> ExitCode {
    let options = Options::parse();
    let mut total = Counts::default();
    for file in &options.files {
        match of_file(file, options.every as usize) {
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

/// Compares the frames of a script or of a map, and prints the first wrong pixel of each frame.
fn of_file(file: &Path, every: usize) -> Result<Counts, Box<dyn Error>> {
    let (name, field_of_view) = (file.display().to_string(), FieldOfView::default());
    let size = FrameSize::new(80, 48).ok_or("a frame has pixels")?;
    let mut total = Counts::default();
    let mut add = |world: &World, camera: &Camera, place: usize| {
        let (counts, wrong) = compare(world, camera, &draw(world, camera, size));
        total += counts;
        if let Some(wrong) = wrong {
            println!("{name}: frame {place}: {} wrong, such as {wrong}", counts.wrong);
        }
    };
    if file.extension().is_some_and(|it| it == "script") {
        let content = fs::read(file).map_err(|error| format!("{name}: {error}"))?;
        let script = Script::from_bytes(content, &name)?;
        let mut game = Game::with_rules(level_of(&script, file)?, script.header().rules());
        for (step, (_, intents)) in script.iter().enumerate() {
            game.step(intents);
            if step % every == 0 {
                add(game.world(), &game.camera(field_of_view), step / every);
            }
        }
    } else {
        // A game puts the guards into the world.
        let game = Game::new(map::load(file)?);
        for eighth in 0..8_u32 {
            let heading = Heading::from_degrees(f64::from(eighth) * 45.0 + 11.0);
            let mut camera = game.camera(field_of_view);
            camera.heading = heading.unwrap_or_default();
            add(game.world(), &camera, eighth as usize);
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
