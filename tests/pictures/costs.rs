//! A frame costs only what its scene shows: counts of reads and writes for each map of the gallery.

use std::path::Path;

use allocation_counter::measure;
use cellcaster::cast::{Caster, Exact, Ray};
use cellcaster::map::{self, Level};
use cellcaster::render::{
    Explanation, Filter, Frame, FrameSize, FrameStats, PassStats, PixelAspect, PlaneLoop, Renderer,
};
use cellcaster::space::{self, Scene};
use cellcaster::world::{Camera, FieldOfView, Heading, World};

const WIDTH: u32 = 160;
const HEIGHT: u32 = 90;
const PIXELS: u64 = WIDTH as u64 * HEIGHT as u64;

fn gallery(name: &str) -> World {
    map::load(Path::new(&format!("maps/gallery/{name}.toml"))).unwrap()
}

fn frame() -> Frame {
    Frame::new(FrameSize::new(WIDTH, HEIGHT).unwrap(), PixelAspect::SQUARE)
}

fn explained(world: &World) -> Explanation {
    let camera = world.start_camera(FieldOfView::default());
    Renderer::new().explain(world, &camera, &mut frame())
}

#[test]
fn a_flat_scene_reads_texels_for_its_walls_alone() {
    let Explanation { plan, stats, .. } = explained(&gallery("flat"));
    assert!(matches!(plan.floor, PlaneLoop::Fill(_)));
    assert!(matches!(plan.ceiling, Some(PlaneLoop::Fill(_))));
    assert_eq!((stats.floor.texels, stats.ceiling.texels, stats.sky.pixels), (0, 0, 0));
    assert_eq!(stats.walls.texels, stats.walls.pixels);
    // Rays between two rays that hit the same face need not be cast.
    assert!((2..u64::from(WIDTH) / 2).contains(&stats.walk.rays));
    // There are two fills, each of half the picture, and the walls over them.
    assert_eq!(stats.floor.pixels + stats.ceiling.pixels, PIXELS);
    assert_eq!(stats.overwritten, stats.walls.pixels);
}

#[test]
fn walls_of_one_colour_read_no_texel_at_all() {
    let text = include_str!("../../maps/gallery/flat.toml")
        .replace("brick", "#804030")
        .replace("stone", "#606468");
    let stats = explained(&map::parse_str(&text).unwrap()).stats;
    assert_eq!(stats.walls.texels, 0);
}

#[test]
fn textures_are_read_once_for_each_pixel_that_shows_them() {
    let stats = explained(&gallery("floor")).stats;
    assert_eq!(stats.overwritten, 0);
    assert_eq!(stats.floor.texels, stats.floor.pixels);
    assert_eq!(stats.ceiling.texels, stats.ceiling.pixels);
}

#[test]
fn a_texture_on_the_floor_alone_costs_the_floor_alone() {
    let text = include_str!("../../maps/gallery/floor.toml").replace("\"wood\"", "\"#26262c\"");
    let Explanation { plan, stats, .. } = explained(&map::parse_str(&text).unwrap());
    assert!(matches!(plan.ceiling, Some(PlaneLoop::Fill(_))));
    assert_eq!(stats.ceiling.texels, 0);
    assert_eq!(stats.floor, explained(&gallery("floor")).stats.floor);
}

#[test]
fn a_gradient_reads_no_texel_and_a_panorama_one_per_pixel() {
    let gradient = explained(&gallery("gradient")).stats.sky;
    assert_eq!((gradient.texels, gradient.pixels), (0, PIXELS / 2));
    let panorama = explained(&gallery("panorama")).stats.sky;
    assert_eq!(panorama.texels, panorama.pixels);
}

#[test]
fn opaque_tiles_keep_one_hit_per_column() {
    for name in ["flat", "floor", "doors"] {
        let world = gallery(name);
        let camera = world.start_camera(FieldOfView::default());
        let mut renderer = Renderer::new();
        let stats = renderer.explain(&world, &camera, &mut frame()).stats;
        assert_eq!(stats.see_through, PassStats::default());
        assert_eq!(renderer.distances().len(), WIDTH as usize, "{name}");
    }
}

#[test]
fn a_still_door_costs_the_same_as_a_wall() {
    let map = |tile: &str| {
        let text = format!(
            "grid = '''\n#########\n#@..+...#\n#########\n'''\n\
             tiles = {{ '#'.wall = 'brick', '+'.{tile} = 'oak' }}\nthings.'@'.start = 0\n"
        );
        map::parse_str(&text).unwrap()
    };
    let [door, wall] = ["door", "wall"].map(|tile| explained(&map(tile)).stats);
    // The rays continue into the cell of the door.
    assert!(door.walk.rays <= 4 * wall.walk.rays, "{:?}", [door.walk, wall.walk]);
    assert_eq!(door.see_through, wall.see_through);
    assert_eq!(door.walls.texels, door.walls.pixels);
    // The door is half a cell farther away, and covers slightly fewer pixels.
    assert!(door.walls.pixels <= wall.walls.pixels && door.pixels() <= wall.pixels());
}

#[test]
fn uneven_cells_cost_only_what_is_in_view() {
    let map = |height: f64, heading: u32| {
        let text = format!(
            "grid = '''\n############\n#...s..@...#\n#..........#\n############\n'''\n\
             tiles.'#'.wall = 'brick'\ntiles.'s'.floor_height = {height:?}\n\
             things.'@'.start = {heading}\n"
        );
        explained(&map::parse_str(&text).unwrap()).stats
    };
    // The tile is behind the camera.
    assert_eq!(map(0.25, 0), map(0.0, 0));
    let (level, raised) = (map(0.0, 180), map(0.25, 180));
    assert_eq!(level.walk.sectors, 1);
    // The sectors are the raised tile, and the floor behind it and beside it.
    assert!((2..6).contains(&raised.walk.sectors), "{raised:?}");
    assert!(raised.walk.rays < level.walk.rays + 20, "{:?}", [raised.walk, level.walk]);
}

/// Spans would be cut and faces split if the look of a tile in another room counted.
#[test]
fn a_tile_in_another_room_changes_no_count() {
    let counts = |tile: &str| {
        let text = format!(
            "floor = 'flagstone'\nceiling = 'wood'\n\
             grid = '''\n####################\n#@.................#\n#......#...........#\n\
             #..................#\n##################.#\n##########.,.#######\n\
             ####################\n'''\n\
             tiles.'#'.wall = 'brick'\ntiles.','.{tile}\nthings.'@'.start = 10\n"
        );
        explained(&map::parse_str(&text).unwrap()).stats
    };
    let level = counts("light = 1.0");
    for tile in [
        "light = 0.5",
        "floor = 'moss'",
        "ceiling = 'sky'",
        "door = 'oak'",
        "pillar = 'marble'",
        "floor_height = 0.25",
    ] {
        assert_eq!(counts(tile), level, "{tile}");
    }
}

#[test]
fn a_scene_without_things_considers_none() {
    for name in ["flat", "floor", "masks"] {
        let Explanation { plan, stats, .. } = explained(&gallery(name));
        assert!(!plan.has_things, "{name}");
        let things = (stats.things_considered, stats.things_drawn, stats.things);
        assert_eq!(things, (0, 0, PassStats::default()), "{name}");
    }
}

#[test]
fn a_single_lamp_costs_the_pixels_that_it_covers() {
    let with_lamp = include_str!("../../maps/gallery/flat.toml")
        .replace("[things]", "[things]\n\"l\" = { sprite = \"lamp\" }")
        .replace("@..", "@.l");
    let flat = explained(&gallery("flat")).stats;
    let Explanation { plan, stats, .. } = explained(&map::parse_str(&with_lamp).unwrap());
    // Everything is fully lit, so the lamp adds no light and the floor is still one fill.
    assert!(matches!(plan.floor, PlaneLoop::Fill(_)));
    assert_eq!((stats.things_considered, stats.things_drawn), (1, 1));
    let without_lamp = FrameStats {
        things: PassStats::default(),
        things_considered: 0,
        things_drawn: 0,
        overwritten: stats.overwritten - stats.things.pixels,
        ..stats
    };
    assert_eq!(without_lamp, flat);
    assert!((1..PIXELS / 20).contains(&stats.things.pixels), "{}", stats.things.pixels);
}

#[test]
fn lamplight_adds_no_reads_or_writes() {
    let lit = gallery("lamps");
    let text = include_str!("../../maps/gallery/lamps.toml");
    let sprites =
        text.replace("lamp\"", "plant\"").replace("torch\", light = 0.8, reach = 5", "plant\"");
    let unlit = map::parse_str(&sprites).unwrap();
    let (lit, unlit) = (explained(&lit), explained(&unlit));
    assert_eq!(lit.plan, unlit.plan);
    let same = |stats: FrameStats| (stats.floor, stats.ceiling, stats.walls, stats.walk.cells);
    assert_eq!(same(lit.stats), same(unlit.stats));
}

/// The variants of the tile `u`, which is out of view. They decide which passes draw the map.
const OUT_OF_SIGHT: [&str; 3] = ["wall = 'brick'", "floor_height = 0.25", "mirror = true"];

#[test]
fn ten_thousand_things_elsewhere_are_not_considered() {
    let row = format!("#{}#\n", "b".repeat(398));
    let hall = "#@...b...#".to_owned() + &"#".repeat(389) + "u\n";
    let wall = "#".repeat(400) + "\n";
    for tile in OUT_OF_SIGHT {
        let text = |rows: usize| {
            format!(
                "grid = '''\n{wall}{hall}{wall}{}{wall}'''\n\
                 tiles = {{ '#'.wall = 'brick', u.{tile} }}\n\
                 things = {{ '@'.start = 0, 'b'.sprite = 'barrel' }}\n",
                row.repeat(rows)
            )
        };
        let [few, many] = [0, 26].map(|rows| map::parse_str(&text(rows)).unwrap());
        assert!(many.things().len() > 10_000);
        let (few, many) = (explained(&few).stats, explained(&many).stats);
        assert_eq!((few.things_considered, few.things_drawn), (1, 1), "{tile}");
        assert_eq!(few, many, "{tile}");
    }
}

#[test]
fn things_on_both_sides_of_a_diagonal_view_are_not_considered() {
    const SIDE: u32 = 100;
    let character = |column: u32, row: u32| match column.abs_diff(row) {
        _ if (column, row) == (1, 1) => '@',
        _ if (column, row) == (0, SIDE - 1) => 'u',
        _ if [column, row].iter().any(|place| [0, SIDE - 1].contains(place)) => '#',
        0 | 1 => '.',
        2 => '#',
        _ => 'b',
    };
    let line = |row| (0..SIDE).map(|column| character(column, row)).collect::<String>() + "\n";
    for tile in OUT_OF_SIGHT {
        let text = format!(
            "grid = '''\n{}'''\ntiles = {{ '#'.wall = 'brick', u.{tile} }}\n\
             things = {{ '@'.start = 45, 'b'.sprite = 'bones' }}\n",
            (0..SIDE).map(line).collect::<String>()
        );
        let world = map::parse_str(&text).unwrap();
        assert!(world.things().len() > 9_000);
        let stats = explained(&world).stats;
        assert_eq!(stats.things_drawn, 0, "{tile}");
        assert!(stats.things_considered < u64::from(SIDE), "{}", stats.things_considered);
    }
}

/// Between two mirrors, with thousands of things behind them, only the barrel is considered: once
/// directly, and once in each of its mirror images.
#[test]
fn things_behind_mirrors_are_not_considered() {
    let hall = "bbbMMMMMMMMMMbbb\n";
    let text = |row: &str| {
        let rows = row.repeat(500);
        format!(
            "grid = '''\n{rows}{hall}bbbM@....b..Mbbb\n{hall}{rows}'''\ntiles.M.mirror = true\n\
             things = {{ '@'.start = 0, 'b'.sprite = 'barrel' }}\n"
        )
    };
    let [few, many] = ["################\n", "bbbbbbbbbbbbbbbb\n"]
        .map(|row| map::parse_str(&(text(row) + "tiles.'#'.wall = 'brick'\n")).unwrap());
    assert!(many.things().len() > 10_000);
    let [few, many] = [few, many].map(|world| explained(&world).stats);
    assert_eq!(few, many);
    assert!(many.things_drawn > 8 && many.things_considered < 400, "{many:?}");
}

#[test]
fn explaining_draws_the_same_frame() {
    for name in ["flat", "tiles", "fog", "panorama", "light"] {
        let world = gallery(name);
        let camera = world.start_camera(FieldOfView::default());
        let (mut drawn, mut explained) = (frame(), frame());
        Renderer::new().render(&world, &camera, &mut drawn);
        Renderer::new().explain(&world, &camera, &mut explained);
        assert!(drawn == explained, "{name}");
    }
}

#[test]
fn no_feature_allocates_after_the_first_frame() {
    for entry in std::fs::read_dir("maps/gallery").unwrap() {
        let world = match map::load_level(&entry.unwrap().path()).unwrap() {
            Level::Grid(world) => world,
            Level::Space(scene) => {
                assert_no_allocation_in_space(&scene);
                continue;
            }
        };
        let mut camera = world.start_camera(FieldOfView::default());
        let (mut renderer, mut frame) = (Renderer::new(), frame());
        renderer.render(&world, &camera, &mut frame);
        for turn in 0..42 {
            camera.heading = camera.heading.turned(0.3);
            let made = world.mip_levels_made();
            let counted = measure(|| renderer.render(&world, &camera, &mut frame));
            // A texture takes memory when it is first visible.
            let is_new = world.mip_levels_made() > made;
            assert!(counted.count_total == 0 || is_new && turn < 21, "{}", world.title());
        }
    }
}

fn assert_no_allocation_in_space(scene: &Scene) {
    let mut camera = scene.start_camera(FieldOfView::default());
    let (mut renderer, mut frame) = (space::Renderer::new(), frame());
    renderer.render(scene, &camera, &mut frame);
    for _ in 0..20 {
        camera.heading = camera.heading.turned(0.3);
        let counted = measure(|| renderer.render(scene, &camera, &mut frame));
        assert_eq!(counted.count_total, 0, "{}", scene.title);
    }
}

/// The map of glass with different panes, and the same map with a tile somewhere that makes it
/// uneven.
fn with_panes(pane: &str) -> [World; 2] {
    let text = |rest: &str| {
        format!(
            "floor = '#46443e'\nceiling = '#23262e'\ngrid = '''\n##########\n#....g...#\n#@...g...#\n\
             #....#...#\n##########\n{rest}\n'''\n[tiles]\n'#' = {{ wall = 'marble' }}\n\
             'g' = {{ {pane} }}\n'^' = {{ floor_height = 0.5 }}\n[things]\n'@' = {{ start = 0 }}\n"
        )
    };
    ["..........", "^........."].map(|rest| map::parse_str(&text(rest)).unwrap())
}

fn pixels_of(world: &World) -> Frame {
    let mut frame = frame();
    let camera = Camera::new((2.0, 2.5).into(), Heading::default(), FieldOfView::default());
    Renderer::new().render(world, &camera.unwrap(), &mut frame);
    frame
}

#[test]
fn clear_glass_costs_as_much_as_open_floor() {
    for (clear, open) in
        with_panes("glass = '#80c0ff', opacity = 0").iter().zip(&with_panes("light = 1"))
    {
        assert_eq!(explained(clear).stats.see_through.pixels, 0);
        assert!(pixels_of(clear) == pixels_of(open));
    }
}

#[test]
fn opaque_glass_and_mirrors_cost_as_much_as_a_wall() {
    for pane in ["glass = '#80c0ff', opacity = 1", "mirror = '#80c0ff', opacity = 1"] {
        let walls = with_panes("wall = '#80c0ff'");
        for (opaque, wall) in with_panes(pane).iter().zip(&walls) {
            let [of_pane, of_wall] = [opaque, wall].map(|world| explained(world).stats);
            assert_eq!(of_pane.see_through.pixels, 0, "{pane}");
            assert_eq!(of_pane.overwritten, of_wall.overwritten, "{pane}");
            assert!(pixels_of(opaque) == pixels_of(wall), "{pane}");
        }
    }
}

#[test]
fn a_clear_mirror_has_no_tint_to_draw() {
    for mirror in with_panes("mirror = '#80c0ff', opacity = 0") {
        let stats = explained(&mirror).stats;
        assert_eq!((stats.see_through.pixels, stats.walk.bounces > 0), (0, true));
    }
}

#[test]
fn unseen_textures_are_not_made() {
    let world = map::load(Path::new("maps/museum.toml")).unwrap();
    assert_eq!(world.mip_levels_made(), 0);
    let ray = Ray::new(world.start().cell.center(), (1.0, 0.3).into()).unwrap();
    assert!(Exact.cast_through(&world, &ray, &mut |_| {}).is_some());
    assert_eq!(world.mip_levels_made(), 0, "a ray reads no texel");
    let mut renderer = Renderer::new();
    renderer.set_filter(Filter::Nearest);
    renderer.render(&world, &world.start_camera(FieldOfView::default()), &mut frame());
    let nearest = world.mip_levels_made();
    assert!((1..20).contains(&nearest), "{nearest}");
    renderer.set_filter(Filter::Mip);
    renderer.render(&world, &world.start_camera(FieldOfView::default()), &mut frame());
    assert!(world.mip_levels_made() > nearest);
}
