//! What happens: a player walks through a world, in fixed steps, finds keys, opens doors, and reaches
//! the exit.
//!
//! A step lasts [`STEP`] seconds whatever the machine does meanwhile, and takes nothing but
//! [`Intents`]: the same intents give the same states, bit for bit, on every machine. Steps as long
//! as the frame took were refused, since a slow machine would then play another game than a fast
//! one, and no walk could be repeated.

mod collision;
mod doors;
mod flight;
mod intent;
mod motion;
mod notice;
mod player;

use std::collections::BTreeSet;

use crate::world::{Camera, Cell, Door, FieldOfView, KeyId, ThingKind, World};
use doors::{Doors, door_ahead};
use notice::Notice;
use player::{AIM, FRICTION, Player, RUN, STILL, TURN, TURN_FRICTION, WALK};

pub use flight::Flight;
pub use intent::{Intent, Intents};
#[cfg(feature = "accuracy")]
pub(crate) use motion::approach;

/// How long one step lasts, in seconds.
pub const STEP: f64 = 1.0 / 60.0;

/// A world, who walks in it, and for how long they have.
#[derive(Clone, Debug, PartialEq)]
pub struct Game {
    world: World,
    player: Player,
    doors: Doors,
    keys: BTreeSet<KeyId>,
    notice: Notice,
    steps: u64,
    revision: u64,
}

impl Game {
    /// A game at its beginning: the player stands still at the world's start.
    pub fn new(world: World) -> Self {
        Self {
            player: Player::new(world.start()),
            world,
            doors: Doors::default(),
            keys: BTreeSet::new(),
            notice: Notice::default(),
            steps: 0,
            revision: 0,
        }
    }

    /// Where the game takes place, as it is now: with its doors as far open as they are, and without
    /// the keys that were taken.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// What the player sees.
    #[expect(clippy::missing_panics_doc, reason = "the player stands inside the map")]
    pub fn camera(&self, field_of_view: FieldOfView) -> Camera {
        Camera::new(self.player.position(), self.player.heading(), field_of_view)
            .expect("the player stands inside the map, where all places are finite")
    }

    /// Seconds that have passed in the game, counted in steps.
    pub fn elapsed(&self) -> f64 {
        self.steps as f64 * STEP
    }

    /// What there is to tell the player, such as why a door does not open; for a few seconds.
    pub fn message(&self) -> Option<&str> {
        self.notice.text()
    }

    /// The names of the keys that the player has found.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.keys.iter().map(|&key| self.world.key_name(key))
    }

    /// A number that grows whenever anything changes that can be seen, other than what the camera
    /// tells: a door moves, a key is taken, there is something else to tell.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Whether the player has reached the exit's cell. Nothing moves after that, nor does the clock.
    pub fn is_finished(&self) -> bool {
        let cell = self.player.cell();
        self.world.things().iter().any(|thing| thing.kind == ThingKind::Exit && thing.cell == cell)
    }

    /// Whether steps with these intents, however many, would change nothing but the clock: the player
    /// stands still and wants no more, or pushes against what does not give way, all doors are closed,
    /// and nothing is being told.
    pub fn is_at_rest(&self, intents: Intents) -> bool {
        self.quiet_steps(intents) == u64::MAX
    }

    /// For how many steps with these intents nothing happens but that clocks run: the game's own, and
    /// those of doors that wait to close and of what is being told. [`u64::MAX`] where the game is [at
    /// rest](Game::is_at_rest).
    pub fn quiet_steps(&self, intents: Intents) -> u64 {
        if self.is_finished() {
            return u64::MAX;
        }
        if self.player.stepped(self.world.grid(), intents) != self.player {
            return 0;
        }
        if self.door_wanted(intents).is_some_and(|(cell, door)| self.would_answer(cell, door)) {
            return 0;
        }
        let waits = [self.doors.quiet_steps(), self.notice.quiet_steps()];
        waits.into_iter().flatten().min().unwrap_or(u64::MAX)
    }

    /// Lets one step pass, of [`STEP`] seconds, in which the player wants what `intents` says.
    pub fn step(&mut self, intents: Intents) {
        if self.is_finished() {
            return;
        }
        self.player = self.player.stepped(self.world.grid(), intents);
        self.take_keys();
        let is_silent = self.notice.wait(1);
        let player = self.player;
        let has_moved = self.doors.step(&mut self.world, |cell| player.touches(cell));
        self.revision += u64::from(is_silent) + u64::from(has_moved);
        if let Some((cell, door)) = self.door_wanted(intents) {
            self.try_to_open(cell, door);
        }
        self.steps = self.steps.saturating_add(1);
    }

    /// Lets the clocks run for `steps` steps in which nobody moves: all that as many calls of
    /// [`Game::step`] do where there are no more of them than [`Game::quiet_steps`].
    pub fn wait(&mut self, steps: u64) {
        if !self.is_finished() {
            self.steps = self.steps.saturating_add(steps);
            self.doors.wait(steps);
            self.notice.wait(steps);
        }
    }

    /// The door that the player is before, if they want to open it or to walk through it.
    fn door_wanted(&self, intents: Intents) -> Option<(Cell, Door)> {
        if self.world.is_of_walls() {
            return None;
        }
        let looking = intents.contains(Intent::Open).then(|| self.player.heading().direction());
        let directions = [looking, self.player.wanted_direction(intents)];
        let position = self.player.position();
        directions.into_iter().flatten().find_map(|way| door_ahead(&self.world, position, way))
    }

    fn can_open(&self, door: Door) -> bool {
        door.key.is_none_or(|key| self.keys.contains(&key))
    }

    fn try_to_open(&mut self, cell: Cell, door: Door) {
        if self.can_open(door) {
            self.doors.open(cell);
        } else {
            self.say(self.refusal(door));
        }
    }

    /// Whether [`Game::try_to_open`] would change anything.
    fn would_answer(&self, cell: Cell, door: Door) -> bool {
        if self.can_open(door) {
            self.doors.would_open(cell)
        } else {
            self.notice.text() != Some(&self.refusal(door))
        }
    }

    fn say(&mut self, text: String) {
        if self.notice.text() != Some(&text) {
            self.notice = Notice::new(text);
            self.revision += 1;
        }
    }

    /// What a locked door says to who does not have its key.
    fn refusal(&self, door: Door) -> String {
        let name = door.key.map_or("right", |key| self.world.key_name(key));
        format!("This door needs the {name} key.")
    }

    /// Takes the keys in the player's cell.
    fn take_keys(&mut self) {
        let cell = self.player.cell();
        let found = self.world.things().iter().find_map(|thing| match thing.kind {
            ThingKind::Key(key) if thing.cell == cell => Some(key),
            _ => None,
        });
        if let Some(key) = found {
            self.keys.insert(key);
            self.world.take_things(cell, |kind| kind == ThingKind::Key(key));
            self.revision += 1;
            self.say(format!("You have the {} key.", self.world.key_name(key)));
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use super::*;
    use crate::world::{
        Ceiling, Cell, Covering, Grid, Heading, Paint, Parts, Rgb, Sky, Start, Thing, Tile,
        TileKind,
    };

    /// A world drawn in characters: `#` is solid, `@` is where the player starts, `E` is an exit.
    fn world(rows: &[&str], degrees: f64) -> World {
        let cells_that_hold = |wanted: char| {
            rows.iter().zip(0..).flat_map(move |(line, row)| {
                let columns = line.chars().zip(0..).filter(move |&(found, _)| found == wanted);
                columns.map(move |(_, column)| Cell { column, row })
            })
        };
        let floors: Vec<String> = rows.iter().map(|row| row.replace(['@', 'E'], ".")).collect();
        let floors: Vec<&str> = floors.iter().map(String::as_str).collect();
        let gray = Paint::Color(Rgb::new(128, 128, 128));
        let (floor, ceiling) = (Covering::from(gray), Ceiling::Covered(gray.into()));
        let tile = |character, kind| Tile { character, kind, floor, ceiling, light: None };
        World::from_parts(Parts {
            title: String::new(),
            grid: Grid::sketch(&floors).unwrap(),
            tiles: vec![tile('.', TileKind::Open), tile('#', TileKind::Wall(gray))],
            textures: vec![],
            floor,
            ceiling,
            sky: Sky::default(),
            fog: None,
            start: Start {
                cell: cells_that_hold('@').next().unwrap(),
                heading: Heading::from_degrees(degrees).unwrap(),
            },
            things: cells_that_hold('E')
                .map(|cell| Thing { kind: ThingKind::Exit, cell })
                .collect(),
            keys: vec![],
        })
    }

    const CELLAR: [&str; 7] = [
        "##########",
        "#@...#...#",
        "#....#.#.#",
        "#.##...#.#",
        "#....#.#.#",
        "#..#.....#",
        "##########",
    ];

    fn intents(list: &[Intent]) -> Intents {
        list.iter().copied().collect()
    }

    fn walk(game: &mut Game, steps: usize, list: &[Intent]) {
        for _ in 0..steps {
            game.step(intents(list));
        }
    }

    fn position(game: &Game) -> DVec2 {
        game.camera(FieldOfView::default()).position()
    }

    fn to_nearest_wall(grid: &Grid, point: DVec2) -> f64 {
        let cells = (0..grid.height()).flat_map(|row| (0..grid.width()).map(move |c| (c, row)));
        cells
            .filter(|&(column, row)| grid.is_solid(column.into(), row.into()))
            .map(|(column, row)| Cell { column, row }.center())
            .map(|middle| point.distance(point.clamp(middle - 0.5, middle + 0.5)))
            .fold(f64::INFINITY, f64::min)
    }

    /// Intents that are held for a few steps each.
    fn script() -> impl Strategy<Value = Vec<(usize, Vec<Intent>)>> {
        let held = prop::sample::subsequence(Intent::ALL.to_vec(), 0..=Intent::ALL.len());
        prop::collection::vec((1..60_usize, held), 0..30)
    }

    proptest! {
        #[test]
        fn the_same_intents_give_the_same_states(script in script(), degrees in 0.0..360.0) {
            let mut games = [0; 2].map(|_| Game::new(world(&CELLAR, degrees)));
            for (steps, held) in &script {
                for game in &mut games {
                    walk(game, *steps, held);
                }
            }
            let [one, other] = games.map(|game| position(&game).to_array().map(f64::to_bits));
            prop_assert_eq!(one, other);
        }

        #[test]
        fn nobody_enters_a_wall_or_outruns_a_runner(script in script(), degrees in 0.0..360.0) {
            let mut game = Game::new(world(&CELLAR, degrees));
            for held in script.iter().flat_map(|(steps, held)| vec![held; *steps]) {
                let before = position(&game);
                walk(&mut game, 1, held);
                let after = position(&game);
                prop_assert!(before.distance(after) <= 5.5 * STEP * (1.0 + 1e-12));
                prop_assert!(to_nearest_wall(game.world().grid(), after) >= 0.25 - 1e-12);
            }
        }

        #[test]
        fn who_wants_nothing_comes_to_rest(script in script(), degrees in 0.0..360.0) {
            let mut game = Game::new(world(&CELLAR, degrees));
            for (steps, held) in &script {
                walk(&mut game, *steps, held);
            }
            walk(&mut game, 120, &[]);
            prop_assert!(game.is_at_rest(Intents::new()));
            prop_assert!(game.is_at_rest(intents(&[Intent::Run])));

            let mut waiting = game.clone();
            walk(&mut game, 1000, &[]);
            waiting.wait(1000);
            prop_assert_eq!(game, waiting);
        }

        #[test]
        fn who_pushes_into_a_corner_comes_to_rest(degrees in 1.0..89.0) {
            let mut game = Game::new(world(&["####", "#@.#", "#..#", "####"], degrees));
            walk(&mut game, 60 * 60, &[Intent::Forward]);
            prop_assert!(game.is_at_rest(intents(&[Intent::Forward])));
            prop_assert!(!game.is_at_rest(intents(&[Intent::Back])));
            prop_assert_eq!(position(&game), DVec2::new(2.75, 2.75));
        }
    }

    #[test]
    fn a_second_of_walking_and_of_turning() {
        let row = format!("@{}", ".".repeat(20));
        for (gait, speed) in [(&[][..], 3.0), (&[Intent::Run], 5.5)] {
            let mut game = Game::new(world(&[&row], 0.0));
            walk(&mut game, 60, &[&[Intent::Forward], gait].concat());
            let before = position(&game);
            walk(&mut game, 60, &[&[Intent::Forward], gait].concat());
            assert!((position(&game) - before - DVec2::new(speed, 0.0)).length() < 1e-4);
        }
        let mut game = Game::new(world(&["@"], 0.0));
        walk(&mut game, 60, &[Intent::TurnRight]);
        let heading = game.camera(FieldOfView::default()).heading.degrees();
        assert!((heading - (2.4_f64 - 2.4 / 20.0).to_degrees()).abs() < 1e-6, "{heading}");
        assert!(!game.is_at_rest(Intents::new()));
        assert!((game.elapsed() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_wall_keeps_no_speed() {
        let mut game = Game::new(world(&["@....#"], 0.0));
        walk(&mut game, 600, &[Intent::Forward, Intent::Run]);
        assert_eq!(position(&game), DVec2::new(4.75, 0.5));
        assert!(game.is_at_rest(Intents::new()));
        assert!(game.is_at_rest(intents(&[Intent::Forward])));
    }

    #[test]
    fn the_exit_ends_the_game() {
        let mut game = Game::new(world(&["@..E..."], 0.0));
        let forward = [Intent::Forward];
        while !game.is_finished() {
            assert!(position(&game).x < 3.0 && !game.is_at_rest(intents(&forward)));
            walk(&mut game, 1, &forward);
        }
        assert!((3.0..3.1).contains(&position(&game).x));

        let end = game.clone();
        assert!(game.is_at_rest(intents(&forward)));
        walk(&mut game, 60, &forward);
        game.wait(60);
        assert_eq!(game, end);
    }

    #[test]
    fn a_walk_ends_at_the_same_place_on_every_machine() {
        use Intent::{Back, Forward, Run, StrafeLeft, StrafeRight, TurnLeft, TurnRight};
        let mut game = Game::new(world(&CELLAR, 17.0));
        let script: [(usize, &[Intent]); 7] = [
            (50, &[Forward]),
            (25, &[Forward, TurnRight, Run]),
            (90, &[Forward, StrafeLeft]),
            (31, &[TurnLeft, Run, StrafeRight]),
            (77, &[Forward, Run]),
            (13, &[Back, TurnRight]),
            (5, &[]),
        ];
        for (steps, held) in script {
            walk(&mut game, steps, held);
        }
        let camera = game.camera(FieldOfView::default());
        insta::assert_debug_snapshot!(
            (camera.position().to_array(), camera.direction().to_array()),
            @r"
        (
            [
                8.203787533664316,
                5.624213200187348,
            ],
            [
                0.8502489054169883,
                0.5263808496110145,
            ],
        )
        "
        );
    }
}
