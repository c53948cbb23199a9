//! What the filter by area gains over mip levels.

use ratatui::layout::Size;

use super::{CAMERAS, DISPLAYS, Differences, cameras, compare, way};
use cellcaster::map::builtin;
use cellcaster::render::Filter;

#[test]
fn areas_have_little_more_than_half_the_error_and_crawl_of_mip_levels() {
    let level = builtin::LEVELS.iter().find(|level| level.name == "museum");
    let world = level.unwrap().world().unwrap();
    let shown = [Filter::Area, Filter::Mip].map(|filter| (DISPLAYS[0], filter));
    for size in [Size::new(80, 24), Size::new(160, 45)] {
        let mut all = [Differences::default(), Differences::default()];
        for camera in cameras(&world, 1).take(CAMERAS) {
            compare(&world, &way(camera)[..2], size, &shown, &mut all);
        }
        let [area, mip] = all.map(|differences| differences.values());
        for (index, most) in [(1, 0.55), (7, 0.65)] {
            let [area, mip]: [f64; 2] = [&area, &mip].map(|it| it[index].number().unwrap());
            assert!(0.0 < area && area < most * mip, "{index} in {size}: {area} {mip}");
        }
    }
}
