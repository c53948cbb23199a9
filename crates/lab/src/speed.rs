//! The speed of drawing: scenes, a walk through them, two loops for comparison, and the costs of
//! large and crowded maps.
//!
//! A time means little on an unknown machine. Reports therefore contain ratios: to the classic
//! loop, as found in tutorials, and to a fill of the same number of pixels, which no renderer can
//! beat. All three draw the same map with the same textures from the same cameras. `pixel_aspect`
//! gives the renderer's picture the proportions of the classic picture, so that both draw the same
//! pixels.

mod classic;
mod drawing;
mod growth;

pub(crate) use drawing::measure_drawing;
pub(crate) use growth::{measure_crowds, measure_maps};

use cellcaster::game::{Game, Intent, Intents};
use cellcaster::map;
use cellcaster::render::{FrameSize, PixelAspect};
use cellcaster::world::{Camera, FieldOfView, World};

/// A level of rooms and pillars, with five wall textures and a textured floor and ceiling.
pub(crate) fn textured_scene() -> World {
    scene("\"flagstone\"", "\"wood\"")
}

/// The same level with a floor and a ceiling of one colour each.
fn plain_scene() -> World {
    scene("\"#403830\"", "\"#202028\"")
}

fn scene(floor: &str, ceiling: &str) -> World {
    let text = format!("floor = {floor}\nceiling = {ceiling}\n{ROOMS}");
    map::parse_str(&text).expect("the level is sound, and tests parse it")
}

const ROOMS: &str = include_str!("speed/rooms.toml");

/// `count` cameras along a walk through `world` that turns continually, and therefore looks in all
/// directions.
fn walk(world: &World, count: usize) -> Vec<Camera> {
    const STEPS_BETWEEN: usize = 6;
    let mut game = Game::new(world.clone());
    let turning: Intents = [Intent::Forward, Intent::TurnRight, Intent::Aim].into_iter().collect();
    let straight: Intents = [Intent::Forward].into_iter().collect();
    let mut view = |camera: usize| {
        // A camera that pushes into a wall shows little else; a turn leads away from the wall.
        let intents = if camera % 16 < 10 { straight } else { turning };
        for _ in 0..STEPS_BETWEEN {
            game.step(intents);
        }
        game.camera(FieldOfView::default())
    };
    (0..count).map(&mut view).collect()
}

/// The pixel shape for which a wall is as high as in the classic picture, in which a cube at
/// distance 1 from the camera fills the picture from top to bottom.
fn pixel_aspect(size: FrameSize) -> PixelAspect {
    let (width, height) = (f64::from(size.width.get()), f64::from(size.height.get()));
    let across = width / 2.0 / FieldOfView::default().half_width();
    PixelAspect::new(across / height).unwrap_or(PixelAspect::SQUARE)
}

#[cfg(test)]
mod tests {
    use super::classic::{Classic, ClassicFloor};
    use super::*;
    use cellcaster::render::{Filter, Frame, Renderer};

    const SIZE: (u32, u32) = (160, 90);

    /// A comparison is only meaningful if both renderers draw the same picture.
    #[test]
    fn the_classic_loop_draws_the_same_walls() {
        for (world, floor) in [
            (plain_scene(), ClassicFloor::None),
            (textured_scene(), ClassicFloor::ByColumn),
            (textured_scene(), ClassicFloor::ByScanline),
        ] {
            let size = FrameSize::new(SIZE.0, SIZE.1).unwrap();
            let classic = Classic::new(&world);
            let mut renderer = Renderer::new();
            renderer.set_filter(Filter::Nearest);
            let mut frame = Frame::new(size, pixel_aspect(size));
            let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
            for camera in walk(&world, 24) {
                renderer.render(&world, &camera, &mut frame);
                classic.draw(&camera, floor, (SIZE.0 as usize, SIZE.1 as usize), &mut pixels);
                let ours = frame.rows().flatten();
                let alike = ours.zip(&pixels).filter(|&(ours, theirs)| {
                    let theirs = theirs.to_be_bytes();
                    let apart = ours.channels().into_iter().zip(&theirs[1..]);
                    apart.into_iter().all(|(one, &other)| one.abs_diff(other) <= 48)
                });
                // The classic loop casts through the edges of pixels, and the renderer through
                // their centres.
                let share = alike.count() as f64 / pixels.len() as f64;
                assert!(share > 0.7, "{floor:?}: {share}");
            }
        }
    }

    #[test]
    fn the_walk_visits_many_cells() {
        let world = plain_scene();
        let cameras = walk(&world, 240);
        let cells: std::collections::HashSet<_> = cameras
            .iter()
            .map(|camera| (camera.position().x as i64, camera.position().y as i64))
            .collect();
        assert!(cells.len() > 30, "{} cells", cells.len());
    }
}
