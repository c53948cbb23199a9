//! Things: visible and hidden pixels, compared with a separate calculation for each pixel.

use cellcaster::color::Rgb;
use cellcaster::game::{Game, Intent, Intents};
use cellcaster::map;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, Figure, Heading, World};
use glam::DVec2;
use proptest::prelude::*;

const WIDTH: u32 = 96;
const HEIGHT: u32 = 60;

fn frame_of(world: &World, camera: &Camera) -> Frame {
    let size = FrameSize::new(WIDTH, HEIGHT).unwrap();
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    renderer.set_filter(Filter::Nearest);
    renderer.render(world, camera, &mut frame);
    frame
}

fn camera(position: (f64, f64), degrees: f64) -> Camera {
    let heading = Heading::from_degrees(degrees).unwrap();
    Camera::new(position.into(), heading, FieldOfView::default()).unwrap()
}

/// A world with things at `t`, and the same world without them.
fn with_and_without(grid: &str, thing: &str) -> [World; 2] {
    let world = |grid: &str| {
        let text = format!(
            "grid = '''\n{grid}'''\n[tiles]\n'#' = {{ wall = \"brick\" }}\n'%' = {{ mask = \"grate\" }}\n\
             [things]\n'@' = {{ start = 0 }}\n't' = {{ {thing} }}\n"
        );
        map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
    };
    [world(grid), world(&grid.replace('t', "."))]
}

const SPRITES: [&str; 5] = [
    "sprite = 'statue', heading = 40",
    "sprite = 'column'",
    "sprite = 'lamp'",
    "sprite = 'barrel'",
    "sprite = 'table', height = 0.9",
];

proptest! {
    #[test]
    fn a_thing_behind_a_wall_never_shows(
        x in 1.1..5.9,
        y in 1.1..3.9,
        degrees in 0.0..360.0,
        sprite in prop::sample::select(&SPRITES[..]),
    ) {
        let grid = "#########\n#@....#.#\n#.....#t#\n#.....#.#\n#########\n";
        let [with, without] = with_and_without(grid, sprite);
        let camera = camera((x, y), degrees);
        prop_assert!(frame_of(&with, &camera) == frame_of(&without, &camera));
    }

    #[test]
    fn a_thing_in_front_always_shows(
        x in 1.1..5.9,
        y in 1.1..3.9,
        aside in -25.0..25.0,
        sprite in prop::sample::select(&SPRITES[..]),
    ) {
        let grid = "#########\n#@......#\n#......t#\n#.......#\n#########\n";
        let [with, without] = with_and_without(grid, sprite);
        let to_thing = DVec2::new(7.5, 2.5) - DVec2::new(x, y);
        let degrees = to_thing.y.atan2(to_thing.x).to_degrees() + aside;
        let camera = camera((x, y), degrees);
        prop_assert!(frame_of(&with, &camera) != frame_of(&without, &camera));
    }

    /// Each pixel is computed separately: it shows the thing, or else the picture without it.
    #[test]
    fn a_things_pixels_match_a_separate_calculation(
        x in 1.3..4.5,
        y in 1.3..4.7,
        aside in -30.0..30.0,
        sprite in prop::sample::select(&SPRITES[..]),
    ) {
        let grid = "########\n#@.....#\n#.....##\n#....t.#\n#....#.#\n########\n";
        let [with, without] = with_and_without(grid, sprite);
        let to_thing = DVec2::new(5.5, 3.5) - DVec2::new(x, y);
        let camera = camera((x, y), to_thing.y.atan2(to_thing.x).to_degrees() + aside);
        let (drawn, empty) = (frame_of(&with, &camera), frame_of(&without, &camera));
        let oracle = Oracle::new(&with, &camera, standing(&with));
        let mut compared = 0;
        for row in 0..HEIGHT {
            for column in 0..WIDTH {
                if let Some(expected) = oracle.pixel(column, row, empty.pixel(column, row)) {
                    prop_assert_eq!(drawn.pixel(column, row), expected, "({}, {})", column, row);
                    compared += 1;
                }
            }
        }
        prop_assert!(compared > WIDTH * HEIGHT * 9 / 10, "{compared} pixels");
    }

    /// The same as above, for a figure at any place.
    #[test]
    fn a_figures_pixels_match_a_separate_calculation(
        x in 1.3..4.5,
        y in 1.3..4.7,
        place in (1.0..7.0, 1.0..5.0),
        base in -0.2..0.5,
        degrees in (0.0..360.0, 0.0..360.0),
        opacity in prop_oneof![1 => Just(0), 2 => Just(u8::MAX), 2 => any::<u8>()],
        sprite in prop::sample::select(&SPRITES[..]),
    ) {
        // The thing that provides the sprite is behind walls.
        let grid = "########\n#@.....#\n#.....##\n#......#\n#......#\n########\n#t######\n########\n";
        let [mut world, empty] = with_and_without(grid, sprite);
        let heading = Heading::from_degrees(degrees.0).unwrap();
        let thing = standing(&world);
        let figure = Figure { position: place.into(), base, heading, opacity, ..thing };
        world.set_figures([figure].into_iter());
        let camera = camera((x, y), degrees.1);
        let (drawn, empty) = (frame_of(&world, &camera), frame_of(&empty, &camera));
        let oracle = Oracle::new(&world, &camera, figure);
        for row in 0..HEIGHT {
            for column in 0..WIDTH {
                if let Some(expected) = oracle.pixel(column, row, empty.pixel(column, row)) {
                    prop_assert_eq!(drawn.pixel(column, row), expected, "({}, {})", column, row);
                }
            }
        }
        prop_assert!(opacity > 0 || drawn == empty);
    }
}

/// Maps with a room around a court. In one, everything is level; in the other, an uneven tile is
/// out of view.
fn level_and_uneven(thing: &str) -> [World; 2] {
    let world = |last_row: &str| {
        let text = format!(
            "ceiling = '#202030'\nsky = {{ gradient = ['#5080c0', '#c0d8f0'] }}\n\
             grid = '''\n..........\n.########.\n.#@.....#.\n.#..tu,.#.\n.#..,,,.#.\n.#......#.\n.########.\n{last_row}\n'''\n\
             [tiles]\n'#' = {{ wall = 'brick' }}\n',' = {{ ceiling = 'sky' }}\n'^' = {{ floor_height = 0.5 }}\n\
             [things]\n'@' = {{ start = 0 }}\n't' = {{ {thing} }}\n'u' = {{ {thing}, on = ',' }}\n"
        );
        map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
    };
    [world(".........."), world("^.........")]
}

const TALLER_THAN_THE_ROOM: [&str; 3] = [
    "sprite = 'statue', height = 2.5",
    "sprite = 'lamp', height = 1.5, anchor = 'ceiling'",
    "sprite = 'column', height = 1.01",
];

proptest! {
    /// A thing reaches neither through the ceiling nor through the floor, in either way of drawing.
    #[test]
    fn a_thing_taller_than_the_room_is_cut_off(
        x in prop_oneof![2.1..7.9, (3..8).prop_map(|line| f64::from(line) + 1e-7)],
        y in 2.1..5.9,
        degrees in 0.0..360.0,
        thing in prop::sample::select(&TALLER_THAN_THE_ROOM[..]),
        base in -1.0..1.0,
    ) {
        let worlds = level_and_uneven(thing).map(|mut world| {
            let figure = Figure { position: (4.5, 5.5).into(), base, ..standing(&world) };
            world.set_figures([figure].into_iter());
            world
        });
        let camera = camera((x, y), degrees);
        let [level, uneven] = worlds.map(|world| frame_of(&world, &camera));
        prop_assert!(level == uneven);
    }
}

/// A figure in the place of the first thing of a level world.
fn standing(world: &World) -> Figure {
    let thing = world.things()[0];
    let sprite = world.sprite(thing.sprite);
    Figure {
        sprite: thing.sprite,
        position: thing.cell.center(),
        base: match sprite.anchor {
            cellcaster::world::Anchor::Floor => 0.0,
            cellcaster::world::Anchor::Ceiling => 1.0 - sprite.height.cells(),
        },
        heading: sprite.heading,
        frame: 0,
        opacity: u8::MAX,
    }
}

/// The colour of a pixel, from a ray through its centre.
struct Oracle<'a> {
    world: &'a World,
    camera: &'a Camera,
    figure: Figure,
    renderer: Renderer,
}

impl<'a> Oracle<'a> {
    fn new(world: &'a World, camera: &'a Camera, figure: Figure) -> Self {
        let mut renderer = Renderer::new();
        let size = FrameSize::new(WIDTH, HEIGHT).unwrap();
        renderer.render(world, camera, &mut Frame::new(size, PixelAspect::SQUARE));
        Self { world, camera, figure, renderer }
    }

    /// `None` if the pixel is so close to an edge that rounding may decide.
    fn pixel(&self, column: u32, row: u32, behind: Rgb) -> Option<Rgb> {
        const HAIR: f64 = 1e-9;
        let Self { world, camera, figure, renderer } = self;
        let sprite = world.sprite(figure.sprite);
        let half = camera.field_of_view.half_width();
        let across = (2.0 * (f64::from(column) + 0.5) / f64::from(WIDTH) - 1.0) * half;
        let up = (f64::from(HEIGHT) / 2.0 - (f64::from(row) + 0.5)) * 2.0 * half / f64::from(WIDTH);
        let from_eye = figure.position - camera.position();
        let depth = from_eye.dot(camera.direction());
        if depth <= 0.2 || renderer.distances()[column as usize] <= depth {
            return Some(behind);
        }
        let beside = across * depth - from_eye.dot(camera.direction().perp());
        let above = up * depth + 0.5;
        let (width, height) = (sprite.width(), sprite.height.cells());
        let picture = sprite.picture_of(figure.frame, figure.heading, -from_eye);
        let x = (beside / width + 0.5) * f64::from(picture.width());
        let y = (1.0 - (above - figure.base) / height) * f64::from(picture.height());
        if (x - x.round()).abs() < HAIR || (y - y.round()).abs() < HAIR {
            return None;
        }
        if above.abs() < HAIR || (above - 1.0).abs() < HAIR {
            return None;
        }
        if !(0.0..1.0).contains(&above) {
            // Behind the floor or the ceiling.
            return Some(behind);
        }
        let inside = |place: f64, count: u32| (0.0..f64::from(count)).contains(&place);
        if !inside(x, picture.width()) || !inside(y, picture.height()) {
            return Some(behind);
        }
        let (color, alpha) = picture.texel(x as u32, y as u32);
        let shown = f64::from(alpha) * f64::from(figure.opacity) / 255.0;
        Some(color.over(behind, shown.round() as u8))
    }
}

#[test]
fn a_symmetrical_scene_is_symmetrical() {
    let grid = "#######\n#.....#\n#.t.t.#\n#..t..#\n#.....#\n#..@..#\n#######\n";
    // The table is a built-in sprite that is its own mirror image, but bricks are not symmetrical.
    let text = format!(
        "grid = '''\n{grid}'''\ntiles.'#'.wall = '#804030'\n\
         things = {{ '@'.start = 0, 't'.sprite = 'table' }}\n"
    );
    let world = map::parse_str(&text).unwrap();
    for eye in [(3.5, 5.5), (3.5, 4.9)] {
        let frame = frame_of(&world, &camera(eye, 270.0));
        for row in 0..HEIGHT {
            for column in 0..WIDTH / 2 {
                let mirrored = frame.pixel(WIDTH - 1 - column, row);
                assert_eq!(frame.pixel(column, row), mirrored, "({column}, {row})");
            }
        }
    }
}

#[test]
fn a_thing_behind_a_grate_shows_only_through_its_holes() {
    let grid = "#######\n#.....#\n#@..%t#\n#.....#\n#######\n";
    let [with, without] = with_and_without(grid, "sprite = 'column'");
    let camera = camera((1.5, 2.5), 0.0);
    let (with, without) = (frame_of(&with, &camera), frame_of(&without, &camera));
    let column = |frame: &Frame, x: u32| (0..HEIGHT).map(|y| frame.pixel(x, y)).collect::<Vec<_>>();
    let changed: Vec<u32> =
        (0..WIDTH).filter(|&x| column(&with, x) != column(&without, x)).collect();
    assert!(!changed.is_empty(), "it shows");
    let (first, last) = (changed[0], changed[changed.len() - 1]);
    let kept = (first..=last)
        .flat_map(|x| (0..HEIGHT).map(move |y| (x, y)))
        .filter(|&(x, y)| with.pixel(x, y) == without.pixel(x, y));
    assert!(kept.count() > 40, "the grate hides some of it");
}

#[test]
fn a_thing_in_front_of_a_grate_hides_it() {
    let grid = "#######\n#.....#\n#@.t%.#\n#.....#\n#######\n";
    let [with, without] = with_and_without(grid, "sprite = 'column'");
    let camera = camera((1.5, 2.5), 0.0);
    let (with, without) = (frame_of(&with, &camera), frame_of(&without, &camera));
    let middle = (WIDTH / 2, HEIGHT / 2);
    assert!(with.pixel(middle.0, middle.1) != without.pixel(middle.0, middle.1));
    let opaque = (0..8).all(|x| with.pixel(middle.0 - 4 + x, middle.1).red() > 60);
    assert!(opaque, "nothing of the grate is on the column");
}

#[test]
fn a_barrel_blocks_the_way_and_bones_do_not() {
    let reached = |thing: &str| {
        let [world, _] = with_and_without("########\n#@.t...#\n########\n", thing);
        let mut game = Game::new(world);
        let forward: Intents = [Intent::Forward].into_iter().collect();
        (0..200).for_each(|_| game.step(forward));
        game.camera(FieldOfView::default()).position().x
    };
    assert_eq!(reached("sprite = 'barrel'"), 2.75);
    assert_eq!(reached("sprite = 'bones'"), 6.75);
    assert_eq!(reached("sprite = 'bones', blocks = true"), 2.75);
    assert_eq!(reached("sprite = 'barrel', blocks = false"), 6.75);
}

#[test]
fn a_lamp_lights_cells_in_line_of_sight() {
    let text = "light = 0.25\ngrid = '''\n#######\n#l..#.#\n#...#.#\n#@....#\n#######\n'''\n\
                [tiles]\n'#' = { wall = 'brick' }\n\
                [things]\n'@' = { start = 0 }\n'l' = { sprite = 'lamp', reach = 6 }\n";
    let world = map::parse_str(text).unwrap();
    let light = |column, row| world.light_in(cellcaster::world::Cell { column, row }).in_256ths();
    assert!(light(1, 1) > light(2, 1) && light(2, 1) > light(3, 1) && light(3, 1) > 64);
    assert_eq!(light(5, 1), 64, "a wall is in between");
    let unlit = map::parse_str(&text.replace("light = 0.25\n", "")).unwrap();
    assert_eq!(unlit.light_in(cellcaster::world::Cell { column: 1, row: 1 }).in_256ths(), 256);
}

#[test]
fn a_picture_changes_only_when_its_next_frame_is_due() {
    let [world, _] = with_and_without("######\n#@.t.#\n######\n", "sprite = 'torch'");
    let camera = camera((1.5, 1.5), 0.0);
    let mut renderer = Renderer::new();
    let mut draw = |seconds| {
        let mut frame = Frame::new(FrameSize::new(WIDTH, HEIGHT).unwrap(), PixelAspect::SQUARE);
        renderer.set_time(seconds);
        renderer.render(&world, &camera, &mut frame);
        (frame, renderer.next_change())
    };
    let (first, change) = draw(0.0);
    let change = change.expect("it flickers");
    assert!(draw(change - 0.01).0 == first);
    assert!(draw(change + 0.01).0 != first);
}

/// The number of pixels in which a thing is visible behind a tile, under the sky.
fn pixels_behind(tile: &str, thing: &str, ceiling_height: f64) -> usize {
    let [with, without] = ["B", "."].map(|cell| {
        let text = format!(
            "ceiling = 'sky'\nceiling_height = {ceiling_height}\ngrid = '''\n.........\n@..%..{cell}..\n.........\n'''\n\
             [tiles]\n'%' = {{ {tile} }}\n[things]\n'@' = {{ start = 0 }}\n'B' = {{ {thing}, on = '.' }}\n"
        );
        let world = map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"));
        frame_of(&world, &world.start_camera(FieldOfView::default()))
    });
    with.rows().flatten().zip(without.rows().flatten()).filter(|(one, other)| one != other).count()
}

/// The thing hangs at the height that the ceiling would have.
#[test]
fn a_thing_hangs_above_a_low_wall_under_the_sky() {
    let thing = "sprite = 'column', height = 0.5, anchor = 'ceiling'";
    let behind = |height| pixels_behind(&format!("wall = 'brick', height = {height}"), thing, 2.0);
    let all = behind(0.01);
    assert!(all > 5, "{all} pixels");
    for height in [0.2, 0.6, 0.9] {
        assert_eq!(behind(height), all, "{height}");
    }
}

/// This does not depend on the height of the ceiling, which is not visible.
#[test]
fn a_tall_thing_shows_above_a_wall_under_the_sky() {
    let column = "sprite = 'column', height = 3";
    let [level, uneven] =
        [1.0, 1.2].map(|it| pixels_behind("wall = 'brick', height = 1", column, it));
    assert!(uneven > 20, "{uneven} pixels");
    assert_eq!(level, uneven);
    let behind_pillar = pixels_behind("pillar = 'brick', radius = 0.5, height = 1", column, 1.0);
    assert!(behind_pillar > 20, "{behind_pillar} pixels");
}
