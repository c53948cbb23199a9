//! Exits in reach and out of reach.

use super::*;
use crate::map;

/// Whether the exit of a map of those `tiles` is out of reach.
fn is_out_of_reach(grid: &str, tiles: &str) -> bool {
    let text = format!(
        "ceiling = 'sky'\ngrid = \"\"\"\n{grid}\n\"\"\"\n[tiles]\n'#' = {{ wall = 'brick', height = 3 }}\n\
         {tiles}\n[things]\n'@'.start = 0\n'X'.exit = true\n'k'.key = 'brass'"
    );
    is_exit_out_of_reach(&map::parse_str(&text).unwrap_or_else(|it| panic!("{it}")))
}

#[test]
fn what_is_walled_in_is_out_of_reach() {
    assert!(!is_out_of_reach("@..X", ""));
    assert!(is_out_of_reach("@.#X", ""));
    // There is no way between two corners.
    assert!(is_out_of_reach("@#\n#X", ""));
    assert!(!is_out_of_reach("@#\n.X", ""));
    assert!(is_out_of_reach("@gX", "'g'.glass = '#ffffff'"));
}

#[test]
fn nobody_starts_on_a_roof() {
    let text = "ceiling_height = 1.5\ngrid = '@.#X'\n[tiles]\n'#'.wall = 'brick'\n[things]\n\
                '@'.start = 0\nX.exit = true";
    assert!(is_exit_out_of_reach(&map::parse_str(text).unwrap()));
}

#[test]
fn a_map_without_an_exit_has_none_out_of_reach() {
    assert!(!is_out_of_reach("@#.", ""));
}

#[test]
fn a_locked_door_needs_a_key_that_can_be_reached() {
    let door = "'+' = { door = 'oak', key = 'brass' }";
    assert!(!is_out_of_reach("#####\n@.+.X\nk####", door));
    assert!(!is_out_of_reach("######\n@k.+.X\n######", door));
}

#[test]
fn who_jumps_gets_so_high_and_so_far() {
    let climb = |height: f64| is_out_of_reach("@.hX", &format!("'h'.floor_height = {height}"));
    assert!(!climb(0.66) && climb(0.67));
    let gap = |cells: usize| {
        let pit = "p".repeat(cells);
        is_out_of_reach(&format!("@.{pit}.X"), "'p'.floor_height = -3")
    };
    assert!(!gap(1) && !gap(3) && gap(5));
}
