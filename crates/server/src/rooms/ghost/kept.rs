//! The runs of boards, played once and kept for the next round.

use std::collections::VecDeque;
use std::sync::Arc;

use super::{Ghost, Run};
use crate::accounts::{AccountId, HostStore, LevelBoard, StoreFailure};
use crate::rooms::room::{Catalog, NAME_COLUMNS};
use crate::sessions::line::Line;
use cellcaster::game::Script;
use cellcaster::world::Difficulty;

/// The most runs that are kept: at most 10 MB.
const MOST: usize = 32;

/// Runs that were played, the newest last.
#[derive(Debug, Default)]
pub(crate) struct KeptRuns {
    runs: VecDeque<(Key, Arc<Run>)>,
    /// The number of scripts that were played.
    #[cfg(test)]
    played: usize,
}

/// What tells a run from all others: an account's fastest run of a level takes fewer steps than the one
/// before it.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    level: String,
    difficulty: Difficulty,
    account: AccountId,
    steps: u64,
}

impl KeptRuns {
    /// The ghosts of a level: the best run of the board, and the best one of the visitor's `own`
    /// account, if it is another one.
    ///
    /// # Errors
    /// Where the store can't be read.
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

    /// The run of an account that took so many steps.
    fn run(
        &mut self,
        store: &mut HostStore,
        catalog: &Catalog,
        board: &LevelBoard,
        (account, steps): (AccountId, u64),
    ) -> Result<Option<Arc<Run>>, StoreFailure> {
        let (level, difficulty) = (board.level().to_owned(), board.difficulty());
        let key = Key { level, difficulty, account, steps };
        if let Some((_, run)) = self.runs.iter().find(|(known, _)| *known == key) {
            return Ok(Some(Arc::clone(run)));
        }
        let Some(text) = store.script(account, board)? else { return Ok(None) };
        let script = Script::parse(&text, "the script").ok();
        let world = catalog.world(board.level());
        let Some((script, world)) = script.zip(world) else { return Ok(None) };
        let run = Run::played(world.as_ref().clone(), script.header().rules(), &script);
        let run = Arc::new(run);
        self.runs.push_back((key, Arc::clone(&run)));
        if self.runs.len() > MOST {
            self.runs.pop_front();
        }
        #[cfg(test)]
        {
            self.played += 1;
        }
        Ok(Some(run))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accounts::{Account, AccountKey, Name, UnixTime, verify};

    const WON: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../maps/scripts/cellar.normal.script"
    ));
    const CELLAR: (&str, Difficulty) = ("cellar", Difficulty::Normal);

    fn account(store: &mut HostStore, number: u8, name: &str) -> Account {
        let key = AccountKey::new([number; 32]);
        store.create_account(&key, &Name::new(name).unwrap(), UnixTime::new(7)).unwrap()
    }

    #[test]
    fn the_best_run_and_the_own_one_walk_along() {
        let (catalog, mut store) = (Catalog::builtin(), HostStore::in_memory());
        let [mara, jon] =
            [(1, "Mara"), (2, "Jon")].map(|(number, name)| account(&mut store, number, name).id);
        let mut kept = KeptRuns::default();
        let mut labels = |store: &mut HostStore, level, own| -> Vec<String> {
            let ghosts = kept.ghosts(store, &catalog, level, own).unwrap();
            ghosts.iter().map(Ghost::label).collect()
        };
        assert_eq!(labels(&mut store, CELLAR, Some(jon)), [""; 0]);
        let run = verify(WON).unwrap();
        store.record(mara, &run, UnixTime::new(8)).unwrap();
        assert_eq!(labels(&mut store, CELLAR, Some(jon)), ["Mara's best"]);
        assert_eq!(labels(&mut store, CELLAR, None), ["Mara's best"]);
        assert_eq!(labels(&mut store, CELLAR, Some(mara)), ["your best"]);
        store.record(jon, &run, UnixTime::new(9)).unwrap();
        assert_eq!(labels(&mut store, CELLAR, Some(jon)), ["Mara's best", "your best"]);
        assert_eq!(labels(&mut store, ("cellar", Difficulty::Hard), Some(jon)), [""; 0]);
        assert_eq!(labels(&mut store, ("no such", Difficulty::Normal), Some(jon)), [""; 0]);
        // Each script was played once.
        assert_eq!(kept.played, 2);
    }

    #[test]
    fn only_some_runs_are_kept() {
        let (catalog, mut store) = (Catalog::builtin(), HostStore::in_memory());
        let mara = account(&mut store, 1, "Mara").id;
        let run = verify(WON).unwrap();
        store.record(mara, &run, UnixTime::new(8)).unwrap();
        let board = LevelBoard::new(CELLAR.0, CELLAR.1).unwrap();
        let mut kept = KeptRuns::default();
        for steps in 0..MOST as u64 + 3 {
            let run = kept.run(&mut store, &catalog, &board, (mara, steps)).unwrap();
            assert!(run.is_some());
        }
        assert_eq!(kept.runs.len(), MOST);
    }
}
