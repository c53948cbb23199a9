//! Ray segments: the cells in view of each image.
//!
//! The contents of an image lie along the parts of rays that are in it. Each such segment is
//! followed on the map, and extends the interval of each row of cells that it crosses. A thing that
//! extends into a ray is at most half its width from it, so that the area between two rays need not
//! be considered. Rejected: the rectangle around all segments. For a diagonal view it contains
//! everything on both sides.

use glam::DVec2;

use super::ImageId;
use crate::visibility::Scene;
use crate::visibility::runs::IMAGES_AT_ONCE;
use crate::visibility::visible_cells::VisibleCells;
use crate::world::{Thing, World};

/// The part of a ray in one image, by its two ends on the map.
#[derive(Clone, Debug)]
pub(crate) struct RaySegment {
    pub(crate) ends: [DVec2; 2],
    pub(crate) image: ImageId,
}

/// The visible cells of each image, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct ImagesInView {
    /// One for each image, and possibly more.
    list: Vec<VisibleCells>,
    /// The extent of each image from north to south.
    extents: Vec<NorthSouth>,
}

/// An interval of coordinates from north to south.
#[derive(Clone, Copy, Debug)]
struct NorthSouth {
    north: f64,
    south: f64,
}

impl NorthSouth {
    const NONE: Self = Self { north: f64::INFINITY, south: f64::NEG_INFINITY };

    fn include(&mut self, y: f64) {
        *self = Self { north: self.north.min(y), south: self.south.max(y) };
    }
}

impl ImagesInView {
    /// Finds the cells that the `segments` cross in each of this number of images.
    pub(crate) fn look(&mut self, scene: Scene<'_>, images: usize, segments: &[RaySegment]) {
        self.make_room(scene.world, images);
        let list = &mut self.list[..images];
        if list.iter_mut().all(|visible| visible.shows_all_of(scene.world)) {
            return;
        }
        self.extents.clear();
        self.extents.resize(images, NorthSouth::NONE);
        // Segments that end nowhere near the map are excluded.
        let is_near = |segment: &&RaySegment| segment.ends.iter().all(|end| end.is_finite());
        let segments = || segments.iter().filter(is_near);
        for RaySegment { ends, image: ImageId(image) } in segments() {
            for end in ends {
                self.extents[usize::from(*image)].include(end.y);
            }
        }
        for (visible, extent) in self.list.iter_mut().zip(&self.extents) {
            visible.begin(scene.world, extent.north, extent.south);
        }
        for &RaySegment { ends: [one, other], image: ImageId(image) } in segments() {
            self.list[usize::from(image)].follow(one, other);
        }
    }

    /// The things of which a part may be in view in an image, row by row.
    pub(crate) fn things<'a>(
        &self,
        image: usize,
        world: &'a World,
    ) -> impl Iterator<Item = &'a Thing> {
        self.list[image].things(world)
    }

    /// Reserves memory for at least `count` images of `world`.
    pub(crate) fn make_room(&mut self, world: &World, count: usize) {
        let at_once = if world.has_mirrors() { count.max(IMAGES_AT_ONCE) } else { count };
        if self.list.len() < at_once {
            self.list.resize_with(at_once, VisibleCells::default);
            self.list.iter_mut().for_each(|visible| visible.make_room(world));
            self.extents.reserve(at_once);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;
    use crate::map;
    use crate::visibility::portal::layers::Passed;
    use crate::visibility::portal::{self, PortalMemory};
    use crate::visibility::{
        DrawList, Filter, FramePlan, FrameSize, PixelAspect, Projection, Stats, Visibility,
        WhyPortals,
    };
    use crate::world::{Camera, FieldOfView, Heading};

    const SIDE: usize = 12;

    /// A map of walls, mirrors, steps and plants, some of them so high that they are wider than a
    /// cell.
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
            let plan = &FramePlan {
                visibility: Visibility::Portals(WhyPortals::Heights),
                ..FramePlan::new(world, &camera, Filter::Mip)
            };
            let scene = Scene { world, camera: &camera, seconds: 0.0, projection, plan };
            let (mut memory, mut list) = (PortalMemory::default(), DrawList::default());
            portal::fill(scene, &mut memory, &mut list, &mut Stats::default());
            let mut in_view = ImagesInView::default();
            let images = list.runs.images();
            in_view.look(scene, images.len(), &memory.walk.segments);
            let considered: Vec<BTreeSet<_>> = (0..images.len())
                .map(|image| in_view.things(image, world).map(|thing| thing.cell).collect())
                .collect();
            for passed in memory.walk.passed.items() {
                let Passed::Billboards(part) = passed else { continue };
                let ImageId(image) = part.image;
                let transform = images[usize::from(image)];
                for thing in world.things() {
                    let place = projection.place(transform.in_image(thing.cell.center()));
                    let width = world.sprite(thing.sprite).width();
                    let half = projection.columns_for(width, place.depth) / 2.0;
                    let column = f64::from(part.column) + 0.5;
                    let is_met = (part.from..part.to).contains(&place.depth)
                        && (place.column - column).abs() <= half;
                    let is_known = considered[usize::from(image)].contains(&thing.cell);
                    prop_assert!(!is_met || is_known, "{thing:?} in image {image}");
                }
            }
        }
    }
}
