//! Guards in small scenes.

use glam::DVec2;
use proptest::prelude::*;

use super::*;
use crate::game::doors::Doors;
use crate::map;
use crate::world::{Cell, Difficulty, Heading};

/// The tiles of all scenes.
const TILES: &str = r##"
[tiles]
"#" = { wall = "#808080" }
"+" = { door = "#a05020" }
"%" = { glass = "#80c0ff" }
"|" = { mask = "grate" }
"1" = { floor_height = 0.3, ceiling_height = 1.5 }
"2" = { floor_height = 0.6, ceiling_height = 2 }
"h" = { floor_height = 0.9, ceiling_height = 2 }
"0" = { ceiling_height = 1.5 }
"p" = { floor_height = -2 }
"~" = { water = true }
"##;

/// A game with guards only: a world, its doors, and one player that the test controls.
struct Scene {
    world: World,
    guards: Guards,
    doors: Doors,
    target: PerceivedPlayer,
    clouds: Vec<Cloud>,
    /// The effects of the guards in the last step.
    effects: Vec<GuardEffect>,
}

impl Scene {
    /// The scene that `rows` draw, with `things` in the syntax of maps. `@` is the player.
    fn new(rows: &str, things: &str) -> Self {
        Self::with_rules(rows, things, Rules::default())
    }

    fn with_rules(rows: &str, things: &str, rules: Rules) -> Self {
        let text = format!(
            "ceiling = \"#202028\"\nfloor = \"#404040\"\ngrid = '''\n{}\n'''\n{TILES}\n[things]\n\
             \"@\" = {{ start = 0 }}\n{things}\n",
            rows.trim()
        );
        let mut world = map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"));
        let guards = Guards::new(&mut world, rules);
        let cell = world.start().cell;
        let feet = world.floor_at(cell);
        let target = PerceivedPlayer {
            position: cell.center(),
            feet,
            head: feet + 0.7,
            visibility: 255,
            has_light: false,
            is_noticeable: true,
        };
        let (doors, clouds, effects) = (Doors::default(), Vec::new(), Vec::new());
        Self { world, guards, doors, target, clouds, effects }
    }

    fn step(&mut self, sounds: &[Sound]) {
        let effects = self.guards.step(&self.world, &[self.target], sounds, &self.clouds);
        self.effects = effects.to_vec();
        for effect in &self.effects {
            if let GuardEffect::Open(cell) = effect {
                self.doors.open(*cell);
            }
        }
        let (position, guards) = (self.target.position, &self.guards);
        let is_occupied = |cell| overlaps(position, cell, RADIUS) || guards.touches(cell);
        self.doors.step(&mut self.world, is_occupied);
    }

    /// Steps until `is_it` returns true, at most `most` times. Returns the number of steps, or
    /// `None`.
    fn steps_until(&mut self, most: u32, mut is_it: impl FnMut(&Self) -> bool) -> Option<u32> {
        (1..=most).find(|_| {
            self.step(&[]);
            is_it(self)
        })
    }

    fn guard(&self, index: usize) -> GuardView {
        self.guards.views().nth(index).unwrap()
    }

    fn mood(&self, index: usize) -> Mood {
        self.guard(index).mood
    }

    fn is_alarmed(&self) -> bool {
        self.guards.alarm() == Alarm::Raised
    }

    fn has_sounded(&self, kind: SoundKind) -> bool {
        self.effects
            .iter()
            .any(|effect| matches!(effect, GuardEffect::Sound(sound) if sound.kind == kind))
    }

    fn put(&mut self, x: f64, y: f64) {
        self.target.position = DVec2::new(x, y);
    }

    /// A sound that the player makes.
    fn sound(&self, kind: SoundKind, reach: u8) -> Sound {
        Sound { kind, cell: self.target.cell(), reach, by: Source::Player(0) }
    }

    /// Whether every guard's body has room.
    fn is_sound(&self) -> bool {
        self.guards.list.iter().all(|guard| {
            let ground = GuardWorld {
                world: &self.world,
                terrain: &self.guards.terrain,
                gait: guard.gait(),
            };
            ground.has_room_for(&guard.motion)
        })
    }
}

fn degrees(heading: Heading) -> f64 {
    heading.degrees()
}

fn cell(column: u32, row: u32) -> Cell {
    Cell { column, row }
}

fn on(difficulty: Difficulty) -> Rules {
    Rules { difficulty, seed: 0 }
}

// Seeing.

/// A corridor of sixteen cells, with a warden at its west end.
fn corridor(heading: u32) -> Scene {
    let warden = format!("\"W\" = {{ guard = \"warden\", heading = {heading} }}");
    Scene::new("##################\n#W.......@.......#\n##################", &warden)
}

#[test]
fn a_player_behind_a_guard_is_not_seen() {
    let mut scene = corridor(180);
    scene.put(2.8, 1.5);
    // A guard who looks around does not look backwards.
    let alarmed = scene.steps_until(600, |scene| scene.mood(0) != Mood::OnDuty);
    assert_eq!(alarmed, None);
}

#[test]
fn a_lit_player_at_eight_cells_is_noticed_then_followed() {
    let mut scene = corridor(0);
    let noticed = scene.steps_until(600, |scene| scene.mood(0) == Mood::Wondering).unwrap();
    assert!(scene.has_sounded(SoundKind::Wonder));
    let more = scene.steps_until(600, Scene::is_alarmed).unwrap();
    assert!(scene.has_sounded(SoundKind::Shout));
    assert!((20..90).contains(&noticed), "{noticed}");
    assert!((30..240).contains(&more), "{more}");
    assert!(scene.effects.contains(&GuardEffect::Raised));
}

#[test]
fn guards_follow_no_sooner_than_half_a_second_after_noticing() {
    for column in 2..11 {
        let mut scene = corridor(0);
        scene.put(f64::from(column) + 1.3, 1.5);
        let noticed = scene.steps_until(900, |scene| scene.mood(0) != Mood::OnDuty).unwrap();
        if !scene.is_alarmed() {
            let more = scene.steps_until(900, Scene::is_alarmed).unwrap();
            assert!(more >= 30, "{column}: {noticed} and {more}");
        }
    }
}

#[test]
fn a_player_face_to_face_cannot_hide() {
    let mut scene = corridor(0);
    scene.put(2.5, 1.5);
    scene.target.visibility = 0;
    assert!(scene.steps_until(5, Scene::is_alarmed).is_some());
}

#[test]
fn a_player_in_the_dark_is_not_seen_from_afar() {
    let mut scene = corridor(0);
    scene.target.visibility = 20;
    assert_eq!(scene.steps_until(900, |scene| scene.mood(0) != Mood::OnDuty), None);
    scene.target.has_light = true;
    assert!(scene.steps_until(900, Scene::is_alarmed).is_some());
}

#[test]
fn near_and_bright_players_are_noticed_sooner() {
    let steps = |x: f64, visibility| {
        let mut scene = corridor(0);
        scene.put(x, 1.5);
        scene.target.visibility = visibility;
        scene.steps_until(2000, |scene| scene.mood(0) == Mood::Wondering).unwrap_or(2000)
    };
    let by_distance: Vec<u32> = (4..11).map(|x| steps(f64::from(x), 255)).collect();
    assert!(by_distance.is_sorted(), "{by_distance:?}");
    let by_light = [255, 200, 120, 60, 20].map(|light| steps(6.5, light));
    assert!(by_light.is_sorted() && by_light[0] < by_light[3], "{by_light:?}");
}

#[test]
fn doors_and_smoke_hide_a_player_and_glass_and_masks_do_not() {
    let alarmed = |between: char, clouds: &[Cloud]| {
        let rows = format!("##########\n#W..{between}..@.#\n##########");
        let mut scene = Scene::new(&rows, r#""W" = { guard = "warden", heading = 0 }"#);
        scene.clouds = clouds.to_vec();
        scene.steps_until(600, Scene::is_alarmed).is_some()
    };
    for transparent in ['.', '%', '|'] {
        assert!(alarmed(transparent, &[]), "{transparent}");
    }
    assert!(!alarmed('+', &[]) && !alarmed('#', &[]));
    let smoke = Cloud { position: DVec2::new(4.5, 1.5), radius: 1.5 };
    assert!(!alarmed('.', &[smoke]));
    let elsewhere = Cloud { position: DVec2::new(4.5, 4.5), ..smoke };
    assert!(alarmed('.', &[elsewhere]));
}

#[test]
fn guards_leave_a_dead_player_alone() {
    let mut scene = corridor(0);
    scene.steps_until(600, Scene::is_alarmed).unwrap();
    scene.target.is_noticeable = false;
    scene.steps_until(60, |scene| !scene.is_alarmed()).unwrap();
    assert_eq!(scene.steps_until(600, Scene::is_alarmed), None);
}

#[test]
fn a_guard_sees_and_wakes_a_fallen_guard() {
    let mut scene = Scene::new(
        "##########\n#W....L..#\n#.......@#\n##########",
        "\"W\" = { guard = \"warden\", heading = 0 }\n\"L\" = { guard = \"listener\", heading = 0 }",
    );
    scene.target.is_noticeable = false;
    scene.guards.stun(1, 1200);
    assert!(scene.guard(1).is_down);
    scene.steps_until(200, |scene| scene.mood(0) == Mood::Wondering).unwrap();
    scene.steps_until(600, |scene| !scene.guard(1).is_down).unwrap();
    assert_eq!([0, 1].map(|index| scene.mood(index)), [Mood::Searching; 2]);
}

#[test]
fn a_stunned_guard_gets_up_unaided() {
    let mut scene = corridor(0);
    scene.target.is_noticeable = false;
    scene.guards.stun(0, 100);
    (0..95).for_each(|_| scene.step(&[]));
    assert!(scene.guard(0).is_down);
    scene.steps_until(10, |scene| !scene.guard(0).is_down).unwrap();
    assert_eq!(scene.mood(0), Mood::Searching);
}

// Hearing and calling.

const GUARDS: &str = r#"
"W" = { guard = "warden", heading = 180 }
"A" = { guard = "archer", heading = 180 }
"L" = { guard = "listener", heading = 180 }
"S" = { guard = "warden", heading = 180, asleep = true }
"#;

/// A guard behind a wall with a doorway, or a door.
fn rooms(guard: char, doorway: char) -> Scene {
    let rows = [
        "###########".to_owned(),
        format!("#.@..#..{guard}.#"),
        format!("#....{doorway}....#"),
        "#....#....#".to_owned(),
        "###########".to_owned(),
    ];
    Scene::new(&rows.join("\n"), &used(&rows))
}

/// The definitions of the guards that occur in `rows`.
fn used(rows: &[String]) -> String {
    let is_used = |line: &&str| {
        let name = line.chars().nth(1);
        name.is_some_and(|name| rows.iter().any(|row| row.contains(name)))
    };
    GUARDS.lines().filter(is_used).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_noise_is_heard_through_a_doorway_but_not_through_a_wall() {
    for (doorway, is_heard) in [('.', true), ('#', false), ('+', false)] {
        let mut scene = rooms('W', doorway);
        let knock = Sound { by: Source::Object, ..scene.sound(SoundKind::Knock, 8) };
        scene.step(&[knock]);
        assert_eq!(scene.mood(0) == Mood::Wondering, is_heard, "{doorway}");
        assert_eq!(scene.has_sounded(SoundKind::Wonder), is_heard);
    }
}

#[test]
fn a_guard_turns_to_a_noise_then_investigates_and_returns() {
    let mut scene = rooms('W', '.');
    scene.target.is_noticeable = false;
    let at_first = scene.guard(0).position;
    let noise = Sound { by: Source::Object, ..scene.sound(SoundKind::Knock, 8) };
    scene.step(&[noise]);
    let has_left = |scene: &Scene| scene.guard(0).position.distance(at_first) > 0.2;
    let turning = scene.steps_until(200, has_left).unwrap();
    assert!(turning >= 40, "{turning}");
    let place = noise.cell.center();
    scene.steps_until(600, |scene| scene.guard(0).position.distance(place) < 0.5).unwrap();
    scene.steps_until(900, |scene| scene.has_sounded(SoundKind::GiveUp)).unwrap();
    assert_eq!(scene.mood(0), Mood::Returning);
    scene.steps_until(900, |scene| scene.guard(0).position.distance(at_first) < 0.35).unwrap();
    let heading = |scene: &Scene| (degrees(scene.guard(0).heading) - 180.0).abs() < 1.0;
    scene.steps_until(900, heading).unwrap();
    assert_eq!(scene.guards.alarm(), Alarm::Calm);
}

#[test]
fn only_nearby_noise_wakes_sleepers() {
    let mut scene = rooms('S', '.');
    scene.target.is_noticeable = false;
    scene.steps_until(5, |scene| scene.guards.are_at_rest()).unwrap();
    scene.step(&[scene.sound(SoundKind::Running, 7)]);
    assert_eq!(scene.mood(0), Mood::Asleep);
    scene.put(7.5, 3.5);
    scene.step(&[scene.sound(SoundKind::Running, 7)]);
    assert_eq!(scene.mood(0), Mood::Wondering);
}

#[test]
fn a_listener_follows_footsteps_but_not_silence() {
    let mut scene = rooms('L', '.');
    scene.put(4.5, 2.5);
    for _ in 0..300 {
        scene.step(&[]);
    }
    assert_eq!(scene.mood(0), Mood::OnDuty);
    let mut steps = 0;
    while !scene.is_alarmed() {
        let sounds = [scene.sound(SoundKind::Running, 7)];
        scene.step(if steps % 14 == 0 { &sounds } else { &[] });
        steps += 1;
        assert!(steps < 120);
    }
    let place = scene.target.position;
    scene.put(1.5, 1.5);
    scene.steps_until(300, |scene| scene.guard(0).position.distance(place) < 0.5).unwrap();
    scene.steps_until(900, |scene| scene.mood(0) == Mood::Searching).unwrap();
}

#[test]
fn a_shout_brings_guards_in_earshot_except_on_easy() {
    for (difficulty, comes) in [(Difficulty::Easy, false), (Difficulty::Normal, true)] {
        let mut scene = Scene::with_rules(
            "#############\n#@...A.#...W#\n#......#....#\n#...........#\n#############",
            "\"A\" = { guard = \"archer\", heading = 180 }\n\"W\" = { guard = \"warden\", heading = 0 }",
            on(difficulty),
        );
        scene.steps_until(300, Scene::is_alarmed).unwrap();
        scene.step(&[]);
        assert_eq!(scene.mood(1) == Mood::Wondering, comes, "{difficulty:?}");
        if comes {
            let place = scene.target.position;
            scene.steps_until(600, |scene| scene.guard(1).position.distance(place) < 5.0).unwrap();
        }
    }
}

#[test]
fn guards_sound_weaker_behind_doors() {
    use crate::game::sound::Hearing;
    for (doorway, strength) in [('.', Some(1)), ('+', None), ('#', None)] {
        let scene = rooms('W', doorway);
        let mut hearing = Hearing::default();
        let sound =
            Sound { kind: SoundKind::Shout, cell: cell(8, 1), reach: 9, by: Source::Guard(0) };
        let changed = hearing.step(&scene.world, 0, scene.target.position, &[sound]);
        assert_eq!(changed, strength.is_some());
        assert_eq!(hearing.heard.first().map(|heard| heard.strength), strength);
        if let Some(heard) = hearing.heard.first() {
            assert_eq!(heard.bearing.degrees(), 0.0);
            let mut hears = || hearing.step(&scene.world, 0, scene.target.position, &[]);
            assert!((1..45).all(|_| !hears()) && hears());
            assert!(hearing.heard.is_empty());
        }
    }
}

// Walking.

#[test]
fn a_patrol_circles_and_resumes_after_a_noise() {
    let mut scene = Scene::new(
        "###########\n#W..a.....#\n#.###.###.#\n#.###.###b#\n#...c....@#\n###########",
        "\"W\" = { guard = \"warden\", heading = 0, patrol = \"abc\" }\n\
         \"a\" = { waypoint = true }\n\"b\" = { waypoint = true }\n\"c\" = { waypoint = true }",
    );
    scene.target.is_noticeable = false;
    let stops = [cell(4, 1), cell(9, 3), cell(4, 4)];
    let is_at =
        |stop: Cell| move |scene: &Scene| scene.guard(0).position.distance(stop.center()) < 0.4;
    for stop in stops.into_iter().cycle().take(5) {
        scene.steps_until(900, is_at(stop)).unwrap();
    }
    let noise = Sound { cell: cell(1, 1), by: Source::Object, ..scene.sound(SoundKind::Knock, 20) };
    scene.step(&[noise]);
    assert_eq!(scene.mood(0), Mood::Wondering);
    scene.steps_until(3000, |scene| scene.mood(0) == Mood::OnDuty).unwrap();
    for stop in [stops[2], stops[0]] {
        scene.steps_until(1500, is_at(stop)).unwrap();
    }
}

#[test]
fn guards_climb_stairs_and_avoid_pits_and_water() {
    let mut scene = Scene::new(
        "#########\n#W.012h.#\n#.p~~~~.#\n#@......#\n#########",
        "\"W\" = { guard = \"warden\", heading = 0 }",
    );
    scene.target.is_noticeable = false;
    let noise = |cell| Sound { kind: SoundKind::Knock, cell, reach: 20, by: Source::Object };
    scene.step(&[noise(cell(6, 1))]);
    let is_up = |scene: &Scene| scene.guard(0).feet == 0.9;
    scene.steps_until(600, is_up).unwrap();
    scene.step(&[noise(cell(4, 3))]);
    let mut lowest = f64::INFINITY;
    let is_there = |scene: &Scene| {
        lowest = lowest.min(scene.guard(0).feet);
        let here = scene.guards.list[0].motion.cell();
        assert_ne!(here.row, if (2..7).contains(&here.column) { 2 } else { 9 });
        scene.guard(0).position.distance(cell(4, 3).center()) < 0.5
    };
    scene.steps_until(1500, is_there).unwrap();
    assert_eq!(lowest, 0.0);
}

#[test]
fn guards_pass_each_other_in_a_corridor() {
    let mut scene = Scene::new(
        "##########\n#V......W#\n####@#####\n##########",
        "\"V\" = { guard = \"warden\", heading = 0 }\n\"W\" = { guard = \"archer\", heading = 180 }",
    );
    scene.target.is_noticeable = false;
    for (index, column) in [(0, 8), (1, 1)] {
        scene.guards.list[index].post = cell(column, 1);
    }
    let have_passed =
        |scene: &Scene| scene.guard(0).position.x > 7.0 && scene.guard(1).position.x < 3.0;
    scene.steps_until(900, have_passed).unwrap();
}

#[test]
fn far_guards_walk_too() {
    let mut scene = Scene::new(
        &format!("{0}\n#W{1}@#\n{0}", "#".repeat(60), ".".repeat(56)),
        "\"W\" = { guard = \"warden\", heading = 0 }",
    );
    scene.guards.list[0].post = cell(9, 1);
    let arrived = scene.steps_until(600, |scene| scene.guard(0).position.x > 9.0).unwrap();
    // Eight cells at 1.2 cells a second.
    assert!((370..450).contains(&arrived), "{arrived}");
}

/// A room with random walls, steps, pits and water. The guard is in the first cell, the player in
/// the last.
fn maze(side: usize) -> impl Strategy<Value = String> {
    let tile = prop_oneof![
        9 => Just('.'),
        4 => Just('#'),
        1 => Just('1'),
        1 => Just('p'),
        1 => Just('~'),
        1 => Just('2'),
    ];
    prop::collection::vec(tile, side * side).prop_map(move |tiles| {
        let mut tiles = tiles;
        tiles[0] = 'G';
        tiles[side * side - 1] = '@';
        let edge = "#".repeat(side + 2);
        let rows = tiles.chunks(side).map(|row| format!("#{}#", row.iter().collect::<String>()));
        [vec![edge.clone()], rows.collect(), vec![edge]].concat().join("\n")
    })
}

fn kind() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec!["warden", "listener", "lantern", "hound", "archer"])
}

/// The cells that a player can be in.
fn open_cells(scene: &Scene) -> Vec<Cell> {
    let (width, height) = (scene.world.grid().width(), scene.world.grid().height());
    let cells = (0..height).flat_map(|row| (0..width).map(move |column| Cell { column, row }));
    cells.filter(|cell| !scene.world.grid().is_solid(cell.column.into(), cell.row.into())).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn guards_never_enter_solid_or_avoided_cells(
        rows in maze(8),
        name in kind(),
        moves in prop::collection::vec((0..1000_usize, 1..40_u32, 0..5_u32), 1..12),
    ) {
        let things = format!("\"G\" = {{ guard = \"{name}\", heading = 0, wander = 6 }}");
        let mut scene = Scene::new(&rows, &things);
        let cells = open_cells(&scene);
        for (place, steps, deed) in moves {
            let at = cells[place % cells.len()];
            (scene.target.position, scene.target.feet) = (at.center(), scene.world.floor_at(at));
            scene.target.head = scene.target.feet + 0.7;
            match deed {
                0 => scene.guards.push(0, DVec2::new(0.6, -0.8)),
                1 => scene.guards.stun(0, 20),
                _ => {}
            }
            let sounds = [scene.sound(SoundKind::Running, 12)];
            for step in 0..steps * 3 {
                scene.step(if step % 15 == 0 { &sounds } else { &[] });
                prop_assert!(scene.is_sound(), "{:?}", scene.guard(0));
                let here = scene.guards.list[0].motion.cell();
                prop_assert!(!scene.guards.terrain.is_hazard(&scene.world, here));
            }
        }
    }

    /// A guard who follows a reachable player comes nearer every two seconds, or is already near.
    #[test]
    fn a_following_guard_never_gets_stuck(
        walls in prop::collection::vec(prop::bool::weighted(0.3), 100),
        name in prop::sample::select(vec!["warden", "hound", "listener"]),
    ) {
        let rows: Vec<String> = walls.chunks(10).enumerate().map(|(row, walls)| {
            let tile = |(column, &wall): (usize, &bool)| match (row, column) {
                (0, 0) => 'G',
                (9, 9) => '@',
                _ if wall => '#',
                _ => '.',
            };
            format!("#{}#", walls.iter().enumerate().map(tile).collect::<String>())
        }).collect();
        let rows = format!("{0}\n{1}\n{0}", "#".repeat(12), rows.join("\n"));
        let things = format!("\"G\" = {{ guard = \"{name}\", heading = 0 }}");
        let mut scene = Scene::new(&rows, &things);
        let goal = scene.target.cell();
        let quarry = guard::KnownPlayer { target: 0, position: goal.center(), unseen: 0 };
        scene.guards.list[0].quarry = Some(quarry);
        scene.guards.list[0].state = GuardActivity::Chasing { fright: 0 };
        let gait = scene.guards.list[0].gait();
        let mut best = u16::MAX;
        let mut since = 0;
        for _ in 0..900 {
            scene.step(&[]);
            let guard = &scene.guards.list[0];
            let from = guard.motion.cell();
            let near = guard.motion.position().distance(scene.target.position) < 2.2;
            if near || !guard.state.is_alarmed() {
                break;
            }
            let mut known = crate::game::distances::Distances::default();
            known.begin(goal, scene.guards.terrain.size);
            let (terrain, world) = (&scene.guards.terrain, &scene.world);
            let costs = ways::ReverseCosts { terrain, world, gait };
            while known.advance(&costs) {}
            let Some(distance) = known.distance(from) else { break };
            since = if distance < best { 0 } else { since + 1 };
            best = best.min(distance);
            prop_assert!(since < 120, "{:?} at {distance}", guard.motion);
        }
    }
}

// Chasing and striking.

const WARDEN: &str = r#""W" = { guard = "warden", heading = 0 }"#;

/// The number of steps between the warning and the blow, for a guard next to the player.
fn warning(name: &str) -> u32 {
    let things = format!("\"W\" = {{ guard = \"{name}\", heading = 0 }}");
    let mut scene = Scene::new("######\n#W.@.#\n######", &things);
    scene.put(2.4, 1.5);
    let told =
        |scene: &Scene| scene.has_sounded(SoundKind::Windup) || scene.has_sounded(SoundKind::Draw);
    scene.steps_until(900, told).unwrap();
    let is_blow = |effect: &GuardEffect| {
        matches!(effect, GuardEffect::Hurt { .. } | GuardEffect::Bolt { .. })
    };
    let mut frames = Vec::new();
    let steps = scene.steps_until(200, |scene| {
        frames.push(scene.guards.list[0].frame());
        scene.effects.iter().any(is_blow)
    });
    assert!(frames[..23].iter().all(|&frame| frame == 4), "{name}: {frames:?}");
    steps.unwrap()
}

#[test]
fn blows_are_announced_at_least_24_steps_ahead() {
    for name in ["warden", "lantern", "hound", "archer"] {
        assert!(warning(name) >= 24, "{name}");
    }
    assert!(warning("warden") >= 48);
}

#[test]
fn a_player_who_steps_aside_is_not_hit() {
    let mut scene = Scene::new("########\n#W.@...#\n#......#\n########", WARDEN);
    scene.put(2.4, 1.5);
    scene.steps_until(900, |scene| scene.mood(0) == Mood::Attacking).unwrap();
    scene.put(4.9, 2.5);
    let hurt = |scene: &Scene| {
        scene.effects.iter().any(|effect| matches!(effect, GuardEffect::Hurt { .. }))
    };
    assert_eq!(scene.steps_until(70, hurt), None);
}

#[test]
fn a_guard_opens_doors_on_the_way_and_a_hound_does_not() {
    for (name, gets_there) in [("warden", true), ("hound", false)] {
        let things = format!("\"W\" = {{ guard = \"{name}\", heading = 0 }}");
        let mut scene = Scene::new("##########\n#W..+...@#\n##########", &things);
        scene.target.is_noticeable = false;
        let noise = Sound { by: Source::Object, ..scene.sound(SoundKind::Knock, 24) };
        scene.step(&[noise]);
        let is_there = |scene: &Scene| scene.guard(0).position.x > 7.0;
        assert_eq!(scene.steps_until(900, is_there).is_some(), gets_there, "{name}");
    }
}

#[test]
fn a_hound_gives_up_the_trail_of_a_player_who_has_left() {
    let hound = r#""H" = { guard = "hound", heading = 180 }"#;
    let mut scene = Scene::new("##########\n#@......H#\n##########", hound);
    let gone = PerceivedPlayer { position: DVec2::new(6.5, 1.5), visibility: 0, ..scene.target };
    scene.target.is_noticeable = false;
    scene.guards.step(&scene.world, &[scene.target, gone], &[], &[]);
    scene.guards.list[0].state = GuardActivity::Tracking { target: 1, mark: 0, lost: 0 };
    scene.guards.forget_player(1);
    scene.step(&[]);
    assert_eq!(scene.mood(0), Mood::Returning);
}

#[test]
fn a_hound_follows_the_trail_around_a_corner_and_stops_at_a_door() {
    let mut scene = Scene::new(
        "##########\n#@...H...#\n#.########\n#...+....#\n##########",
        r#""H" = { guard = "hound", heading = 0 }"#,
    );
    // The player walks past behind the hound, around the corner and through the door.
    let way = [(4.5, 1.5), (1.5, 1.5), (1.5, 3.5), (3.5, 3.5)];
    let mut position = DVec2::new(4.5, 1.5);
    for place in way.map(DVec2::from) {
        while position.distance(place) > 0.1 {
            position += (place - position).normalize() * 0.09;
            scene.put(position.x, position.y);
            scene.step(&[]);
        }
    }
    scene.put(7.5, 3.5);
    let is_at_the_door =
        |scene: &Scene| scene.guard(0).position.distance(cell(3, 3).center()) < 0.7;
    scene.steps_until(900, is_at_the_door).unwrap();
    // The trail lasts for twenty seconds.
    scene.steps_until(2400, |scene| scene.has_sounded(SoundKind::GiveUp)).unwrap();
    assert!(scene.guard(0).position.x < 4.0 || scene.guard(0).position.y < 2.0);
}

#[test]
fn an_archer_keeps_its_distance_and_shoots_along_the_line() {
    let mut scene = Scene::new(
        "##############\n#....A..@....#\n#............#\n##############",
        r#""A" = { guard = "archer", heading = 0 }"#,
    );
    scene.put(7.0, 1.5);
    scene.steps_until(600, Scene::is_alarmed).unwrap();
    let mut shots = 0;
    for _ in 0..1200 {
        scene.step(&[]);
        for effect in &scene.effects {
            if let &GuardEffect::Bolt { from, height, direction, slope, .. } = effect {
                let distance = (scene.target.position - from).dot(direction);
                let meets = from + direction * distance;
                assert!(meets.distance(scene.target.position) < 0.05);
                let middle = scene.target.middle();
                assert!((height + slope * distance - middle).abs() < 0.05);
                shots += 1;
            }
        }
    }
    assert!(shots >= 3, "{shots}");
    assert!(scene.guard(0).position.distance(scene.target.position) >= 3.5);
}

#[test]
fn a_lantern_bearer_rings_the_bell_first() {
    let mut scene = Scene::new(
        "###########\n#N..@.....#\n#.........#\n#######.###\n#.........#\n#.......A.#\n###########",
        "\"N\" = { guard = \"lantern\", heading = 0 }\n\"A\" = { guard = \"archer\", heading = 90 }",
    );
    scene.steps_until(600, Scene::is_alarmed).unwrap();
    assert!(scene.has_sounded(SoundKind::Bell));
    scene.steps_until(600, |scene| scene.mood(1) >= Mood::Chasing).unwrap();
    assert_eq!(scene.guards.lamps().count(), 1);
    scene.guards.stun(0, 60);
    assert_eq!(scene.guards.lamps().count(), 0);
}

#[test]
fn a_guard_who_loses_a_player_searches_and_gives_up() {
    let mut scene =
        Scene::new("############\n#W...@.....#\n####.#######\n#..........#\n############", WARDEN);
    scene.steps_until(600, Scene::is_alarmed).unwrap();
    scene.guards.list[0].quarry.as_mut().unwrap().unseen = 100;
    scene.put(10.5, 3.5);
    scene.target.visibility = 0;
    scene.steps_until(900, |scene| scene.mood(0) == Mood::Searching).unwrap();
    let steps = scene.steps_until(2000, |scene| scene.has_sounded(SoundKind::GiveUp)).unwrap();
    assert!((540..=960).contains(&steps), "{steps}");
}

#[test]
fn guards_who_cannot_reach_a_player_give_up() {
    let mut scene = Scene::new("##########\n#W..p..@.#\n#...p....#\n##########", WARDEN);
    scene.steps_until(600, Scene::is_alarmed).unwrap();
    scene.steps_until(900, |scene| scene.mood(0) == Mood::Searching).unwrap();
    assert!(scene.guard(0).feet == 0.0 && scene.is_sound());
}

#[test]
fn a_push_stops_a_blow() {
    let mut scene = Scene::new("########\n#..W@..#\n########", WARDEN);
    scene.steps_until(600, |scene| scene.mood(0) == Mood::Attacking).unwrap();
    let before = scene.guard(0).position;
    scene.guards.push(0, -DVec2::X);
    let hurt = |scene: &Scene| {
        scene.effects.iter().any(|effect| matches!(effect, GuardEffect::Hurt { .. }))
    };
    assert_eq!(scene.steps_until(30, hurt), None);
    assert!(scene.guard(0).position.x < before.x - 0.3);
}

#[test]
fn tools_find_the_guard_in_front_of_the_player() {
    let scene = Scene::new("########\n#@.W...#\n########", WARDEN);
    let near = |direction, reach| {
        scene.guards.guard_near(&scene.world, scene.target.position, direction, reach, 0.5)
    };
    assert_eq!(near(DVec2::X, 2.5), Some(0));
    assert_eq!([near(DVec2::X, 1.0), near(-DVec2::X, 2.5)], [None; 2]);
    let eye = (scene.target.position, 0.5);
    let aimed = scene.guards.aim(&scene.world, &[], eye, DVec2::X, 0.9).unwrap();
    assert_eq!(aimed.0, DVec2::new(3.5, 1.5));
    assert_eq!(scene.guards.hit_between(eye, (DVec2::new(6.0, 1.5), 0.5)), Some(0));
    assert_eq!(scene.guards.hit_between(eye, (DVec2::new(6.0, 1.5), 3.5)), None);
    assert!(scene.guards.is_behind(0, scene.target.position) && scene.guards.is_unaware(0));
}
