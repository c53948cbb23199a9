//! Rectangles: blocks in courses, tiles in rows, panels in a frame.

use super::SIDE;

/// A texel's place in a rectangle.
#[derive(Clone, Copy)]
pub(super) struct Block {
    /// Texels from the rectangle's left edge.
    pub(super) x: i32,
    /// Texels from its top edge.
    pub(super) y: i32,
    pub(super) width: i32,
    pub(super) height: i32,
    /// Which rectangle of the texture it is.
    pub(super) id: i32,
}

impl Block {
    /// The square that holds the texel `(x, y)` of those `side` texels wide.
    pub(super) fn in_squares(side: i32, x: i32, y: i32) -> Self {
        let id = y / side * (SIDE / side) + x / side;
        Self { x: x % side, y: y % side, width: side, height: side, id }
    }

    /// The one of `areas` that holds the texel `(x, y)`.
    pub(super) fn among(areas: &[Area], x: i32, y: i32) -> Option<Self> {
        (0..).zip(areas).find_map(|(id, &Area { left, top, width, height })| {
            let (x, y) = (x - left, y - top);
            let holds = (0..width).contains(&x) && (0..height).contains(&y);
            holds.then_some(Self { x, y, width, height, id })
        })
    }

    /// Texels to the nearest edge: 0 for those along it.
    pub(super) fn rim(self) -> i32 {
        let [left, right, top, bottom] = self.to_edges();
        left.min(right).min(top).min(bottom)
    }

    /// How much light falls on a slope down to the nearest edge: from 3, the brightest, at the top
    /// to −3, the darkest, at the bottom.
    pub(super) fn slope(self) -> i32 {
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

    /// The light on a bevel just inside the joint around the rectangle: `strength` for each step of
    /// [`Block::slope`]; 0 off the bevel.
    pub(super) fn bevel(self, strength: i32) -> i32 {
        if self.rim() == 1 { self.slope() * strength } else { 0 }
    }

    /// Texels to the left, right, upper and lower edge.
    fn to_edges(self) -> [i32; 4] {
        let Self { x, y, width, height, .. } = self;
        [x, width - 1 - x, y, height - 1 - y]
    }
}

/// A rectangle of the texture.
pub(super) struct Area {
    pub(super) left: i32,
    pub(super) top: i32,
    pub(super) width: i32,
    pub(super) height: i32,
}

/// How blocks are laid: courses from top to bottom that cover the whole texture.
pub(super) struct Bond(&'static [Course]);

/// A course of blocks.
pub(super) struct Course {
    pub(super) height: i32,
    /// Where the first block begins; the last one wraps around to there.
    pub(super) start: i32,
    pub(super) widths: &'static [i32],
}

/// More than any course has blocks.
const IDS_A_COURSE: usize = 16;

impl Bond {
    /// The bond of these courses, whose heights, and whose widths in each, come to the texture's
    /// side: otherwise it does not compile, as long as it is a constant.
    pub(super) const fn new(courses: &'static [Course]) -> Self {
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

    /// The block that holds the texel `(x, y)`.
    pub(super) fn block(&self, x: i32, y: i32) -> Block {
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

/// Which of the stretches of those `lengths`, end to end, holds `place`, how far into it, and how
/// long it is.
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
