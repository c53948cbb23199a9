//! Scripts played off screen: a recording shows the frames of the game.
#![cfg(feature = "cli")]

use std::fs::{self, File};
use std::io::BufReader;
use std::num::{NonZeroU16, NonZeroU32};
use std::path::Path;

use crate::asciicast::Asciicast;
use crate::looks::{Look, looks};
use crate::support::{complaint_about, output_of};
use cellcaster::app::{Levels, Replay, Settings};
use cellcaster::color::Rgb;
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::Script;
use cellcaster::map::builtin;
use cellcaster::terminal::CellWriter;
use cellcaster::tui::rgb_of;
use ratatui::backend::Backend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Size;
use vt100::Parser;

const SCRIPT: &str =
    "0.5 s stand\n[out]\n7 steps forward\n1 s forward turn-right run\n20 steps open\n";
const SIZE: Size = Size { width: 60, height: 20 };
const FRAMES_PER_SECOND: NonZeroU32 = NonZeroU32::new(20).unwrap();

fn file(name: &str, text: &str) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

fn terminal() -> Parser {
    let length = |cells| NonZeroU16::new(cells).unwrap();
    Parser::new(length(SIZE.height), length(SIZE.width), 0)
}

/// The cells of a terminal that has received the whole `picture`.
fn drawn(picture: &Buffer) -> Vec<Look> {
    let mut bytes = Vec::new();
    let mut writer = CellWriter::new(&mut bytes, SIZE);
    writer.draw(Buffer::empty(SIZE.into()).diff(picture).into_iter()).unwrap();
    Backend::flush(&mut writer).unwrap();
    let mut terminal = terminal();
    terminal.process(&bytes);
    looks(terminal.screen())
}

#[test]
fn a_recording_shows_every_frame_of_the_game_at_its_time() {
    let script = file("frames.script", SCRIPT);
    let words = ["share", &script, "museum", "--size", "60x20", "--fps", "20", "--format", "cast"];
    let file = output_of(&words);
    let recording = Asciicast::read(&String::from_utf8(file).unwrap());
    assert_eq!((recording.columns, recording.rows), (60, 20));
    let mut terminal = terminal();
    let mut events = recording.events.iter().peekable();
    // The sequence for the alternate screen has the same time as the first frame.
    terminal.process(events.next().unwrap().data.as_bytes());

    let levels = Levels::new(builtin::LEVELS[1].world().unwrap().into(), std::iter::empty());
    let levels = levels.numbered(2, builtin::LEVELS.len());
    let mut replay = Replay::new(levels, Settings::default(), SIZE);
    let mut last = 0;
    let shown = replay.play(
        &Script::parse(SCRIPT, "it").unwrap(),
        FRAMES_PER_SECOND,
        |frame, _, picture| {
            while let Some(event) = events.next_if(|event| event.time <= frame * 50) {
                if event.data.contains("\x1b[?1049l") {
                    break;
                }
                terminal.process(event.data.as_bytes());
            }
            last = frame;
            if looks(terminal.screen()) == drawn(picture) { Ok(()) } else { Err(frame) }
        },
    );
    assert_eq!(shown, Ok(()));
    assert_eq!(last, 39);
    assert!(events.next().is_none());
}

#[test]
fn the_same_script_makes_the_same_recording() {
    let script = file("same.script", SCRIPT);
    let cast = file("same.cast", "");
    let written = output_of(&["share", &script, "--format", "cast"]);
    let said = output_of(&["share", &script, "cellar", "--output", &cast]);
    assert!(fs::read(&cast).unwrap() == written && !written.is_empty());
    let size = written.len().div_ceil(1000);
    let expected = format!("{cast}: {size} kB, 2 s, 80×24 cells, 15 frames a second\n");
    assert_eq!(String::from_utf8(said).unwrap(), expected);
}

/// A decoded frame: its length in frames of the replay, and the whole picture after it, in RGB.
struct Shown {
    length: u16,
    pixels: Vec<[u8; 3]>,
}

/// The width of an animated PNG, and its frames.
fn decoded(path: &str) -> (usize, Vec<Shown>) {
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let count = reader.info().animation_control().unwrap().num_frames;
    let (mut pixels, mut part) = (vec![[0; 3]; width * height], vec![0; 3 * width * height]);
    let frames = (0..count).map(|_| {
        reader.next_frame(&mut part).unwrap();
        let control = reader.info().frame_control().unwrap();
        let (x, y) = (control.x_offset as usize, control.y_offset as usize);
        let rows = part.as_chunks().0.chunks_exact(control.width as usize);
        for (y, row) in (y..).zip(rows).take(control.height as usize) {
            pixels[y * width + x..][..row.len()].copy_from_slice(row);
        }
        assert_eq!(u32::from(control.delay_den), FRAMES_PER_SECOND.get());
        Shown { length: control.delay_num, pixels: pixels.clone() }
    });
    (width, frames.collect())
}

/// The colours of the halves of a cell; `None` for a cell with another glyph.
fn halves(cell: &Cell) -> Option<[Rgb; 2]> {
    let [above, below] = match cell.symbol() {
        " " => [cell.bg, cell.bg],
        "▀" => [cell.fg, cell.bg],
        "▄" => [cell.bg, cell.fg],
        _ => return None,
    };
    Some([rgb_of(above)?, rgb_of(below)?])
}

#[test]
fn an_animated_png_shows_every_frame_of_the_game_for_its_time() {
    let (script, path) = (file("animated.script", SCRIPT), file("animated.png", ""));
    let draw = |more: &[&str]| {
        let words = ["share", &script, "museum", "--size", "60x20", "--fps", "20"];
        // With few colours, the palette is exact.
        let words = [&words[..], &["--colors", "16", "--output", &path], more].concat();
        let said = String::from_utf8(output_of(&words)).unwrap();
        assert!(said.ends_with(" s, 60×20 cells, 20 frames a second\n"), "{said}");
        fs::read(&path).unwrap()
    };
    let drawn = draw(&[]);
    let (width, frames) = decoded(&path);
    assert!(draw(&[]) == drawn, "another run draws another file");

    let levels = Levels::new(builtin::LEVELS[1].world().unwrap().into(), std::iter::empty());
    let levels = levels.numbered(2, builtin::LEVELS.len());
    let settings = Settings { depth: Some(ColorDepth::Indexed16), ..Settings::default() };
    let mut pictures: Vec<(u16, Buffer)> = Vec::new();
    let script = Script::parse(SCRIPT, "it").unwrap();
    let mut replay = Replay::new(levels, settings, SIZE);
    let played = replay.play(&script, FRAMES_PER_SECOND, |_, _, picture| {
        match pictures.last_mut().filter(|(_, last)| last == picture) {
            Some((length, _)) => *length += 1,
            None => pictures.push((1, picture.clone())),
        }
        Ok::<_, ()>(())
    });
    assert_eq!(played, Ok(()));
    let lengths = |frames: &[Shown]| frames.iter().map(|it| it.length).collect::<Vec<_>>();
    assert!(lengths(&frames).into_iter().eq(pictures.iter().map(|it| it.0)));
    assert!((10..40).contains(&frames.len()), "some of the 40 frames are equal");
    assert_eq!((width, frames[0].pixels.len()), (8 * 60, 8 * 60 * 16 * 20));
    let mut compared = 0;
    for (frame, (_, picture)) in frames.iter().zip(&pictures) {
        for position in picture.area.positions() {
            let corner = usize::from(position.y) * 16 * width + usize::from(position.x) * 8;
            let pixels = [0, 8].map(|y| frame.pixels[corner + y * width]);
            if let Some(halves) = halves(&picture[position]) {
                assert_eq!(pixels, halves.map(Rgb::channels), "{position}");
                compared += 1;
            }
        }
    }
    assert!(compared > 1000, "{compared}");

    draw(&["--from", "0.5", "--to", "0:01.5"]);
    assert_eq!(lengths(&decoded(&path).1).iter().sum::<u16>(), 20);
}

/// The width of a GIF, and its frames. Their lengths are in hundredths of a second.
fn decoded_gif(path: &str) -> (usize, Vec<Shown>) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(File::open(path).unwrap()).unwrap();
    let (width, height) = (usize::from(decoder.width()), usize::from(decoder.height()));
    let (mut pixels, mut frames) = (vec![[0; 3]; width * height], Vec::new());
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        let rows = frame.buffer.as_chunks::<4>().0.chunks_exact(frame.width.into());
        for (y, row) in (usize::from(frame.top)..).zip(rows) {
            let place = &mut pixels[y * width + usize::from(frame.left)..][..row.len()];
            for (pixel, &[red, green, blue, opacity]) in place.iter_mut().zip(row) {
                *pixel = if opacity == 0 { *pixel } else { [red, green, blue] };
            }
        }
        frames.push(Shown { length: frame.delay, pixels: pixels.clone() });
    }
    assert_eq!(decoder.repeat(), gif::Repeat::Infinite);
    (width, frames)
}

#[test]
fn a_gif_shows_the_pictures_of_the_animated_png_at_their_times() {
    let script = file("gif.script", SCRIPT);
    let [png, gif] = ["same.png", "same.gif"].map(|name| file(name, ""));
    for path in [&png, &gif] {
        output_of(&[
            "share", &script, "museum", "--size", "60x20", "--fps", "20", "--colors", "16", "-o",
            path,
        ]);
    }
    let (png, gif) = (decoded(&png), decoded_gif(&gif));
    assert_eq!((png.0, png.1.len()), (gif.0, gif.1.len()));
    for (png, gif) in png.1.iter().zip(&gif.1) {
        assert_eq!(u32::from(png.length) * 100 / FRAMES_PER_SECOND.get(), u32::from(gif.length));
        assert!(png.pixels == gif.pixels);
    }
}

/// The width of an SVG, and its frames: the pictures at their beginnings, without their lengths.
fn decoded_svg(path: &str) -> (usize, Vec<Vec<[u8; 3]>>) {
    let text = fs::read_to_string(path).unwrap();
    let between = |text: &str, from: &str, to: &str| {
        let rest = text.split_once(from).unwrap().1;
        rest.split_once(to).unwrap().0.to_owned()
    };
    let side =
        |name: &str| -> usize { between(&text, &format!(" {name}=\""), "\"").parse().unwrap() };
    let (width, height) = (side("width"), side("height"));
    let (mut pixels, mut frames) = (vec![[0; 3]; width * height], Vec::new());
    let mut begun = -1.0;
    for group in text.split("<g>").skip(1) {
        let times = between(group, "keyTimes=\"", "\"");
        let times: Vec<f64> = times.split(';').map(|time| time.parse().unwrap()).collect();
        let values = between(group, "values=\"", "\"");
        let from = times[values.split(';').position(|value| value == "inline").unwrap()];
        assert!(from > begun, "a frame appears after the one before");
        begun = from;
        for path in group.split("<path ").skip(1) {
            let color = u32::from_str_radix(&between(path, "fill=\"#", "\""), 16).unwrap();
            let [_, color @ ..] = color.to_be_bytes();
            for rectangle in between(path, "d=\"", "\"").split('M').skip(1) {
                let numbers = rectangle.split([' ', 'h', 'v', 'z']).take(4);
                let numbers: Vec<usize> = numbers.map(|it| it.parse().unwrap()).collect();
                for y in numbers[1]..numbers[1] + numbers[3] {
                    pixels[y * width..][numbers[0]..][..numbers[2]].fill(color);
                }
            }
        }
        frames.push(pixels.clone());
    }
    (width, frames)
}

#[test]
fn an_svg_shows_the_pictures_of_the_animated_png() {
    let script = file("svg.script", SCRIPT);
    let [png, svg] = ["as_png.png", "as_svg.svg"].map(|name| file(name, ""));
    for path in [&png, &svg] {
        output_of(&[
            "share", &script, "museum", "--size", "60x20", "--fps", "20", "--colors", "16", "-o",
            path,
        ]);
    }
    let (png, svg) = (decoded(&png), decoded_svg(&svg));
    assert_eq!((png.0, png.1.len()), (svg.0, svg.1.len()));
    assert!(png.1.iter().zip(&svg.1).all(|(png, svg)| png.pixels == *svg));
}

#[test]
fn mistakes_are_reported() {
    let bad = file("bad.script", "[x]\n1 s foward\n");
    let turns = file("turns.script", "1 s turn-left\n");
    let long = file("long.script", &"3600 s stand\n".repeat(25));
    let complaints = [
        complaint_about(&["replay"]),
        complaint_about(&["replay", "absent.script"]),
        complaint_about(&["replay", &bad]),
        complaint_about(&["replay", &turns]),
        complaint_about(&["replay", &long]),
        complaint_about(&["share"]),
        complaint_about(&["share", &turns]),
        complaint_about(&["share", &turns, "--output", "x.webm"]),
        complaint_about(&["share", &bad, "--output", "x.png"]),
        complaint_about(&["share", &bad, "--size", "0x3"]),
        complaint_about(&["share", &bad, "--size", "1000x1000"]),
        complaint_about(&["share", &bad, "--from", "1:2:3"]),
        complaint_about(&["share", &turns, "--output", "x.png", "--from", "2", "--to", "1"]),
        complaint_about(&["share", &turns, "--output", "x.gif", "--fps", "60"]),
        complaint_about(&["share", &turns, "--output", "x.png", "--from", "9", "--to", "10"]),
        complaint_about(&["share", &turns, "--output", "x.cast", "--from", "9"]),
        complaint_about(&["share", &turns, "--output", "x.png", "--size", "1000x200"]),
        complaint_about(&["share", &long, "--output", "x.cast"]),
        complaint_about(&["share", "maps/together.log", "--output", "x.png"]),
    ];
    assert!(["x.png", "x.gif", "x.cast", "x.webm"].iter().all(|it| !Path::new(it).exists()));
    let folder = format!("{}/", env!("CARGO_TARGET_TMPDIR"));
    insta::assert_snapshot!(complaints.join("\n").replace(&folder, ""));
}
