//! The part of the map that each image shows: for each row of cells, the stretch of it.
//!
//! What is seen in an image is what lies along its rays, as far as they are in it. Each of those legs is
//! followed on the map, where the rows that it crosses take it in. A thing whose picture reaches into a ray
//! is no further beside that than half its width, so that what lies between two rays need not be asked
//! for. The rectangle around all legs was refused: of a diagonal view it is everything on both sides.

use super::notes::Leg;
use super::{IMAGES_AT_ONCE, Reflection, Scene};
use crate::render::things::Sight;
use crate::world::{Thing, World};

/// What is seen in each of the images; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct Sights {
    /// One for each image, and some to spare.
    list: Vec<Sight>,
    /// How far to the north and to the south each image reaches.
    extents: Vec<Extent>,
}

/// From where to where something reaches from north to south.
#[derive(Clone, Copy, Debug)]
struct Extent {
    north: f64,
    south: f64,
}

impl Extent {
    const NONE: Self = Self { north: f64::INFINITY, south: f64::NEG_INFINITY };

    fn include(&mut self, y: f64) {
        *self = Self { north: self.north.min(y), south: self.south.max(y) };
    }
}

impl Sights {
    /// Finds out what is seen in so many images, by all `legs` of rays.
    pub(super) fn look(&mut self, scene: Scene<'_>, images: usize, legs: &[Leg]) {
        self.make_room(scene.world, images);
        self.extents.clear();
        self.extents.resize(images, Extent::NONE);
        // Those that end nowhere near the map are left out.
        let is_near = |leg: &&Leg| leg.ends.iter().all(|end| end.is_finite());
        let legs = || legs.iter().filter(is_near);
        for Leg { ends, reflection: Reflection(image) } in legs() {
            for end in ends {
                self.extents[usize::from(*image)].include(end.y);
            }
        }
        for (sight, extent) in self.list.iter_mut().zip(&self.extents) {
            sight.begin(scene.world, extent.north, extent.south);
        }
        for &Leg { ends: [one, other], reflection: Reflection(image) } in legs() {
            self.list[usize::from(image)].follow(one, other);
        }
    }

    /// The things of which a part may be in view in an image, row by row.
    pub(super) fn things<'a>(
        &self,
        image: usize,
        world: &'a World,
    ) -> impl Iterator<Item = &'a Thing> {
        self.list[image].things(world)
    }

    fn make_room(&mut self, world: &World, count: usize) {
        let at_once = if world.has_mirrors() { count.max(IMAGES_AT_ONCE) } else { count };
        if self.list.len() < at_once {
            self.list.resize_with(at_once, Sight::default);
            self.list.iter_mut().for_each(|sight| sight.make_room(world));
            self.extents.reserve(at_once);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::super::Windows;
    use super::super::veils::Veil;
    use super::*;
    use crate::map;
    use crate::render::{Filter, FrameSize, PixelAspect, Projection, WallLoop};
    use crate::world::{Camera, FieldOfView, Heading};

    const SIDE: usize = 12;

    /// A map of walls, mirrors, steps and plants, some of them so high that they are wider than a cell.
    fn world(cells: &[char]) -> World {
        let rows: String =
            cells.chunks(SIDE).map(|row| row.iter().collect::<String>() + "\n").collect();
        let text = format!(
            "ceiling = 'sky'\ngrid = '''\n{}'''\n[tiles]\n'#' = {{ wall = 'brick' }}\n\
             'l' = {{ wall = 'brick', height = 0.3 }}\n'M' = {{ mirror = true }}\n\
             's' = {{ floor_height = 0.25 }}\n[things]\n'@' = {{ start = 0 }}\n\
             'p' = {{ sprite = 'plant' }}\n'P' = {{ sprite = 'table', height = 3 }}\n",
            rows.replacen('.', "@", 1)
        );
        map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        #[test]
        fn nothing_that_a_ray_passes_is_left_out(
            cells in prop::collection::vec(
                prop::sample::select(&['.', '.', '.', 'p', 'p', 'P', '#', 'l', 'M', 's'][..]),
                SIDE * SIDE,
            ),
            position in (-2.0..14.0, -2.0..14.0),
            degrees in prop_oneof![0.0..360.0, prop::sample::select(&[0.0, 45.0, 90.0][..])],
        ) {
            prop_assume!(cells.contains(&'.'));
            let world = &world(&cells);
            let heading = Heading::from_degrees(degrees).unwrap();
            let camera = Camera::new(position.into(), heading, FieldOfView::default()).unwrap();
            let size = FrameSize::new(30, 20).unwrap();
            let projection = &Projection::new(&camera, size, PixelAspect::SQUARE);
            let walls = WallLoop { textured: true, faded: false, jambs: false };
            let scene = Scene::new(world, projection, Filter::Mip, walls);
            let mut windows = Windows::default();
            windows.look(scene, size.height.get(), &mut Vec::new());
            let mut sights = Sights::default();
            sights.look(scene, windows.notes.images.len(), &windows.notes.legs);
            let considered: Vec<BTreeSet<_>> = (0..windows.notes.images.len())
                .map(|image| sights.things(image, world).map(|thing| thing.cell).collect())
                .collect();
            for veil in &windows.notes.veils {
                let Veil::Things(between) = veil else { continue };
                let Reflection(image) = between.reflection;
                let unfolding = windows.notes.images[usize::from(image)];
                for thing in world.things() {
                    let place = projection.place(unfolding.unfolded_point(thing.cell.center()));
                    let width = world.sprite(thing.sprite).width();
                    let half = projection.columns_for(width, place.depth) / 2.0;
                    let column = f64::from(between.column) + 0.5;
                    let is_met = (between.from..between.to).contains(&place.depth)
                        && (place.column - column).abs() <= half;
                    let is_known = considered[usize::from(image)].contains(&thing.cell);
                    prop_assert!(!is_met || is_known, "{thing:?} in image {image}");
                }
            }
        }
    }
}
