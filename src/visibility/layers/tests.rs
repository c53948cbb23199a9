use std::collections::BTreeSet;

use proptest::prelude::*;

use super::*;
use crate::map;
use crate::visibility::walk::{self, WalkMemory};
use crate::visibility::{Filter, FramePlan, FrameSize, PixelAspect, Projection};
use crate::world::{Camera, FieldOfView, Heading};

const SIDE: usize = 12;

/// A map of walls, mirrors, steps, plants and tables. The tables are so high that they are wider than a cell.
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
    fn no_thing_that_a_ray_meets_is_left_out(
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
        let plan = &FramePlan::new(world, Filter::Mip);
        let scene = FrameContext { world, camera: &camera, seconds: 0.0, projection, plan };
        let (mut list, mut walked) = (DrawList::default(), WalkMemory::default());
        list.begin(projection.columns());
        walked.make_room(projection.columns());
        list.sectors.begin(world, walk::top_of_sky(scene));
        list.directions.begin(projection);
        walk::walk(scene, &mut walked, &mut list);
        let mut memory = LayerMemory::default();
        look(scene, &mut memory, &list);
        let considered: Vec<BTreeSet<_>> = (0..list.images.len())
            .map(|image| memory.visible[image].things(world).map(|thing| thing.cell).collect())
            .collect();
        for layer in &list.passed {
            let Layer::Part(part) = layer else { continue };
            let image = list.images.iter().position(|&it| it == part.image).unwrap();
            for (x, stretch) in part.columns.clone().zip(&list.stretches[part.first..]) {
                for thing in world.things() {
                    let place = projection.place(part.image.in_image(thing.cell.center()));
                    let width = world.sprite(thing.sprite).width();
                    let half = projection.columns_for(width, place.depth) / 2.0;
                    let is_met = (stretch.from..stretch.to).contains(&place.depth)
                        && (place.column - (x as f64 + 0.5)).abs() <= half;
                    let is_known = considered[image].contains(&thing.cell);
                    prop_assert!(!is_met || is_known, "{thing:?} in image {image}");
                }
            }
        }
    }
}
