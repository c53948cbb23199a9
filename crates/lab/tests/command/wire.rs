//! Bytes and colour errors of a game on the wire.

use std::num::NonZeroU32;

use cellcaster::app::{Levels, Replay, Settings};
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::Script;
use cellcaster::map;
use cellcaster::terminal::Fidelity;
use cellcaster::tui::GlyphSet;
use cellcaster::world::World;
use cellcaster_lab::wire::{self, EncoderReport, PalettePlan, PaletteRow, Part, Plan, Report};
use ratatui::layout::Size;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// Levels that stay as they are, unlike those of the campaign.
const LEVELS: [&str; 5] = ["cellar", "museum", "citadel", "cistern", "observatory"];

fn world(level: &str) -> World {
    map::load(format!("{ROOT}/tests/maps/{level}.toml").as_ref()).unwrap()
}

fn script() -> Script {
    Script::parse(include_str!("../../../../maps/showcase.script"), "showcase").unwrap()
}

fn report(level: &str) -> Report {
    report_of(&script(), level, Settings::default())
}

fn report_of(script: &Script, level: &str, settings: Settings) -> Report {
    let levels = Levels::new(world(level).into(), std::iter::empty());
    let size = Size::new(120, 40);
    let frames_per_second = NonZeroU32::new(30).unwrap();
    let fidelities = vec![Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW];
    let depth = settings.depth.unwrap_or_default();
    let plan = Plan { script, size, depth, frames_per_second, fidelities };
    wire::report(&plan, &mut Replay::new(levels, settings, size))
}

fn encoder<'a>(report: &'a Report, name: &str) -> &'a EncoderReport {
    report.encoders.iter().find(|encoder| encoder.name == name).unwrap()
}

fn section<'a>(encoder: &'a EncoderReport, name: &str) -> &'a Part {
    encoder.sections.iter().find(|part| part.name == name).unwrap()
}

/// The bytes and the errors of each of Cellcaster's encoders, as means over three levels. The
/// figures are those of the report, and are repeatable.
#[test]
fn three_levels_take_no_more_bytes_than_is_promised() {
    let reports = ["citadel", "museum", "observatory"].map(report);
    for (name, most, farthest) in [
        ("exact", 0.5405, 0.0),
        ("exact+", 0.431, 0.0),
        ("high", 0.137, 1.017),
        ("high+", 0.1012, 1.018),
        ("low", 0.0645, 2.17),
        ("low+", 0.0467, 2.21),
    ] {
        let parts = reports.each_ref().map(|report| &encoder(report, name).all);
        let mean = |of: fn(&Part) -> f64| parts.iter().map(|part| of(part)).sum::<f64>() / 3.0;
        let (ratio, distance) = (mean(|part| part.ratio), mean(|part| part.seen.mean_distance));
        assert!(ratio <= most && distance <= farthest, "{name}: {ratio:.4} at {distance:.3}");
    }
}

/// A tolerance for changes of the levels.
const SLACK: f64 = 1.05;

#[test]
fn a_frame_takes_no_more_bytes_than_is_promised() {
    let report = report("citadel");
    let exact = encoder(&report, "exact");
    assert!(exact.all.ratio <= 0.53 * SLACK, "{:?}", exact.all);
    assert!(section(exact, "turning").ratio <= 0.54 * SLACK, "{exact:?}");
    assert_eq!(section(exact, "standing").bytes.largest, 0);
    assert_eq!(exact.all.seen.mean_distance, 0.0);
    assert_eq!(exact.all.seen.signal_to_noise, f64::INFINITY);
    assert_eq!(section(encoder(&report, "stock"), "standing").bytes.largest, 25);

    let stock = encoder(&report, "stock");
    let (high, low) = (encoder(&report, "high"), encoder(&report, "low"));
    assert!(high.all.seen.mean_distance <= 1.0 && low.all.seen.mean_distance <= 2.0);
    assert!(high.all.ratio <= 0.14 * SLACK, "{:?}", high.all);
    assert!(low.all.ratio <= 0.06 * SLACK, "{:?}", low.all);
    for pair in [stock, exact, high, low].windows(2) {
        assert!(pair[1].all.bytes.mean < 0.9 * pair[0].all.bytes.mean, "{}", pair[1].name);
    }

    let frames: usize = exact.sections.iter().map(|part| part.frames).sum();
    assert_eq!((exact.all.frames, report.frames), (frames, frames));
    for part in exact.sections.iter().chain([&exact.all]) {
        let bytes = part.bytes;
        assert!(bytes.median <= bytes.percentile_95 && bytes.percentile_95 <= bytes.largest);
        assert!(bytes.mean <= bytes.largest as f64);
    }
}

/// Fidelity spares bytes whatever cells are made of. Without colours there is nothing that could be about right.
#[test]
fn every_colour_depth_and_glyph_mode_takes_fewer_bytes_at_lower_fidelity() {
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
        let mean = |name| encoder(&report, name).all.bytes.mean;
        let ratios = ["high", "low"].map(|name| mean(name) / mean("exact"));
        let is_less = ratios.iter().zip(most).all(|(ratio, most)| *ratio <= most);
        assert!(is_less, "{glyphs:?} {depth:?}: {ratios:?}");
    }
}

fn palettes(levels: &[&'static str], depth: ColorDepth, frames_per_second: u32) -> Vec<PaletteRow> {
    let frames_per_second = NonZeroU32::new(frames_per_second).unwrap();
    let plan = PalettePlan { depth, size: Size::new(80, 24), frames_per_second };
    wire::report_palettes(&plan, levels.iter().map(|&name| (name, world(name))))
}

#[test]
fn shades_of_256_colours_look_like_true_colour() {
    let rows = palettes(&LEVELS, ColorDepth::Indexed256, 10);
    for [nearest, dots, flat, unknown] in rows.as_chunks().0 {
        for row in [dots, flat] {
            assert!(row.start_error < 0.02 && row.start_chroma_error < 0.016, "{row:?}");
        }
        for row in [dots, flat, unknown] {
            assert!(row.error < 0.85 * nearest.error, "{row:?} {nearest:?}");
        }
        assert!(dots.start_lightness.abs() < 0.01 && flat.start_lightness.abs() < 0.01, "{dots:?}");
    }
    let all = &rows[rows.len() - 3];
    assert_eq!((&*all.level, all.method), ("all", "dots"));
    assert!(all.start_error < 0.0135 && all.start_chroma_error < 0.011, "{all:?}");
}

#[test]
fn sixteen_colours_keep_the_brightness_of_a_dark_level() {
    let rows = palettes(&["kennels"], ColorDepth::Indexed16, 2);
    let [nearest, dots, flat, _] = rows.first_chunk().unwrap();
    assert!(dots.start_lightness.abs() < 0.08 && flat.start_lightness.abs() < 0.03, "{rows:?}");
    assert!(flat.error < 0.6 * nearest.error, "{rows:?}");
}
