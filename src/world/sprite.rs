//! Sprites: how things look, as flat pictures that turn with the viewer.
//!
//! A sprite has a picture for each of its frames, which follow each other in time, and for each of
//! its facings, which are the sides it is seen from. Sheets are cut into pictures when they are
//! loaded: each has levels of its own, which a sheet's would mix across the cuts.

pub mod builtin;

use std::f64::consts::TAU;

use glam::DVec2;

use super::{Heading, Heights, Lamp, Texture};

/// How a thing looks, and where in its cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Sprite {
    /// Frame by frame, and in each facing by facing.
    pictures: Vec<Texture>,
    facings: Facings,
    frame_time: FrameTime,
    /// Where its front looks.
    pub heading: Heading,
    /// Where it begins.
    pub anchor: Anchor,
    /// How high it is, in cells.
    pub height: SpriteHeight,
    /// Whether it is in everybody's way.
    pub blocks: bool,
    /// How it shines, if it does.
    pub lamp: Option<Lamp>,
}

/// Which sprite: an index into the world's list of sprites.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SpriteId(pub u16);

/// From how many sides a sprite looks different.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Facings {
    /// The same from everywhere.
    #[default]
    One,
    /// From its front, its right, its back and its left.
    Four,
    /// Those, and the sides between them.
    Eight,
}

impl Facings {
    /// How many they are.
    pub const fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }

    /// That many facings. `None` for anything but 1, 4 and 8.
    pub fn new(count: u32) -> Option<Self> {
        [Self::One, Self::Four, Self::Eight].into_iter().find(|facings| facings.count() == count)
    }
}

/// What a sprite is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Anchor {
    /// It stands on the floor.
    #[default]
    Floor,
    /// It hangs from the ceiling.
    Ceiling,
}

/// How high a sprite is, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpriteHeight(f64);

impl SpriteHeight {
    /// As high as the walls of most maps.
    pub const FULL: Self = Self(1.0);

    /// A height above 0, and 4 at most. `None` outside that.
    pub fn new(cells: f64) -> Option<Self> {
        (cells > 0.0 && cells <= 4.0).then_some(Self(cells))
    }

    /// The height in cells.
    pub const fn cells(self) -> f64 {
        self.0
    }
}

/// How long a frame of a sprite is shown, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTime(f64);

impl FrameTime {
    /// From a twentieth of a second, which is as fast as most terminals follow, to a minute. `None`
    /// outside that.
    pub fn new(seconds: f64) -> Option<Self> {
        (0.05..=60.0).contains(&seconds).then_some(Self(seconds))
    }
}

impl Default for FrameTime {
    /// A fifth of a second.
    fn default() -> Self {
        Self(0.2)
    }
}

impl Sprite {
    /// How high its lower edge is in a cell of those heights.
    pub fn base(&self, heights: Heights) -> f64 {
        match self.anchor {
            Anchor::Floor => heights.floor(),
            Anchor::Ceiling => heights.ceiling() - self.height.cells(),
        }
    }

    /// A sprite of `pictures`, frame by frame and in each facing by facing, that stands on the floor
    /// and is in nobody's way. `None` where there is no whole frame.
    pub fn new(pictures: Vec<Texture>, facings: Facings) -> Option<Self> {
        let is_whole = pictures.len().is_multiple_of(facings.count() as usize);
        (is_whole && !pictures.is_empty()).then(|| Self {
            pictures,
            facings,
            frame_time: FrameTime::default(),
            heading: Heading::default(),
            anchor: Anchor::default(),
            height: SpriteHeight::FULL,
            blocks: false,
            lamp: None,
        })
    }

    /// With frames that are shown for so long.
    #[must_use]
    pub fn with_frame_time(self, frame_time: FrameTime) -> Self {
        Self { frame_time, ..self }
    }

    /// How many frames it has; with one it does not move.
    pub fn frames(&self) -> usize {
        self.pictures.len() / self.facings.count() as usize
    }

    /// How wide it is, in cells: as its picture is to be shown with that height.
    pub fn width(&self) -> f64 {
        let picture = &self.pictures[0];
        self.height.cells() * f64::from(picture.width()) / f64::from(picture.height())
    }

    /// What it looks like after `seconds`, to a viewer who is in the direction `to_viewer` of it.
    pub fn picture(&self, seconds: f64, to_viewer: DVec2) -> &Texture {
        &self.pictures[self.picture_index(seconds, to_viewer)]
    }

    /// Which of its pictures [`Sprite::picture`] is.
    pub(crate) fn picture_index(&self, seconds: f64, to_viewer: DVec2) -> usize {
        let frame = (seconds.max(0.0) / self.frame_time.0) as u64 % self.frames() as u64;
        let facings = self.facings.count() as usize;
        frame as usize * facings + self.facing(to_viewer)
    }

    /// All that it looks like.
    pub(crate) fn pictures(&self) -> &[Texture] {
        &self.pictures
    }

    /// When it begins to look different from what it looks like after `seconds`; `None` for never.
    pub fn next_change(&self, seconds: f64) -> Option<f64> {
        let frame = (seconds.max(0.0) / self.frame_time.0).floor();
        (self.frames() > 1).then_some((frame + 1.0) * self.frame_time.0)
    }

    /// Which side a viewer sees: 0 for the front, then clockwise as the viewer walks around it.
    fn facing(&self, to_viewer: DVec2) -> usize {
        let count = self.facings.count();
        if count == 1 {
            return 0;
        }
        let front = self.heading.direction();
        let around = libm::atan2(front.perp_dot(to_viewer), front.dot(to_viewer));
        (around / TAU * f64::from(count)).round().rem_euclid(f64::from(count)) as usize
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use super::*;
    use crate::color::Rgb;

    fn sprite(count: u8, facings: Facings) -> Sprite {
        let side = NonZeroU32::new(2).unwrap();
        let picture = |index| Texture::from_fn(side, side, |_, _| Rgb::new(index, 0, 0));
        Sprite::new((0..count).map(picture).collect(), facings).unwrap()
    }

    fn shown(sprite: &Sprite, seconds: f64, to_viewer: (f64, f64)) -> u8 {
        sprite.picture(seconds, to_viewer.into()).mean().red()
    }

    #[test]
    fn frames_follow_each_other_and_begin_again() {
        let sprite = sprite(3, Facings::One);
        let frames = [0.0, 0.19, 0.21, 0.41, 0.61, -1.0, f64::NAN];
        let frames = frames.map(|seconds| shown(&sprite, seconds, (1.0, 0.0)));
        assert_eq!(frames, [0, 0, 1, 2, 0, 0, 0]);
        let change = sprite.next_change(0.3).unwrap();
        assert!((change - 0.4).abs() < 1e-12);
    }

    #[test]
    fn what_has_one_frame_never_changes() {
        assert_eq!(sprite(4, Facings::Four).next_change(0.3), None);
    }

    #[test]
    fn facings_go_clockwise_from_the_front() {
        // Its front looks east; who stands in the south sees what is a quarter further.
        let four = sprite(4, Facings::Four);
        let sides = [(1.0, 0.1), (0.1, 1.0), (-1.0, 0.1), (0.1, -1.0)];
        assert_eq!(sides.map(|side| shown(&four, 0.0, side)), [0, 1, 2, 3]);
        let mut eight = sprite(8, Facings::Eight);
        assert_eq!(shown(&eight, 0.0, (1.0, 1.0)), 1);
        eight.heading = Heading::from_degrees(90.0).unwrap();
        assert_eq!(shown(&eight, 0.0, (1.0, 1.0)), 7);
    }

    #[test]
    fn a_sheet_without_whole_frames_is_no_sprite() {
        assert_eq!(Sprite::new(Vec::new(), Facings::One), None);
        let side = NonZeroU32::MIN;
        let picture = Texture::from_fn(side, side, |_, _| Rgb::BLACK);
        assert_eq!(Sprite::new(vec![picture; 3], Facings::Four), None);
    }
}
