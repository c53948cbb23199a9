//! Ghosts: the best runs of a level, shown as translucent figures that walk along.
//!
//! A ghost is only drawn. It is not part of the room's state: no player can touch it, and the room is the
//! same, bit for bit, with and without ghosts.
//!
//! The store's thread plays the script of a run once and keeps the player's figure in every second step. Rejected: a
//! second game in each session that replays the script. Each session would step another game with guards 60
//! times a second, and could not start in the middle of a round.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::accounts::{AccountId, HostStore, LevelBoard, StoreFailure};
use crate::line::Line;
use crate::queue::push_within;
use crate::rooms::room::{Catalog, NAME_COLUMNS};
use cellcaster::game::{Game, PlayerColor, Rules, Script};
use cellcaster::world::{Difficulty, FieldOfView, Figure, SpriteId, World};

/// The longest part of a run that is shown, in steps: ten minutes, the length of the longest race.
const MAX_STEPS: usize = 10 * 60 * 60;
/// The number of steps per stored figure.
const EVERY: usize = 2;
/// The opacity of a ghost, of 255; the same as at home.
const OPACITY: u8 = 96;
/// The colour of the best run. It is the second to last colour that members are assigned.
const BEST: PlayerColor = PlayerColor::Orange;
/// The maximum number of cached runs, 14 MB in all.
const MAX_KEPT: usize = 16;

/// The player's figures in a run.
#[derive(Debug, PartialEq)]
pub(crate) struct Run {
    figures: Box<[Figure]>,
}

/// A run that is shown to a visitor.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ghost {
    run: Arc<Run>,
    /// The runner's name; `None` for the visitor's own run.
    name: Option<Line>,
}

impl Run {
    /// Plays `script` in `world` until the player first reaches the exit.
    fn played(world: World, rules: Rules, script: &Script) -> Self {
        let mut game = Game::with_rules(world, rules);
        let mut walked = 0.0;
        let mut figures = Vec::new();
        for (step, (_section, intents)) in script.iter().take(MAX_STEPS).enumerate() {
            if game.is_finished() {
                break;
            }
            if step % EVERY == 0 {
                figures.push(figure(&game, walked));
            }
            let before = game.camera(FieldOfView::default()).position();
            game.step(intents);
            walked += before.distance(game.camera(FieldOfView::default()).position());
        }
        Self { figures: figures.into() }
    }
}

/// The figure of the player of `game` after walking `walked` cells. Its sprite depends on the room that shows it.
fn figure(game: &Game, walked: f64) -> Figure {
    let camera = game.camera(FieldOfView::default());
    Figure {
        sprite: SpriteId(0),
        position: camera.position(),
        base: game.feet(),
        heading: camera.heading,
        frame: game.frame_of_figure(walked),
        opacity: OPACITY,
    }
}

impl Ghost {
    /// A ghost with the runner's name; `None` for the visitor's own run.
    pub(crate) fn new(run: Arc<Run>, name: Option<Line>) -> Self {
        Self { run, name }
    }

    /// The label above the figure.
    pub(crate) fn label(&self) -> String {
        match &self.name {
            Some(name) => format!("{name}'s best"),
            None => "your best".to_owned(),
        }
    }

    /// The colour of the figure. The visitor's own run has their colour, `own`.
    pub(crate) fn color(&self, own: Option<PlayerColor>) -> PlayerColor {
        own.filter(|_| self.name.is_none()).unwrap_or(BEST)
    }

    /// The figure after `step` steps of the run; `None` after its end.
    pub(crate) fn figure(&self, step: u64, sprite: SpriteId) -> Option<Figure> {
        let index = usize::try_from(step).ok()? / EVERY;
        Some(Figure { sprite, ..*self.run.figures.get(index)? })
    }
}

/// A cache of runs from the boards, oldest first. Each run is played once and reused in later rounds.
#[derive(Debug, Default)]
pub(crate) struct KeptRuns {
    runs: VecDeque<((LevelBoard, AccountId, u64), Arc<Run>)>,
}

impl KeptRuns {
    /// The ghosts of a level: the best run on the board, and the best run of the visitor's account `own` if
    /// that is a different run.
    ///
    /// # Errors
    /// Fails if the store cannot be read.
    pub(crate) fn ghosts(
        &mut self,
        store: &mut HostStore,
        catalog: &Catalog,
        (level, difficulty): (&str, Difficulty),
        own: Option<AccountId>,
    ) -> Result<Vec<Ghost>, StoreFailure> {
        let Some(board) = LevelBoard::new(level, difficulty) else { return Ok(Vec::new()) };
        let mut ghosts = Vec::new();
        let best = store.level_scores(&board, 1)?.into_iter().next();
        if let Some(best) = best.filter(|best| Some(best.account) != own) {
            let run = self.run(store, catalog, &board, (best.account, best.tally.steps))?;
            let name = Line::of(best.name.as_str(), NAME_COLUMNS);
            ghosts.extend(run.map(|run| Ghost::new(run, name)));
        }
        if let Some(account) = own {
            let bests = store.bests(account)?;
            let steps = bests.iter().find(|best| best.0 == board).map(|best| best.1.tally.steps);
            let run = steps.map(|steps| self.run(store, catalog, &board, (account, steps)));
            let run = run.transpose()?.flatten();
            ghosts.extend(run.map(|run| Ghost::new(run, None)));
        }
        Ok(ghosts)
    }

    /// The run of an account that took `steps` steps.
    fn run(
        &mut self,
        store: &mut HostStore,
        catalog: &Catalog,
        board: &LevelBoard,
        (account, steps): (AccountId, u64),
    ) -> Result<Option<Arc<Run>>, StoreFailure> {
        // This key is unique: each new best run of an account takes fewer steps than its previous one.
        let key = (board.clone(), account, steps);
        if let Some((_, run)) = self.runs.iter().find(|(known, _)| *known == key) {
            return Ok(Some(Arc::clone(run)));
        }
        let Some(text) = store.script(account, board)? else { return Ok(None) };
        let script = Script::parse(&text, "the script").ok();
        let world = catalog.world(board.level());
        let Some((script, world)) = script.zip(world) else { return Ok(None) };
        let run = Run::played(world.as_ref().clone(), script.header().rules(), &script);
        let run = Arc::new(run);
        push_within(&mut self.runs, (key, Arc::clone(&run)), MAX_KEPT);
        Ok(Some(run))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accounts::{Account, AccountKey, Name, UnixTime, verify};
    use cellcaster::map::builtin;

    const WON: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../maps/scripts/cellar.normal.script"
    ));

    const CELLAR: (&str, Difficulty) = ("cellar", Difficulty::Normal);

    impl Ghost {
        /// The ghost of a script with these lines in `world`.
        pub(crate) fn of_script(world: &World, script: &str, name: Option<&str>) -> Self {
            let script = Script::parse(script, "it").unwrap_or_else(|faults| panic!("{faults}"));
            let run = Run::played(world.clone(), Rules::default(), &script);
            Self::new(Arc::new(run), name.and_then(|name| Line::of(name, 16)))
        }
    }

    fn cellar() -> World {
        builtin::LEVELS.iter().find(|level| level.name == "cellar").unwrap().world().unwrap()
    }

    #[test]
    fn a_ghost_is_where_the_script_was_at_each_step() {
        let script = Script::parse(WON, "it").unwrap();
        let ghost = Ghost::of_script(&cellar(), WON, Some("Mara"));
        let mut game = Game::with_rules(cellar(), script.header().rules());
        let mut shown = 0;
        for (step, (_, intents)) in script.iter().enumerate() {
            if game.is_finished() {
                break;
            }
            if step % EVERY == 0 {
                let figure = ghost.figure(step as u64, SpriteId(0)).unwrap();
                let camera = game.camera(FieldOfView::default());
                assert!(figure.position.distance(camera.position()) < 1e-4, "step {step}");
                assert!((figure.base - game.feet()).abs() < 1e-4, "step {step}");
                let turned = figure.heading.degrees() - camera.heading.degrees();
                assert!(turned.abs().min(360.0 - turned.abs()) < 0.01, "step {step}");
                shown += 1;
            }
            game.step(intents);
        }
        assert!(game.is_finished() && shown > 100);
        assert_eq!(ghost.figure(2 * shown, SpriteId(0)), None, "it has left the level");
        assert_eq!(ghost.figure(u64::MAX, SpriteId(0)), None);
        assert_eq!(ghost.label(), "Mara's best");
    }

    #[test]
    fn a_ghost_is_animated_while_it_walks() {
        let ghost = Ghost::of_script(&cellar(), WON, None);
        let frames = (0..400).filter_map(|step| Some(ghost.figure(step, SpriteId(0))?.frame));
        let frames: std::collections::BTreeSet<u8> = frames.collect();
        assert!(frames.len() >= 3, "{frames:?}");
        assert_eq!(ghost.color(Some(PlayerColor::Sky)), PlayerColor::Sky);
        assert_eq!(ghost.color(None), BEST);
    }

    #[test]
    fn the_longest_run_takes_under_a_megabyte() {
        let text = format!("level cellar\n{} steps stand\n", MAX_STEPS + 100);
        let script = Script::parse(&text, "it").unwrap();
        let run = Run::played(cellar().without_guards(), Rules::default(), &script);
        assert_eq!(run.figures.len(), MAX_STEPS / EVERY);
        let bytes = size_of_val(&*run.figures);
        assert!(bytes < 1_000_000, "{bytes}");
    }

    fn account(store: &mut HostStore, number: u8, name: &str) -> Account {
        let key = AccountKey::new([number; 32]);
        store.create_account(None, &key, &Name::new(name).unwrap(), UnixTime::new(7)).unwrap()
    }

    #[test]
    fn the_best_run_and_the_personal_best_walk_along() {
        let (catalog, mut store) = (Catalog::builtin(), HostStore::in_memory());
        let [mara, jon] =
            [(1, "Mara"), (2, "Jon")].map(|(number, name)| account(&mut store, number, name).id);
        let mut kept = KeptRuns::default();
        let mut labels = |store: &mut HostStore, level, own| -> Vec<String> {
            let ghosts = kept.ghosts(store, &catalog, level, own).unwrap();
            ghosts.iter().map(Ghost::label).collect()
        };
        assert_eq!(labels(&mut store, CELLAR, Some(jon)), [""; 0]);
        let run = verify(WON, |_| None).unwrap();
        store.record(mara, &run, UnixTime::new(8)).unwrap();
        assert_eq!(labels(&mut store, CELLAR, Some(jon)), ["Mara's best"]);
        assert_eq!(labels(&mut store, CELLAR, None), ["Mara's best"]);
        assert_eq!(labels(&mut store, CELLAR, Some(mara)), ["your best"]);
        store.record(jon, &run, UnixTime::new(9)).unwrap();
        assert_eq!(labels(&mut store, CELLAR, Some(jon)), ["Mara's best", "your best"]);
        assert_eq!(labels(&mut store, ("cellar", Difficulty::Hard), Some(jon)), [""; 0]);
        assert_eq!(labels(&mut store, ("no such", Difficulty::Normal), Some(jon)), [""; 0]);
        // Each script was played once: the runs are cached.
        assert_eq!(kept.runs.len(), 2);
    }

    #[test]
    fn the_number_of_cached_runs_is_bounded() {
        let (catalog, mut store) = (Catalog::builtin(), HostStore::in_memory());
        let mara = account(&mut store, 1, "Mara").id;
        let run = verify(WON, |_| None).unwrap();
        store.record(mara, &run, UnixTime::new(8)).unwrap();
        let board = LevelBoard::new(CELLAR.0, CELLAR.1).unwrap();
        let mut kept = KeptRuns::default();
        for steps in 0..MAX_KEPT as u64 + 3 {
            let run = kept.run(&mut store, &catalog, &board, (mara, steps)).unwrap();
            assert!(run.is_some());
        }
        assert_eq!(kept.runs.len(), MAX_KEPT);
    }
}
