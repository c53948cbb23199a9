//! Tests of the decisions after sequences of events.

use std::collections::VecDeque;

use super::*;

/// A flow whose terminal has answered once, after 100 ms.
fn answered_once() -> Flow {
    let mut flow = Flow::new(false);
    flow.sent(Duration::ZERO, 0, Request::Status);
    flow.answered(100 * MILLISECOND);
    flow
}

fn send(flow: &mut Flow, now: Duration, bytes: usize) {
    let request = flow.request(now);
    flow.sent(now, bytes, request);
}

#[test]
fn the_first_frame_over_a_network_is_coarse() {
    assert_eq!(Flow::new(false).fidelity(), Fidelity::EXACT);
    let mut flow = Flow::new(true);
    flow.sent(Duration::ZERO, 0, Request::Status);
    flow.answered(100 * MILLISECOND);
    assert_eq!(flow.fidelity(), FIRST_FIDELITY);
    send(&mut flow, SECOND, 14_000);
    flow.sent_motion(14_000, FIRST_FIDELITY);
    flow.answered(SECOND + 128 * MILLISECOND);
    assert_eq!(flow.fidelity(), Fidelity::EXACT, "nothing has moved yet");
}

#[test]
fn a_dead_link_receives_no_frames() {
    let mut flow = answered_once();
    send(&mut flow, SECOND, 1000);
    let mut now = SECOND;
    let (mut frames, mut probes) = (0, 0);
    while now < 120 * SECOND {
        if flow.probe_is_due(now) {
            flow.sent(now, 0, Request::Fence);
            probes += 1;
        }
        if now >= 2 * SECOND && flow.may_send(now) {
            send(&mut flow, now, 1000);
            frames += 1;
        }
        now += 10 * MILLISECOND;
    }
    assert_eq!((frames, probes), (0, 1));
    assert_eq!(flow.opens_at(), None);
    flow.fence_answered(now);
    assert!(flow.may_send(now), "it is there again");
}

#[test]
fn a_key_wakes_a_terminal_that_has_stopped_answering() {
    let mut flow = answered_once();
    send(&mut flow, SECOND, 1000);
    let mut now = SECOND;
    let mut frames = Vec::new();
    while now < 60 * SECOND && flow.request(now) != Request::Nothing {
        if flow.probe_is_due(now) {
            flow.sent(now, 0, Request::Fence);
        }
        flow.received_input();
        if now >= 2 * SECOND && flow.may_send(now) {
            send(&mut flow, now, 1000);
            frames.push(now);
        }
        now += 10 * MILLISECOND;
    }
    assert!(frames[0] <= 5 * SECOND, "{frames:?}");
    assert!(now < 40 * SECOND, "it is asked for ever");
    flow.written(now);
    assert!(flow.may_send(now));
    flow.answered(now);
    assert_ne!(flow.request(now), Request::Nothing, "it answers after all");
}

#[test]
fn an_answer_that_is_lost_shifts_the_others_until_the_next_fence() {
    let mut flow = answered_once();
    let mut now = SECOND;
    flow.sent(now, 1000, Request::Status);
    let mut requests = VecDeque::new();
    // The first answer is lost; after it, one frame is always in flight.
    for _ in 0..100 {
        now += 60 * MILLISECOND;
        let request = flow.request(now);
        flow.sent(now, 1000, request);
        requests.push_back(request);
        now += 100 * MILLISECOND;
        match requests.pop_front().unwrap() {
            Request::Status => flow.answered(now),
            Request::Fence => flow.fence_answered(now),
            Request::Nothing => unreachable!("it has answered"),
        }
    }
    assert_eq!(flow.in_flight.frames(), 0);
    assert_eq!(flow.round_trip(), Some(100 * MILLISECOND));
}

#[test]
fn a_terminal_that_ignores_requests_is_not_asked_again() {
    let mut flow = Flow::new(false);
    flow.sent(Duration::ZERO, 0, Request::Status);
    flow.sent(Duration::ZERO, 0, Request::Fence);
    flow.fence_answered(MILLISECOND);
    assert_eq!(flow.request(MILLISECOND), Request::Nothing);
    assert!(flow.may_send(MILLISECOND));
    send(&mut flow, MILLISECOND, 1000);
    assert!(!flow.may_send(1000 * MILLISECOND), "the system has not taken the frame yet");
    assert_eq!(flow.opens_at(), None);
    flow.written(1001 * MILLISECOND);
    assert!(flow.may_send(1001 * MILLISECOND));
    assert!(!flow.awaits_answers());
    flow.sent_motion(1000, Fidelity::EXACT);
    assert!(flow.fidelity() > Fidelity::EXACT, "a kilobyte a second is slow");
}

#[test]
fn a_silent_terminal_is_asked_once_or_twice() {
    let mut flow = Flow::new(false);
    flow.sent(Duration::ZERO, 0, Request::Status);
    flow.sent(Duration::ZERO, 0, Request::Fence);
    while flow.may_send(Duration::ZERO) {
        send(&mut flow, Duration::ZERO, 100);
    }
    let opens_at = flow.opens_at().unwrap();
    assert!(flow.may_send(opens_at));
    send(&mut flow, opens_at, 100);
    assert_eq!(flow.request(opens_at), Request::Nothing);
}

#[test]
fn an_answer_to_a_forgotten_request_is_ignored() {
    let mut flow = answered_once();
    send(&mut flow, 200 * MILLISECOND, 1000);
    flow.forget();
    send(&mut flow, 210 * MILLISECOND, 1000);
    flow.answered(215 * MILLISECOND);
    assert_eq!(flow.in_flight.frames(), 1, "the second frame has not been answered");
    flow.answered(310 * MILLISECOND);
    assert_eq!(flow.in_flight.frames(), 0);
    assert_eq!(flow.round_trip(), Some(100 * MILLISECOND));
}

/// An event in a program that shows frames.
#[derive(Clone, Copy, Debug)]
enum FlowEvent {
    Answer,
    FenceAnswer,
    Taken,
    Key,
    Forget,
    Draw(usize),
    Time(u64),
}

fn event() -> impl Strategy<Value = FlowEvent> {
    prop_oneof![
        4 => Just(FlowEvent::Answer),
        2 => Just(FlowEvent::FenceAnswer),
        2 => Just(FlowEvent::Taken),
        2 => Just(FlowEvent::Key),
        1 => Just(FlowEvent::Forget),
        8 => (0..200_000_usize).prop_map(FlowEvent::Draw),
        4 => (0..3000_u64).prop_map(FlowEvent::Time),
    ]
}

proptest! {
    /// However answers are delayed or lost, few frames are unanswered, and after a key a frame or a
    /// fence is sent within the longest timeout.
    #[test]
    fn the_window_is_never_exceeded_and_never_closed_for_ever(
        events in prop::collection::vec(event(), 0..200),
    ) {
        let mut flow = Flow::new(false);
        let mut now = Duration::ZERO;
        for event in events {
            match event {
                FlowEvent::Answer => flow.answered(now),
                FlowEvent::FenceAnswer => flow.fence_answered(now),
                FlowEvent::Taken => flow.written(now),
                FlowEvent::Key => flow.received_input(),
                FlowEvent::Forget => flow.forget(),
                FlowEvent::Draw(bytes) if flow.may_send(now) => {
                    let fidelity = flow.fidelity();
                    send(&mut flow, now, bytes);
                    flow.sent_motion(bytes, fidelity);
                }
                FlowEvent::Draw(_) if flow.probe_is_due(now) => {
                    flow.sent(now, 0, Request::Fence);
                }
                FlowEvent::Draw(_) => {}
                FlowEvent::Time(milliseconds) => now += Duration::from_millis(milliseconds),
            }
            prop_assert!(flow.in_flight.frames() <= MAX_FRAMES + MAX_TIMEOUTS as usize);
            flow.received_input();
            let later = now + MAX_TIMEOUT;
            if flow.answers != Answers::Never {
                prop_assert!(flow.may_send(later) || flow.probe_is_due(later));
                prop_assert!(flow.may_send(now) || flow.opens_at().is_some());
            }
        }
    }
}
