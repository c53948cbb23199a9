//! Exits in reach and out of reach.

use super::*;
use crate::map;

/// Whether the exit of a map with these `tiles` is out of reach.
fn is_out_of_reach(grid: &str, tiles: &str) -> bool {
    let text = format!(
        "ceiling = 'sky'\ngrid = \"\"\"\n{grid}\n\"\"\"\n[tiles]\n'#' = {{ wall = 'brick', height = 3 }}\n\
         {tiles}\n[things]\n'@'.start = 0\n'X'.exit = true\n'k'.key = 'brass'"
    );
    is_exit_out_of_reach(&map::parse_str(&text).unwrap_or_else(|it| panic!("{it}")))
}

/// Like [`is_out_of_reach`], but under a roof, with `top` before the grid and with additional
/// `things`.
fn is_out_of_reach_inside(top: &str, grid: &str, tiles: &str, things: &str) -> bool {
    let text = format!(
        "{top}\ngrid = \"\"\"\n{grid}\n\"\"\"\n[tiles]\n'#'.wall = 'brick'\n{tiles}\n[things]\n\
         '@'.start = 0\n'X'.exit = true\n{things}"
    );
    is_exit_out_of_reach(&map::parse_str(&text).unwrap_or_else(|it| panic!("{it}")))
}

#[test]
fn a_walled_in_exit_is_out_of_reach() {
    assert!(!is_out_of_reach("@..X", ""));
    assert!(is_out_of_reach("@.#X", ""));
    // There is no path between the corners of two walls.
    assert!(is_out_of_reach("@#\n#X", ""));
    assert!(!is_out_of_reach("@#\n.X", ""));
    assert!(is_out_of_reach("@gX", "'g'.glass = '#ffffff'"));
}

#[test]
fn the_start_is_never_on_a_roof() {
    let text = "ceiling_height = 1.5\ngrid = '@.#X'\n[tiles]\n'#'.wall = 'brick'\n[things]\n\
                '@'.start = 0\nX.exit = true";
    assert!(is_exit_out_of_reach(&map::parse_str(text).unwrap()));
}

#[test]
fn a_map_without_an_exit_has_no_exit_out_of_reach() {
    assert!(!is_out_of_reach("@#.", ""));
}

#[test]
fn a_locked_door_needs_a_reachable_key() {
    let door = "'+' = { door = 'oak', key = 'brass' }";
    assert!(!is_out_of_reach("#####\n@.+.X\nk####", door));
    assert!(!is_out_of_reach("######\n@k.+.X\n######", door));
}

#[test]
fn a_jump_has_a_limited_height_and_length() {
    let climb = |height: f64| is_out_of_reach("@.hX", &format!("'h'.floor_height = {height}"));
    assert!(!climb(0.66) && climb(0.67));
    let gap = |cells: usize| {
        let pit = "p".repeat(cells);
        is_out_of_reach(&format!("@.{pit}.X"), "'p'.floor_height = -3")
    };
    assert!(!gap(1) && !gap(3) && gap(5));
}

#[test]
fn secret_walls_count_as_open() {
    let secret = "'%'.secret = 'brick'";
    assert!(!is_out_of_reach_inside("", "####\n@.%X\n####", secret, ""));
    // The roof above the secret wall is not a path for a player who starts inside.
    assert!(is_out_of_reach_inside("", "#####\n@%.#X\n#####", secret, ""));
}

#[test]
fn a_crumbled_floor_does_not_come_back() {
    let floors = "'c'.crumbles = -3\n'p'.floor_height = -3";
    assert!(!is_out_of_reach("@.c.X", floors));
    assert!(is_out_of_reach("@.ppppppcX", floors));
}

#[test]
fn a_switch_needs_a_reachable_lever_or_plate() {
    let inside =
        |grid: &str, tiles: &str, things: &str| is_out_of_reach_inside("", grid, tiles, things);
    let door = "'+' = { door = 'metal', switch = 'gate' }\n'p'.plate = 'gate'";
    assert!(!inside("######\n@l.+.X\n######", door, "'l'.lever = 'gate'"));
    assert!(inside("######\n@..+lX\n######", door, "'l'.lever = 'gate'"));
    assert!(!inside("######\n@p.+.X\n######", door, ""));
    assert!(inside("######\n@..+pX\n######", door, ""));
    assert!(!inside("#######\n@..+pgX\n#######", door, "'g'.guard = 'hound'"));
    let wall = "'w' = { wall = 'stone', switch = 'gate' }";
    assert!(!inside("#####\n@lw.X\n#####", wall, "'l'.lever = 'gate'"));
    assert!(inside("#####\n@.wlX\n#####", wall, "'l'.lever = 'gate'"));
}

#[test]
fn a_lift_carries_to_both_ends() {
    let lift = |grid: &str, lift: &str| {
        let tiles = format!("'h'.floor_height = 3\n'm' = {{ {lift}, switch = 'lift' }}");
        let things = "'l'.lever = 'lift'\n'L' = { lever = 'lift', on = 'h' }\n\
                      'E' = { exit = true, on = 'h' }";
        is_out_of_reach_inside("ceiling = 'sky'", grid, &tiles, things)
    };
    assert!(!lift("@lmhE", "moves_to = 3"));
    assert!(!lift("@lmhE", "floor_height = 3, moves_to = 0"));
    assert!(lift("@lmhE", "moves_to = 2"));
    // The lever is on the upper floor.
    assert!(lift("@.mhLE", "moves_to = 3"));
}

#[test]
fn an_exit_may_need_reachable_treasure() {
    let asks = |worth: u32, grid: &str| {
        let top = format!("treasure_needed = {worth}");
        is_out_of_reach_inside(&top, grid, "", "'t'.treasure = 50")
    };
    assert!(!asks(50, "@tX") && !asks(100, "@tXt"));
    assert!(asks(51, "@tX#t") && !asks(50, "@tX#t"));
}
