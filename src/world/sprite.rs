//! Sprites: flat pictures that always face the camera.
//!
//! A sprite has a picture for each frame of its animation and for each facing, the side from which
//! it is seen. Sheets are divided into pictures when they are loaded, because the mip levels of a
//! whole sheet would mix neighbouring pictures.

pub mod builtin;

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{Heading, Heights, Lamp, Texture};

/// The pictures of a thing, and their position in the cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Sprite {
    /// Frame by frame, and within each frame facing by facing.
    pictures: Arc<[Texture]>,
    facings: Facings,
    frame_time: FrameTime,
    /// The number of frames in the animation, counted from the first. A game selects the others.
    animated: usize,
    /// The direction of its front.
    pub heading: Heading,
    /// The surface that it is fixed to.
    pub anchor: Anchor,
    /// The height, in cells.
    pub height: SpriteHeight,
    /// `true` if it stops players.
    pub blocks: bool,
    /// Its light, if it is a lamp.
    pub lamp: Option<Lamp>,
    /// `true` if neither darkness nor fog dims its figures.
    pub glows: bool,
}

/// A sprite: an index into the world's list of sprites.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct SpriteId(pub u16);

/// The number of sides with pictures of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Facings {
    /// The same picture from everywhere.
    #[default]
    One,
    /// Front, right, back and left.
    Four,
    /// The four sides, and the sides between them.
    Eight,
}

impl Facings {
    /// The number of facings.
    pub const fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }

    /// The variant with `count` facings. `None` unless `count` is 1, 4 or 8.
    pub fn new(count: u32) -> Option<Self> {
        [Self::One, Self::Four, Self::Eight].into_iter().find(|facings| facings.count() == count)
    }
}

/// The surface that a sprite is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Anchor {
    /// On the floor.
    #[default]
    Floor,
    /// At the ceiling.
    Ceiling,
}

/// The height of a sprite, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpriteHeight(f64);

impl SpriteHeight {
    /// One cell.
    pub const FULL: Self = Self(1.0);

    /// A height above 0, at most 4. `None` outside that range.
    pub fn new(cells: f64) -> Option<Self> {
        (cells > 0.0 && cells <= 4.0).then_some(Self(cells))
    }

    /// The height in cells.
    pub const fn cells(self) -> f64 {
        self.0
    }
}

/// The time for which a frame of an animation shows, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTime(f64);

impl FrameTime {
    /// A time from 0.05 s, which is as fast as most terminals can follow, to 60 s. `None` outside
    /// that range.
    pub fn new(seconds: f64) -> Option<Self> {
        (0.05..=60.0).contains(&seconds).then_some(Self(seconds))
    }
}

impl Default for FrameTime {
    /// 0.2 s.
    fn default() -> Self {
        Self(0.2)
    }
}

impl Sprite {
    /// The height of its lower edge in a cell with these heights.
    pub fn base(&self, heights: Heights) -> f64 {
        match self.anchor {
            Anchor::Floor => heights.floor(),
            Anchor::Ceiling => heights.ceiling() - self.height.cells(),
        }
    }

    /// A sprite of `pictures`, frame by frame and within each frame facing by facing. It stands on
    /// the floor and does not block. `None` if there is no whole frame.
    pub fn new(pictures: Vec<Texture>, facings: Facings) -> Option<Self> {
        let is_whole = pictures.len().is_multiple_of(facings.count() as usize);
        (is_whole && !pictures.is_empty()).then(|| Self {
            animated: pictures.len() / facings.count() as usize,
            pictures: pictures.into(),
            facings,
            frame_time: FrameTime::default(),
            heading: Heading::default(),
            anchor: Anchor::default(),
            height: SpriteHeight::FULL,
            blocks: false,
            lamp: None,
            glows: false,
        })
    }

    /// The sprite with another frame time.
    #[must_use]
    pub fn with_frame_time(self, frame_time: FrameTime) -> Self {
        Self { frame_time, ..self }
    }

    /// The sprite with only its first `frames` frames in the animation. A game selects the others.
    /// The count is clamped to at least 1 and at most the number of all frames.
    #[must_use]
    pub fn with_animated_frames(self, frames: usize) -> Self {
        Self { animated: frames.clamp(1, self.frames()), ..self }
    }

    /// The number of all frames, including frames that only a game selects.
    pub fn frames(&self) -> usize {
        self.pictures.len() / self.facings.count() as usize
    }

    /// The number of frames in the animation, counted from the first; 1 for a sprite that is not
    /// animated. The frame after them, if there is one, shows a lamp that is out.
    pub fn animated_frames(&self) -> usize {
        self.animated
    }

    /// The last frame, which shows a lamp that is out.
    pub(crate) fn last_frame(&self) -> u8 {
        (self.frames() - 1).min(usize::from(u8::MAX)) as u8
    }

    /// The width in cells, in proportion to its picture.
    pub fn width(&self) -> f64 {
        let picture = &self.pictures[0];
        self.height.cells() * f64::from(picture.width()) / f64::from(picture.height())
    }

    /// The picture after `seconds`, for a viewer in the direction `to_viewer`.
    pub fn picture(&self, seconds: f64, to_viewer: DVec2) -> &Texture {
        &self.pictures[self.picture_index(self.frame_at(seconds), self.heading, to_viewer)]
    }

    /// The picture of a frame, for a viewer in the direction `to_viewer`, if the front faces
    /// `heading`. If there is no such frame, returns the picture of the last one.
    pub fn picture_of(&self, frame: u8, heading: Heading, to_viewer: DVec2) -> &Texture {
        &self.pictures[self.picture_index(usize::from(frame), heading, to_viewer)]
    }

    /// The index of the picture that [`Sprite::picture_of`] returns.
    pub(crate) fn picture_index(&self, frame: usize, heading: Heading, to_viewer: DVec2) -> usize {
        let frame = frame.min(self.frames() - 1);
        frame * self.facings.count() as usize + self.facing(heading, to_viewer)
    }

    /// The frame of the animation after `seconds`.
    pub(crate) fn frame_at(&self, seconds: f64) -> usize {
        ((seconds.max(0.0) / self.frame_time.0) as u64 % self.animated as u64) as usize
    }

    /// All pictures.
    pub(crate) fn pictures(&self) -> &[Texture] {
        &self.pictures
    }

    /// The time of the first change of the picture after `seconds`; `None` if it never changes.
    pub fn next_change(&self, seconds: f64) -> Option<f64> {
        let frame = (seconds.max(0.0) / self.frame_time.0).floor();
        (self.animated > 1).then_some((frame + 1.0) * self.frame_time.0)
    }

    /// The index of the facing that a viewer sees, if the front faces `heading`: 0 for the front,
    /// then clockwise around the sprite.
    fn facing(&self, heading: Heading, to_viewer: DVec2) -> usize {
        let count = self.facings.count();
        if count == 1 {
            return 0;
        }
        let front = heading.direction();
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
    fn frames_play_in_order_and_repeat() {
        let sprite = sprite(3, Facings::One);
        let frames = [0.0, 0.19, 0.21, 0.41, 0.61, -1.0, f64::NAN];
        let frames = frames.map(|seconds| shown(&sprite, seconds, (1.0, 0.0)));
        assert_eq!(frames, [0, 0, 1, 2, 0, 0, 0]);
        let change = sprite.next_change(0.3).unwrap();
        assert!((change - 0.4).abs() < 1e-12);
    }

    #[test]
    fn a_single_frame_never_changes() {
        assert_eq!(sprite(4, Facings::Four).next_change(0.3), None);
    }

    #[test]
    fn time_cycles_only_the_animated_frames() {
        let sprite = |animated| sprite(3, Facings::One).with_animated_frames(animated);
        let shows = |animated, seconds| shown(&sprite(animated), seconds, (1.0, 0.0));
        assert_eq!([0.1, 0.3, 0.5].map(|seconds| shows(2, seconds)), [0, 1, 0]);
        assert_eq!([0.1, 0.3, 0.5].map(|seconds| shows(1, seconds)), [0, 0, 0]);
        assert_eq!((sprite(1).next_change(0.3), sprite(1).frames()), (None, 3));
        assert_eq!([0, 2, 9].map(|count| sprite(count).animated_frames()), [1, 2, 3]);
    }

    #[test]
    fn facings_go_clockwise_from_the_front() {
        // Its front faces east; a viewer in the south sees the facing after a quarter turn.
        let four = sprite(4, Facings::Four);
        let sides = [(1.0, 0.1), (0.1, 1.0), (-1.0, 0.1), (0.1, -1.0)];
        assert_eq!(sides.map(|side| shown(&four, 0.0, side)), [0, 1, 2, 3]);
        let mut eight = sprite(8, Facings::Eight);
        assert_eq!(shown(&eight, 0.0, (1.0, 1.0)), 1);
        eight.heading = Heading::from_degrees(90.0).unwrap();
        assert_eq!(shown(&eight, 0.0, (1.0, 1.0)), 7);
    }

    #[test]
    fn a_sheet_without_whole_frames_is_refused() {
        assert_eq!(Sprite::new(Vec::new(), Facings::One), None);
        let side = NonZeroU32::MIN;
        let picture = Texture::from_fn(side, side, |_, _| Rgb::BLACK);
        assert_eq!(Sprite::new(vec![picture; 3], Facings::Four), None);
    }
}
