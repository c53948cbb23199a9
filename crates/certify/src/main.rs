//! The command `cellcaster-certify`.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use cellcaster::game::{Game, Rules, Script};
use cellcaster::map::{self, builtin};
use cellcaster::render::FrameSize;
use cellcaster::world::{Camera, FieldOfView, Heading, World};
use cellcaster_certify::{Counts, compare, draw};
use clap::Parser;

/// Compare every pixel of recorded games with an independent calculation
///
/// Plays each script and compares a frame of every second of it. Of a map file, compares what the player sees from the
/// start in eight directions. The status is 1 if a pixel is wrong, and 2 if a file cannot be read.
#[derive(Parser)]
#[command(
    version,
    after_long_help = "\
Examples:
  cellcaster-certify maps/scripts/museum.hard.script
  cellcaster-certify --every 600 --size 80x48 maps/scripts/*.script maps/*.toml"
)]
struct Options {
    /// A script of a game, with its level in its header, or a map file
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The number of steps from one compared frame to the next; a second has 60
    #[arg(long, value_name = "STEPS", default_value = "60", value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// The size of a frame in pixels, from 1x1 to 1024x1024
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "160x90", value_parser = size)]
    size: FrameSize,
}

fn size(text: &str) -> Result<FrameSize, &'static str> {
    let side = |text: &str| text.parse().ok().filter(|side| (1..=1024).contains(side));
    text.split_once('x')
        .and_then(|(width, height)| FrameSize::new(side(width)?, side(height)?))
        .ok_or("it takes WIDTHxHEIGHT, each from 1 to 1024, such as 160x90")
}

fn main() -> ExitCode {
    let options = Options::parse();
    let mut total = Counts::default();
    for file in &options.files {
        match of_file(file, &options) {
            Ok(counts) => {
                println!("{}: {counts}", file.display());
                total = total + counts;
            }
            Err(message) => {
                eprintln!("{message}");
                return ExitCode::from(2);
            }
        }
    }
    if options.files.len() > 1 {
        println!("all: {total}");
    }
    if total.wrong > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Compares the frames of a script or of a map, and prints the first wrong pixel of each frame.
fn of_file(file: &Path, options: &Options) -> Result<Counts, String> {
    let mut total = Counts::default();
    let mut add = |world: &World, camera: &Camera, place: String| {
        let frame = draw(world, camera, options.size);
        let (counts, wrong) = compare(world, camera, &frame);
        total = total + counts;
        if let Some(wrong) = wrong {
            println!(
                "{}: {place}: {} wrong, the first at {},{}: {} instead of {}",
                file.display(),
                counts.wrong,
                wrong.x,
                wrong.y,
                wrong.drawn,
                wrong.expected
            );
        }
        _ = io::stdout().flush();
    };
    let field_of_view = FieldOfView::default();
    if file.extension().is_some_and(|it| it == "script") {
        let name = file.display().to_string();
        let content = fs::read(file).map_err(|error| format!("{name}: {error}"))?;
        let script = Script::from_bytes(content, &name).map_err(|faults| faults.to_string())?;
        let rules = script.header().rules();
        let mut game = Game::with_rules(level_of(&script, file)?, rules);
        for (step, (_, intents)) in script.iter().enumerate() {
            game.step(intents);
            if step % options.every as usize == 0 {
                add(game.world(), &game.camera(field_of_view), format!("step {}", step + 1));
            }
        }
    } else {
        let world = map::load(file).map_err(|faults| faults.to_string())?;
        // A game puts the guards into the world.
        let game = Game::with_rules(world, Rules::default());
        let start = game.camera(field_of_view);
        for eighth in 0..8 {
            let turned = Heading::from_degrees(f64::from(eighth) * 45.0 + 11.0);
            let camera = turned
                .and_then(|heading| Camera::new(start.position(), heading, field_of_view))
                .and_then(|camera| camera.with_eye(start.eye()));
            add(game.world(), &camera.unwrap_or(start), format!("direction {eighth}"));
        }
    }
    Ok(total)
}

/// The level that `script` names: a built-in one, or a map file beside it.
fn level_of(script: &Script, file: &Path) -> Result<World, String> {
    let Some(level) = &script.header().level else {
        return Err(format!(
            "{}: the script names no level: add a line such as \"level museum\" at its top",
            file.display()
        ));
    };
    if level.floor().is_some() {
        return Err(format!(
            "{}: floors of a descent cannot be compared: choose the script of a level",
            file.display()
        ));
    }
    let built_in = builtin::LEVELS.iter().find(|it| it.name == level.as_str());
    let world = match built_in {
        Some(level) => level.world(),
        None => map::load(&file.with_file_name(level.as_str())),
    };
    world.map_err(|faults| faults.to_string())
}
