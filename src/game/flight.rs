//! Flying through a scene of bodies: the player floats, and enters no body.
//!
//! All bodies are convex. Therefore each body is behind a plane through its point nearest to the
//! player, and a path on the near side of all these planes enters no body. The path is clipped to
//! these half-spaces, which makes the player slide along bodies. Rejected: moving first and pushing
//! out afterwards. Between two bodies, the player would end inside one of them.

use glam::{DVec2, DVec3};

use super::intent::{Intent, Intents};
use super::turning::{self, Turning};
use super::{FRICTION, RUN, STEP, STILL, WALK};
use crate::numeric::damped_motion::{DampedMotion, approach};
use crate::space::{Camera, EYE_CLEARANCE, Elevation, Scene};
use crate::world::{FieldOfView, Heading};

/// The speed at which the elevation changes, in radians per second.
const RAISE: f64 = 0.8;
/// The speed while aiming.
const AIM_UPWARDS: f64 = 0.2;
/// The maximum number of passes that clip one path. Between two planes, each pass removes another
/// part.
const CUTS: usize = 8;

/// A scene, a player in it, and the time since the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    scene: Scene,
    player: FlyingPlayer,
    steps: u64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct FlyingPlayer {
    position: DVec3,
    /// Cells per second.
    velocity: DVec3,
    heading: Heading,
    turning: Turning,
    elevation: Elevation,
    /// Radians per second, upwards.
    raising: f64,
}

impl Flight {
    /// A flight at its start. The player is still, at the scene's start.
    pub fn new(scene: Scene) -> Self {
        let start = scene.start;
        let player = FlyingPlayer {
            position: start.position(),
            velocity: DVec3::ZERO,
            heading: start.heading,
            turning: Turning::default(),
            elevation: start.elevation,
            raising: 0.0,
        };
        Self { scene, player, steps: 0 }
    }

    /// A flight in another scene that continues this one. The player is still, at the same position
    /// with the same view. If there is no room, the player is at the scene's start.
    #[must_use]
    pub fn begun_again_in(&self, scene: Scene) -> Self {
        let FlyingPlayer { position, heading, elevation, .. } = self.player;
        let has_room = is_free(&scene, position);
        let begun = Self::new(scene);
        if !has_room {
            return begun;
        }
        let player = FlyingPlayer { position, heading, elevation, ..begun.player };
        Self { player, ..begun }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The player's camera.
    pub fn camera(&self, field_of_view: FieldOfView) -> Camera {
        let FlyingPlayer { position, heading, elevation, .. } = self.player;
        // Every position of the player is valid for a camera.
        Camera::new(position, heading, field_of_view)
            .unwrap_or_else(|| self.scene.start_camera(field_of_view))
            .with_elevation(elevation)
    }

    /// The time in seconds, counted in steps.
    pub fn elapsed(&self) -> f64 {
        self.steps as f64 * STEP
    }

    /// Whether any number of steps with these intents would change nothing but the clock.
    pub fn is_at_rest(&self, intents: Intents) -> bool {
        self.player.stepped(&self.scene, intents) == self.player
    }

    /// Advances the flight by one step of [`STEP`] seconds with these intents. Jumping and opening
    /// make the player rise, ducking makes them sink.
    pub fn step(&mut self, intents: Intents) {
        self.player = self.player.stepped(&self.scene, intents);
        self.wait(1);
    }

    /// Advances the clock by `steps` steps in which nothing moves.
    pub fn wait(&mut self, steps: u64) {
        self.steps = self.steps.saturating_add(steps);
    }
}

impl FlyingPlayer {
    fn stepped(self, scene: &Scene, intents: Intents) -> Self {
        self.turned(intents).raised(intents).moved(scene, intents)
    }

    fn turned(self, intents: Intents) -> Self {
        let (turning, turned) = self.turning.after_a_step(intents);
        let angle = turned + intents.look().turn_radians();
        Self { heading: self.heading.turned(angle), turning, ..self }
    }

    fn raised(self, intents: Intents) -> Self {
        if intents.contains(Intent::LookAhead) {
            return Self { elevation: Elevation::LEVEL, raising: 0.0, ..self };
        }
        let speed = if intents.contains(Intent::Aim) { AIM_UPWARDS } else { RAISE };
        let target = speed * intents.balance(Intent::LookUp, Intent::LookDown);
        let DampedMotion { velocity, displacement } =
            approach(self.raising, target, turning::FRICTION, STEP);
        let elevation = self.elevation.raised(displacement + intents.look().tilt_radians());
        let has_stopped = velocity.abs() < STILL || elevation == self.elevation;
        Self { elevation, raising: if has_stopped { 0.0 } else { velocity }, ..self }
    }

    fn moved(self, scene: &Scene, intents: Intents) -> Self {
        let target = wanted_velocity(self.heading, intents);
        let glide = |velocity, target| approach(velocity, target, FRICTION, STEP);
        let [x, y, z] = [
            glide(self.velocity.x, target.x),
            glide(self.velocity.y, target.y),
            glide(self.velocity.z, target.z),
        ];
        let way = DVec3::new(x.displacement, y.displacement, z.displacement);
        let velocity = DVec3::new(x.velocity, y.velocity, z.velocity);
        let (way, velocity) = self.cut_down(scene, way, velocity);
        let velocity = if velocity.length() < STILL { DVec3::ZERO } else { velocity };
        if way.length() < STILL * STEP {
            return Self { velocity, ..self };
        }
        let position = self.position + way;
        if is_free(scene, position) {
            Self { position, velocity, ..self }
        } else {
            Self { velocity: DVec3::ZERO, ..self }
        }
    }

    /// `way` and `velocity` without the parts that lead into bodies.
    fn cut_down(self, scene: &Scene, mut way: DVec3, mut velocity: DVec3) -> (DVec3, DVec3) {
        for _ in 0..CUTS {
            let before = way;
            for body in &scene.bodies {
                let (clearance, outwards) = body.shape.signed_distance(self.position);
                // The remaining room, so that rounding leads no further.
                let room = (clearance - EYE_CLEARANCE - SLACK).max(0.0);
                let too_far = -outwards.dot(way) - room;
                if too_far > 0.0 {
                    way += outwards * too_far;
                    velocity -= outwards * outwards.dot(velocity).min(0.0);
                }
            }
            if way == before {
                break;
            }
        }
        (way, velocity)
    }
}

/// The extra distance from bodies at which the player stops, in cells.
const SLACK: f64 = 1e-9;

/// Whether the player can be at `position`.
fn is_free(scene: &Scene, position: DVec3) -> bool {
    scene.bodies.iter().all(|body| body.shape.signed_distance(position).0 >= EYE_CLEARANCE)
        && Camera::new(position, Heading::default(), FieldOfView::default()).is_some()
}

/// The velocity that the player approaches in empty space.
fn wanted_velocity(heading: Heading, intents: Intents) -> DVec3 {
    let forward = intents.balance(Intent::Forward, Intent::Back);
    let right = intents.balance(Intent::StrafeRight, Intent::StrafeLeft);
    let rises = [Intent::Jump, Intent::Open].into_iter().any(|up| intents.contains(up));
    let up = f64::from(rises) - f64::from(intents.contains(Intent::Duck));
    let speed = if intents.contains(Intent::Run) { RUN } else { WALK };
    let level = heading.direction().rotate(DVec2::new(forward, right));
    level.extend(up).normalize_or_zero() * speed
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::color::Rgb;
    use crate::game::Look;
    use crate::space::{Block, Body, BodyShape, Plane, SceneStart, SolidTexture, Sphere};

    /// A start between a floor, a ball, an inclined wall and a box.
    fn scene(degrees: f64) -> Scene {
        let shapes = [
            BodyShape::Plane(Plane::new(DVec3::ZERO, DVec3::Z).unwrap()),
            BodyShape::Plane(Plane::new(-DVec3::X, DVec3::new(2.0, 1.0, -1.0)).unwrap()),
            BodyShape::Sphere(Sphere::new(DVec3::new(2.0, 0.0, 0.5), 1.0).unwrap()),
            BodyShape::Block(
                Block::new(DVec3::new(-1.0, 1.0, 0.0), DVec3::new(3.0, 2.0, 1.0)).unwrap(),
            ),
        ];
        let heading = Heading::from_degrees(degrees).unwrap();
        let texture = SolidTexture::Plain(Rgb::WHITE);
        Scene {
            bodies: shapes.map(|shape| Body { shape, texture }).to_vec(),
            start: SceneStart::new(DVec3::new(0.5, 0.0, 0.5), heading, Elevation::LEVEL).unwrap(),
            ..Scene::default()
        }
    }

    fn intents(list: &[Intent]) -> Intents {
        list.iter().copied().collect()
    }

    proptest! {
        #[test]
        fn the_player_never_enters_a_body_or_exceeds_running_speed(
            degrees in 0.0..360.0,
            script in prop::collection::vec(
                (1..40_usize, prop::sample::subsequence(Intent::ALL.to_vec(), 0..6)),
                0..30,
            ),
        ) {
            let mut flight = Flight::new(scene(degrees));
            let sides = |at| flight_sides(&scene(degrees), at);
            let at_first = sides(flight.player.position);
            for (steps, held) in script {
                for _ in 0..steps {
                    let before = flight.player.position;
                    flight.step(intents(&held));
                    let after = flight.player.position;
                    prop_assert!(is_free(flight.scene(), after));
                    prop_assert!(before.distance(after) <= RUN * STEP * (1.0 + 1e-9));
                }
            }
            prop_assert_eq!(sides(flight.player.position), at_first);
            (0..120).for_each(|_| flight.step(Intents::new()));
            prop_assert!(flight.is_at_rest(Intents::new()));
        }
    }

    /// For each plane, the side on which a position is.
    fn flight_sides(scene: &Scene, at: DVec3) -> Vec<bool> {
        let planes = scene.bodies.iter().filter_map(|body| match body.shape {
            BodyShape::Plane(plane) => Some(plane.normal().dot(at - plane.point()) > 0.0),
            _ => None,
        });
        planes.collect()
    }

    #[test]
    fn the_player_rises_sinks_and_looks() {
        let mut flight = Flight::new(scene(0.0));
        (0..30).for_each(|_| flight.step(intents(&[Intent::Jump, Intent::LookUp])));
        assert!(flight.player.position.z > 1.0 && flight.player.elevation.degrees() > 10.0);
        (0..120).for_each(|_| flight.step(intents(&[Intent::Duck, Intent::LookDown])));
        assert!((flight.player.position.z - EYE_CLEARANCE).abs() < 1e-6);
        flight.step(intents(&[Intent::LookAhead]));
        assert_eq!(flight.player.elevation, Elevation::LEVEL);
        let before = flight.player.heading.degrees();
        flight.step(Intents::new().with_look(Look { turn: -1550, tilt: 2025 }));
        assert!((flight.player.elevation.degrees() - 20.25).abs() < 1e-12);
        assert!((flight.player.heading.degrees() - before - 344.5).abs() < 1e-9);
        flight.step(intents(&[Intent::LookAhead]));
        assert!((flight.elapsed() - 153.0 * STEP).abs() < 1e-12);
    }
}
