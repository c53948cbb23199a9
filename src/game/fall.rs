//! Falling and jumping: a parabola between a floor and a ceiling.
//!
//! The times of landing, of hitting the ceiling and of the highest point have a closed form. A step
//! is solved up to the first of them, and continues from there. Therefore the result does not
//! depend on the length of steps, and nobody falls through a floor. Rejected: adding `gravity * dt`
//! to the speed. The height of a jump would depend on the step, and a fast fall would have to be
//! stopped after it has gone too far.

/// Cells per second squared.
pub(crate) const GRAVITY: f64 = 12.0;

/// The height and the vertical speed of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VerticalMotion {
    /// In cells.
    pub(crate) height: f64,
    /// Cells per second, upwards.
    pub(crate) speed: f64,
}

/// The lowest and the highest position, both inclusive. The ceiling is not below the floor. Each is
/// infinite if it does not exist.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VerticalRange {
    pub(crate) floor: f64,
    pub(crate) ceiling: f64,
}

impl VerticalMotion {
    /// The flight after `duration` seconds in `room`, which contains it now. The flight ends on the
    /// floor, and begins to fall at the ceiling.
    pub(crate) fn after(self, duration: f64, room: VerticalRange) -> Self {
        match self.time_to_ceiling(room.ceiling) {
            Some(time) if time < duration => {
                let top = Self { height: room.ceiling, speed: 0.0 };
                top.falling(duration - time, room)
            }
            _ => self.falling(duration, room),
        }
    }

    /// The time until the body hits a ceiling on the way up, in seconds.
    fn time_to_ceiling(self, ceiling: f64) -> Option<f64> {
        let way = ceiling - self.height;
        let left = self.speed * self.speed - 2.0 * GRAVITY * way;
        (self.speed > 0.0 && left > 0.0).then(|| 2.0 * way / (self.speed + left.sqrt()))
    }

    /// The flight after `duration` seconds without a ceiling.
    fn falling(self, duration: f64, room: VerticalRange) -> Self {
        if duration >= self.time_to_floor(room.floor) {
            return Self { height: room.floor, speed: 0.0 };
        }
        let speed = self.speed - GRAVITY * duration;
        let height = self.height + f64::midpoint(self.speed, speed) * duration;
        Self { height: height.clamp(room.floor, room.ceiling), speed }
    }

    /// The time until the body lands, in seconds.
    fn time_to_floor(self, floor: f64) -> f64 {
        let way = self.height - floor;
        let at_floor = (self.speed * self.speed + 2.0 * GRAVITY * way).sqrt();
        // The solution has two forms. Each branch uses the form that adds terms of the same sign.
        if self.speed > 0.0 {
            (self.speed + at_floor) / GRAVITY
        } else if way > 0.0 {
            2.0 * way / (at_floor - self.speed)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SKY: VerticalRange = VerticalRange { floor: 0.0, ceiling: f64::INFINITY };

    fn power_of_ten(exponents: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
        exponents.prop_map(|exponent| libm::pow(10.0, exponent))
    }

    proptest! {
        #[test]
        fn two_steps_equal_one_step_of_their_sum(
            height in 0.0..1.0,
            speed in -10.0..10.0,
            ceiling in prop_oneof![Just(f64::INFINITY), 1.0..3.0],
            first in power_of_ten(-9.0..1.0),
            second in power_of_ten(-9.0..1.0),
        ) {
            let room = VerticalRange { ceiling, ..SKY };
            let flight = VerticalMotion { height, speed };
            let twice = flight.after(first, room).after(second, room);
            let once = flight.after(first + second, room);
            // The speed at the ceiling says little about the time of the hit.
            prop_assert!((twice.height - once.height).abs() < 1e-6, "{twice:?}, {once:?}");
            let is_landing = twice.height < 1e-6;
            prop_assert!(is_landing || (twice.speed - once.speed).abs() < 1e-6);
        }

        #[test]
        fn a_flight_stays_between_floor_and_ceiling(
            height in 0.0..=1.0,
            speed in prop_oneof![-1e9..1e9, -1.0..1.0],
            floor in prop_oneof![Just(0.0), Just(-1e9), -1e-9..0.0],
            headroom in prop_oneof![Just(0.0), 0.0..1e-9, 0.0..1e9],
            duration in power_of_ten(-9.0..9.0),
        ) {
            let room = VerticalRange { floor, ceiling: height + headroom };
            let after = VerticalMotion { height, speed }.after(duration, room);
            prop_assert!((room.floor..=room.ceiling).contains(&after.height), "{after:?}");
            prop_assert!(after.speed.is_finite());
        }

        #[test]
        fn energy_is_kept_in_the_air(speed in 0.1..10.0, part in 0.0..1.0) {
            let start = VerticalMotion { height: 0.0, speed };
            let after = start.after(part * 2.0 * speed / GRAVITY, SKY);
            let energy = |flight: VerticalMotion| {
                flight.speed * flight.speed / 2.0 + GRAVITY * flight.height
            };
            prop_assert!((energy(after) - energy(start)).abs() < 1e-12 * energy(start) || after.height == 0.0);
        }
    }

    #[test]
    fn a_fall_of_a_thousand_cells_ends_on_the_floor() {
        let start = VerticalMotion { height: 1000.0, speed: 0.0 };
        let time = (2.0 * 1000.0 / GRAVITY).sqrt();
        assert!(start.after(time - 1e-6, SKY).height > 0.0);
        let landed = VerticalMotion { height: 0.0, speed: 0.0 };
        assert_eq!(start.after(time + 1e-6, SKY), landed);
        assert_eq!(start.after(1e9, SKY), landed);
        assert_eq!(landed.after(1e-9, SKY), landed);
    }
}
