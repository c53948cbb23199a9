//! A step of the game allocates nothing once its memory has grown, and takes only as long as the
//! moving parts need.

use allocation_counter::measure;
use cellcaster::game::{Alarm, Game, Intent, Intents, Outcome};
use cellcaster::map::{self, builtin};
use cellcaster::world::World;

/// The number of steps in which the memory grows, and the number of steps that are counted.
const GROWS: u32 = 14_400;
const COUNTED: u32 = 600;

/// A corridor with rooms on both sides. The player starts in column `start`; guards with the duty
/// `duty` stand in the west.
fn rooms(start: usize, duty: &str) -> World {
    const COLUMNS: usize = 160;
    let lines = (0..13_usize).map(|row| {
        let cell = |column: usize| match (column, row) {
            (0, _) | (_, 0 | 12) => '#',
            (_, 6) if column == start => '@',
            _ if column + 1 == COLUMNS => '#',
            _ if column.is_multiple_of(4) && !matches!(row % 6, 0 | 1 | 5) => '#',
            (2..30, 4 | 8) if column % 3 == 1 => 'G',
            _ => '.',
        };
        (0..COLUMNS).map(cell).collect::<String>()
    });
    let grid = lines.collect::<Vec<_>>().join("\n");
    let text = format!(
        "grid = '''\n{grid}\n'''\n[tiles]\n'#' = {{ wall = 'brick' }}\n[things]\n\
         '@' = {{ start = 0 }}\n'G' = {{ guard = 'warden', heading = 0{duty} }}\n"
    );
    map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The allocations of [`COUNTED`] steps with these intents.
fn allocations(game: &mut Game, intents: Intents) -> u64 {
    measure(|| (0..COUNTED).for_each(|_| game.step(intents))).count_total
}

fn circling() -> Intents {
    [Intent::Forward, Intent::TurnRight, Intent::Duck].into_iter().collect()
}

#[test]
fn patrols_allocate_nothing_once_their_paths_are_known() {
    let level = builtin::LEVELS.iter().find(|level| level.name == "barracks").unwrap();
    let mut game = Game::new(level.world().unwrap());
    (0..GROWS).for_each(|_| game.step(Intents::new()));
    let before: Vec<_> = game.guards().map(|guard| guard.position).collect();
    assert_eq!(allocations(&mut game, Intents::new()), 0);
    assert!(game.guards().map(|guard| guard.position).ne(before), "nobody walks");
    assert_eq!(game.outcome(), Outcome::Playing);
}

#[test]
fn guards_on_duty_and_asleep_allocate_nothing() {
    for duty in ["", ", asleep = true", ", wander = 8"] {
        let mut game = Game::new(rooms(100, duty));
        (0..GROWS).for_each(|_| game.step(circling()));
        assert_eq!(allocations(&mut game, circling()), 0, "{duty}");
        assert_eq!(game.outcome(), Outcome::Playing, "{duty}");
    }
}

/// Guards share their path searches, of which there are at most twelve at once, and each search has
/// two lists.
#[test]
fn each_search_by_a_guard_allocates_two_lists() {
    let mut game = Game::new(rooms(30, ""));
    let run = [Intent::Forward, Intent::Run].into_iter().collect();
    let mut has_been_wary = false;
    let counted = measure(|| {
        for _ in 0..900 {
            game.step(run);
            has_been_wary |= game.alarm() == Alarm::Wary;
        }
    });
    assert!(has_been_wary, "nobody searches");
    assert!(counted.count_total <= 36, "{}", counted.count_total);
}

/// A hall of `rows` rows, each of which repeats the characters of `row`, and one more row before
/// them, in which the player starts beside `first`.
fn hall(rows: usize, first: &str, row: &str, legend: &str) -> Game {
    let row = row.repeat(40);
    let grid = format!("@{first}.{row}\n{}", format!("...{row}\n").repeat(rows));
    let text = format!("ceiling = 'sky'\ngrid = '''\n{grid}'''\n{legend}");
    Game::new(map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}")))
}

/// The largest work of a step in ten seconds of running ahead.
fn most_work(mut game: Game) -> u64 {
    let run = [Intent::Forward, Intent::Run, Intent::Open].into_iter().collect();
    let work = (0..600).map(|_| {
        game.step(run);
        game.work()
    });
    work.max().unwrap()
}

#[test]
fn untouched_cells_cost_a_step_nothing() {
    let kinds = [
        ("m", "p", "p.plate = 'a'\nm = { moves_to = 1, switch = 'a' }\n"),
        (".", "c", "c.crumbles = -3\n"),
        (".", "S.", "S.secret = 'brick'\n"),
    ];
    for (first, row, tiles) in kinds {
        let legend = format!("[tiles]\n{tiles}[things]\n'@'.start = 0\n");
        let work = |rows| most_work(hall(rows, first, row, &legend));
        assert_eq!(work(4), work(400), "{row}");
    }
}

#[test]
fn the_largest_moving_crowd_stays_within_the_work_limit_of_a_step() {
    let rows = ["GGms".repeat(128), "ms".repeat(192), "p".repeat(512)];
    let width = 520;
    let rows = rows.map(|row| format!("{row:.<width$}")).join("\n");
    let text = format!(
        "ceiling = 'sky'\ngrid = '''\n{:.<width$}\n{rows}\n'''\n[tiles]\np.plate = 'a'\n\
         m = {{ moves_to = 1, switch = 'a' }}\n[things]\n'@'.start = 0\ns.spikes = 1\n\
         G = {{ guard = 'hound', heading = 0, wander = 8 }}\n",
        "@"
    );
    let game = Game::new(map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}")));
    let work = most_work(game);
    assert!((50_000..=Game::MAX_WORK).contains(&work), "{work}");
}
