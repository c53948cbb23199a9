//! The cost of a step with guards, and of a copy of the game.
//!
//! `cargo bench -p cellcaster-lab --bench guards`, on maps of 160 × 90 cells. A quarter of the
//! cells are walls. The player runs in circles, so guards who follow always have a new goal. An
//! iteration is one step of the whole game. The step without guards is the cost of everything else.

use std::hint::black_box;
use std::time::{Duration, Instant};

use cellcaster::game::{Alarm, Game, Input, Intent, Intents, MultiplayerRules, PlayerColor, Rules};
use cellcaster::map::{self, builtin};
use cellcaster::world::World;
use criterion::{Criterion, criterion_group, criterion_main};

const COLUMNS: u64 = 160;
const ROWS: u64 = 90;

/// The behaviour of a map's guards.
#[derive(Clone, Copy, PartialEq)]
enum Deed {
    Chase,
    Sleep,
    FarPatrol,
}

/// A map with `count` guards. Guards who chase are around the player, the others in the east.
fn world(count: u64, deed: Deed) -> World {
    let middle = (COLUMNS / 4, ROWS / 2);
    let mut left = count;
    let mut grid = String::new();
    for row in 0..ROWS {
        grid.push('\n');
        for column in 0..COLUMNS {
            let is_edge = column == 0 || row == 0 || column == COLUMNS - 1 || row == ROWS - 1;
            let is_wall = column % 4 == 0 && row % 4 != 1;
            let apart = (column.abs_diff(middle.0), row.abs_diff(middle.1));
            let is_post = match deed {
                Deed::Chase => apart.0.max(apart.1) <= 6 && (row + column) % 2 == 1,
                Deed::Sleep | Deed::FarPatrol => column > 120 && row % 4 == 1 && column % 4 == 1,
            };
            grid.push(match () {
                () if is_edge => '#',
                () if apart.0.max(apart.1) <= 1 => {
                    if apart == (0, 0) {
                        '@'
                    } else {
                        '.'
                    }
                }
                () if is_wall => '#',
                () if is_post && left > 0 => {
                    left -= 1;
                    'G'
                }
                () => '.',
            });
        }
    }
    assert_eq!(left, 0, "there is room for all guards");
    let duty = match deed {
        Deed::Chase => "",
        Deed::Sleep => ", asleep = true",
        Deed::FarPatrol => ", wander = 8",
    };
    let guard = if count > 0 {
        format!("'G' = {{ guard = 'warden', heading = 180{duty} }}")
    } else {
        String::new()
    };
    let text = format!(
        "grid = '''{grid}\n'''\n[tiles]\n'#' = {{ wall = 'brick' }}\n\
         [things]\n'@' = {{ start = 0 }}\n{guard}\n"
    );
    map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
}

fn circling() -> Intents {
    [Intent::Forward, Intent::Run, Intent::TurnRight].into_iter().collect()
}

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("a step");
    for (name, count, deed) in [
        ("no guards", 0, Deed::Chase),
        ("20 chasing", 20, Deed::Chase),
        ("20 asleep, far", 20, Deed::Sleep),
        ("20 wandering, far", 20, Deed::FarPatrol),
    ] {
        let mut game = Game::new(world(count, deed));
        let is_chase = deed == Deed::Chase && count > 0;
        let mut waited = 0;
        while if is_chase { game.alarm() < Alarm::Raised } else { waited < 60 } {
            game.step(circling());
            waited += 1;
            assert!(waited < 2000, "{name}: nobody notices the player");
        }
        // A shout is heard one step later.
        game.step(circling());
        // Guards who chase soon kill the player. Then the game begins again, which is not measured.
        let begun = game.clone();
        group.bench_function(name, |bencher| {
            bencher.iter_custom(|steps| {
                let mut time = Duration::ZERO;
                let mut left = steps;
                while left > 0 {
                    if is_chase {
                        game = begun.clone();
                    }
                    let count = if is_chase { left.min(120) } else { left };
                    let start = Instant::now();
                    (0..count).for_each(|_| game.step(black_box(circling())));
                    time += start.elapsed();
                    left -= count;
                }
                time
            });
        });
        let chasing = game.guards().filter(|guard| guard.mood >= cellcaster::game::Mood::Wondering);
        println!("{name}: {} of {count} alert at the end", chasing.count());
    }
    group.finish();
}

/// The same with eight players who run in circles from one place, and who collide or walk through
/// each other.
fn steps_of_several(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("a step of 8 players");
    for (name, count, collides) in [
        ("no guards", 0, false),
        ("no guards, colliding", 0, true),
        ("20 guards", 20, false),
        ("20 guards, colliding", 20, true),
    ] {
        let rules = MultiplayerRules { collides, ..MultiplayerRules::default() };
        let mut game = Game::for_players(world(count, Deed::Chase), Rules::default(), rules);
        let players = PlayerColor::ALL.map(|color| game.join(color).expect("there is room"));
        let step = |game: &mut Game| {
            let seen = game.steps();
            game.step_all(&players.map(|player| Input { player, intents: circling(), seen }));
        };
        (0..60).for_each(|_| step(&mut game));
        let begun = game.clone();
        let mut left = 0;
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                if left == 0 {
                    (game, left) = (begun.clone(), 120);
                }
                left -= 1;
                step(black_box(&mut game));
            });
        });
        group.bench_function(format!("{name}: a copy"), |bencher| bencher.iter(|| begun.clone()));
    }
    group.finish();
}

/// A copy of the game, as for a checkpoint, after half a minute in which guards search for paths.
fn copies(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("a copy");
    let cells = |world: &World| world.grid().width() * world.grid().height();
    let levels = builtin::LEVELS.iter().filter_map(|level| level.world().ok());
    let largest = levels.filter(World::is_mission).max_by_key(cells).expect("there are levels");
    for (name, world) in [
        ("largest level", largest),
        ("no guards", world(0, Deed::Sleep)),
        ("20 wandering, far", world(20, Deed::FarPatrol)),
    ] {
        let mut game = Game::new(world);
        (0..1800).for_each(|_| game.step(circling()));
        group.bench_function(name, |bencher| bencher.iter(|| black_box(&game).clone()));
        println!("{name}: {} cells", cells(game.world()));
    }
    group.finish();
}

criterion_group!(benches, steps, copies, steps_of_several);
criterion_main!(benches);
