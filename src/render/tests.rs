use glam::DVec2;

use super::{Frame, FrameSize, PixelAspect, Renderer};
use crate::map;
use crate::world::{FieldOfView, Figure, Heading};

/// Under the sky, a figure behind a level wall may show if it rises above the wall.
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
        let mut renderer = Renderer::new();
        renderer.render(&world, &camera, &mut frame);
        let (sprite, position) = (world.things()[0].sprite, DVec2::new(4.5, 0.5));
        let heading = Heading::default();
        let figure = Figure { sprite, position, base, heading, frame: 0, opacity: u8::MAX };
        renderer.may_show(&world, &camera, &frame, &figure)
    };
    assert!(may_show("sky", 0.2));
    assert!(!may_show("sky", 0.0));
    assert!(!may_show("oak", 0.2));
}
