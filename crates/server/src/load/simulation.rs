//! The governor, and the flow control of players, in one simulation: players whose pictures move, each on a link of
//! their own, share one processor.

use std::num::NonZero;

use cellcaster::color::Rgb;
use cellcaster::rng::SplitMix64;
use cellcaster::terminal::{Fidelity, Protocol, Screen, SessionOptions, WindowSize};
use cellcaster::tui::canvas::Canvas;

use super::*;

const TICK: Duration = Duration::from_millis(1);
/// The processor time of a frame, by search and greedy.
const FRAME_COST: [Duration; 2] = [Duration::from_micros(270), Duration::from_micros(130)];
const GOVERNED: Duration = Duration::from_millis(250);
const DELAY: Duration = Duration::from_millis(20);
const MOST: u32 = 30;
const BUDGET: NonZero<u32> = NonZero::new(60_000).unwrap();
const WARM_UP: Duration = Duration::from_secs(14);
const END: Duration = Duration::from_secs(30);

/// The figures of a player after the warm-up.
#[derive(Debug, Default)]
struct Figures {
    frames_a_second: f64,
    bytes_a_second: f64,
    /// The longest time from a frame to its arrival.
    oldest: Duration,
    /// The fidelity of the last frame.
    fidelity: Fidelity,
    effort: Effort,
}

/// The figures of one of `players` equal players, on a link of this many bytes a second.
fn play(players: u32, link: f64) -> Figures {
    let options = SessionOptions {
        is_remote: true,
        ..SessionOptions::from_environment(|name| {
            let value = [("TERM", "xterm-256color"), ("COLORTERM", "truecolor")];
            value.iter().find(|it| it.0 == name).map(|it| it.1.to_owned())
        })
    };
    let mut protocol = Protocol::new(options, WindowSize::of_cells(80, 24));
    protocol.set_budget(Some(BUDGET));
    protocol.begin(Duration::ZERO);
    let mut governor = Governor::new();
    let mut rate = governor.decide(Sample::default(), MOST);
    let [mut drawn_at, mut link_free, mut due] = [Duration::ZERO; 3];
    let mut busy = 0.0;
    // The answers, and the frames with the bytes that they have, by time of arrival.
    let mut answers: Vec<(Duration, &[u8])> = Vec::new();
    let mut figures = Figures::default();
    let mut now = Duration::ZERO;
    let seconds = END.saturating_sub(WARM_UP).as_secs_f64();
    while now < END {
        now += TICK;
        if now.as_millis().is_multiple_of(GOVERNED.as_millis()) {
            rate = governor.decide(Sample { busy, lateness: Duration::ZERO }, MOST);
            protocol.set_effort(rate.effort);
        }
        while answers.first().is_some_and(|answer| answer.0 <= now) {
            protocol.receive(answers.remove(0).1, now);
        }
        protocol.wake(now);
        while protocol.next_event().is_some() {}
        // A frame of each player takes the processor for this time.
        let cost = FRAME_COST[usize::from(rate.effort == Effort::Greedy)] * players;
        let may_draw = now >= due.max(protocol.budget_opens_at()) && protocol.is_ready(now);
        let is_frame = may_draw && drawn_at + cost <= now;
        if is_frame {
            due = now + rate.frame_time.max(protocol.frame_time());
            busy = cost.as_secs_f64() / now.saturating_sub(drawn_at).as_secs_f64();
            drawn_at = now;
            figures.fidelity = protocol.fidelity();
            protocol.draw(|screen| picture(screen, now));
        }
        let output = take(protocol.output(now));
        if output.is_empty() {
            continue;
        }
        link_free = link_free.max(now) + Duration::from_secs_f64(output.len() as f64 / link);
        protocol.written(now);
        protocol.carried(output.len(), output.len());
        let arrival = link_free + DELAY;
        for start in 0..output.len() {
            for (query, answer) in [("\x1b[5n", "\x1b[0n"), ("\x1b[c", "\x1b[?62c")] {
                if output[start..].starts_with(query.as_bytes()) {
                    answers.push((arrival + DELAY, answer.as_bytes()));
                }
            }
        }
        if now > WARM_UP {
            figures.bytes_a_second += output.len() as f64 / seconds;
            if is_frame {
                figures.frames_a_second += 1.0 / seconds;
                figures.oldest = figures.oldest.max(arrival.saturating_sub(now));
            }
        }
    }
    Figures { effort: rate.effort, ..figures }
}

/// A picture that moves to the side, of textures whose colours differ a little from pixel to pixel.
fn picture(screen: &mut Screen, now: Duration) {
    let passed = now.as_millis() as u64 / 20;
    for row in 0..24 {
        let pixel = |column: u64, half: u64| {
            let (x, y) = (column + passed, 2 * u64::from(row) + half);
            let noise = SplitMix64::new(x << 8 | y).bits();
            let shade = 45 * (x / 9 % 5) as u8 + 3 * (y / 4) as u8;
            let [red, green, blue] = [0, 8, 16].map(|bit| shade + (noise >> bit) as u8 % 24);
            Rgb::new(red, green, blue)
        };
        screen.draw_pixels(0, row, (0..80).map(|column| [0, 1].map(|half| pixel(column, half))));
    }
}

#[test]
fn one_to_a_thousand_players_on_any_link_share_processor_link_and_budget() {
    for kilobits in [20.0, 128.0, 1_000.0, f64::INFINITY] {
        for players in [1, 60, 240, 400, 1000] {
            let link = kilobits * 125.0;
            let figures = play(players, link);
            let about = format!("{kilobits} kbit/s, {players} players: {figures:?}");
            assert!(figures.bytes_a_second < link.min(60_000.0) * 1.02, "{about}");
            if kilobits < 100.0 {
                // A frame takes a second or two, however coarse it is.
                assert!(figures.oldest < Duration::from_secs(5), "{about}");
                continue;
            }
            let greedy = FRAME_COST[1].as_secs_f64() * f64::from(players);
            let most = f64::min(20.0, TARGET / greedy);
            let share = figures.frames_a_second / most;
            assert!(share > 0.92 && share < 1.03, "{about}");
            assert!(figures.oldest < Duration::from_millis(150), "{about}");
            assert_eq!(figures.effort == Effort::Greedy, players >= 240, "{about}");
            // The greedy effort does not find the shift of this picture, so it needs more bytes or coarser colours.
            let is_fine = figures.fidelity.tolerance() <= 12;
            assert!(is_fine || kilobits < 1_000.0 || figures.effort == Effort::Greedy, "{about}");
        }
    }
}
