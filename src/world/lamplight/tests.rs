use proptest::prelude::*;

use super::*;
use crate::cast::{Ray, Walk};
use crate::map;
use crate::render::{Frame, FrameSize, PixelAspect, Renderer};
use crate::world::{FieldOfView, Opening};

const SIDE: u32 = 10;

const DOOR: Cell = Cell { column: 2, row: SIDE / 2 };

/// A dim map of walls, grates, a row with a door, torches that reach 3 cells and lamps that reach 6.
fn world(mut cells: Vec<char>) -> World {
    let door = (DOOR.row * SIDE + DOOR.column) as usize;
    cells[door] = '.';
    cells[door - SIDE as usize] = '@';
    let mut rows: Vec<String> =
        cells.chunks(SIDE as usize).map(|row| row.iter().collect()).collect();
    rows.insert(DOOR.row as usize, "##+#######".to_owned());
    let rows = rows.join("\n");
    let text = format!(
        "light = 0.1\ngrid = '''\n{rows}\n'''\n[tiles]\n'#' = {{ wall = 'brick' }}\n\
         '%' = {{ mask = 'grate' }}\n'+' = {{ door = 'oak' }}\n[things]\n'@' = {{ start = 0 }}\n\
         't' = {{ sprite = 'torch', light = 0.5, reach = 3 }}\n\
         'l' = {{ sprite = 'lamp', light = 0.3, reach = 6 }}\n"
    );
    let mut world = map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"));
    let torches: Vec<Cell> = world.things().iter().map(|thing| thing.cell).collect();
    for cell in torches {
        world.things.in_cell_mut(cell)[0].kind = ThingKind::Flame;
    }
    world
}

/// The light that a lamp adds in a cell, computed from the line between the two alone.
fn share(world: &World, (place, lamp): (Cell, Lamp), cell: Cell, carrier: Carrier) -> u32 {
    let way = cell.center() - place.center();
    let passes = |tile: TileId| match world.tile(tile).kind {
        TileKind::Open | TileKind::Mask(_) => true,
        TileKind::Doorway(_) => carrier == Carrier::Mover,
        _ => false,
    };
    let is_lit = Ray::new(place.center(), way).map_or(true, |ray| {
        let mut lit = Walk::new(world.grid(), &ray).take_while(|crossing| passes(crossing.tile));
        lit.any(|crossing| crossing.cell == cell)
    });
    if is_lit { lamp.light_at(way.length()).in_256ths() } else { 0 }
}

/// The lamplight in `cell`, as the sum of all lamps.
fn sum(world: &World, moving: &[(Cell, Lamp)], cell: Cell) -> u32 {
    let lamp = |thing: &Thing| Some((thing.cell, world.sprite(thing.sprite).lamp?));
    let burning = world.things().iter().filter(|thing| thing.frame.is_none()).filter_map(lamp);
    let of_things = burning.map(|lamp| share(world, lamp, cell, Carrier::Thing));
    let of_movers = moving.iter().map(|&lamp| share(world, lamp, cell, Carrier::Mover));
    of_things.chain(of_movers).sum::<u32>().min(256)
}

/// An event that changes the light.
#[derive(Clone, Debug)]
enum Event {
    Move(Vec<(Cell, Lamp)>),
    Flame(Cell, bool),
    Wall(Cell, bool),
    Door(bool),
    Take(Cell),
}

fn cell() -> impl Strategy<Value = Cell> {
    (0..SIDE, 0..=SIDE).prop_map(|(column, row)| Cell { column, row })
}

fn lamp() -> impl Strategy<Value = Lamp> {
    const KINDS: [(f64, f64); 3] = [(0.4, 4.0), (0.7, 4.0), (1.0, 2.5)];
    prop::sample::select(&KINDS[..]).prop_map(|(light, reach)| Lamp {
        light: Light::new(light).unwrap(),
        reach: Reach::new(reach).unwrap(),
    })
}

fn event() -> impl Strategy<Value = Event> {
    let moving = prop::collection::vec((cell(), lamp()), 0..4);
    prop_oneof![
        3 => moving.prop_map(Event::Move),
        2 => (cell(), any::<bool>()).prop_map(|(cell, burns)| Event::Flame(cell, burns)),
        2 => (cell(), any::<bool>()).prop_map(|(cell, stands)| Event::Wall(cell, stands)),
        1 => any::<bool>().prop_map(Event::Door),
        1 => cell().prop_map(Event::Take),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn light_is_the_sum_of_all_lamps_after_any_events(
        cells in prop::collection::vec(
            prop::sample::select(&['.', '.', '.', '.', 't', 'l', '#', '%'][..]),
            (SIDE * SIDE) as usize,
        ),
        events in prop::collection::vec(event(), 1..12),
    ) {
        let mut world = world(cells);
        let all = (0..=SIDE).flat_map(|row| (0..SIDE).map(move |column| Cell { column, row }));
        let all: Vec<Cell> = all.collect();
        let mut moving = Vec::new();
        for event in events {
            match event.clone() {
                Event::Move(lamps) => {
                    world.set_moving_lamps(lamps.iter().copied());
                    moving = lamps;
                }
                Event::Flame(cell, burns) => {
                    let before = world.things_in(cell).to_vec();
                    world.set_flame(cell, burns);
                    let frames = world.things_in(cell).iter().map(|thing| thing.frame.is_none());
                    prop_assert!(frames.eq(before.iter().map(|_| burns)));
                }
                Event::Wall(cell, stands) if world.door(cell).is_none() => {
                    let kind = |tile: &Tile| matches!(tile.kind, TileKind::Wall(_)) == stands;
                    let state = world.tiles().iter().position(kind).unwrap();
                    world.set_tile(cell, TileId(state as u8));
                }
                Event::Wall(..) => {}
                Event::Door(opens) => {
                    let opening = if opens { Opening::OPEN } else { Opening::new(0.5).unwrap() };
                    world.set_opening(DOOR, opening);
                }
                Event::Take(cell) => world.take_things(cell, |_| true),
            }
            for &cell in &all {
                let light = world.lamplight_in(cell).in_256ths();
                prop_assert_eq!(light, sum(&world, &moving, cell), "{:?} after {:?}", cell, event);
            }
        }
    }
}

#[test]
fn lamps_change_nothing_in_a_fully_lit_world() {
    let text =
        "grid = '''\n#####\n#@..#\n#####\n'''\ntiles.'#'.wall = 'brick'\nthings.'@'.start = 0\n";
    let mut world = map::parse_str(text).unwrap();
    let before = world.clone();
    let lamp = Lamp { light: Light::FULL, reach: Reach::default() };
    world.set_moving_lamps([(world.start().cell, lamp)].into_iter());
    assert!(world == before && !world.has_lamplight());
}

#[test]
fn a_lamp_carried_into_a_dim_level_lights_it() {
    let text = "light = 0.1\ngrid = '''\n#####\n#@..#\n#####\n'''\n\
                tiles.'#'.wall = 'brick'\nthings.'@'.start = 0\n";
    let mut world = map::parse_str(text).unwrap();
    let cell = world.start().cell;
    let before = world.light_in(cell);
    assert!(!world.has_lamplight());
    let lamp = Lamp { light: Light::new(0.5).unwrap(), reach: Reach::default() };
    world.set_moving_lamps([(cell, lamp)].into_iter());
    assert_eq!(world.light_in(cell), before.plus(lamp.light));
    assert_eq!(world.light_in(Cell { column: 3, row: 1 }), before.plus(lamp.light_at(2.0)));
    world.set_moving_lamps([(Cell { column: 90, row: 1 }, lamp)].into_iter());
    assert_eq!(world.light_in(cell), before, "off the map it lights nothing");
}

#[test]
fn a_flame_that_is_out_neither_shines_nor_flickers() {
    let text = "light = 0.1\ngrid = '''\n#####\n#@.t#\n#####\n'''\n[tiles]\n'#' = { wall = 'brick' }\n\
                [things]\n'@' = { start = 0 }\n't' = { sprite = 'torch' }\n";
    let mut world = map::parse_str(text).unwrap();
    let cell = world.things()[0].cell;
    world.things.in_cell_mut(cell)[0].kind = ThingKind::Flame;
    let camera = world.start_camera(FieldOfView::default());
    let mut renderer = Renderer::new();
    let mut draw = |world: &World, seconds| {
        let mut frame = Frame::new(FrameSize::new(48, 32).unwrap(), PixelAspect::SQUARE);
        renderer.set_time(seconds);
        renderer.render(world, &camera, &mut frame);
        (frame, renderer.next_change())
    };
    let burning = draw(&world, 0.0);
    assert!(burning.1.is_some());
    world.set_flame(cell, false);
    assert_eq!(world.light_in(cell), Light::new(0.1).unwrap());
    let out = draw(&world, 0.0);
    assert!(out.0 != burning.0 && out == draw(&world, 0.7));
    assert_eq!(out.1, None);
    world.set_flame(cell, true);
    assert!(draw(&world, 0.0) == burning);
}

mod lines {
    use std::collections::BTreeMap;
    use std::num::NonZeroU32;

    use proptest::prelude::*;

    use super::super::*;
    use crate::cast::{Ray, Walk};

    #[test]
    fn a_reach_in_whole_cells_excludes_the_last() {
        let counts =
            [1.0, 1.5, 2.0, 4.0, 32.0].map(|cells| Reach::new(cells).unwrap().cell_count());
        assert_eq!(counts, [1, 9, 9, 45, 3205]);
    }

    #[test]
    fn a_lamp_is_brightest_in_its_cell_and_ends_at_its_reach() {
        let lamp = Lamp { light: Light::new(0.5).unwrap(), reach: Reach::default() };
        let lights = [0.0, 1.0, 2.0, 3.0, 3.9, 4.0, 9.0].map(|cells| lamp.light_at(cells));
        assert_eq!(lights[0], lamp.light);
        assert!(lights.windows(2).all(|pair| pair[0].in_256ths() >= pair[1].in_256ths()));
        assert_eq!(lights[5..], [Light::NONE; 2]);
    }

    /// Returns whether the line from the middle of one cell to the middle of another leads through
    /// open floor.
    fn is_seen(grid: &Grid, from: Cell, to: Cell) -> bool {
        let Ok(ray) = Ray::new(from.center(), to.center() - from.center()) else { return true };
        let mut open = Walk::new(grid, &ray).take_while(|it| !grid.is_solid_tile(it.tile));
        open.any(|crossing| crossing.cell == to)
    }

    proptest! {
        #[test]
        fn a_lamp_lights_cells_in_line_of_sight(
            width in 1_u32..24,
            solid in prop::collection::vec(prop::bool::weighted(0.2), 24 * 24),
            height in 1_u32..24,
            place in any::<prop::sample::Index>(),
            reach in prop_oneof![1.0..=32.0, (1..=32_u32).prop_map(f64::from)],
        ) {
            let place = place.index((width * height) as usize) as u32;
            let place = Cell { column: place % width, row: place / width };
            let cells: Vec<TileId> = (0..height * width)
                .map(|index| TileId(u8::from(solid[index as usize])))
                .collect();
            let sides = [width, height].map(|side| NonZeroU32::new(side).unwrap());
            let grid = Grid::new(sides[0], sides[1], TileId(1), cells).unwrap();
            let lamp = Lamp { light: Light::FULL, reach: Reach::new(reach).unwrap() };

            let mut lit = BTreeMap::new();
            let is_clear = |tile| !grid.is_solid_tile(tile);
            Glow::of(&lamp).shine(&grid, place, is_clear, |cell, light| {
                let before = lit.entry(cell).or_insert(Light::NONE);
                *before = before.plus(light);
            });
            let every_cell = (0..height).flat_map(|row| (0..width).map(move |column| Cell { column, row }));
            for cell in every_cell {
                let distance = cell.center().distance(place.center());
                let is_lit = distance < reach && is_seen(&grid, place, cell);
                let expected = if is_lit { lamp.light_at(distance) } else { Light::NONE };
                prop_assert_eq!(lit.get(&cell).copied().unwrap_or(Light::NONE), expected, "{:?}", cell);
            }
        }
    }
}
