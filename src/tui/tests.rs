//! Tests of every widget on areas of every small size, each after every other.

use glam::DVec2;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::{StatefulWidget, Widget};

use super::*;
use crate::color::palette::ColorDepth;
use crate::map::{builtin, parse_str};
use crate::render::Renderable;
use crate::space::Scene;
use crate::world::{FieldOfView, Heading, World};

const MODES: [GlyphSet; 6] = [
    GlyphSet::Half,
    GlyphSet::Quadrant,
    GlyphSet::Sextant,
    GlyphSet::Octant,
    GlyphSet::Ascii,
    GlyphSet::Ramp,
];
const DEPTHS: [ColorDepth; 4] =
    [ColorDepth::True, ColorDepth::Indexed256, ColorDepth::Indexed16, ColorDepth::Mono];

/// Heights, a pit and things, in a room.
const HEIGHTS: &str = r##"
ceiling = "sky"
grid = '''
########
#@.ab.p#
#..o...#
########
'''
[tiles]
"#" = { wall = "brick", height = 1.5 }
"a" = { floor_height = 0.5 }
"b" = { floor_height = 0.25, ceiling = "wood", ceiling_height = 1.2 }
"p" = { floor_height = -0.5 }
[things]
"@" = { start = 0 }
"o" = { sprite = "barrel" }
"##;

fn heights() -> World {
    parse_str(HEIGHTS).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The areas of 0 to 3 columns and rows, and a large area. Each area follows each area once.
fn areas_in_turn() -> impl Iterator<Item = Rect> {
    let areas = || {
        let small =
            (0..4).flat_map(|width| (0..4).map(move |height| Rect::new(1, 1, width, height)));
        small.chain([Rect::new(0, 0, 9, 5)])
    };
    areas().flat_map(move |before| areas().flat_map(move |area| [before, area]))
}

/// Asserts that `draw` fills each of the areas and draws nothing outside of it.
fn assert_filled(mut draw: impl FnMut(Rect, &mut Buffer)) {
    let mut buffer = Buffer::empty(Rect::new(0, 0, 9, 5));
    for area in areas_in_turn() {
        for cell in &mut buffer.content {
            cell.set_symbol("?").set_fg(Color::Magenta);
        }
        draw(area, &mut buffer);
        for position in buffer.area.positions() {
            let cell = &buffer[position];
            let is_untouched = cell.symbol() == "?" && cell.fg == Color::Magenta;
            assert_eq!(is_untouched, !area.contains(position), "{position} of {area}: {cell:?}");
        }
    }
}

fn assert_pictures_fill<S: Renderable>(scene: &S) {
    let camera = scene.start_camera(FieldOfView::default());
    let mut view = View::<S>::default();
    for (glyphs, depth) in MODES.into_iter().flat_map(|mode| DEPTHS.map(|depth| (mode, depth))) {
        let widget = FirstPerson::new(scene, &camera).glyphs(glyphs).color_depth(depth);
        assert_filled(|area, buffer| widget.render(area, buffer, &mut view));
    }
}

#[test]
fn pictures_of_a_grid_fill_exactly_their_area() {
    assert_pictures_fill(&builtin::LEVELS[0].world().unwrap());
    assert_pictures_fill(&heights());
}

#[test]
fn pictures_of_bodies_fill_exactly_their_area() {
    assert_pictures_fill(&Scene::default());
}

#[test]
fn maps_fill_exactly_their_area() {
    let world = heights();
    let camera = world.start_camera(FieldOfView::default());
    let mut explored = Explored::default();
    explored.look(&world, &camera, 9);
    let heading = Heading::from_degrees(90.0).unwrap();
    let marks =
        [DVec2::new(2.5, 1.5), DVec2::new(-1.0, 9.0)].map(|position| MapMark { position, heading });
    for (glyphs, depth) in MODES.into_iter().flat_map(|mode| DEPTHS.map(|depth| (mode, depth))) {
        for zoom in [-3, 0, 3] {
            let map = Minimap::new(&world, &camera).glyphs(glyphs).color_depth(depth).zoom(zoom);
            assert_filled(|area, buffer| map.marks(&marks).render(area, buffer));
            assert_filled(|area, buffer| map.explored(&explored).render(area, buffer));
        }
    }
}

/// The layout of this module's example, in windows that have no room for the picture.
#[test]
fn the_layout_example_works_in_any_window() {
    use ratatui::layout::{Constraint, Layout};
    let world = heights();
    let camera = world.start_camera(FieldOfView::default());
    let mut view = View::default();
    for (columns, rows) in (0..50).flat_map(|columns| [0, 1, 2, 24].map(|rows| (columns, rows))) {
        let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
        let panels = [Constraint::Fill(1), Constraint::Length(40)];
        let [picture, map] = Layout::horizontal(panels).areas(buffer.area);
        FirstPerson::new(&world, &camera).render(picture, &mut buffer, &mut view);
        Minimap::new(&world, &camera).seen(view.distances()).render(map, &mut buffer);
    }
}
