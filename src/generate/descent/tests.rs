//! Properties of floors.

use std::collections::{BTreeSet, VecDeque};
use std::fmt::Write;

use glam::DVec2;
use proptest::prelude::*;

use super::*;
use crate::cast::{Caster, Exact, Ray};
use crate::game::is_exit_out_of_reach;
use crate::world::{Cell, Difficulty, Duty, GuardKind, ThingKind, TileKind};

/// The cells that can be reached from the start by steps along the grid, including through doors.
fn reachable(world: &World) -> BTreeSet<(u32, u32)> {
    let is_open = |column: u32, row: u32| {
        let (column, row) = (i64::from(column), i64::from(row));
        let grid = world.grid();
        let Some(tile) = grid.tile(column, row) else { return false };
        let is_door = matches!(world.tile(tile).kind, TileKind::Door(door) if door.key.is_none());
        (is_door || !grid.is_solid(column, row)) && !grid.is_occupied(column, row)
    };
    let start = (world.start().cell.column, world.start().cell.row);
    let mut seen = BTreeSet::from([start]);
    let mut queue = VecDeque::from([start]);
    while let Some((column, row)) = queue.pop_front() {
        for next in [(column - 1, row), (column + 1, row), (column, row - 1), (column, row + 1)] {
            if is_open(next.0, next.1) && seen.insert(next) {
                queue.push_back(next);
            }
        }
    }
    seen
}

/// The cells of the items, the exit, the guards and their waypoints.
fn places(world: &World) -> Vec<Cell> {
    let items = world.things().iter().filter(|thing| thing.kind != ThingKind::Ornament);
    let guards = world.guards().iter().flat_map(|post| {
        let waypoints = match &post.duty {
            Duty::Patrol(cells) => &cells[..],
            _ => &[],
        };
        waypoints.iter().copied().chain([post.cell])
    });
    items.map(|thing| thing.cell).chain(guards).collect()
}

fn treasure(world: &World) -> u32 {
    let worth = |kind| if let ThingKind::Treasure(worth) = kind { u32::from(worth) } else { 0 };
    world.things().iter().map(|thing| worth(thing.kind)).sum()
}

fn floors() -> impl Strategy<Value = u32> {
    prop_oneof![8 => 1..16_u32, 1 => Just(u32::MAX)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn a_floor_can_be_won(seed: u64, floor in floors()) {
        let world = descent(seed, floor).unwrap();
        let reached = reachable(&world);
        for cell in places(&world) {
            prop_assert!(reached.contains(&(cell.column, cell.row)), "{cell:?}");
        }
        let exits = world.things().iter().filter(|thing| thing.kind == ThingKind::Exit).count();
        prop_assert_eq!(exits, 1);
        prop_assert!(!is_exit_out_of_reach(&world));
        prop_assert!((30..600).contains(&world.par().unwrap()));
        let needed = world.treasure_needed();
        prop_assert!(needed > 0 && needed <= treasure(&world));
    }

    #[test]
    fn an_office_has_few_wide_open_areas(seed: u64, floor in 1..16_u32) {
        prop_assume!(kind(seed, floor) == Generator::Office);
        let world = descent(seed, floor).unwrap();
        let is_opaque = |column: u32, row: u32| {
            let tile = world.grid().tile(column.into(), row.into()).unwrap();
            matches!(world.tile(tile).kind, TileKind::Wall(_) | TileKind::Mirror(_) | TileKind::Door(_))
        };
        let reached = reachable(&world);
        let is_open = |&&(column, row): &&(u32, u32)| {
            (row - 1..=row + 1).all(|row| (column - 1..=column + 1).all(|it| !is_opaque(it, row)))
        };
        let open = reached.iter().filter(is_open).count();
        prop_assert!(open * 100 <= reached.len() * 42, "{open} of {}", reached.len());
    }

    #[test]
    fn the_same_seed_gives_the_same_floor(seed: u64, floor in floors()) {
        let world = descent(seed, floor).unwrap();
        prop_assert_eq!(&world, &descent(seed, floor).unwrap());
        prop_assert_ne!(&world, &descent(seed, floor % 16 + 1).unwrap());
        prop_assert_ne!(&world, &descent(seed ^ 1, floor).unwrap());
    }
}

proptest! {
    // Lines along corners are rare, so this needs many cases.
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn guards_start_apart_and_out_of_sight(seed: u64, floor in floors()) {
        let world = descent(seed, floor).unwrap();
        let start = world.start().cell.center();
        prop_assert!(world.guards().iter().any(|post| post.from == Difficulty::Easy));
        let mut cells = BTreeSet::new();
        for post in world.guards() {
            prop_assert!(cells.insert((post.cell.column, post.cell.row)), "two in {:?}", post.cell);
            let distance = post.cell.center().distance(start);
            prop_assert!(distance >= f64::from(population::GUARD_DISTANCE), "{distance} cells");
            for aside in [(0.0, 0.0), (-0.3, -0.3), (0.3, 0.3), (-0.3, 0.3), (0.3, -0.3)] {
                let to = post.cell.center() + DVec2::from(aside) - start;
                let hit = Exact.cast(world.grid(), &Ray::new(start, to).unwrap());
                let is_seen = hit.is_none_or(|hit| hit.t >= 1.0);
                prop_assert!(!is_seen, "{:?} sees the start", post.cell);
            }
        }
    }
}

#[test]
fn floors_grow_harder() {
    let on = |floor: u32| (0..20).map(move |seed| descent(seed, floor).unwrap());
    let mean = |floor: u32, count: fn(&World) -> usize| {
        on(floor).map(|world| count(&world)).sum::<usize>() / 20
    };
    let cells = |world: &World| (world.grid().width() * world.grid().height()) as usize;
    let easy =
        |world: &World| world.guards().iter().filter(|post| post.from == Difficulty::Easy).count();
    let figures = [1, 2, 3, 5, 8, 12, 20].map(|floor| {
        let all = mean(floor, |world| world.guards().len());
        (floor, mean(floor, cells), mean(floor, easy), all, mean(floor, |it| treasure(it) as usize))
    });
    insta::assert_debug_snapshot!(figures);
    assert!(figures.windows(2).all(|pair| pair[0].2 <= pair[1].2 && pair[0].4 <= pair[1].4));
    // Each of the first floors introduces its own kind of guard.
    for (floor, kind) in (1..).zip([
        GuardKind::Warden,
        GuardKind::Listener,
        GuardKind::Hound,
        GuardKind::Lantern,
        GuardKind::Archer,
    ]) {
        assert!(on(floor).all(|world| world.guards().iter().any(|post| post.kind == kind)));
    }
}

/// Scripts recorded on a floor must stay valid, so this snapshot may change only with a new version
/// of the descent.
#[test]
fn floors_never_change() {
    let drawn = [(20_261_122, 1), (20_261_122, 2), (20_261_122, 3), (7, 9)]
        .map(|(seed, floor)| drawing(&descent(seed, floor).unwrap()));
    insta::assert_snapshot!(drawn.join("\n"));
}

/// The floor as text: `@` start, `X` exit, `$` treasure, `i` other items, `1` to `9` guards, `'`
/// waypoints, `+` doors, `#` cells that block the way.
fn drawing(world: &World) -> String {
    let grid = world.grid();
    let mut rows: Vec<Vec<char>> = (0..grid.height())
        .map(|row| (0..grid.width()).map(|column| character(world, Cell { column, row })).collect())
        .collect();
    let mut legend = String::new();
    for (number, post) in (1..).zip(world.guards()) {
        if let Duty::Patrol(cells) = &post.duty {
            for cell in cells {
                rows[cell.row as usize][cell.column as usize] = '\'';
            }
        }
        let digit = char::from_digit(number, 36).unwrap_or('?');
        _ = write!(legend, "{digit} {:?} {:?} ", post.kind, post.from);
        legend += match post.duty {
            Duty::Stand => "stands\n",
            Duty::Sleep => "sleeps\n",
            Duty::Wander(_) => "wanders\n",
            Duty::Patrol(_) => "patrols\n",
        };
    }
    for (number, post) in (1..).zip(world.guards()) {
        rows[post.cell.row as usize][post.cell.column as usize] =
            char::from_digit(number, 36).unwrap_or('?');
    }
    let rows: String =
        rows.into_iter().map(|row| row.into_iter().collect::<String>() + "\n").collect();
    let (par, needed) = (world.par().unwrap(), world.treasure_needed());
    format!(
        "{}, par {par} s, treasure {needed} of {}\n{rows}{legend}",
        world.title(),
        treasure(world)
    )
}

fn character(world: &World, cell: Cell) -> char {
    if cell == world.start().cell {
        return '@';
    }
    let (column, row) = (i64::from(cell.column), i64::from(cell.row));
    let mut things = world.things_in(cell).iter().filter_map(|thing| match thing.kind {
        ThingKind::Exit => Some('X'),
        ThingKind::Treasure(_) => Some('$'),
        ThingKind::Ornament => None,
        _ => Some('i'),
    });
    let kind = world.grid().tile(column, row).map(|tile| world.tile(tile).kind);
    let is_blocked = world.grid().is_solid(column, row) || world.grid().is_occupied(column, row);
    things.next_back().unwrap_or(match kind {
        Some(TileKind::Door(_)) => '+',
        _ if is_blocked => '#',
        _ => '.',
    })
}
