use std::path::Path;
use std::sync::LazyLock;

use glam::DVec2;
use proptest::prelude::*;

use super::{
    Filter, Frame, FramePlan, FrameSize, Memory, Picture, PixelAspect, Threads, Visibility,
    WhyPortals,
};
use crate::cast::Exact;
use crate::map::{self, Level, builtin};
use crate::visibility::{Projection, Stats};
use crate::world::{Camera, Cell, FieldOfView, Heading, Opening, Pitch, World};

/// All maps, with doors ajar if there are any.
static MAPS: LazyLock<Vec<(String, World)>> = LazyLock::new(|| {
    let builtin =
        builtin::LEVELS.iter().map(|level| (level.name.to_owned(), level.world().unwrap()));
    let gallery = std::fs::read_dir("maps/gallery").unwrap().filter_map(|entry| {
        let path = entry.unwrap().path();
        match map::load_level(Path::new(&path)).unwrap() {
            Level::Grid(world) => Some((path.display().to_string(), *world)),
            Level::Space(_) => None,
        }
    });
    let mut maps: Vec<(String, World)> = builtin.chain(gallery).collect();
    for (_, world) in &mut maps {
        let (width, height) = (world.grid().width(), world.grid().height());
        for (column, row) in (0..width).flat_map(|column| (0..height).map(move |row| (column, row)))
        {
            let part = f64::from((column + row) % 5) / 4.0;
            world.set_opening(Cell { column, row }, Opening::new(part).unwrap());
        }
    }
    maps.sort_by(|(one, _), (other, _)| one.cmp(other));
    maps
});

/// The view of `camera` twice: drawn as planned, and by the portal way.
fn both(world: &World, camera: &Camera, filter: Filter, size: FrameSize) -> [Frame; 2] {
    let plan = FramePlan::new(world, camera, filter);
    [plan.visibility, Visibility::Portals(WhyPortals::Heights)].map(|visibility| {
        let plan = FramePlan { visibility, ..plan };
        let mut drawn = Frame::new(size, PixelAspect::SQUARE);
        let (memory, frame, stats) = (&mut Memory::default(), &mut drawn, &mut Stats::default());
        let (seconds, threads) = (0.0, None);
        let picture = Picture { world, camera, filter, seconds, threads, memory, frame, stats };
        picture.draw_planned(&Exact, plan, Threads::new(size, None));
        drawn
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// The flat way draws a level scene, or the level part of another scene, like the portal way,
    /// bit for bit. Excepted are pixels whose centres are on a line between two tiles.
    #[test]
    fn level_scenes_are_drawn_the_same_by_both_ways(
        choice in any::<prop::sample::Index>(),
        place in (0.0..1.0, 0.0..1.0),
        is_in_the_middle in any::<bool>(),
        degrees in prop_oneof![3 => 0.0..360.0, 1 => (0..8).prop_map(|eighth| 45.0 * f64::from(eighth))],
        eye in prop_oneof![Just(0.5), 0.1..0.9],
        pitch in prop_oneof![Just(0.0), -30.0..30.0],
        size in (1_u32..120, 1_u32..90),
        is_nearest in any::<bool>(),
    ) {
        let (name, world) = choice.get(&MAPS);
        let extent = world.grid().extent();
        let mut position = DVec2::from(place) * extent;
        if is_in_the_middle {
            position = position.floor() + 0.5;
        }
        // Inside a solid cell, neither picture is defined.
        prop_assume!(!world.grid().is_solid(position.x as i64, position.y as i64));
        let heading = Heading::from_degrees(degrees).unwrap();
        let camera = Camera::new(position, heading, FieldOfView::default()).unwrap();
        let camera = camera.with_eye(eye).unwrap().with_pitch(Pitch::from_degrees(pitch).unwrap());
        let filter = if is_nearest { Filter::Nearest } else { Filter::Mip };
        let size = FrameSize::new(size.0, size.1).unwrap();
        let [planned, portals] = both(world, &camera, filter, size);
        let projection = Projection::new(&camera, size, PixelAspect::SQUARE);
        for (y, (one, other)) in (0..).zip(planned.rows().zip(portals.rows())) {
            for (x, (one, other)) in one.iter().zip(other).enumerate() {
                let is_doubtful = is_on_a_line(projection.mapping(y).point(x));
                prop_assert!(one == other || is_doubtful, "at ({}, {}) of {}", x, y, name);
            }
        }
    }
}

/// Under the sky, walls and sprites of other heights show above a wall, a door and a pillar of height 1.
#[test]
fn what_is_higher_than_a_level_wall_shows_above_it() {
    let map = "ceiling = 'sky'\ngrid = '''\n#########\n#...w..T#\n#@..####T\n#...+..T#\n#...####T\n\
               #...o..T#\n#########\n'''\n[tiles]\n'#'.wall = 'brick'\n'w'.wall = 'stone'\n'+'.door = 'oak'\n\
               'o'.pillar = 'marble'\n'T' = { wall = 'metal', height = 3 }\n[things]\n'@'.start = 0\n";
    let world = map::parse_str(map).unwrap();
    let size = FrameSize::new(60, 40).unwrap();
    for degrees in [-40.0, -20.0, 0.0, 15.0, 30.0, 45.0] {
        let camera = Camera::new(
            (1.4, 3.3).into(),
            Heading::from_degrees(degrees).unwrap(),
            FieldOfView::default(),
        );
        let [planned, portals] = both(&world, &camera.unwrap(), Filter::Mip, size);
        assert!(planned == portals, "{degrees}°");
    }
}

/// Under the sky, a figure is looked for behind a level wall if it rises above the wall.
#[cfg(feature = "terminal")]
#[test]
fn a_figure_may_show_above_a_wall_under_the_sky() {
    let may_show = |ceiling: &str, base: f64| {
        let map = format!(
            "ceiling = '{ceiling}'\ngrid = '''\n@.#..t\n'''\n[tiles]\n'#'.wall = 'brick'\n\
             [things]\n'@'.start = 0\nt = {{ sprite = 'statue', height = 0.9 }}\n"
        );
        let world = map::parse_str(&map).unwrap();
        let camera = world.start_camera(FieldOfView::default());
        let mut frame = Frame::new(FrameSize::new(60, 40).unwrap(), PixelAspect::SQUARE);
        let mut renderer = super::Renderer::new();
        renderer.render(&world, &camera, &mut frame);
        let (sprite, position) = (world.things()[0].sprite, DVec2::new(4.5, 0.5));
        let heading = Heading::default();
        let figure =
            crate::world::Figure { sprite, position, base, heading, frame: 0, opacity: u8::MAX };
        renderer.may_show(&world, &camera, &frame, &figure)
    };
    assert!(may_show("sky", 0.2));
    assert!(!may_show("sky", 0.0));
    assert!(!may_show("oak", 0.2));
}

/// Whether `point` is on a line between two cells, so that its cell is ambiguous.
fn is_on_a_line(point: DVec2) -> bool {
    (point - point.round()).abs().min_element() < 1e-9
}
