//! Work whose instructions `.ci/instructions` counts.
//!
//! `instructions` lists the cases, and `instructions CASE` does the work of one. Only the work
//! inside `counted` is counted. It is done once before, so that memory has already grown. Times
//! differ from run to run and from machine to machine; these counts differ with the compiler alone.

mod pipeline;

use std::env;
use std::hint::black_box;
use std::num::NonZero;
use std::path::Path;

use cellcaster::game::{Game, Intent, Intents};
use cellcaster::map::{self, Level, builtin};
use cellcaster::render::{Filter, Frame, FrameSize, Options, PixelAspect, Renderable, Renderer};
use cellcaster::terminal::Fidelity;
use cellcaster::tui::GlyphSet;
use cellcaster::world::{FieldOfView, Heading, World};
use ratatui::layout::Size;

const CASES: [Case; 16] = [
    Case { name: "rooms-80x48", work: Work::Frames("rooms", 80, 48) },
    Case { name: "rooms-160x90", work: Work::Frames("rooms", 160, 90) },
    Case { name: "levels-80x48", work: Work::Levels(80, 48) },
    Case { name: "area-160x90", work: Work::FramesByArea("rooms", 160, 90) },
    Case { name: "rooms-320x200", work: Work::Frames("rooms", 320, 200) },
    Case { name: "rooms-1920x1080", work: Work::Frames("rooms", 1920, 1080) },
    Case { name: "lamps-160x90", work: Work::Frames("lamps", 160, 90) },
    Case { name: "things-160x90", work: Work::Frames("things", 160, 90) },
    Case { name: "heights-160x90", work: Work::Frames("heights", 160, 90) },
    Case { name: "mirrors-160x90", work: Work::Frames("mirrors", 160, 90) },
    Case { name: "bodies-160x90", work: Work::Frames("spheres", 160, 90) },
    Case { name: "steps-citadel", work: Work::Steps("citadel") },
    Case { name: "pipeline-120x40", work: Work::Pipeline(GlyphSet::Half, 120, 40) },
    Case { name: "pipeline-80x24", work: Work::Pipeline(GlyphSet::Half, 80, 24) },
    Case { name: "octants-80x24", work: Work::Pipeline(GlyphSet::Octant, 80, 24) },
    Case { name: "greedy-80x24", work: Work::Greedy(80, 24) },
];

struct Case {
    name: &'static str,
    work: Work,
}

#[derive(Clone, Copy)]
enum Work {
    /// Frames of this map and this size, in all directions from the start.
    Frames(&'static str, u32, u32),
    /// The same from the starts of all built-in levels.
    Levels(u32, u32),
    /// The same with the area filter.
    FramesByArea(&'static str, u32, u32),
    /// Steps of the game on this level, in which the player runs in circles.
    Steps(&'static str),
    /// A played script in these glyphs and a window of this size, from intents to bytes.
    Pipeline(GlyphSet, u16, u16),
    /// The same as a busy server does it: in half blocks, at high fidelity, with the greedy effort.
    Greedy(u16, u16),
}

/// The number of frames, each in another direction.
const FRAMES: u32 = 8;
/// The number of steps.
const STEPS: u32 = 240;

/// Rooms and pillars with textures on walls, floor and ceiling.
const ROOMS: &str = "
floor = 'flagstone'
ceiling = 'wood'
grid = '''
bbbbbbbbbbbbbbbbssssssss
b..............s.......s
b...p...p......s..p....s
b..............s.......s
b...p...p..............s
b..............s..p....s
b......@.......s.......s
mmmmmm..mmmmmmmssss..sss
m......................o
m.........p...p...p....o
m......................o
m.........p...p...p....o
m......................o
mmmmmmmmmmmmmmmooooooooo
'''
[tiles]
b = { wall = 'brick' }
s = { wall = 'stone' }
m = { wall = 'moss' }
o = { wall = 'oak' }
p = { wall = 'marble' }
[things]
'@' = { start = 20 }
";

fn main() {
    let Some(name) = env::args().nth(1) else {
        CASES.iter().for_each(|case| println!("{}", case.name));
        return;
    };
    let case =
        CASES.iter().find(|case| case.name == name).expect("this case is among those listed");
    match case.work {
        Work::FramesByArea(map, width, height) => {
            let size = FrameSize::new(width, height).expect("a picture has pixels");
            if let Level::Grid(world) = level(map) {
                draw_world(&world, size, Filter::Area);
            }
        }
        Work::Levels(width, height) => {
            let size = FrameSize::new(width, height).expect("a picture has pixels");
            for level in builtin::LEVELS {
                let world = level.world().expect("a built-in level is sound");
                draw_world(&world, size, Filter::Mip);
            }
        }
        Work::Frames(map, width, height) => {
            let size = FrameSize::new(width, height).expect("a picture has pixels");
            match level(map) {
                Level::Grid(world) => draw_world(&world, size, Filter::Mip),
                Level::Space(scene) => {
                    let camera = scene.start_camera(FieldOfView::default());
                    draw(&scene, size, Default::default(), Options::default(), |_| camera);
                }
            }
        }
        Work::Steps(name) => {
            let level = builtin::LEVELS.iter().find(|level| level.name == name);
            let world = level.expect("the level is built in").world();
            let mut game = Game::new(world.expect("a built-in level is sound"));
            let intents: Intents = [Intent::Forward, Intent::TurnRight].into_iter().collect();
            game.step(intents);
            counted(|| (0..STEPS).for_each(|_| _ = black_box(game.step(intents))));
        }
        Work::Pipeline(glyphs, columns, rows) => {
            pipeline::play(glyphs, Size::new(columns, rows), Fidelity::EXACT);
        }
        Work::Greedy(columns, rows) => {
            pipeline::play(GlyphSet::Half, Size::new(columns, rows), Fidelity::HIGH);
        }
    }
}

fn level(map: &str) -> Level {
    if map == "rooms" {
        return Level::Grid(Box::new(map::parse_str(ROOMS).expect("the map is sound")));
    }
    let gallery = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../../maps/gallery"));
    map::load_level(&gallery.join(map).with_extension("toml"))
        .expect("a map of the gallery is sound")
}

fn draw_world(world: &World, size: FrameSize, filter: Filter) {
    let mut renderer = Renderer::new();
    renderer.set_threads(NonZero::<usize>::MIN);
    let start = world.start_camera(FieldOfView::default());
    let options = Options { filter, ..Options::default() };
    draw(world, size, renderer, options, |frame| {
        let degrees = start.heading.degrees() + 360.0 / f64::from(FRAMES) * f64::from(frame);
        let heading = Heading::from_degrees(degrees).expect("it is finite");
        let mut camera = start;
        camera.heading = heading;
        camera
    });
}

fn draw<R: Renderable>(
    scene: &R,
    size: FrameSize,
    mut renderer: R::Renderer,
    options: Options,
    camera: impl Fn(u32) -> R::Camera,
) {
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    let cameras: Vec<R::Camera> = (0..FRAMES).map(camera).collect();
    let mut draw_all = || {
        for camera in &cameras {
            scene.render(black_box(camera), options, &mut renderer, &mut frame);
        }
    };
    draw_all();
    counted(draw_all);
    black_box(&frame);
}

/// Does the work that is counted.
#[inline(never)]
fn counted(work: impl FnOnce()) {
    work();
    // Without this, the call would be the last one in the function, and would be compiled to a
    // jump.
    black_box(());
}
