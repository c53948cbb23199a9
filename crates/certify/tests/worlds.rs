//! Worlds with heights compared with geometry: every pixel of small random worlds is computed again
//! by testing the line through the pixel against everything in the world.

use std::fmt::Write as _;

use cellcaster::color::Rgb;
use cellcaster::map::{self, TextureFileError, TextureFiles};
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{
    Camera, FieldOfView, Figure, Heading, Outline, Pitch, Shape, SpriteId, TileKind,
};
use cellcaster_certify::{Solids, clear_color};
use glam::DVec2;
use proptest::prelude::*;

const SKY: Rgb = Rgb::new(1, 2, 3);
const COLUMNS: usize = 6;
const ROWS: usize = 5;
/// The number of kinds of tiles. Things stand on the first kind.
const KINDS: usize = 5;

/// Textures of noise, each with its own hue.
struct Noise;

impl TextureFiles for Noise {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let number = name.bytes().fold(0_u8, |sum, byte| sum.wrapping_mul(31).wrapping_add(byte));
        let is_thing = name.starts_with("thing");
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 8, 8);
        encoder.set_color(png::ColorType::Rgba);
        let places = (0..8_u8).flat_map(|y| (0..8_u8).map(move |x| (x, y)));
        let texels: Vec<u8> = places
            .flat_map(|(x, y)| {
                // A thing has holes and no edges.
                let is_clear = is_thing && (x ^ y) % 3 == 0;
                [x * 32 + 7, y * 32 + 7, number | 1, if is_clear { 0 } else { u8::MAX }]
            })
            .collect();
        encoder.write_header().unwrap().write_image_data(&texels).unwrap();
        Ok(bytes)
    }
}

/// A tile of a random world.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Wall {
        height: f64,
    },
    Open {
        floor: f64,
    },
    Covered {
        floor: f64,
        room: f64,
        rock: f64,
    },
    Shape {
        floor: f64,
        height: f64,
        outline: &'static str,
    },
    /// Glass of this opacity.
    Glass {
        floor: f64,
        room: f64,
        opacity: f64,
    },
    Mask {
        floor: f64,
        room: f64,
    },
    Mirror {
        height: f64,
        opacity: f64,
    },
}

/// The paints of a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Look {
    Colors,
    Textures,
}

impl Look {
    /// The map text for the paint of one part of the tile `character`.
    fn paint(self, character: char, part: u8) -> String {
        match self {
            Self::Colors => {
                let kind = character as u8 - b'a';
                Rgb::new(9 * kind + 20, 50 * part, 200).to_string()
            }
            Self::Textures => format!("{character}{part}.png"),
        }
    }
}

fn ordinary_height() -> impl Strategy<Value = f64> {
    prop_oneof![
        2 => (-4..=8_i32).prop_map(|quarters| f64::from(quarters) / 4.0),
        1 => -1.0..2.0,
    ]
}

fn height() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => ordinary_height(),
        1 => prop::sample::select(vec![1e-9, -1e-9, 0.5 + 1e-9, 1e3, -1e3, 1e9, -1e9]),
    ]
}

fn open_kind<H: Strategy<Value = f64>>(height: impl Fn() -> H) -> impl Strategy<Value = Kind> {
    let above = || prop_oneof![4 => 0.25..2.0, 1 => Just(1e-9), 1 => Just(1e3)];
    let rock = prop_oneof![Just(0.0), 0.1..1.0];
    prop_oneof![
        height().prop_map(|floor| Kind::Open { floor }),
        // No ceiling is higher than a map allows.
        (height(), above(), rock).prop_map(|(floor, room, rock)| Kind::Covered {
            floor: floor.min(1e9 - 2e3),
            room,
            rock
        }),
    ]
}

fn kind<H: Strategy<Value = f64>>(height: impl Fn() -> H) -> impl Strategy<Value = Kind> {
    let outline = prop::sample::select(&OUTLINES[..]);
    let shape = (ordinary_height(), 0.1..2.0, outline);
    prop_oneof![
        1 => height().prop_map(|height| Kind::Wall { height: height.abs().max(1e-9) }),
        2 => open_kind(height),
        1 => shape.prop_map(|(floor, height, outline)| Kind::Shape { floor, height, outline }),
    ]
}

/// A tile that shows the scene behind it or a reflection.
fn see_through_kind() -> impl Strategy<Value = Kind> {
    let opacity = || prop_oneof![1 => Just(0.0), 1 => Just(1.0), 3 => 0.0..=1.0];
    let cube = || (ordinary_height(), 0.25..2.0);
    prop_oneof![
        2 => (cube(), opacity())
            .prop_map(|((floor, room), opacity)| Kind::Glass { floor, room, opacity }),
        1 => cube().prop_map(|(floor, room)| Kind::Mask { floor, room }),
        3 => (0.01..2.0, opacity()).prop_map(|(height, opacity)| Kind::Mirror { height, opacity }),
    ]
}

/// The map text of a shape after its kind and its paint.
const OUTLINES: [&str; 6] = [
    "pillar = ; radius = 0.5",
    "pillar = ; radius = 0.3",
    "pillar = ; radius = 0.11",
    "diagonal = ; from = \"north-east\"",
    "diagonal = ; from = \"north-west\"",
    "thin = ; at = \"north-south\"",
];

/// A map of tiles `a`, `b` and so on, with things on some tiles of the first kind. The player
/// starts in a corner that is outside all pictures.
fn map_of(scene: &Scene, look: Look) -> String {
    let Scene { kinds, cells, is_covered, lights, .. } = scene;
    let is_covered = *is_covered;
    let light = |kind: usize| lights.get(kind).map(|light| format!(", light = {light}"));
    let mut text = format!(
        "sky = {{ gradient = [\"{SKY}\", \"{SKY}\"] }}\nfloor = \"{}\"\nceiling = \"{}\"\n",
        look.paint('z', 0),
        if is_covered { look.paint('z', 1) } else { "sky".to_owned() }
    );
    if let Some(distance) = scene.fog {
        _ = writeln!(text, "fog = {{ color = \"#403020\", distance = {distance:?} }}");
    }
    _ = writeln!(text, "ceiling_height = {:?}\ngrid = '''", scene.ceiling_height);
    for row in cells.chunks(COLUMNS) {
        let character = |&kind: &usize| match kind {
            KINDS.. => 't',
            kind => char::from(b'a' + kind as u8),
        };
        text.extend(row.iter().map(character));
        text.push('\n');
    }
    _ = writeln!(text, "@.....\n'''\n[tiles]");
    for (character, (index, kind)) in ('a'..).zip(kinds.iter().enumerate()) {
        let light = light(index).unwrap_or_default();
        let [floor, ceiling, riser, lintel] = [0, 1, 2, 3].map(|part| look.paint(character, part));
        _ = match kind {
            Kind::Wall { height } => {
                writeln!(
                    text,
                    "{character} = {{ wall = \"{riser}\", height = {height:?}{} }}",
                    if index == 1 { &light } else { "" }
                )
            }
            Kind::Open { floor: height } => writeln!(
                text,
                "{character} = {{ floor = \"{floor}\", floor_height = {height:?}, riser = \"{riser}\", \
                 ceiling = \"sky\"{light} }}",
            ),
            Kind::Covered { floor: height, room, rock } => {
                let top = height + room.max(height.abs() * 1e-9);
                writeln!(
                    text,
                    "{character} = {{ floor = \"{floor}\", floor_height = {height:?}, \
                     riser = \"{riser}\", ceiling = \"{ceiling}\", ceiling_height = {top:?}, \
                     roof_height = {:?}, lintel = \"{lintel}\"{light} }}",
                    top + rock
                )
            }
            Kind::Glass { floor: height, room, opacity } => {
                // Under the sky, glass is as high as the map's ceiling would be.
                let above = if scene.is_covered {
                    format!("ceiling = \"{ceiling}\", ceiling_height = {:?}", height + room)
                } else {
                    "ceiling = \"sky\"".to_owned()
                };
                writeln!(
                    text,
                    "{character} = {{ glass = \"#80c0ff\", opacity = {opacity:?}, floor = \"{floor}\", \
                     floor_height = {height:?}, riser = \"{riser}\", {above}, lintel = \"{lintel}\" }}"
                )
            }
            Kind::Mask { floor: height, room } => writeln!(
                text,
                "{character} = {{ mask = \"thing-{character}.png\", floor = \"{floor}\", \
                 floor_height = {height:?}, riser = \"{riser}\", ceiling = \"{ceiling}\", \
                 ceiling_height = {:?}, lintel = \"{lintel}\" }}",
                height + room
            ),
            Kind::Mirror { height, opacity } => writeln!(
                text,
                "{character} = {{ mirror = \"#d0b070\", opacity = {opacity:?}, height = {height:?}{light} }}",
            ),
            Kind::Shape { floor: floor_height, height, outline } => {
                let outline = outline.replace(';', &format!("\"{lintel}\","));
                writeln!(
                    text,
                    "{character} = {{ {outline}, height = {height:?}, floor = \"{floor}\", \
                     floor_height = {floor_height:?}, riser = \"{riser}\", ceiling = \"sky\" }}"
                )
            }
        };
    }
    text + "[things]\n\"@\" = { start = 0 }\n\
            t = { sprite = \"thing.png\", on = \"a\", "
        + &format!("height = {:?}, anchor = \"{}\" }}\n", scene.thing.0, scene.thing.1)
}

/// A figure of a random world. It may be off the map, or partly in the floor.
#[derive(Clone, Debug)]
struct Standing {
    position: (f64, f64),
    base: f64,
    degrees: f64,
    opacity: u8,
}

prop_compose! {
    fn standing()(
        position in (-1.0..COLUMNS as f64 + 1.0, -1.0..ROWS as f64 + 2.0),
        base in ordinary_height(),
        degrees in 0.0..360.0,
        opacity in prop_oneof![2 => Just(u8::MAX), 1 => any::<u8>()],
    ) -> Standing {
        Standing { position, base, degrees, opacity }
    }
}

/// A world of tiles, with a camera.
#[derive(Clone, Debug)]
struct Scene {
    kinds: Vec<Kind>,
    cells: Vec<usize>,
    /// The brightness of each kind of tile; empty if everything is fully lit.
    lights: Vec<f64>,
    /// The distance at which fog hides half.
    fog: Option<f64>,
    is_covered: bool,
    ceiling_height: f64,
    /// The height and the anchor of the things.
    thing: (f64, &'static str),
    figures: Vec<Standing>,
    position: DVec2,
    is_on_a_roof: bool,
    up: f64,
    degrees: f64,
    pitch: f64,
    size: (u32, u32),
}

prop_compose! {
    fn scene(of: Look)(
        first in match of {
            Look::Colors => open_kind(height).boxed(),
            Look::Textures => open_kind(ordinary_height).boxed(),
        },
        others in match of {
            Look::Colors => prop::collection::vec(kind(height), KINDS - 1).boxed(),
            Look::Textures => prop::collection::vec(kind(ordinary_height), KINDS - 1).boxed(),
        },
        cells in prop::collection::vec(0..=KINDS, COLUMNS * ROWS),
        lights in prop_oneof![
            Just(Vec::new()),
            prop::collection::vec(0.0..=1.0, KINDS),
        ],
        fog in prop_oneof![3 => Just(None), 1 => (0.5..20.0).prop_map(Some)],
        is_covered in any::<bool>(),
        thing in (
            prop_oneof![Just(0.8), 0.1..3.0],
            prop::sample::select(vec!["floor", "ceiling"]),
        ),
        figures in prop_oneof![Just(Vec::new()), prop::collection::vec(standing(), 1..6)],
        position in (0.0..6.0, 0.0..5.0),
        is_on_a_roof in any::<bool>(),
        up in 0.01..0.99,
        degrees in prop_oneof![0.0..360.0, (0..8).prop_map(|eighth| 45.0 * f64::from(eighth))],
        pitch in prop_oneof![Just(0.0), -30.0..30.0],
        size in (1_u32..40, 1_u32..40),
    ) -> Scene {
        let kinds = [vec![first], others].concat();
        let position = DVec2::from(position);
        let ceiling_height = 1.25;
        Scene {
            kinds, cells, lights, fog, is_covered, ceiling_height, thing, figures, position,
            is_on_a_roof, up, degrees, pitch, size,
        }
    }
}

/// The same kind with its floor at 0 and its top at 1.
fn level(kind: Kind) -> Kind {
    match kind {
        Kind::Wall { .. } | Kind::Shape { .. } => Kind::Wall { height: 1.0 },
        Kind::Open { .. } => Kind::Open { floor: 0.0 },
        Kind::Covered { .. } => Kind::Covered { floor: 0.0, room: 1.0, rock: 0.0 },
        Kind::Glass { opacity, .. } => Kind::Glass { floor: 0.0, room: 1.0, opacity },
        Kind::Mask { .. } => Kind::Mask { floor: 0.0, room: 1.0 },
        Kind::Mirror { opacity, .. } => Kind::Mirror { height: 1.0, opacity },
    }
}

prop_compose! {
    /// A world in which everything is level. Things and figures may be partly in the floor, or
    /// above the ceiling.
    fn level_scene(of: Look)(
        scene in scene(of),
        up in prop_oneof![0.01..0.99, prop::sample::select(vec![1e-12, 0.001, 0.015, 0.99, 0.999])],
    ) -> Scene {
        let kinds: Vec<Kind> = scene.kinds.into_iter().map(level).collect();
        Scene { kinds, up, ceiling_height: 1.0, is_on_a_roof: false, ..scene }
    }
}

prop_compose! {
    /// A world of level floors and walls under the sky. The walls are as high as in a level scene,
    /// or of any height. The same applies to the ceiling height from which things hang.
    fn walled_scene()(
        scene in level_scene(Look::Colors),
        heights in prop::collection::vec(prop_oneof![1 => Just(1.0), 2 => 0.01..2.0], KINDS),
        ceiling_height in prop_oneof![Just(1.0), 0.75..3.0],
    ) -> Scene {
        let walled = |(kind, height): (Kind, f64)| match kind {
            Kind::Wall { .. } => Kind::Wall { height },
            _ => Kind::Open { floor: 0.0 },
        };
        let kinds = scene.kinds.into_iter().zip(heights).map(walled).collect();
        Scene { kinds, ceiling_height, is_covered: false, ..scene }
    }
}

prop_compose! {
    /// A world in which some tiles show the scene behind them or a reflection.
    fn see_through_scene()(
        scenes in (scene(Look::Textures), level_scene(Look::Textures)),
        is_level in any::<bool>(),
        others in prop::collection::vec(see_through_kind(), 1..KINDS - 1),
    ) -> Scene {
        let scene = if is_level { scenes.1 } else { scenes.0 };
        let kept = scene.kinds.iter().copied().take(KINDS - others.len());
        let others = others.into_iter().map(|kind| if is_level { level(kind) } else { kind });
        Scene { kinds: kept.chain(others).collect(), ..scene }
    }
}

/// Compares every pixel of a picture that is not on an edge.
fn compare(scene: &Scene, look: Look) -> Result<(), TestCaseError> {
    let text = map_of(scene, look);
    let mut world = map::parse(&text, "random", &Noise).unwrap_or_else(|it| panic!("{text}\n{it}"));
    // Figures have the same sprite as things.
    let sprite = world.things().first().map(|thing| thing.sprite);
    let figures = scene.figures.iter().filter_map(|figure| {
        let &Standing { position, base, degrees, opacity } = figure;
        let heading = Heading::from_degrees(degrees)?;
        Some(Figure {
            sprite: sprite?,
            position: position.into(),
            base,
            heading,
            frame: 0,
            opacity,
        })
    });
    let position = scene.position;
    // Mirrors show the player, unless a figure represents the player.
    let own = Figure {
        sprite: SpriteId(0),
        position,
        base: 0.0,
        heading: Heading::default(),
        frame: 0,
        opacity: 0,
    };
    world.set_figures(figures.chain([own]));
    let tile = world.grid().tile(position.x as i64, position.y as i64).unwrap();
    let mut gaps = world.tile(tile).gaps();
    let gap = if scene.is_on_a_roof { gaps.next_back() } else { gaps.next() }.unwrap();
    let eye = gap.bottom + scene.up * gap.height().min(3.0);
    let heading = Heading::from_degrees(scene.degrees).unwrap();
    let camera = Camera::new(position, heading, FieldOfView::default()).unwrap();
    let camera = camera.with_eye(eye).unwrap();
    let camera = camera.with_pitch(Pitch::from_degrees(scene.pitch).unwrap());
    let solids = Solids::of(&world, &camera);
    let is_in_pillar = matches!(world.tile(tile).kind, TileKind::Shape(Shape { outline: Outline::Pillar(radius), .. })
        if position.distance(position.floor() + 0.5) <= radius.cells() && eye <= world.tile(tile).top_of_what_stands());
    // Nothing is visible from inside a pillar.
    prop_assume!(!is_in_pillar);

    let size = FrameSize::new(scene.size.0, scene.size.1).unwrap();
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    renderer.set_filter(Filter::Nearest);
    renderer.render(&world, &camera, &mut frame);
    let mut with_surfaces = Frame::new(size, PixelAspect::SQUARE);
    renderer.keep_surfaces(true);
    renderer.render(&world, &camera, &mut with_surfaces);
    for (x, y) in (0..scene.size.0).flat_map(|x| (0..scene.size.1).map(move |y| (x, y))) {
        if let Some(color) = clear_color(&solids, &camera, &frame, [x, y]) {
            prop_assert_eq!(frame.pixel(x, y), color, "at ({}, {})", x, y);
            prop_assert_eq!(with_surfaces.pixel(x, y), color, "with surfaces at ({}, {})", x, y);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn every_pixel_is_where_geometry_says(scene in scene(Look::Colors)) {
        compare(&scene, Look::Colors)?;
    }

    #[test]
    fn every_texel_is_where_geometry_says(scene in scene(Look::Textures)) {
        compare(&scene, Look::Textures)?;
    }

    #[test]
    fn every_pixel_of_a_level_scene_is_where_geometry_says(scene in level_scene(Look::Colors)) {
        compare(&scene, Look::Colors)?;
    }

    #[test]
    fn every_texel_of_a_level_scene_is_where_geometry_says(scene in level_scene(Look::Textures)) {
        compare(&scene, Look::Textures)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn every_pixel_behind_glass_and_in_mirrors_is_where_geometry_says(scene in see_through_scene()) {
        compare(&scene, Look::Textures)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_pixel_behind_walls_under_the_sky_is_where_geometry_says(scene in walled_scene()) {
        compare(&scene, Look::Colors)?;
    }
}

#[test]
fn a_ceiling_continues_over_a_step_at_pixel_centres() {
    // The point half a cell above the eye and half a cell to its side is at the centre of some
    // pixel.
    let grid = "##########\n#BBBBBBBB#\n#@AAAAAAA#\n#BBBBBBBB#\n##########\n#0########";
    let text = format!(
        "floor = '#808080'\nceiling = '#0000ff'\nsky = {{ gradient = ['#ffffff', '#ffffff'] }}\n\
         grid = '''\n{grid}\n'''\n[tiles]\n'#' = {{ wall = '#808080' }}\n\
         'A' = {{ ceiling = '#ff0000' }}\n'B' = {{ floor_height = -0.5 }}\n\
         '0' = {{ floor_height = -0.5, ceiling = 'sky' }}\n\
         [things]\n'@' = {{ start = 0, on = 'A' }}\n"
    );
    let world = map::parse_str(&text).unwrap();
    let mut renderer = Renderer::new();
    for position in (12..36).map(|eighths| DVec2::new(f64::from(eighths) / 8.0, 2.5)) {
        let camera = Camera::new(position, Heading::default(), FieldOfView::default()).unwrap();
        for size in [(32, 32), (64, 48), (80, 48)] {
            let mut frame =
                Frame::new(FrameSize::new(size.0, size.1).unwrap(), PixelAspect::SQUARE);
            renderer.render(&world, &camera, &mut frame);
            for (x, y) in (0..size.0).flat_map(|x| (0..size.1 / 2).map(move |y| (x, y))) {
                let [red, green, blue] = frame.pixel(x, y).channels();
                assert_eq!(
                    green,
                    if red == blue { red } else { 0 },
                    "{size:?}, {position}, {x}, {y}"
                );
                assert!(red < 255 || blue < 255, "the sky shows: {size:?}, {position}, {x}, {y}");
            }
        }
    }
}

#[test]
fn a_ray_ends_at_a_wall_that_is_out_of_the_picture() {
    let text = "grid = '''\n######\n#@...#\n#....#\n######\n'''\n[tiles]\n'#' = { wall = '#808080' }\n[things]\n'@' = { start = 0 }\n";
    let world = map::parse_str(text).unwrap();
    let level = world.start_camera(FieldOfView::default());
    let mut renderer = Renderer::new();
    let mut frame = Frame::new(FrameSize::new(40, 8).unwrap(), PixelAspect::SQUARE);
    renderer.render(&world, &level, &mut frame);
    let distances = renderer.distances().to_vec();
    assert!(distances.iter().all(|&distance| distance > 0.5));
    for degrees in [-30.0, 30.0] {
        let camera = level.with_pitch(Pitch::from_degrees(degrees).unwrap());
        renderer.render(&world, &camera, &mut frame);
        assert!(renderer.distances() == distances, "{degrees}");
    }
}
