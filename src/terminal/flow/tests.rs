//! The policy on links that are made up: it is fresh on slow ones, exact on fast ones, and goes
//! on whatever is lost.

use proptest::prelude::*;

use super::demand::LEAST_FIDELITY;
use super::*;

const MILLISECOND: Duration = Duration::from_millis(1);

/// A link that delays and limits, and a terminal at its end.
struct Simulation {
    flow: Flow,
    now: Duration,
    delay: Duration,
    /// Bytes a second.
    rate: f64,
    /// When the link has carried all that was sent.
    carried_at: Duration,
    answers: VecDeque<Duration>,
    shown: Vec<Shown>,
}

/// A frame that was sent.
#[derive(Clone, Copy, Debug)]
struct Shown {
    sent_at: Duration,
    /// When it is on the screen.
    at: Duration,
    fidelity: Fidelity,
}

impl Shown {
    /// How old it is when it is seen.
    fn age(self) -> Duration {
        self.at.saturating_sub(self.sent_at)
    }
}

/// By how much smaller the pretended encoder's frames are at `fidelity`.
fn saving(fidelity: Fidelity) -> f64 {
    1.0 + f64::from(fidelity.tolerance()) * 0.3
}

impl Simulation {
    fn new(delay: Duration, rate: f64) -> Self {
        let mut simulation = Self {
            flow: Flow::default(),
            now: Duration::ZERO,
            delay,
            rate,
            carried_at: Duration::ZERO,
            answers: VecDeque::new(),
            shown: Vec::new(),
        };
        simulation.send(0);
        simulation
    }

    fn send(&mut self, bytes: usize) {
        self.flow.sent(self.now, bytes);
        let carried_at =
            self.carried_at.max(self.now) + Duration::from_secs_f64(bytes as f64 / self.rate);
        self.carried_at = carried_at;
        self.answers.push_back(carried_at + 2 * self.delay);
        let fidelity = self.flow.fidelity();
        self.shown.push(Shown { sent_at: self.now, at: carried_at + self.delay, fidelity });
    }

    /// Moves for so long, at 30 frames a second at the most. A frame is of `exact` bytes, or fewer
    /// where it is less exact.
    fn walk(&mut self, time: Duration, exact: usize) {
        let until = self.now + time;
        let mut due = self.now;
        while self.now < until {
            while self.answers.front().is_some_and(|at| *at <= self.now) {
                self.answers.pop_front();
                self.flow.answered(self.now);
            }
            if self.now >= due && self.flow.may_send(self.now) {
                let fidelity = self.flow.fidelity();
                let saving = saving(fidelity);
                let bytes = (exact as f64 / saving) as usize;
                self.send(bytes);
                self.flow.showed_motion(bytes, fidelity);
                due = self.now + 33 * MILLISECOND;
            }
            self.now += MILLISECOND;
        }
    }

    /// What was sent after `time`.
    fn shown_since(&self, time: Duration) -> Vec<Shown> {
        self.shown.iter().copied().filter(|shown| shown.sent_at >= time).collect()
    }
}

#[test]
fn on_a_slow_link_frames_are_fresh_and_many() {
    let mut link = Simulation::new(50 * MILLISECOND, 125_000.0);
    link.walk(Duration::from_secs(5), 40_000);
    let settled = link.shown_since(Duration::from_secs(2));
    assert!(settled.len() >= 3 * 17, "{} frames in three seconds", settled.len());
    let late = settled.iter().map(|shown| shown.age()).max().unwrap();
    assert!(late <= 150 * MILLISECOND, "{late:?} from being drawn to being seen");
    let first = link.shown_since(Duration::from_secs(1))[0].fidelity;
    assert!(first > Fidelity::EXACT, "{first} a second after it began");
}

#[test]
fn on_a_fast_link_every_frame_is_exact_and_in_time() {
    for delay in [Duration::ZERO, MILLISECOND, 40 * MILLISECOND] {
        let mut link = Simulation::new(delay, 10e6);
        link.walk(Duration::from_secs(3), 60_000);
        let settled = link.shown_since(Duration::from_secs(1));
        assert!(settled.iter().all(|shown| shown.fidelity == Fidelity::EXACT), "{delay:?}");
        assert!(settled.len() >= 58, "{} frames in two seconds after {delay:?}", settled.len());
    }
}

#[test]
fn it_is_exact_again_when_the_link_has_become_fast() {
    let mut link = Simulation::new(20 * MILLISECOND, 100_000.0);
    link.walk(Duration::from_secs(5), 40_000);
    assert!(link.flow.fidelity() > Fidelity::EXACT);
    link.rate = 10e6;
    link.walk(Duration::from_secs(20), 40_000);
    assert_eq!(link.flow.fidelity(), Fidelity::EXACT);
}

#[test]
fn a_terminal_that_passes_over_requests_is_not_asked_again() {
    let mut flow = Flow::default();
    assert!(flow.asks());
    flow.sent(Duration::ZERO, 0);
    flow.passed_over();
    assert!(!flow.asks());
    assert!(flow.may_send(Duration::ZERO));
    flow.sent(MILLISECOND, 1000);
    assert!(!flow.may_send(1000 * MILLISECOND), "the system has not taken the frame yet");
    assert_eq!(flow.opens_at(), None);
    flow.taken(1001 * MILLISECOND);
    assert!(flow.may_send(1001 * MILLISECOND));
    assert!(!flow.awaits_answers());
    flow.showed_motion(1000, Fidelity::EXACT);
    assert!(flow.fidelity() > Fidelity::EXACT, "a kilobyte a second is slow");
}

#[test]
fn a_terminal_that_says_nothing_is_asked_once_or_twice() {
    let mut flow = Flow::default();
    while flow.may_send(Duration::ZERO) {
        flow.sent(Duration::ZERO, 100);
    }
    let opens_at = flow.opens_at().unwrap();
    assert!(flow.may_send(opens_at));
    flow.sent(opens_at, 100);
    assert!(!flow.asks());
}

#[test]
fn an_answer_that_comes_when_it_was_given_up_counts_for_nothing() {
    let mut flow = Flow::default();
    flow.sent(Duration::ZERO, 0);
    flow.answered(100 * MILLISECOND);
    flow.sent(200 * MILLISECOND, 1000);
    let opens_at = flow.opens_at().unwrap();
    flow.sent(opens_at, 1000);
    flow.answered(opens_at + MILLISECOND);
    assert!(!flow.may_send(opens_at + 2 * MILLISECOND), "the second frame has not been answered");
    flow.answered(opens_at + 110 * MILLISECOND);
    assert!(flow.may_send(opens_at + 110 * MILLISECOND));
}

/// What may happen to a program that shows frames.
#[derive(Clone, Copy, Debug)]
enum Happening {
    Answer,
    Taken,
    PassedOver,
    Forget,
    Draw(usize),
    Time(u64),
}

fn happening() -> impl Strategy<Value = Happening> {
    prop_oneof![
        4 => Just(Happening::Answer),
        2 => Just(Happening::Taken),
        1 => Just(Happening::PassedOver),
        1 => Just(Happening::Forget),
        8 => (0..200_000_usize).prop_map(Happening::Draw),
        4 => (0..3000_u64).prop_map(Happening::Time),
    ]
}

proptest! {
    /// Whatever is answered, lost or late, no more than the window is unanswered, and a frame may
    /// be sent sooner or later.
    #[test]
    fn the_window_is_never_exceeded_and_never_closed_for_ever(
        happenings in prop::collection::vec(happening(), 0..200),
    ) {
        let mut flow = Flow::default();
        let mut now = Duration::ZERO;
        for happening in happenings {
            match happening {
                Happening::Answer => flow.answered(now),
                Happening::Taken => flow.taken(now),
                Happening::PassedOver => flow.passed_over(),
                Happening::Forget => flow.forget(),
                Happening::Draw(bytes) if flow.may_send(now) => {
                    let fidelity = flow.fidelity();
                    flow.sent(now, bytes);
                    flow.showed_motion(bytes, fidelity);
                }
                Happening::Draw(_) => {}
                Happening::Time(milliseconds) => now += Duration::from_millis(milliseconds),
            }
            prop_assert!(flow.in_flight.len() <= WIDEST_WINDOW);
            if flow.asks() {
                prop_assert!(flow.may_send(now + MOST_PATIENCE));
                prop_assert!(flow.may_send(now) || flow.opens_at().is_some());
            } else {
                flow.taken(now);
                prop_assert!(flow.may_send(now));
            }
        }
    }

    /// On any link, after a while, what is shown is not much older than the link makes it.
    #[test]
    fn it_converges(
        delay in 0..200_u64,
        rate in 20_000.0..20e6,
        exact in 2_000..100_000_usize,
    ) {
        let mut link = Simulation::new(Duration::from_millis(delay), rate);
        link.walk(Duration::from_secs(12), exact);
        let settled = link.shown_since(Duration::from_secs(8));
        let least = exact as f64 / saving(LEAST_FIDELITY) / rate;
        let allowed = link.delay + 150 * MILLISECOND + Duration::from_secs_f64(2.0 * least);
        for shown in &settled {
            prop_assert!(shown.age() <= allowed, "{shown:?}");
        }
        let round_trip = (2 * link.delay).as_secs_f64();
        let frames = (1.0 / least).min(4.0 / (round_trip + 0.04)).min(20.0) * 0.7;
        prop_assert!(settled.len() as f64 / 4.0 >= frames, "{} < 4 × {frames}", settled.len());
    }
}
