//! Simulated links: frames are fresh on slow links, exact on fast links, and continue after losses
//! and stalls.

use super::*;

#[test]
fn on_a_slow_link_frames_are_fresh_and_many() {
    let mut line = Simulation::of_one(50 * MILLISECOND, MEGABIT, Frames::all_of(40_000));
    line.walk(5 * SECOND);
    let settled = line.players[0].shown_since(2 * SECOND);
    assert!(settled.len() >= 3 * 17, "{} frames in three seconds", settled.len());
    let arrived = settled.iter().filter(|shown| shown.at.is_some());
    let late = arrived.map(|shown| shown.age()).max().unwrap();
    assert!(late <= 150 * MILLISECOND, "{late:?} from being drawn to being seen");
    let first = line.players[0].shown_since(SECOND)[0].fidelity;
    assert!(first > Fidelity::EXACT, "{first} a second after it began");
}

#[test]
fn on_a_fast_link_every_frame_is_exact_and_in_time() {
    for delay in [Duration::ZERO, MILLISECOND, 40 * MILLISECOND] {
        let mut line = Simulation::of_one(delay, 10e6, Frames::all_of(60_000));
        line.walk(3 * SECOND);
        let settled = line.players[0].shown_since(SECOND);
        assert!(settled.iter().all(|shown| shown.fidelity == Fidelity::EXACT), "{delay:?}");
        assert!(settled.len() >= 58, "{} frames in two seconds after {delay:?}", settled.len());
    }
}

/// The quotient of bytes and busy time mistakes jitter for slowness: 0 to 100 ms each way made most
/// frames as coarse as possible.
#[test]
fn jitter_is_not_taken_for_slowness() {
    for (jitter, frames_per_second) in [(50, 28), (100, 17)] {
        let jitter = jitter * MILLISECOND;
        let conditions = Conditions { delay: 20 * MILLISECOND, jitter, rate: UNLIMITED };
        let mut line = Simulation::new(conditions, &[Frames::CITADEL]);
        line.walk(42 * SECOND);
        let settled = line.players[0].shown_since(2 * SECOND);
        assert!(settled.len() >= 40 * frames_per_second, "{} with {jitter:?}", settled.len());
        let exact = settled.iter().filter(|one| one.fidelity == Fidelity::EXACT).count();
        assert!(exact * 4 >= settled.len() * 3, "{exact} of {} with {jitter:?}", settled.len());
        let coarse = settled.iter().filter(|one| one.fidelity > Fidelity::HIGH).count();
        assert!(coarse * 50 <= settled.len(), "{coarse} of {} with {jitter:?}", settled.len());
    }
}

#[test]
fn frames_are_exact_again_when_the_link_has_become_fast() {
    let mut line = Simulation::of_one(20 * MILLISECOND, 100_000.0, Frames::all_of(40_000));
    line.walk(5 * SECOND);
    assert!(line.players[0].flow.fidelity() > Fidelity::EXACT);
    line.conditions.rate = 10e6;
    line.walk(20 * SECOND);
    assert_eq!(line.players[0].flow.fidelity(), Fidelity::EXACT);
}

/// When frames were removed after a timeout, their late answers made a link of 100 ms seem one of 0
/// to 17 ms, for as long as anything moved.
#[test]
fn after_a_stall_answers_belong_to_their_frames() {
    let mut line = Simulation::of_one(50 * MILLISECOND, 10.0 * MEGABIT, Frames::CITADEL);
    line.walk(10 * SECOND);
    line.conditions.rate = 1000.0;
    line.walk(12 * SECOND);
    line.conditions.rate = 10.0 * MEGABIT;
    line.walk(SECOND);
    for _ in 0..200 {
        line.walk(50 * MILLISECOND);
        let round_trip = line.players[0].flow.round_trip().unwrap();
        assert!(round_trip >= 100 * MILLISECOND, "{round_trip:?} at {:?}", line.now);
    }
    let slow = |one: &&Latency| one.pressed_at >= 23 * SECOND && one.taken > 300 * MILLISECOND;
    assert_eq!(line.players[0].latencies.iter().find(slow).map(|one| one.taken), None);
}

/// When frames were sent to a link that did not answer, 30 s of them waited for it.
#[test]
fn no_frames_queue_before_a_link_that_has_become_slow() {
    let mut line = Simulation::of_one(20 * MILLISECOND, 10.0 * MEGABIT, Frames::CITADEL);
    line.walk(10 * SECOND);
    let before = line.players[0].shown_since(Duration::ZERO).len();
    line.conditions.rate = 2500.0;
    line.walk(40 * SECOND);
    let after = &line.players[0].shown_since(Duration::ZERO)[before..];
    let first = after.iter().position(|one| one.fidelity >= Fidelity::LOW).unwrap();
    let exact: usize = after[..first].iter().map(|one| one.bytes).sum();
    assert!(exact <= 60_000, "{exact} bytes before it noticed");
    assert!(after[first..].iter().all(|one| one.bytes < 4000));
}

#[test]
fn two_sessions_share_a_link_in_time() {
    let conditions =
        Conditions { delay: 30 * MILLISECOND, jitter: Duration::ZERO, rate: 2.0 * MEGABIT };
    let mut line = Simulation::new(conditions, &[Frames::CITADEL; 2]);
    line.walk(42 * SECOND);
    for player in &line.players {
        let frames = player.shown_since(2 * SECOND).len();
        assert!(frames >= 40 * 19, "{frames} frames in 40 s");
    }
}

/// The frames in flight when a link becomes slow arrive before any new one. Without waiting for
/// late answers, and with all frames that the link has room for, they had 78 kB in the median and
/// 103 kB at most.
#[test]
fn little_is_in_flight_when_a_link_becomes_slow() {
    let [median, most] = scenarios::queued_after_drop(20, 20, Frames::CITADEL);
    assert!(median <= 50_000.0 && most <= 70_000.0, "{median} bytes, {most} at most");
}

/// The tables in the documentation are the present results of the simulation.
#[test]
fn the_documented_tables_are_those_of_this_policy() {
    let documented = include_str!("../../../../docs/links.md").replace("\r\n", "\n");
    for table in [scenarios::table(), scenarios::table_of_drops()] {
        println!("{table}");
        assert!(documented.contains(&table), "docs/links.md has another table than this:\n{table}");
    }
}

proptest! {
    /// On any link, after some seconds, frames on the screen are not much older than the link makes
    /// them.
    #[test]
    fn frames_become_fresh_on_any_link(
        delay in 0..200_u64,
        rate in 20_000.0..20e6,
        exact in 2_000..100_000_usize,
    ) {
        let delay = Duration::from_millis(delay);
        let mut line = Simulation::of_one(delay, rate, Frames::all_of(exact));
        line.walk(12 * SECOND);
        let settled = line.players[0].shown_since(8 * SECOND);
        let least = exact as f64 / saving(MIN_FIDELITY) / rate;
        let allowed = delay + 150 * MILLISECOND + Duration::from_secs_f64(2.0 * least);
        for shown in settled.iter().filter(|shown| shown.at.is_some()) {
            prop_assert!(shown.age() <= allowed, "{shown:?}");
        }
        let round_trip = (2 * delay).as_secs_f64();
        let frames = (1.0 / least).min(4.0 / (round_trip + 0.04)).min(20.0) * 0.7;
        prop_assert!(settled.len() as f64 / 4.0 >= frames, "{} < 4 × {frames}", settled.len());
    }
}
