//! Surroundings: what a tile of any kind may have of its own.

use toml::de::DeTable;

use super::{Meaning, Section, light};
use crate::fault::document::Entry;
use crate::map::covering::{CeilingText, CoveringText};
use crate::map::heights::HeightsText;
use crate::map::mechanisms::FloorMechanism;
use crate::world::Light;

/// What a tile has of its own; the rest is the map's.
#[derive(Default)]
pub(crate) struct Surroundings<'a> {
    pub(crate) floor: Option<CoveringText<'a>>,
    pub(crate) ceiling: Option<CeilingText<'a>>,
    pub(crate) light: Option<Light>,
    pub(crate) heights: HeightsText<'a>,
    pub(crate) mechanism: FloorMechanism<'a>,
}

/// Whether an entry was one of the [`Surroundings`].
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Taken {
    Yes,
    No,
}

impl<'a> Surroundings<'a> {
    pub(crate) fn is_empty(&self) -> bool {
        !self.has_covering()
            && self.light.is_none()
            && self.heights.is_empty()
            && self.mechanism.is_empty()
    }

    /// Whether a tile with that meaning can have these.
    pub(crate) fn suit(&self, meaning: &Meaning<'_>) -> bool {
        let is_fixed = self.mechanism.is_empty();
        is_fixed
            && match meaning {
                Meaning::Wall(..) | Meaning::Mirror(..) | Meaning::MovingWall(_) => {
                    !self.has_covering() && self.heights.is_empty()
                }
                Meaning::Shape(_) => true,
                Meaning::Door(_) | Meaning::Mask(_) | Meaning::Glass(_) => self.light.is_none(),
                _ => self.is_empty(),
            }
    }

    fn has_covering(&self) -> bool {
        self.floor.is_some() || self.ceiling.is_some()
    }

    /// Reads `entry` if it is one of a tile's surroundings.
    pub(crate) fn take(
        &mut self,
        section: Section,
        entry: &Entry<'a, '_>,
        table: &DeTable<'_>,
    ) -> Taken {
        match (section, entry.key) {
            (Section::Tiles, "floor") => {
                self.floor = CoveringText::read(entry, r#"{ floor = "moss" }"#);
            }
            (Section::Tiles, "ceiling") => {
                self.ceiling = CeilingText::read(entry, r#"{ ceiling = "wood" }"#);
            }
            (Section::Tiles, "light") => self.light = light(entry),
            (Section::Tiles, _) if self.heights.take(entry) => {}
            (Section::Tiles, _) if self.mechanism.take(entry, table) => {}
            _ => return Taken::No,
        }
        Taken::Yes
    }
}
