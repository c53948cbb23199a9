//! Distance fields of small maps.

use proptest::prelude::*;

use super::*;

fn of<Row: AsRef<str>>(rows: &[Row]) -> DistanceField {
    let may_be_solid = |drawn: char| drawn == '#';
    DistanceField::new(
        rows.iter()
            .map(|row| row.as_ref().chars().map(may_be_solid).collect::<Vec<_>>().into_iter()),
    )
}

/// The distances of the cells of the map, without the border.
fn inner(distance_field: &DistanceField) -> Vec<Vec<u16>> {
    let rows: Vec<&[CodedDistance]> =
        distance_field.cells.chunks_exact(distance_field.width).collect();
    let lines =
        |row: &&[CodedDistance]| row[1..row.len() - 1].iter().map(|cell| cell.lines()).collect();
    rows[1..rows.len() - 1].iter().map(lines).collect()
}

#[test]
fn nothing_outside_the_map_is_clear() {
    let distance_field = of(&["....", "...#"]);
    assert_eq!(inner(&distance_field), [[1, 1, 1, 1], [1, 1, 1, 0]]);
    assert_eq!(distance_field.cells.iter().filter(|&&cell| cell != CodedDistance::NONE).count(), 7);
    assert_eq!(inner(&of(&[".....", ".....", "....."]).measured())[1], [1, 2, 2, 2, 1]);
    assert!(!distance_field.is_clear(-1));
}

#[test]
fn large_distances_round_down() {
    for (lines, coded) in [(0, 0), (1, 1), (128, 128), (159, 128), (160, 160), (4096, 4096)] {
        assert_eq!(CodedDistance::new(lines).lines(), coded);
    }
    assert_eq!(CodedDistance::new(u16::MAX).lines(), CodedDistance::MAX);
    let wide = of(&vec![".".repeat(600); 600]).measured();
    assert_eq!((inner(&wide)[300][100], inner(&wide)[300][254]), (101, 224));
}

#[test]
fn halls_are_worth_measuring_and_rooms_are_not() {
    assert!(of(&vec![".".repeat(62); 62]).measured_if_worthwhile().is_measured());
    assert!(!of(&vec!["......#".repeat(9); 62]).measured_if_worthwhile().is_measured());
}

proptest! {
    /// The distance is the distance to the nearest solid cell, found by brute force.
    #[test]
    fn distances_match_brute_force(
        rows in prop::collection::vec("[.......#]{9}", 1..9_usize),
    ) {
        let drawn: Vec<&[u8]> = rows.iter().map(String::as_bytes).collect();
        let may_be_solid = |column: i64, row: i64| {
            let row = drawn.get(row as usize);
            row.and_then(|row| row.get(column as usize)).is_none_or(|&drawn| drawn == b'#')
        };
        let places = || (-1..10).flat_map(|row| (-1..10).map(move |column| (column, row)));
        let nearest = |column: i64, row: i64| {
            let solid = places().filter(|&(column, row)| may_be_solid(column, row));
            solid.map(|other| column.abs_diff(other.0).max(row.abs_diff(other.1))).min()
        };
        for (cells, row) in inner(&of(&rows).measured()).into_iter().zip(0..) {
            for (cell, column) in cells.into_iter().zip(0..) {
                prop_assert_eq!(Some(u64::from(cell)), nearest(column, row));
            }
        }
    }
}
