use proptest::prelude::*;

use crate::map;
use crate::visibility::portal::{self, PortalMemory, PortalStart};
use crate::visibility::runs::{FlatSurface, ImageId, Shown};
use crate::visibility::{
    Column, DrawList, Filter, FramePlan, FrameSize, PixelAspect, Projection, Scene, Stats,
    Visibility, WhyPortals,
};
use crate::world::{Camera, FieldOfView, Heading, World};

const SIDE: usize = 10;
const COLUMNS: u32 = 40;

/// A map with everything that divides bundles.
fn world(cells: &[char]) -> World {
    let rows: String =
        cells.chunks(SIDE).map(|row| row.iter().collect::<String>() + "\n").collect();
    let text = format!(
        "ceiling = 'sky'\ngrid = '''\n{}'''\n[tiles]\n'#' = {{ wall = 'brick' }}\n\
         'l' = {{ wall = 'brick', height = 0.3 }}\n'M' = {{ mirror = true }}\n\
         'T' = {{ mirror = '#80a0c0', opacity = 0.3 }}\n's' = {{ floor_height = 0.25 }}\n\
         'g' = {{ glass = '#4080ff', opacity = 0.3 }}\n\
         'r' = {{ ceiling_height = 0.7, roof_height = 1.0, ceiling = 'oak' }}\n\
         'o' = {{ pillar = 'marble', radius = 0.3, height = 0.4 }}\n\
         [things]\n'@' = {{ start = 0 }}\n'p' = {{ sprite = 'plant' }}\n",
        rows.replacen('.', "@", 1)
    );
    map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The contents of `column` of a draw list.
fn contents(list: &DrawList, column: u32) -> String {
    let x = column as usize;
    // Images are numbered in the order in which they are found.
    let runs = list.runs.columns().nth(x).unwrap().iter().map(|run| {
        let image = match run.shown {
            Shown::Sky(image) | Shown::Plane(FlatSurface { image, .. }) => image,
            Shown::Flat | Shown::Face(_) => ImageId::NONE,
        };
        let shown = match run.shown {
            Shown::Sky(_) => Shown::Sky(ImageId::NONE),
            Shown::Plane(it) => Shown::Plane(FlatSurface { image: ImageId::NONE, ..it }),
            other => other,
        };
        (&run.rows, shown, list.runs.image(image))
    });
    let walls = list.walls.iter().filter(|wall| wall.column == column);
    let see_through = list.see_through.iter().filter(|face| face.column == column);
    format!(
        "{:?} {:?} {:?} {:?}",
        list.columns[x],
        runs.collect::<Vec<_>>(),
        walls.collect::<Vec<_>>(),
        see_through.collect::<Vec<_>>()
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn a_ray_shows_the_same_in_a_bundle_and_alone(
        cells in prop::collection::vec(
            prop::sample::select(
                &['.', '.', '.', '.', 'p', '#', 'l', 'M', 'T', 's', 'g', 'r', 'o'][..]
            ),
            SIDE * SIDE,
        ),
        position in prop::array::uniform2(prop_oneof![
            -1.0..11.0,
            (-2..22_i32).prop_map(|halves| f64::from(halves) / 2.0),
        ]),
        degrees in prop_oneof![0.0..360.0, prop::sample::select(&[0.0, 45.0, 90.0][..])],
    ) {
        prop_assume!(cells.contains(&'.'));
        let world = &world(&cells);
        let heading = Heading::from_degrees(degrees).unwrap();
        let camera = Camera::new(position.into(), heading, FieldOfView::default()).unwrap();
        let size = FrameSize::new(COLUMNS, 30).unwrap();
        let projection = &Projection::new(&camera, size, PixelAspect::SQUARE);
        let plan = &FramePlan {
            visibility: Visibility::Portals(WhyPortals::Heights),
            ..FramePlan::new(world, &camera, Filter::Mip)
        };
        let scene = Scene { world, camera: &camera, seconds: 0.0, projection, plan };
        let fill = |of_column: &dyn Fn(u32) -> Option<PortalStart>| {
            let (mut memory, mut list) = (PortalMemory::default(), DrawList::default());
            memory.make_room(world, COLUMNS as usize, &mut list);
            list.columns.resize(COLUMNS as usize, Column::UNKNOWN);
            let mut starts = (0..COLUMNS).map(of_column);
            portal::fill_columns(scene, &mut memory, &mut list, &mut Stats::default(), |_| starts.next()?);
            list
        };
        let together = fill(&|_| Some(PortalStart::Camera));
        for column in 0..COLUMNS {
            let alone = fill(&|it| (it == column).then_some(PortalStart::Camera));
            prop_assert_eq!(contents(&alone, column), contents(&together, column));
        }
    }
}
