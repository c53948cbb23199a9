//! Floors and walls that move among guards and a player. No body is ever inside anything.

use crate::open::{is_in_the_open, is_open_for};
use crate::walker::{position, want};
use cellcaster::game::{Game, Intent};
use cellcaster::map;
use cellcaster::world::World;
use proptest::prelude::*;

const SIDE: usize = 10;

/// The characters of [`world_of`], each as often as it should appear.
const CELLS: &[u8] = b".........mmmmmnnnnpppppsslghHHHGGAb";

/// A room whose cells have these characters. The player starts in its middle.
fn world_of(cells: &[u8], ends: (f64, f64), room: f64) -> World {
    let mut cells = cells.to_vec();
    cells[..3].copy_from_slice(b"pmn");
    cells[SIDE * SIDE / 2 + SIDE / 2] = b'@';
    let rows: Vec<_> = cells.chunks(SIDE).map(String::from_utf8_lossy).collect();
    let (edge, inside) = ("#".repeat(SIDE + 2), rows.join("#\n#"));
    let text = format!(
        "ceiling = 'sky'\nceiling_height = 1.5\ngrid = '''\n{edge}\n#{inside}#\n{edge}\n'''\n[tiles]\n\
         '#' = {{ wall = 'brick', height = 3 }}\n\
         m = {{ moves_to = {:?}, switch = 'a', floor = 'oak' }}\n\
         n = {{ moves_to = {:?}, switch = 'a', floor = 'oak', ceiling = 'oak', ceiling_height = 1.5 }}\n\
         p = {{ plate = 'a', floor = 'stone' }}\ns = {{ wall = 'stone', switch = 'a' }}\n\
         l = {{ ceiling = 'oak', ceiling_height = {room:?} }}\ng = {{ glass = '#80c0ff' }}\n\
         h = {{ floor = 'stone', floor_height = 0.3 }}\n\
         [things]\n'@'.start = 252\nH.guard = 'hound'\nG.guard = 'warden'\n\
         A = {{ guard = 'archer', asleep = true }}\nb.sprite = 'column'\n",
        ends.0, ends.1
    );
    map::parse_str(&text).unwrap_or_else(|faults| panic!("{text}\n{faults}"))
}

/// Describes a body that is inside something, if there is one.
fn inside(game: &Game) -> Option<String> {
    let world = game.world();
    let guard =
        game.guards().find(|it| !is_open_for(world, it.position, it.feet, it.kind.height()));
    let player = (!is_in_the_open(world, position(game), game.feet())).then(|| "the player".into());
    player.or(guard.map(|guard| format!("{guard:?}")))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn moving_tiles_never_enter_a_player(
        cells in prop::collection::vec(prop::sample::select(CELLS), SIDE * SIDE),
        ends in (-1.0..=1.0, -1.0..=1.0),
        room in 0.5..1.2,
        script in prop::collection::vec(
            (1..60_usize, prop::sample::subsequence(Intent::ALL.to_vec(), 0..=5)),
            10..60,
        ),
    ) {
        let mut game = Game::new(world_of(&cells, ends, room));
        for (steps, wanted) in &script {
            for _ in 0..*steps {
                game.step(want(wanted));
                let inside = inside(&game);
                prop_assert!(inside.is_none(), "step {}: {}", game.steps(), inside.unwrap());
            }
        }
    }
}
