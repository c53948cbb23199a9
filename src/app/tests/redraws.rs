//! Redraws while guards move.

use proptest::prelude::*;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;

use super::*;

const WINDOW: Rect = Rect { x: 0, y: 0, width: 80, height: 24 };

/// The cells of the picture, without the status line.
fn picture(rig: &mut Rig) -> Vec<Cell> {
    let mut buffer = Buffer::empty(WINDOW);
    rig.app.draw(&mut buffer);
    let cells = usize::from(WINDOW.width) * usize::from(WINDOW.height - 1);
    buffer.content()[..cells].to_vec()
}

/// Plays for `steps` steps, and draws whenever the screen is out of date. Returns the number of
/// frames.
fn frames(rig: &mut Rig, steps: u32) -> usize {
    let drawn = (0..steps).filter(|_| {
        rig.wait(17);
        let is_stale = rig.app.is_stale();
        if is_stale {
            picture(rig);
            rig.app.drawn();
        }
        is_stale
    });
    drawn.count()
}

fn rig(grid: &str, tiles: &str, things: &str) -> Rig {
    let text = format!(
        "par = 60\nceiling = 'stone'\ngrid = '''\n{}\n'''\n[tiles]\n'#' = {{ wall = 'brick' }}\n\
         {tiles}\n[things]\n'@' = {{ start = 0 }}\n{things}\n",
        grid.trim()
    );
    Rig::new(parse_str(&text).unwrap_or_else(|faults| panic!("{faults}")), None)
}

#[test]
fn a_guard_who_moves_outside_the_view_costs_no_frame() {
    let grid = "
##############
#....#1.....2#
#@...####..###
#....#3.....4#
##############";
    let waypoints = [1, 2, 3, 4].map(|number| format!("{number}.waypoint = true")).join("\n");
    let things = format!("{waypoints}\ng = {{ guard = 'warden', heading = 0, patrol = '1423' }}");
    for place in [8, 11] {
        let mut rows: Vec<String> = grid.trim().lines().map(str::to_owned).collect();
        rows[1].replace_range(place..=place, "g");
        for tiles in ["", "u = { floor_height = 0.2 }"] {
            let grid = rows.join("\n");
            let grid = if tiles.is_empty() { grid } else { grid.replacen("#@.", "#@u", 1) };
            let mut rig = rig(&grid, tiles, &things);
            let position = |rig: &Rig| rig.game().guards().next().unwrap().position;
            let (before, mut farthest, mut drawn) = (position(&rig), 0.0_f64, 0);
            for _ in 0..60 {
                drawn += frames(&mut rig, 10);
                farthest = farthest.max(before.distance(position(&rig)));
            }
            assert_eq!(drawn, 1, "{place} {tiles}");
            assert!(farthest > 2.0, "{place}: the guard stands");
        }
    }
}

#[test]
fn a_guard_standing_in_view_costs_a_frame_only_when_turning() {
    let grid = "
#########
#@....g.#
#########";
    let mut rig = rig(grid, "", "g = { guard = 'warden', heading = 0 }");
    let mut turns = 0;
    let mut heading = None;
    let mut drawn = 0;
    for _ in 0..600 {
        drawn += frames(&mut rig, 1);
        let now = rig.game().guards().next().map(|guard| guard.heading);
        turns += usize::from(now != heading);
        heading = now;
    }
    assert_eq!(drawn, turns);
    assert!((2..200).contains(&turns), "{turns}");
}

/// Several rooms. The player is in the first one; a lantern bearer and a warden patrol all the
/// others.
const ROOMS: &str = "
######################
#....#1......#......2#
#.@..+...o...+..h....#
#....#....w..#.......#
#o.###.....###..l..3.#
#..%...4...#.........#
######################";
const THINGS: &str = "
1 = { waypoint = true }
2 = { waypoint = true }
3 = { waypoint = true }
4 = { waypoint = true }
w = { guard = 'warden', heading = 0, patrol = '1423' }
l = { guard = 'lantern', heading = 0, patrol = '31' }
h = { guard = 'hound', heading = 0, wander = 6 }
";

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn an_up_to_date_screen_shows_the_current_game(
        keys in prop::collection::vec(
            (prop::sample::select(&[Key::Left, Key::Right, Key::Up, W, Key::Char('e')][..]), 20..700_u64),
            6,
        ),
        has_heights in any::<bool>(),
    ) {
        let floor = if has_heights { "floor_height = 0.25" } else { "light = 0.2" };
        let tiles = format!("'+' = {{ door = 'oak' }}\n'%' = {{ mask = 'grate' }}\no = {{ {floor} }}");
        let mut rig = rig(ROOMS, &tiles, THINGS);
        let mut shown = Vec::new();
        for (key, held) in keys {
            rig.press(key);
            for step in 0..60 {
                if step * 17 > held {
                    rig.release(key);
                }
                rig.wait(17);
                let is_stale = rig.app.is_stale();
                let now = picture(&mut rig);
                if is_stale {
                    rig.app.drawn();
                } else {
                    prop_assert!(shown == now, "{:?}", rig.game().elapsed());
                }
                shown = now;
            }
        }
    }
}
