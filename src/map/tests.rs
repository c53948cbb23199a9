//! Maps with all mechanisms, guards and items.

use crate::map;
use crate::world::{
    Cell, Difficulty, Driver, Duty, GuardKind, Rhythm, Supply, ThingKind, TileEffect, TileKind,
    World,
};

const ALL: &str = r##"
par = 90
treasure_needed = 60
grid = '''
##################
#@.ghwl1.2.AHLSZD#
#t.uvpdfnc.ks.F..#
#%%##+############
#.====...........#
##################
'''
[tiles]
"#" = { wall = "brick" }
"%" = { secret = "brick", light = 0.5 }
"+" = { door = "metal", switch = "gate" }
"g" = { floor_height = -2, moves_to = 0, switch = "gate" }
"h" = { wall = "stone", switch = "gate" }
"w" = { water = true, floor_height = -0.25 }
"p" = { plate = "gate", floor = "wood" }
"=" = { floor = "wood", crumbles = -3 }
[things]
"@" = { start = 0 }
"l" = { lever = "gate" }
"1" = { waypoint = true }
"2" = { waypoint = true, on = "w" }
"A" = { guard = "warden", heading = 90, patrol = "21" }
"H" = { guard = "hound", asleep = true, difficulty = "hard" }
"L" = { guard = "lantern", wander = 8 }
"S" = { guard = "archer" }
"Z" = { guard = "listener", on = "w" }
"D" = { sprite = "barrel" }
"t" = { treasure = 24 }
"u" = { treasure = 99 }
"v" = { treasure = 100 }
"d" = { pebbles = 3 }
"f" = { darts = 1 }
"n" = { note = "One.\nTwo." }
"c" = { checkpoint = true }
"k" = { flasks = 2 }
"s" = { spikes = 2.0, delay = 0.5 }
"F" = { sprite = "torch", douse = true }
"##;

fn world() -> World {
    map::parse_str(ALL).unwrap()
}

fn cell(column: u32, row: u32) -> Cell {
    Cell { column, row }
}

#[test]
fn items_become_things() {
    let world = world();
    let kind = |column, row| world.things_in(cell(column, row))[0].kind;
    assert_eq!((world.par(), world.treasure_needed()), (Some(90), 60));
    assert_eq!([1, 3, 4].map(|column| kind(column, 2)), [24, 99, 100].map(ThingKind::Treasure));
    assert_eq!(kind(6, 2), ThingKind::Supply(Supply::Pebbles, 3));
    assert_eq!(kind(7, 2), ThingKind::Supply(Supply::Darts, 1));
    assert_eq!(kind(11, 2), ThingKind::Supply(Supply::Flasks, 2));
    assert_eq!(kind(9, 2), ThingKind::Checkpoint);
    assert_eq!(kind(12, 2), ThingKind::Spikes(Rhythm { period: 120, delay: 30 }));
    assert_eq!(kind(14, 2), ThingKind::Flame);
    let ThingKind::Note(note) = kind(8, 2) else { panic!("a note") };
    assert_eq!(world.note(note), "One.\nTwo.");
    let ThingKind::Lever(lever) = kind(6, 1) else { panic!("a lever") };
    assert_eq!((world.switch_name(lever), world.switch_count()), ("gate", 1));
    assert_eq!(world.effect_in(cell(5, 2)), Some(TileEffect::Plate(lever)));
    assert_eq!(world.door(cell(5, 3)).unwrap().switch, Some(lever));
    assert_eq!(world.effect_in(cell(5, 1)), Some(TileEffect::Water));
}

#[test]
fn guards_become_posts_rather_than_things() {
    let world = world();
    let [warden, hound, lantern, archer, listener] = world.guards() else { panic!("five guards") };
    assert_eq!((warden.kind, warden.heading.degrees()), (GuardKind::Warden, 90.0));
    assert_eq!(warden.duty, Duty::Patrol(vec![cell(9, 1), cell(7, 1)]));
    assert_eq!((hound.duty.clone(), hound.from), (Duty::Sleep, Difficulty::Hard));
    assert_eq!((lantern.duty.clone(), lantern.from), (Duty::Wander(8), Difficulty::Easy));
    assert_eq!((archer.kind, archer.duty.clone()), (GuardKind::Archer, Duty::Stand));
    assert_eq!((listener.kind, listener.cell), (GuardKind::Listener, cell(15, 1)));
    assert!([11, 12, 13, 14, 15].iter().all(|&it| world.things_in(cell(it, 1)).is_empty()));
    assert_eq!(world.effect_in(listener.cell), Some(TileEffect::Water));
}

#[test]
fn moving_tiles_pass_through_states_an_eighth_apart() {
    let world = world();
    let states = |column, row| {
        let drawn = world.grid().tile(column, row).unwrap();
        let moving = world.moving_tiles().iter().find(|it| it.states[0] == drawn).unwrap();
        let tiles: Vec<_> = moving.states.iter().map(|&id| world.tile(id)).collect();
        assert!(tiles.windows(2).all(|pair| {
            let way = pair[0].heights.floor() - pair[1].heights.floor();
            way.abs() <= 0.125 && way != 0.0
        }));
        let ends = [tiles[0], tiles[tiles.len() - 1]].map(|tile| tile.heights.floor());
        (moving.driver, ends, tiles)
    };
    let (driver, ends, _) = states(3, 1);
    assert_eq!((ends, world.switch_count()), ([-2.0, 0.0], 1));
    assert!(matches!(driver, Driver::Switch(_)));
    let (driver, ends, floors) = states(2, 4);
    assert_eq!((driver, ends), (Driver::Weight, [0.0, -3.0]));
    assert!(floors.iter().all(|tile| tile.kind == TileKind::Open));
    for (column, row) in [(4, 1), (1, 3)] {
        let (driver, ends, walls) = states(column, row);
        assert_eq!((driver == Driver::Hand, ends), (row == 3, [1.0, 0.0]));
        let (open, walls) = walls.split_last().unwrap();
        assert_eq!((walls.len(), open.kind), (8, TileKind::Open));
        assert!(walls.iter().all(|tile| matches!(tile.kind, TileKind::Wall(_))));
        assert!(walls.iter().all(|tile| tile.ceiling == open.ceiling));
    }
    assert_eq!(world.moving_tiles().len(), 4);
}

/// Returns whether the reader rejects a map because the key of its exit door is out of reach.
fn is_refused(grid: &str, things: &str) -> bool {
    let text = format!(
        "grid = '''\n{grid}\n'''\n[tiles]\n'#'.wall = 'brick'\n'%'.secret = 'brick'\n\
         '+' = {{ door = 'metal', switch = 'gate' }}\n'=' = {{ door = 'oak', key = 'brass' }}\n\
         'p'.plate = 'gate'\n[things]\n'@'.start = 0\n'k'.key = 'brass'\n'l'.lever = 'gate'\n{things}"
    );
    match map::parse_str(&text) {
        Ok(_) => false,
        Err(faults) => {
            assert!(faults.to_string().contains("cannot be reached"), "{faults}");
            true
        }
    }
}

#[test]
fn a_key_may_lie_behind_secrets_and_switches() {
    let room = |row: &str| format!("#########\n{row}\n###=#####\n#.......#\n#########");
    assert!(!is_refused(&room("#@..%..k#"), ""));
    assert!(!is_refused(&room("#@l.+..k#"), ""));
    assert!(is_refused(&room("#@..+.lk#"), ""));
    assert!(!is_refused(&room("#@p.+..k#"), ""));
    assert!(is_refused(&room("#@..+.pk#"), ""));
    assert!(!is_refused(&room("#@..+gpk#"), "'g'.guard = 'hound'"));
}
