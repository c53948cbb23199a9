//! Mazes: passages one cell wide between walls one cell thick, with halls and torches.
//!
//! The cells with an odd column and an odd row in the chunk are nodes. The cell between two nodes
//! is open or wall. Each chunk has a random spanning tree of its nodes, found by depth-first search
//! with backtracking, and passages to its northern and western neighbours. All nodes are therefore
//! connected through the chunks between them, and the passages between chunks close loops.
//! Rejected: a spanning tree of the whole level. A local rule for such a tree produces a comb with
//! long parallel passages.
//!
//! No straight line of sight crosses two chunk borders. The passages are in the first half of every
//! other border, and in the second half of the borders between.

use super::chunk::{CHUNK_SIDE, Chunk, ChunkArea, Terrain};
use super::purpose::{Purpose, generator, hash};
use crate::rng::SplitMix64;

/// The maze that belongs to a seed.
#[derive(Clone, Debug)]
pub(crate) struct Maze {
    pub(crate) seed: u64,
}

/// The look of a district.
#[derive(Clone, Copy, Debug)]
struct District {
    wall: u8,
    floor: u8,
    /// The things at dead ends.
    torch: u8,
    bones: u8,
    /// The thing in the middle of a hall. A torch may take its place.
    landmark: u8,
}

const DUNGEON: District =
    District { wall: b'#', floor: b'.', torch: b't', bones: b'b', landmark: b's' };
const GARDEN: District =
    District { wall: b'H', floor: b',', torch: b'p', bones: b'q', landmark: b'u' };
const TEMPLE: District =
    District { wall: b'S', floor: b';', torch: b'a', bones: b'c', landmark: b'o' };
const DISTRICTS: [District; 5] = [
    DUNGEON,
    GARDEN,
    TEMPLE,
    District { wall: b'B', ..DUNGEON },
    District { wall: b'M', ..DUNGEON },
];
/// The number of chunks along each side of a district, as a power of two.
const DISTRICT_BITS: u32 = 1;
/// The number of passages to each neighbour.
const PASSAGES: usize = 2;

impl Terrain for Maze {
    fn seed(&self) -> u64 {
        self.seed
    }

    fn legend(&self) -> String {
        format!("title = \"Maze {}\"\n{}", self.seed, include_str!("maze.toml"))
    }

    fn chunk(&self, area: &ChunkArea) -> Chunk {
        let (column, row) = (area.chunk.column, area.chunk.row);
        let district =
            hash(self.seed, Purpose::District, column >> DISTRICT_BITS, row >> DISTRICT_BITS);
        let district = DISTRICTS[(district % DISTRICTS.len() as u64) as usize];
        let mut carving = Carving {
            chunk: Chunk::full_of(district.wall),
            district,
            nodes: (area.columns.end / 2, area.rows.end / 2),
            random: generator(self.seed, Purpose::Plan, column, row),
        };
        if self.hub(area).is_some() {
            carving.grow_tree();
            carving.open_dead_ends();
            carving.carve_halls();
            self.carve_passages(area, &mut carving);
        }
        carving.chunk
    }

    fn hub(&self, area: &ChunkArea) -> Option<(usize, usize)> {
        let has_node = area.columns.end >= 2 && area.rows.end >= 2;
        (has_node && area.contains(1, 1)).then_some((1, 1))
    }
}

impl Maze {
    fn carve_passages(&self, area: &ChunkArea, carving: &mut Carving) {
        let (columns, rows) = carving.nodes;
        let (column, row) = (area.chunk.column, area.chunk.row);
        if self.hub(&area.neighbor(-1, 0)).is_some() {
            let mut random = generator(self.seed, Purpose::WestPassage, column, row);
            for _ in 0..PASSAGES {
                let node = in_half(rows, column, &mut random);
                carving.carve((0, 2 * node + 1));
            }
        }
        if self.hub(&area.neighbor(0, -1)).is_some() {
            let mut random = generator(self.seed, Purpose::NorthPassage, column, row);
            for _ in 0..PASSAGES {
                let node = in_half(columns, row, &mut random);
                carving.carve((2 * node + 1, 0));
            }
        }
    }
}

/// Picks one of `nodes` nodes along a border. The node is in the first half if `border` is even,
/// and in the second half if it is odd.
fn in_half(nodes: usize, border: i64, random: &mut SplitMix64) -> usize {
    let first = nodes / 2;
    if border % 2 == 0 { random.below(first.max(1)) } else { first + random.below(nodes - first) }
}

/// A chunk under construction.
struct Carving {
    chunk: Chunk,
    district: District,
    /// The number of nodes from west to east and from north to south. Both are above 0.
    nodes: (usize, usize),
    random: SplitMix64,
}

/// The column and the row of a node among the nodes of its chunk.
type MazeNode = (usize, usize);

impl Carving {
    /// Connects all nodes with the first one, by depth-first search.
    fn grow_tree(&mut self) {
        let mut way = vec![(0, 0)];
        self.carve((1, 1));
        while let Some(&node) = way.last() {
            let uncarved: Vec<MazeNode> =
                self.beside(node).into_iter().filter(|&next| !self.is_dug(cell(next))).collect();
            if uncarved.is_empty() {
                way.pop();
                continue;
            }
            let next = uncarved[self.random.below(uncarved.len())];
            self.carve(between(node, next));
            self.carve(cell(next));
            way.push(next);
        }
    }

    /// Opens some dead ends, and places things in others.
    fn open_dead_ends(&mut self) {
        for node in self.all() {
            let beside = self.beside(node);
            let is_way = |&next: &MazeNode| self.is_dug(between(node, next));
            let (ways, walls): (Vec<MazeNode>, Vec<MazeNode>) =
                beside.into_iter().partition(is_way);
            if ways.len() > 1 {
                continue;
            }
            let (column, row) = cell(node);
            match self.random.below(6) {
                0..3 if !walls.is_empty() => {
                    let next = walls[self.random.below(walls.len())];
                    self.carve(between(node, next));
                }
                3 => self.chunk.set(column, row, self.district.torch),
                4 => self.chunk.set(column, row, self.district.bones),
                _ => {}
            }
        }
    }

    /// Clears halls of three by two or three by three nodes, each with a landmark or a torch in the
    /// middle.
    fn carve_halls(&mut self) {
        for _ in 0..2 {
            let (width, height) = (3, 2 + self.random.below(2));
            if self.nodes.0 < width || self.nodes.1 < height || self.random.one_in(3) {
                continue;
            }
            let column = self.random.below(self.nodes.0 - width + 1);
            let row = self.random.below(self.nodes.1 - height + 1);
            let ((west, north), (east, south)) =
                (cell((column, row)), cell((column + width - 1, row + height - 1)));
            let cells = (north..=south).flat_map(|row| (west..=east).map(move |x| (x, row)));
            cells.for_each(|place| self.carve(place));
            let center = (usize::midpoint(west, east), usize::midpoint(north, south));
            let District { landmark, torch, .. } = self.district;
            let landmark = if self.random.one_in(2) { landmark } else { torch };
            self.chunk.set(center.0, center.1, landmark);
        }
    }

    fn carve(&mut self, (column, row): (usize, usize)) {
        self.chunk.set(column, row, self.district.floor);
    }

    fn is_dug(&self, (column, row): (usize, usize)) -> bool {
        self.chunk.get(column, row) != self.district.wall
    }

    fn all(&self) -> Vec<MazeNode> {
        let (columns, rows) = self.nodes;
        (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))).collect()
    }

    fn beside(&self, (column, row): MazeNode) -> Vec<MazeNode> {
        let places = [
            (column.wrapping_sub(1), row),
            (column + 1, row),
            (column, row.wrapping_sub(1)),
            (column, row + 1),
        ];
        let (columns, rows) = self.nodes;
        places.into_iter().filter(|&(column, row)| column < columns && row < rows).collect()
    }
}

/// The cell of a node in its chunk.
fn cell((column, row): MazeNode) -> (usize, usize) {
    (2 * column + 1, 2 * row + 1)
}

/// The cell between two neighbouring nodes.
fn between(one: MazeNode, other: MazeNode) -> (usize, usize) {
    (one.0 + other.0 + 1, one.1 + other.1 + 1)
}

const _: () = assert!(CHUNK_SIDE.is_multiple_of(2), "the last node would be beside the next one");
