//! The terrain of a floor: that of a generator, with another title and less light.

use std::sync::Arc;

use super::super::{Chunk, ChunkArea, Terrain};

#[derive(Debug)]
pub(crate) struct FloorTerrain {
    terrain: Arc<dyn Terrain>,
    floor: u32,
}

/// The share of light that each floor loses, and the floor that is darkest.
const DIMMING: f64 = 0.05;
const DARKEST: u32 = 10;

impl FloorTerrain {
    pub(crate) fn new(terrain: Arc<dyn Terrain>, floor: u32) -> Arc<Self> {
        Arc::new(Self { terrain, floor })
    }

    /// A line of the legend as the floor has it.
    fn line(&self, line: &str) -> String {
        match line.split_once('=').map(|(key, value)| (key.trim(), value.trim())) {
            Some(("title", _)) => format!("title = \"Floor {}\"\n", self.floor),
            Some(("light", value)) => {
                let share = 1.0 - DIMMING * f64::from(self.floor.min(DARKEST) - 1);
                let light = value.parse::<f64>().unwrap_or(1.0) * share;
                format!("light = {light:.3}\n")
            }
            _ => format!("{line}\n"),
        }
    }
}

impl Terrain for FloorTerrain {
    fn seed(&self) -> u64 {
        self.terrain.seed()
    }

    fn legend(&self) -> String {
        self.terrain.legend().lines().map(|line| self.line(line)).collect()
    }

    fn chunk(&self, area: &ChunkArea) -> Chunk {
        self.terrain.chunk(area)
    }

    fn hub(&self, area: &ChunkArea) -> Option<(usize, usize)> {
        self.terrain.hub(area)
    }

    fn start(&self, area: &ChunkArea) -> (usize, usize) {
        self.terrain.start(area)
    }
}
