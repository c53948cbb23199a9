//! The fraction of wrong pixels in whole pictures.

use super::cast;
use crate::casters::Method;
use cellcaster::cast::{Caster, Hit, Ray};
use cellcaster::render::{DynCaster, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::rng::SplitMix64;
use cellcaster::world::{Camera, Cell, FieldOfView, Grid, Heading, World};

/// Casts in rational arithmetic: never wrong, and thousands of times slower than the casters.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reference;

impl Caster for Reference {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let truth = cast(grid, ray)?;
        Some(Hit { cell: truth.cell, side: truth.side, t: truth.t.to_f64(), u: truth.u.to_f64() })
    }
}

/// Reference pictures of a world.
#[derive(Clone, Debug)]
pub struct Gallery<'world> {
    world: &'world World,
    pictures: Vec<(Camera, Frame)>,
}

impl<'world> Gallery<'world> {
    /// `count` pictures of `world` in this size: one from its start, the others from random
    /// positions.
    pub fn new(world: &'world World, size: FrameSize, count: usize, seed: u64) -> Self {
        let reference = DynCaster::new(Reference);
        let pictures = cameras(world, seed)
            .take(count)
            .map(|camera| (camera, draw(world, &camera, size, &reference)));
        Self { world, pictures: pictures.collect() }
    }

    /// The fraction of pixels that differ if `method` casts the rays, from 0 to 1.
    pub fn share_wrong(&self, method: &Method) -> f64 {
        let Self { world, pictures } = self;
        let caster = method.caster();
        let (mut wrong, mut all) = (0_usize, 0_usize);
        for (camera, truth) in pictures {
            let picture = draw(world, camera, truth.size(), &caster);
            let pairs = picture.rows().flatten().zip(truth.rows().flatten());
            wrong += pairs.filter(|(shown, truth)| shown != truth).count();
            all += picture.rows().flatten().count();
        }
        wrong as f64 / all.max(1) as f64
    }
}

/// The cameras of the pictures: the start of `world`, and then random positions.
pub(crate) fn cameras(world: &World, seed: u64) -> impl Iterator<Item = Camera> {
    let mut random = SplitMix64::new(seed);
    let start = world.start_camera(FieldOfView::default());
    std::iter::once(start).chain(std::iter::repeat_with(move || random_camera(world, &mut random)))
}

/// A random camera on open floor.
fn random_camera(world: &World, random: &mut SplitMix64) -> Camera {
    let grid = world.grid();
    let on_floor = |random: &mut SplitMix64| {
        let column = random.whole(0, grid.width() as i32 - 1);
        let row = random.whole(0, grid.height() as i32 - 1);
        let cell = Cell { column: column as u32, row: row as u32 };
        (!grid.is_solid(column as i64, row as i64)).then_some(cell)
    };
    // Open floor exists: the start is on it.
    let cell = std::iter::repeat_with(|| on_floor(random)).flatten().next();
    let heading = Heading::default().turned(random.between(0.0, std::f64::consts::TAU));
    Camera::in_cell(cell.unwrap_or(world.start().cell), heading, FieldOfView::default())
}

fn draw(world: &World, camera: &Camera, size: FrameSize, caster: &DynCaster) -> Frame {
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    let caster = DynCaster::new(OnlyWalls(caster.clone()));
    Renderer::with_caster(caster).render(world, camera, &mut frame);
    frame
}

/// Treats doors and transparent cubes as walls, as most methods do. The pictures then differ only
/// by where rays end.
#[derive(Debug)]
struct OnlyWalls(DynCaster);

impl Caster for OnlyWalls {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        self.0.cast(grid, ray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::map;

    #[test]
    fn exact_pictures_have_no_wrong_pixel_and_coarse_ones_have() {
        let museum = include_str!("../../../../tests/maps/museum.toml");
        let world = map::parse_str(museum).unwrap();
        let size = FrameSize::new(40, 24).unwrap();
        let gallery = Gallery::new(&world, size, 3, 7);
        assert_eq!(gallery.share_wrong(&Method::Exact), 0.0);
        assert!(gallery.share_wrong(&"march:0.2".parse().unwrap()) > 0.0);
    }
}
