//! A stage: a game in a small level, written as a map.

use glam::DVec2;

use crate::game::{Game, GuardView, Intent, Intents, Outcome, Rules, SoundKind};
use crate::map;
use crate::world::{Cell, Difficulty, FieldOfView};

/// A game for tests, whose player has acted, so that guards notice them.
pub(crate) struct Stage {
    pub(crate) game: Game,
}

impl Stage {
    /// A game in the level that `rows` draw. `#` is a wall. The player starts at `@` and looks
    /// east. `tiles` and `things` are lines of the map's tables.
    pub(crate) fn new(rows: &[&str], tiles: &str, things: &str) -> Self {
        Self::played(rows, tiles, things, Difficulty::Normal)
    }

    /// Like [`Stage::new`], with a difficulty.
    pub(crate) fn played(rows: &[&str], tiles: &str, things: &str, difficulty: Difficulty) -> Self {
        Self::with_header("par = 60", rows, tiles, things, difficulty)
    }

    /// Like [`Stage::played`], with lines before the tables.
    pub(crate) fn with_header(
        header: &str,
        rows: &[&str],
        tiles: &str,
        things: &str,
        difficulty: Difficulty,
    ) -> Self {
        let text = format!(
            "{header}\ngrid = '''\n{}\n'''\n[tiles]\n'#' = {{ wall = \"brick\" }}\n{tiles}\n[things]\n'@' = {{ start = 0 }}\n{things}\n",
            rows.join("\n")
        );
        let world = map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"));
        let mut game = Game::with_rules(world, Rules { difficulty, seed: 1 });
        game.player.has_acted = true;
        Self { game }
    }

    /// Plays `steps` steps.
    pub(crate) fn play(&mut self, steps: usize, list: &[Intent]) -> &mut Self {
        let intents: Intents = list.iter().copied().collect();
        (0..steps).for_each(|_| self.game.step(intents));
        self
    }

    /// Walks ahead until the player is in `column`.
    pub(crate) fn walk_to(&mut self, column: u32) -> &mut Self {
        for _ in 0..1200 {
            if self.cell().column == column {
                return self;
            }
            self.play(1, &[Intent::Forward]);
        }
        panic!("the player does not reach column {column}: {:?}", self.cell());
    }

    /// Plays until `is_it` returns true, for at most `most` steps. Returns the number of steps, or
    /// `None`.
    pub(crate) fn steps_until(
        &mut self,
        most: usize,
        list: &[Intent],
        is_it: impl Fn(&Self) -> bool,
    ) -> Option<usize> {
        (1..=most).find(|_| is_it(self.play(1, list)))
    }

    /// Presses a key once.
    pub(crate) fn press(&mut self, intent: Intent) -> &mut Self {
        self.play(1, &[intent]).play(1, &[])
    }

    pub(crate) fn cell(&self) -> Cell {
        self.game.player.motion.cell()
    }

    pub(crate) fn position(&self) -> DVec2 {
        self.game.camera(FieldOfView::default()).position()
    }

    /// The guard with that index.
    pub(crate) fn guard(&self, index: usize) -> GuardView {
        self.game.guards().nth(index).unwrap()
    }

    /// Whether the player hears a sound of this kind now.
    pub(crate) fn hears(&self, kind: SoundKind) -> bool {
        self.game.heard().iter().any(|heard| heard.kind == kind)
    }

    pub(crate) fn message(&self) -> &str {
        self.game.message().unwrap_or_default()
    }

    pub(crate) fn points(&self) -> u8 {
        self.game.health().points
    }

    pub(crate) fn is_dead(&self) -> bool {
        matches!(self.game.outcome(), Outcome::Dead { .. })
    }
}
