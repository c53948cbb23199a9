//! The passes for a world that is level: one wall for each column, floor and ceiling around it.
//!
//! What is the same for the whole picture is found out first: what the rays hit, what stands in view.
//! With that, its bands are drawn, by one thread or by many.

use super::band::Band;
use super::coat::Wardrobe;
use super::marks::MarksOfBand;
use super::planes::{Plane, PlaneKind, RowOfPlane};
use super::see_through::{self, Left, Passed};
use super::sky::SkyView;
use super::tally::Tally;
use super::things::InView;
use super::threads::draw_bands;
use super::{
    CeilingLoop, Geometry, Memory, Picture, Plan, Projection, Scene, ThingLoop, columns, walls,
};
use crate::cast::Caster;

/// What the passes for a band hand on to each other; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct Worker {
    rows_of_plane: Vec<RowOfPlane>,
    wardrobe: Wardrobe,
    left: Left,
}

/// What all bands of a picture are drawn from.
struct Shared<'a> {
    plan: Plan,
    scene: Scene<'a>,
    height: u32,
    seconds: f64,
    sky: SkyView<'a>,
    passed: &'a Passed,
    in_view: &'a InView,
}

/// Draws `picture`.
pub(super) fn draw<T: Tally, C: Caster>(picture: Picture<'_, T>, plan: Plan, caster: &C) {
    let Picture { world, camera, filter, seconds, memory, frame, tally, .. } = picture;
    let Memory {
        columns,
        first_row_of_ground,
        passed,
        sky,
        in_view,
        marks,
        next_change,
        geometry,
        workers,
        ..
    } = memory;
    let projection = &Projection::new(camera, frame.size(), frame.pixel_aspect());
    columns::cast(caster, world, projection, columns, passed);
    let scene = Scene { world, projection, columns, filter };
    *first_row_of_ground = projection.first_row_of_ground();
    *geometry = Some(Geometry::Level);
    *next_change = match plan.things {
        ThingLoop::None => None,
        ThingLoop::Billboards => {
            in_view.find(scene, tally);
            in_view.next_change(world, seconds)
        }
    };

    let height = frame.height();
    let sky = SkyView::new(world, projection, filter, sky);
    let shared = Shared { plan, scene, height, seconds, sky, passed, in_view };
    draw_bands(plan.threads, (frame, marks), workers, tally, |worker, band, marks| {
        shared.draw_band(worker, band, marks)
    });
}

impl Shared<'_> {
    /// Draws one of them, and tells what it cost.
    fn draw_band<T: Tally>(
        &self,
        worker: &mut Worker,
        band: &mut Band<'_>,
        marks: &mut MarksOfBand<'_>,
    ) -> T {
        let &Self { plan, scene, height, seconds, ref sky, passed, in_view } = self;
        let Worker { rows_of_plane, wardrobe, left } = worker;
        let mut spent = T::default();
        let tally = &mut spent;
        let plane = |kind| Plane { scene, kind, sky, height };
        match plan.ceiling {
            CeilingLoop::Sky => sky.draw_overhead(plan.sky, scene, band, tally),
            CeilingLoop::Laid(ceiling) => {
                plane(PlaneKind::Ceiling).draw(ceiling, rows_of_plane, band, tally);
                sky.draw_beyond_edge(scene, band, tally);
            }
        }
        plane(PlaneKind::Floor).draw(plan.floor, rows_of_plane, band, tally);
        walls::draw(scene, plan.walls, wardrobe, band, tally);
        match plan.things {
            ThingLoop::None => see_through::draw(scene, passed, marks, band, tally),
            ThingLoop::Billboards => {
                in_view.draw(scene, seconds, (passed, left), marks, band, tally);
            }
        }
        spent
    }
}
