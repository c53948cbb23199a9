//! A circle that meets a shape: a disc around a pillar, or a line with round ends.
//!
//! Along a line, the centre stays [`SKIN`] farther away than the radius. A position at exactly that
//! distance from a slanted line cannot be represented in doubles, and a player who slides along it
//! would be stopped by rounding in every step.

use glam::DVec2;

use super::Radius;
use super::sweep::{Path, distance_to_disc};
use crate::world::{Cell, Line, Outline};

/// How much farther than its radius a circle stays away from a line, in cells.
const SKIN: f64 = 1e-9;
/// A path that approaches a line by less than this for each cell is parallel to it.
const PARALLEL: f64 = 1e-12;

/// A contact of a circle with a shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// The distance along the path.
    pub(crate) distance: f64,
    /// The part of the shape nearest to the circle's centre then.
    pub(crate) kind: TouchKind,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum TouchKind {
    /// A round part around its centre: a pillar, or an end of a line.
    Round(DVec2),
    /// The side of a line, seen from a `position`; `normal` points there.
    Flat { position: DVec2, normal: DVec2 },
}

/// Whether a circle around `center` does not overlap an outline in `cell`; it may touch.
pub(crate) fn is_clear_of(
    outline: Outline,
    cell: Cell,
    center: DVec2,
    Radius(radius): Radius,
) -> bool {
    outline.distance(cell, center) >= radius
}

/// The first contact of a circle on `path` with an outline in `cell`.
pub(crate) fn first_touch(
    outline: Outline,
    cell: Cell,
    path: Path,
    Radius(radius): Radius,
) -> Option<Touch> {
    let round = |center: DVec2, radius: f64| {
        let distance = distance_to_disc(path, center, radius)?;
        Some(Touch { distance, kind: TouchKind::Round(center) })
    };
    match outline {
        Outline::Pillar(pillar) => round(cell.center(), radius + pillar.cells()),
        Outline::Line(line) => {
            let start = line.start(cell);
            let touches = [
                first_touch_of_side(line, start, path, radius),
                round(start, radius),
                round(start + line.stretch(), radius),
            ];
            touches
                .into_iter()
                .flatten()
                .min_by(|one, other| one.distance.total_cmp(&other.distance))
        }
    }
}

fn first_touch_of_side(line: Line, start: DVec2, path: Path, radius: f64) -> Option<Touch> {
    let stretch = line.stretch();
    let length = stretch.length();
    let normal = stretch.perp() / length;
    let offset = path.at(0.0) - start;
    let normal = if offset.dot(normal) < 0.0 { -normal } else { normal };
    let away = offset.dot(normal) - (radius + SKIN);
    let approach = -path.direction().dot(normal);
    if approach <= PARALLEL {
        return None;
    }
    let distance = (away / approach).max(0.0);
    let point = path.at(distance);
    let along = (point - start).dot(stretch) / length;
    // Off by rounding, or because the path began inside the skin.
    let position = point + normal * (radius + SKIN - (point - start).dot(normal));
    let kind = TouchKind::Flat { position, normal };
    (0.0..=length).contains(&along).then_some(Touch { distance, kind })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::*;
    use crate::game::collision::{Body, Obstacles, is_clear, slide};
    use crate::world::PillarRadius;

    const SIDE: u32 = 7;

    /// A closed room with shapes in some of its cells.
    #[derive(Clone, Debug)]
    struct Room(Vec<Option<Outline>>);

    impl Obstacles for Room {
        fn blocks(&self, column: i64, row: i64) -> bool {
            let inside = 0..i64::from(SIDE);
            !inside.contains(&column) || !inside.contains(&row)
        }

        fn outline(&self, cell: Cell) -> Option<Outline> {
            let index = cell.row * SIDE + cell.column;
            self.0.get(index as usize).copied().flatten().filter(|_| cell.column < SIDE)
        }
    }

    impl Room {
        fn empty() -> Self {
            Self(vec![None; (SIDE * SIDE) as usize])
        }

        fn with(mut self, column: u32, row: u32, outline: Outline) -> Self {
            self.0[(row * SIDE + column) as usize] = Some(outline);
            self
        }

        fn clearance(&self, point: DVec2) -> f64 {
            let cells = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| Cell { column, row }));
            let distances =
                cells.filter_map(|cell| Some(self.outline(cell)?.distance(cell, point)));
            distances.fold(f64::INFINITY, f64::min)
        }
    }

    fn any_outline() -> impl Strategy<Value = Outline> {
        let pillar = prop_oneof![Just(0.5), 0.01..0.5]
            .prop_map(|radius| Outline::Pillar(PillarRadius::new(radius).unwrap()));
        prop_oneof![pillar, prop::sample::select(&Line::ALL[..]).prop_map(Outline::Line)]
    }

    /// A room with shapes, and a place in it where a circle is clear.
    fn any_room(radius: Radius) -> impl Strategy<Value = (Room, DVec2)> {
        let shapes = prop::collection::vec(
            prop::option::weighted(0.4, any_outline()),
            (SIDE * SIDE) as usize,
        );
        let place = (0.25..6.75, 0.25..6.75).prop_map(DVec2::from);
        (shapes.prop_map(Room), place)
            .prop_filter("it stands clear", move |(room, place)| is_clear(room, *place, radius))
    }

    fn displacement() -> impl Strategy<Value = DVec2> {
        let eighth = (0..8).prop_map(|eighths| f64::from(eighths) / 8.0);
        let angle = prop_oneof![eighth, 0.0..1.0].prop_map(|turns| turns * TAU);
        (angle, -9.0..3.0).prop_map(|(angle, exponent)| {
            DVec2::new(libm::cos(angle), libm::sin(angle)) * libm::pow(10.0, exponent)
        })
    }

    const QUARTER: Radius = Radius::new(0.25).unwrap();

    fn moved(room: &Room, position: DVec2, displacement: DVec2) -> DVec2 {
        let body = Body { position, velocity: DVec2::ZERO };
        slide(&mut room.clone(), body, displacement, QUARTER).position
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn never_inside_a_shape_and_never_through_one(
            (room, start) in any_room(QUARTER),
            displacements in prop::collection::vec(displacement(), 1..30),
        ) {
            let mut position = start;
            for displacement in displacements {
                let after = moved(&room, position, displacement);
                prop_assert!(is_clear(&room, after, QUARTER), "{after}");
                if displacement.length() < 0.1 {
                    // The way there is nearly straight.
                    for part in 0..10 {
                        let point = position.lerp(after, f64::from(part) / 10.0);
                        prop_assert!(room.clearance(point) > 0.2, "through something at {point}");
                    }
                }
                position = after;
            }
        }

        #[test]
        fn speed_is_only_lost(
            (room, start) in any_room(QUARTER),
            displacement in displacement(),
            velocity in displacement(),
        ) {
            let body = Body { position: start, velocity };
            let after = slide(&mut room.clone(), body, displacement, QUARTER);
            prop_assert!(after.velocity.length() <= velocity.length() * (1.0 + 1e-12));
        }

        #[test]
        fn a_pillar_is_walked_around(
            offset in 0.001..0.7,
            radius in 0.05..0.5,
            stride in 0.001..0.3,
        ) {
            prop_assume!(offset < radius + 0.25);
            let pillar = Outline::Pillar(PillarRadius::new(radius).unwrap());
            let room = Room::empty().with(3, 3, pillar);
            for side in [-1.0, 1.0] {
                let mut position = DVec2::new(1.5, 3.5 + side * offset);
                for _ in 0..(16.0 / stride) as usize {
                    position = moved(&room, position, DVec2::new(stride, 0.0));
                }
                prop_assert!(position.x > 6.0, "caught at {position}");
            }
        }

        /// A wall of diagonals has joints, and doubles do not represent positions on its sides.
        #[test]
        fn diagonals_are_slid_along_without_a_catch(
            x in 0.3..1.5,
            stride in 0.001_f64..0.2,
            push in 0.0..1.0,
        ) {
            let room = (0..SIDE).fold(Room::empty(), |room, index| {
                room.with(index, index, Outline::Line(Line::FromNorthWest))
            });
            let mut position = DVec2::new(x, 5.0);
            // To the wall, and then along it with a push into it.
            for _ in 0..(9.0 / stride) as usize {
                position = moved(&room, position, DVec2::new(0.0, -stride));
            }
            let way = DVec2::new(1.0, 1.0 - push) * stride;
            let steps = 200;
            let along = DVec2::ONE.normalize();
            for _ in 0..steps {
                let before = position;
                position = moved(&room, position, way);
                if position.x > 5.9 {
                    break;
                }
                let gone = (position - before).dot(along);
                prop_assert!((gone - way.dot(along)).abs() < 1e-8, "caught at {position}");
            }
        }
    }

    #[test]
    fn a_pillar_as_wide_as_its_cell_leaves_no_way_beside_a_wall() {
        let widest = Outline::Pillar(PillarRadius::new(0.5).unwrap());
        let room = Room::empty().with(3, 0, widest);
        let end = moved(&room, DVec2::new(1.5, 0.25), DVec2::new(50.0, 0.0));
        assert!(end.x < 3.5 && room.clearance(end) >= 0.25, "{end}");
        let beside = moved(&room, DVec2::new(1.5, 1.5), DVec2::new(50.0, 0.0));
        assert_eq!(beside.x, 6.75);
    }
}
