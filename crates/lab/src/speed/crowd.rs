//! Crowded maps: the same things in view, with few or many others elsewhere.

use cellcaster::map;
use cellcaster::world::World;

/// The visible part of a map: a hall with about sixty plants. The rest of the map is full of
/// plants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vista {
    /// A hall along the axes. The other things are outside the rectangle that contains the view.
    Straight,
    /// A diagonal hall. Ten thousand other things are inside the rectangle that contains the view.
    Diagonal,
}

/// The least side of a map with room for the longest hall.
const SHORTEST_SIDE: u32 = 100;

impl Vista {
    /// All vistas.
    pub const ALL: [Self; 2] = [Self::Straight, Self::Diagonal];

    /// The name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Diagonal => "diagonal",
        }
    }

    /// A map with this hall and `count` things, including those in view.
    ///
    /// # Panics
    /// Panics if `count` is less than the number of things in view, or more than the map has room
    /// for.
    pub fn world(self, count: usize) -> World {
        let side = SHORTEST_SIDE.max((count as f64).sqrt() as u32 + 10);
        let places = || (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
        let in_view = places().filter(|&(column, row)| self.is_plant(column, row)).count();
        let mut elsewhere = count - in_view;
        let mut grid = String::new();
        for (column, row) in places() {
            if column == 0 {
                grid.push('\n');
            }
            grid.push(match (column, row) {
                (1, 1) => '@',
                _ if self.is_plant(column, row) => 'p',
                _ if self.holds(column, row) => '.',
                _ if self.is_beside(column, row) || elsewhere == 0 => '#',
                _ => {
                    elsewhere -= 1;
                    'p'
                }
            });
        }
        assert_eq!(elsewhere, 0, "there is room for all things");
        let text = format!(
            "grid = '''{grid}\n'''\ntiles.'#'.wall = 'brick'\n\
             things = {{ '@'.start = {}, 'p'.sprite = 'plant' }}\n",
            self.heading()
        );
        map::parse_str(&text).expect("the map is sound, but for its size")
    }

    /// The player's heading in degrees, at the cell (1, 1).
    fn heading(self) -> u32 {
        match self {
            Self::Straight => 25,
            Self::Diagonal => 45,
        }
    }

    fn holds(self, column: u32, row: u32) -> bool {
        match self {
            Self::Straight => (1..=24).contains(&column) && (1..=12).contains(&row),
            Self::Diagonal => {
                let is_on_map = |place| (1..SHORTEST_SIDE - 2).contains(&place);
                is_on_map(column) && is_on_map(row) && column.abs_diff(row) <= 1
            }
        }
    }

    fn is_plant(self, column: u32, row: u32) -> bool {
        self.holds(column, row) && (column + 2 * row).is_multiple_of(5)
    }

    fn is_beside(self, column: u32, row: u32) -> bool {
        let around = |place: u32| place.saturating_sub(1)..=place + 1;
        around(row).any(|row| around(column).any(|column| self.holds(column, row)))
    }
}
