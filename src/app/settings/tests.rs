use proptest::prelude::*;

use super::*;
use crate::app::controls::Action;
use crate::game::Intent;
use crate::terminal::Key;

fn parse(text: &str) -> Configuration {
    Configuration::parse(text, "config.toml").unwrap()
}

fn faults(text: &str) -> String {
    Configuration::parse(text, "config.toml").unwrap_err().to_string()
}

#[test]
fn an_empty_file_gives_the_defaults() {
    assert_eq!(parse(""), Configuration::default());
}

#[test]
fn a_file_replaces_the_keys_of_an_action() {
    let text =
        "preset = \"azerty\"\n[keys]\nforward = [\"e\", \"UP\"]\nleave = \"m\"\nstats = []\n";
    let bindings = parse(text).bindings;
    assert_eq!(bindings.action(Key::Char('e')), Some(Action::Want(Intent::Forward)));
    assert_eq!(bindings.action(Key::Char('z')), None);
    assert_eq!(bindings.action(Key::Char('q')), Some(Action::Want(Intent::StrafeLeft)));
    assert_eq!(bindings.action(Key::Char('m')), Some(Action::Leave));
    assert_eq!(bindings.keys(Action::ToggleMinimap).collect::<Vec<_>>(), [Key::Tab]);
    assert_eq!(bindings.keys(Action::ToggleStats).next(), None);
}

#[test]
fn a_file_changes_every_setting() {
    let text = "colors = 256\nglyphs = \"ascii\"\nfov = 90.5\nfps = 60\nmouse = true\n\
                minimap = \"off\"\nfidelity = 7\n";
    let read = parse(text);
    assert_eq!(read.colors, Some(ColorDepth::Indexed256));
    assert_eq!(read.glyphs, Some(GlyphSet::Ascii));
    assert_eq!(read.field_of_view.degrees(), 90.5);
    assert_eq!(read.frames_per_second.get(), 60);
    assert!(read.mouse);
    assert_eq!(read.minimap, MapDisplay::Off);
    assert_eq!(read.fidelity, Some(Fidelity::new(7)));
    assert_eq!(parse("colors = \"256\"\nfidelity = \"high\"").fidelity, Some(Fidelity::HIGH));
}

#[test]
fn every_fault_is_reported_with_its_place() {
    let text = r#"
preset = "azertie"
colour = 3
colors = "265"
glyphs = true
fov = 180
fps = 0
mouse = "yes"
minimap = "al"
fidelity = 256
[keys]
foward = "w"
back = "hyperspace"
run = 7
wider = "x"
narrower = ["y", "x"]
"#;
    insta::assert_snapshot!(faults(text));
    insta::assert_snapshot!(faults("[keys"));
}

#[test]
fn the_printed_file_is_complete() {
    insta::assert_snapshot!(parse("fov = 80\n[keys]\nleave = \"f10\"\njump = \"m\"\n").to_string());
}

fn key() -> impl Strategy<Value = Key> {
    prop_oneof![
        prop::sample::select(&["up", "space", "f1", "home", "\"", "\\", "#", "'", "é", "ж"][..]),
        prop::sample::select(&["a", "b", "w", "m", "?", "="][..]),
    ]
    .prop_map(|name| name.parse().unwrap())
}

proptest! {
    #[test]
    fn a_printed_configuration_parses_to_itself(
        preset in prop::sample::select(&["qwerty", "azerty", "hjkl"][..]),
        (colors, glyphs, minimap) in (0..5_usize, 0..7_usize, 0..3_usize),
        (fov, fps, mouse) in (0.001..179.9, 1..=240_u32, any::<bool>()),
        fidelity in prop::option::of(any::<u8>()),
        art in prop::option::of("[a-z/ ü\"\\\\]{1,8}"),
        actions in prop::collection::vec(0..Action::ALL.len(), 0..6),
        keys in prop::collection::vec(key(), 0..12),
    ) {
        let mut configuration = parse(&format!("preset = \"{preset}\""));
        let actions: Vec<Action> = actions.into_iter().map(|index| Action::ALL[index].2).collect();
        let mut bound: Vec<(Key, Action)> = Vec::new();
        for (index, key) in keys.into_iter().enumerate() {
            if let Some(&action) = actions.get(index % actions.len().max(1))
                && bound.iter().all(|&(other, _)| other != key)
            {
                bound.push((key, action));
            }
        }
        configuration.bindings = configuration.bindings.rebound(&actions, bound);
        configuration.colors = colors.checked_sub(1).map(|index| ColorDepth::ALL[index].0);
        configuration.glyphs = glyphs.checked_sub(1).map(|index| GlyphSet::ALL[index].0);
        configuration.minimap = MapDisplay::ALL[minimap].0;
        configuration.field_of_view = FieldOfView::from_degrees(fov).unwrap();
        configuration.frames_per_second = NonZeroU32::new(fps).unwrap();
        configuration.mouse = mouse;
        configuration.fidelity = fidelity.map(Fidelity::new);
        configuration.art = art;
        let printed = configuration.to_string();
        prop_assert_eq!(parse(&printed), configuration, "{}", printed);
    }
}
