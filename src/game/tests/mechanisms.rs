//! Switches and the tiles and doors that they drive, secret walls, floors that crumble, and flames.

use super::*;
use crate::world::SwitchId;

const LIFT: &str = "l = { floor_height = 0, ceiling = 'sky', moves_to = 2, switch = 'lift' }";

#[test]
fn a_lever_moves_a_floor_and_everyone_on_it() {
    let mut stage = Stage::new(&["@Lll."], LIFT, "L = { lever = 'lift' }");
    stage.press(Intent::Open);
    stage.press(Intent::Open);
    // After two turns of the lever, the floor is back where it was.
    stage.play(30, &[]);
    assert_eq!(stage.game.world().floor_at(Cell { column: 2, row: 0 }), 0.0);
    stage.press(Intent::Open);
    stage.play(140, &[]);
    assert_eq!(stage.game.world().floor_at(Cell { column: 2, row: 0 }), 2.0);
    assert_eq!(stage.game.world().things()[0].frame, Some(1));
    stage.press(Intent::Open);
    stage.play(140, &[]);
    stage.walk_to(2).play(12, &[Intent::Forward]).play(60, &[]);
    assert_eq!(stage.game.feet(), 0.0);
    stage.game.mechanisms.turn(SwitchId(0));
    for _ in 0..130 {
        stage.play(1, &[]);
        assert!(!stage.game.is_airborne());
    }
    assert_eq!(stage.game.feet(), 2.0);
    assert!(stage.game.is_at_rest(Intents::new()));
    stage.game.mechanisms.turn(SwitchId(0));
    for _ in 0..130 {
        stage.play(1, &[]);
        assert!(!stage.game.is_airborne());
    }
    assert_eq!(stage.game.feet(), 0.0);
}

#[test]
fn a_floor_rising_under_a_low_ceiling_stops() {
    let tiles = "l = { floor_height = 0, ceiling_height = 1.4, moves_to = 1, switch = 'lift' }";
    let mut stage = Stage::new(&["@.l.L"], tiles, "L = { lever = 'lift' }");
    let floor = |stage: &Stage| stage.game.world().floor_at(Cell { column: 2, row: 0 });
    stage.walk_to(2).play(6, &[Intent::Forward]).play(60, &[]);
    stage.game.mechanisms.turn(SwitchId(0));
    stage.play(60, &[]);
    assert_eq!((floor(&stage), stage.game.feet()), (0.625, 0.625));
    assert_eq!(stage.message(), "It stops: you are in the way.");
    // The message is shown only once.
    stage.play(180, &[]);
    assert!(stage.game.is_at_rest(Intents::new()));
    // A player who ducks takes less room.
    stage.play(120, &[Intent::Duck]);
    assert_eq!(floor(&stage), 0.875);
    assert_eq!(stage.message(), "It stops: you are in the way.");
}

#[test]
fn an_occupied_plate_is_on_and_opens_its_door() {
    let tiles =
        "p = { plate = 'gate', floor = '#808080' }\nG = { door = 'metal', switch = 'gate' }";
    let rows = ["########", "#@.p..G.", "########"];
    let mut stage = Stage::new(&rows, tiles, "");
    let gate = Cell { column: 6, row: 1 };
    let open = |stage: &Stage| stage.game.world().opening(gate).part();
    stage.walk_to(3).play(60, &[]);
    assert_eq!(open(&stage), 1.0);
    stage.play(600, &[]);
    assert_eq!(open(&stage), 1.0);
    assert!(stage.game.is_at_rest(Intents::new()));
    stage.walk_to(4).play(60, &[]);
    assert_eq!(open(&stage), 0.0);
    stage.play(60, &[Intent::Forward]);
    assert_eq!(stage.message(), "This door is opened elsewhere.");
    assert_eq!(stage.cell().column, 5);
}

#[test]
fn a_secret_wall_sinks_for_good_and_is_counted() {
    let rows = ["######", "#@.S.#", "######"];
    let mut stage = Stage::new(&rows, "S = { secret = 'brick' }", "");
    assert_eq!(stage.game.secrets(), Share { found: 0, total: 1 });
    stage.play(60, &[Intent::Forward]);
    assert_eq!(stage.cell().column, 2);
    stage.press(Intent::Jump);
    assert!(!stage.game.is_airborne());
    assert_eq!(stage.message(), "You have found a secret.");
    assert_eq!(stage.game.secrets(), Share { found: 1, total: 1 });
    stage.walk_to(4);
    assert!(stage.game.world().grid().rows().flatten().all(|tile| tile.0 < u8::MAX));
}

#[test]
fn a_wall_does_not_rise_while_its_cell_is_occupied() {
    let rows = ["######", "#@pGp#", "######"];
    let tiles =
        "p = { plate = 'gate', floor = '#808080' }\nG = { wall = 'brick', switch = 'gate' }";
    let mut stage = Stage::new(&rows, tiles, "");
    let wall = Cell { column: 3, row: 1 };
    stage.walk_to(2).play(120, &[]);
    assert_eq!(stage.game.world().floor_at(wall), 0.0);
    stage.walk_to(3).play(60, &[]);
    assert_eq!(stage.message(), "It stops: you are in the way.");
    stage.play(180, &[]);
    assert_eq!((stage.cell(), stage.game.world().floor_at(wall)), (wall, 0.0));
    assert!(stage.game.is_at_rest(Intents::new()));
    stage.walk_to(4).play(30, &[Intent::Forward]);
    assert_eq!(stage.game.world().floor_at(wall), 0.0);
}

#[test]
fn a_floor_crumbles_after_it_has_cracked() {
    let mut stage = Stage::new(&["@.cccc..."], "c = { floor = 'wood', crumbles = -3 }", "");
    let second = Cell { column: 2, row: 0 };
    stage.walk_to(2);
    stage.play(5, &[Intent::Forward]);
    let cracked = stage.game.world().floor_at(second);
    assert!((-0.3..0.0).contains(&cracked), "{cracked}");
    let mut steps = 0;
    while stage.game.world().floor_at(second) == cracked {
        stage.play(1, &[]);
        steps += 1;
    }
    assert!((23..=30).contains(&steps), "{steps}");
    stage.play(120, &[]);
    assert_eq!((stage.game.feet(), stage.points()), (-3.0, 5));
    assert_eq!(stage.game.world().floor_at(Cell { column: 4, row: 0 }), 0.0);
}

#[test]
fn a_runner_crosses_a_crumbling_floor() {
    let mut stage = Stage::new(&["@....cccc....."], "c = { floor = 'wood', crumbles = -3 }", "");
    stage.play(150, &[Intent::Forward, Intent::Run]);
    assert!(stage.cell().column > 9 && stage.game.feet() == 0.0);
}

#[test]
fn a_flame_is_put_out_and_lit_again() {
    let mut stage = Stage::new(&["@.F."], "", "F = { sprite = 'torch', douse = true }\n");
    let burns = |stage: &Stage| stage.game.world().things()[0].frame.is_none();
    stage.play(25, &[Intent::Forward]);
    stage.press(Intent::Open);
    assert!(!burns(&stage));
    // A key that is held works once.
    stage.play(20, &[Intent::Open]).play(1, &[]);
    assert!(burns(&stage));
}
