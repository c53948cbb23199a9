//! Bytes and colour errors of a game on the wire.

use std::num::NonZeroU32;

use cellcaster::app::{Levels, Replay, Settings};
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::Script;
use cellcaster::map;
use cellcaster::terminal::Fidelity;
use cellcaster::tui::GlyphSet;
use cellcaster::world::World;
use cellcaster_lab::report::{Row, Table};
use cellcaster_lab::wire::{self, WirePlan};
use ratatui::layout::Size;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// Levels that never change, unlike the levels of the campaign.
const LEVELS: [&str; 5] = ["cellar", "museum", "citadel", "cistern", "observatory"];

fn world(level: &str) -> World {
    map::load(format!("{ROOT}/tests/maps/{level}.toml").as_ref()).unwrap()
}

fn script() -> Script {
    Script::parse(include_str!("../../../../maps/showcase.script"), "showcase").unwrap()
}

fn report(level: &str) -> Table {
    report_of(&script(), level, Settings::default())
}

fn report_of(script: &Script, level: &str, settings: Settings) -> Table {
    let levels = Levels::new(world(level).into(), std::iter::empty());
    let size = Size::new(120, 40);
    let frames_per_second = NonZeroU32::new(30).unwrap();
    let fidelities = &[Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW];
    let depth = settings.depth.unwrap_or_default();
    let plan = WirePlan { script, size, depth, frames_per_second, fidelities };
    wire::report(&plan, &mut Replay::new(levels, settings, size))
}

/// The figure in this column of the row of a section and an encoder, such as "stock", "high" or "high+".
fn figure(table: &Table, [section, encoder]: [&str; 2], column: &str) -> f64 {
    let encoder_of = |row: &Row| match row.keys[1].strip_prefix("ours") {
        Some(suffix) => format!("{}{suffix}", row.keys[2]),
        None => row.keys[1].clone(),
    };
    let is_wanted = |row: &&Row| row.keys[0] == section && encoder_of(row) == encoder;
    let row = table.rows.iter().find(is_wanted).unwrap();
    let column = table.columns.iter().position(|name| name == column).unwrap();
    row.values[column].number().unwrap_or(f64::NAN)
}

/// The bytes and the errors of each of Cellcaster's encoders, as means over three levels. The
/// figures are the report's, and are repeatable.
#[test]
fn three_levels_stay_within_the_promised_bytes() {
    let reports = ["citadel", "museum", "observatory"].map(report);
    for (name, most, farthest) in [
        ("exact", 0.5405, 0.0),
        ("exact+", 0.431, 0.0),
        ("high", 0.137, 1.017),
        ("high+", 0.1012, 1.018),
        ("low", 0.0645, 2.17),
        ("low+", 0.0467, 2.21),
    ] {
        let mean = |column| {
            reports.iter().map(|report| figure(report, ["all", name], column)).sum::<f64>() / 3.0
        };
        let (ratio, distance) = (mean("ratio"), mean("mean ΔE"));
        assert!(ratio <= most && distance <= farthest, "{name}: {ratio:.4} at {distance:.3}");
    }
}

/// A tolerance for changes of the levels.
const SLACK: f64 = 1.05;

#[test]
fn frames_stay_within_the_promised_bytes() {
    let report = report("citadel");
    let all = |encoder, column| figure(&report, ["all", encoder], column);
    assert!(all("exact", "ratio") <= 0.53 * SLACK, "{report:?}");
    assert!(figure(&report, ["turning", "exact"], "ratio") <= 0.54 * SLACK, "{report:?}");
    assert_eq!(figure(&report, ["standing", "exact"], "largest bytes"), 0.0);
    assert_eq!(all("exact", "mean ΔE"), 0.0);
    assert_eq!(all("exact", "PSNR"), f64::INFINITY);
    assert_eq!(figure(&report, ["standing", "stock"], "largest bytes"), 25.0);

    assert!(all("high", "mean ΔE") <= 1.0 && all("low", "mean ΔE") <= 2.0);
    assert!(all("high", "ratio") <= 0.14 * SLACK, "{report:?}");
    assert!(all("low", "ratio") <= 0.06 * SLACK, "{report:?}");
    for pair in ["stock", "exact", "high", "low"].windows(2) {
        let [more, fewer] = [pair[0], pair[1]].map(|encoder| all(encoder, "mean bytes"));
        assert!(fewer < 0.9 * more, "{}", pair[1]);
    }

    let exact = report.rows.iter().filter(|row| row.keys[1..] == ["ours", "exact"]);
    let sections: Vec<&str> = exact.map(|row| row.keys[0].as_str()).collect();
    let of_section = |name, column| figure(&report, [name, "exact"], column);
    let named = sections.iter().filter(|name| **name != "all");
    let frames: f64 = named.map(|name| of_section(name, "frames")).sum();
    assert_eq!(all("exact", "frames"), frames);
    assert!(report.title.starts_with(&format!("{frames} frames ")), "{}", report.title);
    for name in sections {
        let largest = of_section(name, "largest bytes");
        let high = of_section(name, "95th % bytes");
        assert!(of_section(name, "median bytes") <= high && high <= largest);
        assert!(of_section(name, "mean bytes") <= largest);
    }
}

/// A lower fidelity saves bytes, whatever the cells consist of. Without colours, nothing can be
/// approximated.
#[test]
fn every_depth_and_glyph_mode_takes_fewer_bytes_at_lower_fidelity() {
    use ColorDepth::{Indexed16, Indexed256, Mono, True};
    for (glyphs, depth, most) in [
        (GlyphSet::Half, Indexed256, [0.75, 0.50]),
        (GlyphSet::Half, Indexed16, [0.92, 0.92]),
        (GlyphSet::Ascii, True, [0.32, 0.25]),
        (GlyphSet::Ascii, Indexed256, [0.88, 0.76]),
        (GlyphSet::Ramp, True, [0.40, 0.32]),
        (GlyphSet::Half, Mono, [1.0, 1.0]),
    ] {
        let settings = Settings { depth: Some(depth), glyphs, ..Settings::default() };
        let walk = Script::parse("1 s forward\n2 s turn-left", "walk").unwrap();
        let report = report_of(&walk, "citadel", settings);
        let mean = |name| figure(&report, ["all", name], "mean bytes");
        let ratios = ["high", "low"].map(|name| mean(name) / mean("exact"));
        let is_less = ratios.iter().zip(most).all(|(ratio, most)| *ratio <= most);
        assert!(is_less, "{glyphs:?} {depth:?}: {ratios:?}");
    }
}

fn palettes(levels: &[&'static str], depth: ColorDepth, frames_per_second: u32) -> Table {
    let frames_per_second = NonZeroU32::new(frames_per_second).unwrap();
    let levels = levels.iter().map(|&name| (name, world(name)));
    wire::report_palettes(depth, Size::new(80, 24), frames_per_second, levels)
}

#[test]
fn dithered_256_colours_look_like_true_colour() {
    let table = palettes(&LEVELS, ColorDepth::Indexed256, 10);
    for level in LEVELS.into_iter().chain(["all"]) {
        let of = |method, column| figure(&table, [level, method], column);
        for method in ["dots", "flat"] {
            assert!(of(method, "first error") < 20.0, "{level} {method}");
            assert!(of(method, "first chroma error") < 16.0, "{level} {method}");
            assert!(of(method, "first lightness").abs() < 10.0, "{level} {method}");
        }
        for method in ["dots", "flat", "unknown"] {
            assert!(of(method, "error") < 0.85 * of("nearest", "error"), "{level} {method}");
        }
    }
    let all = |column| figure(&table, ["all", "dots"], column);
    assert!(all("first error") < 13.5 && all("first chroma error") < 11.0, "{table:?}");
}

#[test]
fn sixteen_colours_keep_the_brightness_of_a_dark_level() {
    let table = palettes(&["kennels"], ColorDepth::Indexed16, 2);
    let of = |method, column| figure(&table, ["kennels", method], column);
    assert!(of("dots", "first lightness").abs() < 80.0, "{table:?}");
    assert!(of("flat", "first lightness").abs() < 30.0, "{table:?}");
    assert!(of("flat", "error") < 0.6 * of("nearest", "error"), "{table:?}");
}
