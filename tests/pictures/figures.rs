//! Figures show the same pixels as things in their places, seen directly and in mirrors.

use cellcaster::game::{Game, MultiplayerRules, PlayerColor, Rules};
use cellcaster::map;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, Cell, FieldOfView, Figure, Heading, Pitch, World};
use glam::DVec2;
use proptest::prelude::*;

const WIDTH: usize = 9;
const HEIGHT: usize = 7;

/// The things, none of which is a lamp.
const THINGS: [char; 3] = ['p', 's', 'c'];

/// The tiles, other than plain floor and walls, that select each way of drawing: only level tiles,
/// these and heights, and these and mirrors.
const TILES: [&[char]; 3] = [&['%', 'g', 'd'], &['%', 'g', 'd', 'u', 'l'], &['%', 'g', 'd', 'M']];

/// A map of `cells` in a dim fog. South of it, a row of walls holds a thing of each kind.
fn world(cells: &[char]) -> World {
    let rows: String =
        cells.chunks(WIDTH).map(|row| row.iter().collect::<String>() + "\n").collect();
    let text = format!(
        "light = 0.6\nfog = {{ color = '#404858', distance = 5 }}\n\
         grid = '''\n{rows}#########\n#p#s#c#@#\n#########\n'''\n\
         [tiles]\n'#' = {{ wall = 'brick' }}\n'%' = {{ mask = 'grate' }}\n\
         'g' = {{ glass = '#80c0ff' }}\n'd' = {{ light = 0.2 }}\n{}[things]\n\
         '@' = {{ start = 0 }}\n'p' = {{ sprite = 'plant' }}\n\
         's' = {{ sprite = 'statue', heading = 70 }}\n\
         'c' = {{ sprite = 'bones', anchor = 'ceiling', height = 0.4 }}\n",
        // A kind of tile selects the way of drawing, whether it is in the grid or not.
        if cells.contains(&'u') || cells.contains(&'l') {
            "'u' = { floor_height = 0.25 }\n'l' = { wall = 'brick', height = 0.4 }\n"
        } else if cells.contains(&'M') {
            "'M' = { mirror = true }\n"
        } else {
            ""
        }
    );
    map::parse_str(&text).unwrap_or_else(|faults| panic!("{text}{faults}"))
}

/// The things of `world` that are not in the southern walls, turned into figures.
fn figures_of(world: &World) -> Vec<Figure> {
    let things = world.things().iter().filter(|thing| (thing.cell.row as usize) < HEIGHT);
    let figure = |thing: &cellcaster::world::Thing| {
        let sprite = world.sprite(thing.sprite);
        Figure {
            sprite: thing.sprite,
            position: thing.cell.center(),
            base: sprite.base(world.room_in(thing.cell)),
            heading: sprite.heading,
            frame: 0,
            opacity: u8::MAX,
        }
    };
    things.map(figure).collect()
}

fn frame_of(world: &World, camera: &Camera, filter: Filter) -> Frame {
    let mut frame = Frame::new(FrameSize::new(72, 48).unwrap(), PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    renderer.set_filter(filter);
    renderer.render(world, camera, &mut frame);
    frame
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    #[test]
    fn a_figure_in_the_middle_of_a_cell_looks_like_the_thing(
        (cells, way) in (0..TILES.len()).prop_flat_map(|way| {
            let kinds = ['.', '.', '.', '.', '#'].iter().chain(&THINGS).chain(TILES[way]);
            let kinds: Vec<char> = kinds.copied().collect();
            (prop::collection::vec(prop::sample::select(kinds), WIDTH * HEIGHT), Just(way))
        }),
        position in (0.1..WIDTH as f64, 0.1..HEIGHT as f64),
        degrees in prop_oneof![0.0..360.0, prop::sample::select(vec![0.0, 45.0, 90.0])],
        (pitch, eye) in prop_oneof![
            2 => Just((0.0, 0.5)),
            1 => (-30.0..30.0, 0.1..0.9),
            1 => (-30.0..30.0, 0.1..3.0),
        ],
        filter in prop::sample::select(vec![Filter::Mip, Filter::Nearest]),
        seed in any::<prop::sample::Index>(),
    ) {
        let with_things = world(&cells);
        let mut figures = figures_of(&with_things);
        let bare: Vec<char> =
            cells.iter().map(|cell| if THINGS.contains(cell) { '.' } else { *cell }).collect();
        let mut with_figures = world(&bare);
        let first = seed.index(figures.len().max(1));
        figures.rotate_left(first);
        with_figures.set_figures(figures.into_iter());
        let heading = Heading::from_degrees(degrees).unwrap();
        let camera = Camera::new(position.into(), heading, FieldOfView::default()).unwrap();
        let camera = camera.with_eye(eye).unwrap();
        let camera = camera.with_pitch(Pitch::from_degrees(pitch).unwrap());
        let frames = [&with_things, &with_figures].map(|world| frame_of(world, &camera, filter));
        prop_assert!(frames[0] == frames[1], "way {way}");
    }
}

const ROOM: &str = "#########\n#.......#\n#.......#\n#.......#\n#.......#\n#.......#\n#########\n";

/// The cells of a room, with `tile` in one cell.
fn room_with(tile: char, cell: Cell) -> Vec<char> {
    let mut cells: Vec<char> = ROOM.chars().filter(|it| !it.is_whitespace()).collect();
    cells[cell.row as usize * WIDTH + cell.column as usize] = tile;
    cells
}

/// A figure in the room, with the sprite of the first thing in the southern walls.
fn figure_at(world: &World, x: f64, y: f64) -> Figure {
    Figure {
        sprite: world.things()[0].sprite,
        position: DVec2::new(x, y),
        base: 0.0,
        heading: Heading::default(),
        frame: 0,
        opacity: u8::MAX,
    }
}

fn camera_at(x: f64, y: f64, degrees: f64) -> Camera {
    let heading = Heading::from_degrees(degrees).unwrap();
    Camera::new(DVec2::new(x, y), heading, FieldOfView::default()).unwrap()
}

#[test]
fn a_figure_behind_the_viewer_shows_in_a_mirror() {
    let mut world = world(&room_with('M', Cell { column: 7, row: 3 }));
    let camera = camera_at(3.5, 3.5, 0.0);
    let without = frame_of(&world, &camera, Filter::Nearest);
    let figure = figure_at(&world, 2.3, 3.9);
    world.set_figures([figure].into_iter());
    assert!(frame_of(&world, &camera, Filter::Nearest) != without);
}

#[test]
fn only_a_figure_behind_glass_is_tinted() {
    let picture = |tile: char, x: f64| {
        let mut world = world(&room_with(tile, Cell { column: 4, row: 3 }));
        let figure = figure_at(&world, x, 3.5);
        world.set_figures([figure].into_iter());
        frame_of(&world, &camera_at(1.5, 3.5, 0.0), Filter::Nearest)
    };
    let middle = |frame: &Frame| (24..40).map(|y| frame.pixel(36, y)).collect::<Vec<_>>();
    assert_eq!(middle(&picture('g', 3.5)), middle(&picture('.', 3.5)));
    assert_ne!(middle(&picture('g', 5.5)), middle(&picture('.', 5.5)));
}

#[test]
fn figures_in_one_place_have_a_fixed_order() {
    let mut world = world(&room_with('.', Cell { column: 1, row: 1 }));
    let camera = camera_at(1.5, 3.5, 0.0);
    let one = figure_at(&world, 4.2, 3.5);
    let other = Figure { sprite: world.things()[1].sprite, ..one };
    let mut frame_with = |figures: [Figure; 2]| {
        world.set_figures(figures.into_iter());
        frame_of(&world, &camera, Filter::Nearest)
    };
    assert!(frame_with([one, other]) == frame_with([other, one]), "by sprite");
    let turned = Figure { heading: Heading::from_degrees(180.0).unwrap(), ..other };
    let last = frame_with([turned, other]);
    assert!(last != frame_with([other, turned]), "else as they are listed");
    let middle = |frame: &Frame| (24..32).map(|y| frame.pixel(36, y)).collect::<Vec<_>>();
    assert_eq!(middle(&last), middle(&frame_with([other, other])), "the last one in front");
}

#[test]
fn a_figure_never_changes_with_time() {
    let text = "grid = '''\n#####\n#@..#\n#####\n#t###\n#####\n'''\n[tiles]\n'#' = { wall = 'brick' }\n\
                [things]\n'@' = { start = 0 }\n't' = { sprite = 'torch' }\n";
    let mut world = map::parse_str(text).unwrap();
    let figure = figure_at(&world, 3.2, 1.5);
    world.set_figures([figure].into_iter());
    let camera = world.start_camera(FieldOfView::default());
    let mut renderer = Renderer::new();
    let mut draw = |seconds| {
        let mut frame = Frame::new(FrameSize::new(72, 48).unwrap(), PixelAspect::SQUARE);
        renderer.set_time(seconds);
        renderer.render(&world, &camera, &mut frame);
        assert_eq!(renderer.next_change(), None);
        frame
    };
    assert!(draw(0.0) == draw(0.3));
}

#[test]
fn neither_darkness_nor_fog_dims_a_marked_player() {
    let body = |light: &str, is_marked: bool| {
        let text = format!(
            "{light}\ngrid = '''\n##########\n#@.......#\n##########\n'''\n\
             [tiles]\n'#' = {{ wall = '#000000' }}\n[things]\n'@' = {{ start = 0 }}\n"
        );
        let world = map::parse_str(&text).unwrap();
        let game = Game::for_players(world, Rules::default(), MultiplayerRules::default());
        let usual = game.sprite_of_players(PlayerColor::Green);
        let sprite = if is_marked { game.sprite_of_marked_players() } else { usual };
        let (sprite, mut world) = (sprite.unwrap(), game.world().clone());
        let position = DVec2::new(6.5, 1.5);
        let (heading, opacity) = (Heading::default(), u8::MAX);
        let figure = Figure { sprite, position, base: 0.0, heading, frame: 0, opacity };
        world.set_figures([figure].into_iter());
        let frame = frame_of(&world, &camera_at(1.5, 1.5, 0.0), Filter::Nearest);
        (24..28).map(|y| frame.pixel(36, y)).collect::<Vec<_>>()
    };
    let lights = ["light = 1.0", "light = 0.1\nfog = { color = '#404858', distance = 2 }"];
    assert_eq!(body(lights[0], true), body(lights[1], true));
    assert_ne!(body(lights[0], false), body(lights[1], false), "others are dimmed");
}

#[test]
fn figures_without_a_sprite_or_a_place_are_not_drawn() {
    let mut world = world(&room_with('.', Cell { column: 1, row: 1 }));
    let camera = camera_at(1.5, 3.5, 0.0);
    let without = frame_of(&world, &camera, Filter::Mip);
    let figure = figure_at(&world, 4.2, 3.5);
    let nowhere = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300].into_iter();
    let strange = nowhere.flat_map(|place| {
        [
            Figure { position: DVec2::new(place, 3.5), ..figure },
            Figure { position: DVec2::new(4.2, place), ..figure },
            Figure { base: place, ..figure },
        ]
    });
    let unknown = Figure { sprite: cellcaster::world::SpriteId(u16::MAX), ..figure };
    world.set_figures(strange.chain([unknown]));
    assert!(frame_of(&world, &camera, Filter::Mip) == without);
}
