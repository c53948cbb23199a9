//! A frame allocates nothing once all buffers have grown.

use allocation_counter::measure;
use cellcaster::color::palette::ColorDepth;
use cellcaster::map::{self, builtin};
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::tui::{FirstPerson, GlyphSet, Minimap, View};
use cellcaster::world::{Camera, Cell, FieldOfView, Figure, Heading, Opening};
use glam::DVec2;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::{StatefulWidget, Widget};

/// A texture takes memory when it is first visible.
#[test]
fn only_new_textures_allocate_after_the_first_frame() {
    for level in builtin::LEVELS {
        let world = level.world().unwrap();
        let mut camera = world.start_camera(FieldOfView::default());
        let mut renderer = Renderer::new();
        let mut frame = Frame::new(FrameSize::new(160, 90).unwrap(), PixelAspect::SQUARE);
        renderer.render(&world, &camera, &mut frame);
        for turn in 0..200 {
            camera.heading = camera.heading.turned(0.1);
            let made = world.mip_levels_made();
            let counted = measure(|| renderer.render(&world, &camera, &mut frame));
            let is_new = world.mip_levels_made() > made;
            assert!(counted.count_total == 0 || is_new, "{}", level.name);
            assert!(!is_new || turn < 63, "{}: nothing is new after a full turn", level.name);
        }
    }
}

#[test]
fn doors_ajar_masks_and_glass_allocate_nothing_after_the_first_frame() {
    let filters = [Filter::Mip, Filter::Area];
    let maps = ["doors", "masks", "glass"];
    for (map, filter) in maps.into_iter().flat_map(|map| filters.map(|filter| (map, filter))) {
        let mut world = map::load(format!("maps/gallery/{map}.toml").as_ref()).unwrap();
        world.set_opening(Cell { column: 4, row: 2 }, Opening::new(0.4).unwrap());
        let heading = Heading::from_degrees(0.0).unwrap();
        let mut renderer = Renderer::new();
        renderer.set_filter(filter);
        let mut frame = Frame::new(FrameSize::new(160, 90).unwrap(), PixelAspect::SQUARE);
        let mut draw = |turn: u32| {
            let heading = heading.turned(f64::from(turn) * 0.1);
            let camera =
                Camera::new(DVec2::new(2.5, 2.5), heading, FieldOfView::default()).unwrap();
            measure(|| renderer.render(&world, &camera, &mut frame)).count_total
        };
        // After one full turn, the list of transparent hits has its final size.
        (0..63).for_each(|turn| _ = draw(turn));
        assert_eq!((0..63).map(&mut draw).sum::<u64>(), 0, "{map}");
    }
}

#[test]
fn drawing_the_widgets_allocates_nothing_after_the_first_time() {
    let world = builtin::LEVELS[1].world().unwrap();
    let mut camera = world.start_camera(FieldOfView::default());
    let picture = Rect::new(0, 0, 120, 40);
    let map = Rect::new(80, 0, 40, 20);
    let mut buffer = Buffer::empty(picture);
    let depths =
        [ColorDepth::True, ColorDepth::Indexed256, ColorDepth::Indexed16, ColorDepth::Mono];
    for (glyphs, depth) in depths.into_iter().flat_map(|depth| {
        [GlyphSet::Half, GlyphSet::Octant, GlyphSet::Ascii].map(|glyphs| (glyphs, depth))
    }) {
        let mut view = View::default();
        for turn in 0..60 {
            camera.heading = camera.heading.turned(0.3);
            let made = world.mip_levels_made();
            let counted = measure(|| {
                FirstPerson::new(&world, &camera).glyphs(glyphs).color_depth(depth).render(
                    picture,
                    &mut buffer,
                    &mut view,
                );
                Minimap::new(&world, &camera)
                    .seen(view.distances())
                    .glyphs(glyphs)
                    .color_depth(depth)
                    .render(map, &mut buffer);
            });
            let is_new = turn == 0 || world.mip_levels_made() > made;
            assert!(counted.count_total == 0 || is_new, "{glyphs:?} {depth:?}");
            assert!(world.mip_levels_made() == made || turn < 21, "{glyphs:?} {depth:?}");
        }
    }
}

#[test]
#[cfg(feature = "terminal")]
fn encoding_a_frame_allocates_nothing_once_its_memory_has_grown() {
    use cellcaster::terminal::{CellWriter, Fidelity};
    use ratatui::backend::Backend;

    let world = builtin::LEVELS[1].world().unwrap();
    let mut camera = world.start_camera(FieldOfView::default());
    let picture = Rect::new(0, 0, 120, 40);
    let fidelities = [Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW];
    for (fidelity, is_shorter) in fidelities.map(|it| [(it, false), (it, true)]).concat() {
        let mut writer = CellWriter::new(Vec::new(), picture.as_size());
        writer.set_fidelity(fidelity);
        writer.set_repeats(is_shorter);
        writer.set_palette(is_shorter);
        let mut view = View::default();
        let mut before = Buffer::empty(picture);
        let mut encode = |turn: usize| {
            camera.heading = camera.heading.turned(if turn % 8 < 6 { 0.1 } else { 0.0 });
            let mut buffer = Buffer::empty(picture);
            FirstPerson::new(&world, &camera).render(picture, &mut buffer, &mut view);
            let changes = before.diff(&buffer);
            writer.output_mut().clear();
            let counted = measure(|| {
                writer.draw(changes.iter().copied()).unwrap();
                Backend::flush(&mut writer).unwrap();
            });
            before = buffer;
            counted.count_total
        };
        // After two full turns, every buffer has its final size.
        (0..170).for_each(|turn| _ = encode(turn));
        assert_eq!((0..80).map(&mut encode).sum::<u64>(), 0, "{fidelity}");
    }
}

/// From the player's intents to the bytes of a frame, as in a game: two steps, the whole picture,
/// and its encoding.
#[test]
#[cfg(feature = "terminal")]
fn the_whole_pipeline_allocates_nothing_once_its_memory_has_grown() {
    use cellcaster::app::{Levels, Replay, Settings};
    use cellcaster::game::{Intents, Script};
    use cellcaster::map::Level;
    use cellcaster::terminal::{CellWriter, Fidelity};
    use ratatui::backend::Backend;
    use ratatui::layout::Size;

    const SIZE: Size = Size::new(120, 40);
    let script = include_str!("../../maps/showcase.script");
    let script = Script::parse(script, "showcase.script").unwrap();
    let intents: Vec<Intents> = script.iter().map(|(_, intents)| intents).collect();
    let citadel = map::load("tests/maps/citadel.toml".as_ref()).unwrap();
    for fidelity in [Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW] {
        let level = Level::Grid(Box::new(citadel.clone()));
        let levels = Levels::new(level, std::iter::empty());
        let mut replay = Replay::new(levels, Settings::default(), SIZE);
        let mut writer = CellWriter::new(Vec::new(), SIZE);
        writer.set_fidelity(fidelity);
        let mut pass = || {
            let frames = intents.chunks_exact(2).map(|steps| {
                writer.output_mut().clear();
                measure(|| {
                    for &intents in steps {
                        replay.step(intents);
                    }
                    writer.draw_frame(|screen| replay.draw(screen));
                    Backend::flush(&mut writer).unwrap();
                })
                .count_total
            });
            frames.sum::<u64>()
        };
        // The second walk starts where the first ended, and shows other things.
        pass();
        assert_eq!(pass(), 0, "{fidelity}");
    }
}

#[test]
fn moving_figures_allocate_nothing_after_the_first_frames() {
    for map in ["things", "mirrors"] {
        let mut world = map::load(format!("maps/gallery/{map}.toml").as_ref()).unwrap();
        let position = world.start().cell.center();
        let sprite = world.things()[0].sprite;
        let mut renderer = Renderer::new();
        let mut frame = Frame::new(FrameSize::new(160, 90).unwrap(), PixelAspect::SQUARE);
        let mut draw = |turn: u32| {
            let heading = Heading::from_degrees(f64::from(turn) * 6.0).unwrap();
            let camera = Camera::new(position, heading, FieldOfView::default()).unwrap();
            let figures = (0..20).map(|index| Figure {
                sprite,
                position: position + heading.direction() * (0.5 + 0.1 * f64::from(index)),
                base: 0.0,
                heading,
                frame: 0,
                opacity: 200,
            });
            measure(|| {
                world.set_figures(figures);
                renderer.render(&world, &camera, &mut frame);
            })
            .count_total
        };
        (0..60).for_each(|turn| _ = draw(turn));
        assert_eq!((0..60).map(&mut draw).sum::<u64>(), 0, "{map}");
    }
}
