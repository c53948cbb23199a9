//! The load that the program puts on the machine and the link.

use std::thread;
use std::time::{Duration, Instant};

use super::game::{Game, Key};
use crate::emulator::Speaks;

const BEGIN: &[u8] = b"\x1b[?2026h";
const END: &[u8] = b"\x1b[?2026l";

fn count(bytes: &[u8], wanted: &[u8]) -> usize {
    bytes.windows(wanted.len()).filter(|window| *window == wanted).count()
}

#[test]
fn while_nothing_moves_nothing_is_written_and_the_processor_rests() {
    const REST: Duration = Duration::from_secs(1);
    let game = Game::start();
    let assert_rests = |when: &str| {
        game.wait_for_rest();
        let (written, used) = (game.bytes_written(), processor_time(&game));
        thread::sleep(REST);
        assert_eq!(game.bytes_written(), written, "{when}, bytes are written");
        if let (Some(before), Some(after)) = (used, processor_time(&game)) {
            assert!(after - before <= 2, "{when}, {} hundredths of a second", after - before);
        }
    };
    assert_rests("standing");
    game.press(Key::Char('w'));
    game.wait_for_picture(&["--camera", "6.75,1.5,0"]);
    assert_rests("pushing against a wall");
    game.press(Key::Right);
    game.press(Key::Char('p'));
    game.wait_for("p resumes");
    assert_rests("paused while turning");
}

#[test]
fn a_flickering_thing_is_drawn_only_while_in_view() {
    const FLICKERS: usize = 4;
    let game = Game::start_map("torch");
    game.wait_for_releases();
    let (begun, before) = (Instant::now(), count(&game.bytes(), BEGIN));
    game.wait_until("flickered", |emulator| count(emulator.bytes(), BEGIN) >= before + FLICKERS);
    // Each frame takes a quarter of a second; the first may come earlier.
    let elapsed = begun.elapsed();
    assert!(elapsed >= Duration::from_millis(700), "{FLICKERS} frames in {elapsed:?}");
    // Walk past it, to the wall behind.
    game.press(Key::Char('w'));
    game.wait_for_rest();
    let written = game.bytes_written();
    thread::sleep(Duration::from_secs(1));
    assert_eq!(game.bytes_written(), written, "the torch is behind the player");
}

/// The processor time in hundredths of a second, if the system reports it in a file.
fn processor_time(game: &Game) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{}/stat", game.process())).ok()?;
    let (_, fields) = status.rsplit_once(')')?;
    let [user, system] = [11, 12].map(|index| fields.split_whitespace().nth(index));
    Some(user?.parse::<u64>().ok()? + system?.parse::<u64>().ok()?)
}

/// The number of times that the program has waited for something, if the system reports it in a
/// file.
fn waits(game: &Game) -> Option<usize> {
    let status = std::fs::read_to_string(format!("/proc/{}/status", game.process())).ok()?;
    let count = status.lines().find_map(|line| line.strip_prefix("voluntary_ctxt_switches:"))?;
    count.trim().parse().ok()
}

#[test]
fn a_frame_takes_two_waits() {
    const FRAMES: usize = 20;
    // The terminal accepts a frame of a small window at once.
    let game = Game::with(Speaks::Kitty, (40, 12), None, &["--fps", "10"], &[]);
    let frames = || count(&game.bytes(), END);
    let still = frames();
    game.press(Key::Right);
    game.wait_until("turned", |emulator| count(emulator.bytes(), END) >= still + 2);
    let (Some(waited), before) = (waits(&game), frames()) else { return };
    game.wait_until("went on turning", |emulator| count(emulator.bytes(), END) >= before + FRAMES);
    let waited = waits(&game).unwrap_or_default() - waited;
    let drawn = frames() - before;
    // One wait until the frame is due, and one for the terminal's answer, which may come in two
    // parts.
    assert!(waited <= 2 * drawn + FRAMES / 2, "{waited} waits for {drawn} frames");
}

#[test]
fn guards_out_of_view_are_checked_once_per_frame() {
    const REST: Duration = Duration::from_secs(2);
    let game = Game::with(Speaks::Kitty, (80, 24), Some("patrol"), &["--fps", "10"], &[]);
    game.wait_for_rest();
    let (Some(waited), written) = (waits(&game), game.bytes_written()) else { return };
    let begun = Instant::now();
    thread::sleep(REST);
    let waited = waits(&game).unwrap_or_default() - waited;
    let frames = begun.elapsed().as_secs_f64() * 10.0;
    assert!((waited as f64) < 1.5 * frames, "{waited} waits in the time of {frames:.0} frames");
    assert_eq!(game.bytes_written(), written, "a guard is in view");
}

#[test]
fn no_more_frames_are_drawn_than_asked_for() {
    const FRAMES: usize = 15;
    let game = Game::with(Speaks::Kitty, (80, 24), None, &["--fps", "10"], &[]);
    game.press(Key::Right);
    game.wait_for_arrow("turned", |arrow| arrow.points != '→');
    let (begun, before) = (Instant::now(), count(&game.bytes(), BEGIN));
    game.wait_until("went on turning", |emulator| {
        count(emulator.bytes(), BEGIN) >= before + FRAMES
    });
    let elapsed = begun.elapsed();
    assert!(elapsed >= Duration::from_secs(1), "{FRAMES} frames in {elapsed:?}");
}

#[test]
fn every_frame_is_shown_at_once() {
    let game = Game::start();
    game.press(Key::Right);
    game.wait_for_arrow("turned", |arrow| arrow.points == '←');
    let bytes = game.bytes();
    let first = bytes.windows(BEGIN.len()).position(|window| window == BEGIN).unwrap();
    let mut rest = &bytes[first..];
    let mut frames = 0;
    // After the first frame, there are only frames with their status requests, and the request for
    // releases.
    while let Some(end) = rest.windows(END.len()).position(|window| window == END) {
        let before = rest.windows(BEGIN.len()).position(|window| window == BEGIN).unwrap();
        let between = String::from_utf8_lossy(&rest[..before]);
        let besides = between.replacen("\x1b[5n", "", 1);
        assert!(["", "\x1b[>15u"].contains(&&*besides), "{between:?} is outside of frames");
        let inside = &rest[before + BEGIN.len()..end];
        assert_eq!(count(inside, BEGIN), 0, "a frame begins within a frame");
        rest = &rest[end + END.len()..];
        frames += 1;
    }
    assert!(frames > 5, "{frames} frames");
}
