//! Where guards walk.

use proptest::prelude::*;

use super::*;
use crate::game::stored::checksum;

#[test]
fn a_patrol_goes_round_and_returns_to_it() {
    let mut scene = Scene::new(
        "###########\n#W..a.....#\n#.###.###.#\n#.###.###b#\n#...c....@#\n###########",
        "\"W\" = { guard = \"warden\", heading = 0, patrol = \"abc\" }\n\
         \"a\" = { waypoint = true }\n\"b\" = { waypoint = true }\n\"c\" = { waypoint = true }",
    );
    scene.target.is_alive = false;
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
fn stairs_are_climbed_and_pits_and_water_avoided() {
    let mut scene = Scene::new(
        "#########\n#W.012h.#\n#.p~~~~.#\n#@......#\n#########",
        "\"W\" = { guard = \"warden\", heading = 0 }",
    );
    scene.target.is_alive = false;
    let noise = |cell| Sound { kind: SoundKind::Knock, cell, reach: 20, by: Source::Object };
    scene.step(&[noise(cell(6, 1))]);
    let is_up = |scene: &Scene| scene.guard(0).feet == 0.9;
    scene.steps_until(600, is_up).unwrap();
    scene.step(&[noise(cell(4, 3))]);
    let mut lowest = f64::INFINITY;
    let is_there = |scene: &Scene| {
        lowest = lowest.min(scene.guard(0).feet);
        let here = scene.guards.list[0].mover.cell();
        assert_ne!(here.row, if (2..7).contains(&here.column) { 2 } else { 9 });
        scene.guard(0).position.distance(cell(4, 3).center()) < 0.5
    };
    scene.steps_until(1500, is_there).unwrap();
    assert_eq!(lowest, 0.0);
}

#[test]
fn guards_who_meet_in_a_corridor_pass() {
    let mut scene = Scene::new(
        "##########\n#V......W#\n####@#####\n##########",
        "\"V\" = { guard = \"warden\", heading = 0 }\n\"W\" = { guard = \"archer\", heading = 180 }",
    );
    scene.target.is_alive = false;
    for (index, column) in [(0, 8), (1, 1)] {
        scene.guards.list[index].post = cell(column, 1);
    }
    let have_passed =
        |scene: &Scene| scene.guard(0).position.x > 7.0 && scene.guard(1).position.x < 3.0;
    scene.steps_until(900, have_passed).unwrap();
}

#[test]
fn far_guards_walk_as_well() {
    let mut scene = Scene::new(
        &format!("{0}\n#W{1}@#\n{0}", "#".repeat(60), ".".repeat(56)),
        "\"W\" = { guard = \"warden\", heading = 0 }",
    );
    scene.guards.list[0].post = cell(9, 1);
    let arrived = scene.steps_until(600, |scene| scene.guard(0).position.x > 9.0).unwrap();
    // Eight cells at 1.2 cells a second.
    assert!((370..450).contains(&arrived), "{arrived}");
}

/// A room with random walls, steps, pits and water; the first two free cells are a guard's and the
/// player's.
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

/// Positions in cells that a player can be in.
fn open_cells(scene: &Scene) -> Vec<Cell> {
    let (width, height) = (scene.world.grid().width(), scene.world.grid().height());
    let cells = (0..height).flat_map(|row| (0..width).map(move |column| Cell { column, row }));
    cells.filter(|cell| !scene.world.grid().is_solid(cell.column.into(), cell.row.into())).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn guards_are_never_in_anything_solid_or_in_what_they_avoid(
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
                let here = scene.guards.list[0].mover.cell();
                prop_assert!(!scene.guards.terrain.is_hazard(&scene.world, here));
            }
        }
    }

    #[test]
    fn the_same_sounds_and_targets_give_the_same_guards(rows in maze(7), name in kind()) {
        let things = format!("\"G\" = {{ guard = \"{name}\", heading = 0, wander = 6 }}");
        let mut scenes = [0; 2].map(|_| Scene::new(&rows, &things));
        for _ in 0..300 {
            for scene in &mut scenes {
                scene.step(&[]);
            }
            let [one, other] = scenes.each_ref().map(|scene| checksum(&scene.guards));
            prop_assert_eq!(one, other);
        }
    }

    /// A guard who follows a player whom they can reach comes nearer in every two seconds, or is
    /// near already.
    #[test]
    fn nobody_is_stuck_while_following(
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
        let quarry = state::Quarry { target: 0, position: goal.center(), unseen: 0 };
        scene.guards.list[0].quarry = Some(quarry);
        scene.guards.list[0].state = State::Chasing { fright: 0 };
        let gait = scene.guards.list[0].gait();
        let mut best = u16::MAX;
        let mut since = 0;
        for _ in 0..900 {
            scene.step(&[]);
            let guard = &scene.guards.list[0];
            let from = guard.mover.cell();
            let near = guard.mover.position().distance(scene.target.position) < 2.2;
            if near || !guard.state.is_alarmed() {
                break;
            }
            let mut flood = crate::game::flood::Flood::default();
            flood.begin(goal, scene.guards.terrain.size());
            let (terrain, world) = (&scene.guards.terrain, &scene.world);
            let costs = terrain::Backwards { terrain, world, gait };
            while flood.advance(&costs) {}
            let Some(distance) = flood.distance(from) else { break };
            since = if distance < best { 0 } else { since + 1 };
            best = best.min(distance);
            prop_assert!(since < 120, "{:?} at {distance}", guard.mover);
        }
    }
}
