//! Rectangles: blocks in courses, tiles in rows, panels in a frame.

use super::SIDE;

/// The position of a texel in a rectangle.
#[derive(Clone, Copy)]
pub(crate) struct Block {
    /// Texels from the left edge.
    pub(crate) x: i32,
    /// Texels from the top edge.
    pub(crate) y: i32,
    pub(crate) width: i32,
    pub(crate) height: i32,
    /// The number of the rectangle in the texture.
    pub(crate) id: i32,
}

impl Block {
    /// The square with sides of `side` texels that contains `(x, y)`.
    pub(crate) fn in_squares(side: i32, x: i32, y: i32) -> Self {
        let id = y / side * (SIDE / side) + x / side;
        Self { x: x % side, y: y % side, width: side, height: side, id }
    }

    /// The one of `areas` that contains `(x, y)`.
    pub(crate) fn among(areas: &[Area], x: i32, y: i32) -> Option<Self> {
        (0..).zip(areas).find_map(|(id, &Area { left, top, width, height })| {
            let (x, y) = (x - left, y - top);
            let holds = (0..width).contains(&x) && (0..height).contains(&y);
            holds.then_some(Self { x, y, width, height, id })
        })
    }

    /// Texels to the nearest edge: 0 along it.
    pub(crate) fn rim(self) -> i32 {
        let [left, right, top, bottom] = self.to_edges();
        left.min(right).min(top).min(bottom)
    }

    /// The light on a slope down to the nearest edge: from 3, the brightest, at the top to −3, the
    /// darkest, at the bottom.
    pub(crate) fn slope(self) -> i32 {
        let rim = self.rim();
        let [_, right, top, bottom] = self.to_edges();
        if bottom == rim {
            -3
        } else if right == rim {
            -2
        } else if top == rim {
            3
        } else {
            2
        }
    }

    /// The light on a bevel inside the joint around the rectangle: `strength` times
    /// [`Block::slope`]; 0 elsewhere.
    pub(crate) fn bevel(self, strength: i32) -> i32 {
        if self.rim() == 1 { self.slope() * strength } else { 0 }
    }

    /// Texels to the left, right, upper and lower edge.
    fn to_edges(self) -> [i32; 4] {
        let Self { x, y, width, height, .. } = self;
        [x, width - 1 - x, y, height - 1 - y]
    }
}

/// A rectangle of the texture.
pub(crate) struct Area {
    pub(crate) left: i32,
    pub(crate) top: i32,
    pub(crate) width: i32,
    pub(crate) height: i32,
}

/// A bond: courses of blocks, from top to bottom, that cover the whole texture.
pub(crate) struct Bond(&'static [Course]);

/// A course of blocks.
pub(crate) struct Course {
    pub(crate) height: i32,
    /// The left edge of the first block; the last block wraps around to it.
    pub(crate) start: i32,
    pub(crate) widths: &'static [i32],
}

/// More than the number of blocks in any course.
const IDS_A_COURSE: usize = 16;

impl Bond {
    /// The bond of these courses. Their heights, and the widths in each, must add up to the side of
    /// the texture: a constant that does not fails to compile.
    pub(crate) const fn new(courses: &'static [Course]) -> Self {
        let (mut index, mut height) = (0, 0);
        while index < courses.len() {
            let course = &courses[index];
            assert!(sum(course.widths) == SIDE, "this course is not as wide as the texture");
            assert!(course.widths.len() <= IDS_A_COURSE, "too many blocks");
            height += course.height;
            index += 1;
        }
        assert!(height == SIDE, "these courses are not as high as the texture");
        Self(courses)
    }

    /// The block that contains `(x, y)`.
    pub(crate) fn block(&self, x: i32, y: i32) -> Block {
        let (row, y, height) = stretch(self.0.iter().map(|course| course.height), y);
        let Course { start, widths, .. } = self.0[row];
        let (column, x, width) = stretch(widths.iter().copied(), (x - start).rem_euclid(SIDE));
        Block { x, y, width, height, id: (row * IDS_A_COURSE + column) as i32 }
    }
}

const fn sum(lengths: &[i32]) -> i32 {
    let (mut index, mut sum) = (0, 0);
    while index < lengths.len() {
        sum += lengths[index];
        index += 1;
    }
    sum
}

/// The index of the one of the consecutive `lengths` that contains `place`, the offset in it, and
/// its length.
fn stretch(lengths: impl Iterator<Item = i32>, place: i32) -> (usize, i32, i32) {
    let mut end = 0;
    lengths
        .enumerate()
        .find_map(|(index, length)| {
            end += length;
            (place < end).then_some((index, place + length - end, length))
        })
        .expect("the lengths of a bond come to the texture's side")
}
