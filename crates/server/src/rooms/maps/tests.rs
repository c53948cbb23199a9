use std::env;
use std::process;

use super::*;

const HALL: &str = "grid = '''\n#####\n#@.>#\n#####\n'''\n[tiles]\n\"#\" = { wall = \"brick\" }\n\
                    [things]\n\"@\" = { start = 0 }\n\">\" = { exit = true }\n";

/// A folder with files that is removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn with(name: &str, files: &[(&str, &str)]) -> Self {
        let folder = env::temp_dir().join(format!("cellcaster-maps-{}-{name}", process::id()));
        _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        for (file, text) in files {
            fs::write(folder.join(file), text).unwrap();
        }
        Self(folder)
    }

    fn fault(&self) -> String {
        let fault = HostMaps::read(&self.0).unwrap_err();
        fault.replace(self.0.to_str().unwrap(), "maps")
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn each_toml_file_in_a_folder_is_a_map() {
    let titled = format!("title = \"The moss\"\n{HALL}");
    let files = [("moss.toml", &*titled), ("hall-2.toml", HALL), ("notes.md", "no map")];
    let folder = Scratch::with("all", &files);
    let maps = HostMaps::read(&folder.0).unwrap();
    assert_eq!(maps.names().collect::<Vec<_>>(), ["hall-2", "moss"]);
    let keys: Vec<&str> = maps.0.iter().map(|map| map.key.as_str()).collect();
    assert_eq!(keys, [map_key("hall-2", HALL), map_key("moss", &titled)]);
    let one = HostMaps::read(&folder.0.join("moss.toml")).unwrap();
    assert_eq!(one.names().collect::<Vec<_>>(), ["moss"]);
    let names = maps.level_names();
    assert!(names.contains(&"cellar"));
    assert_eq!(names[names.len() - 2..], ["hall-2", "moss"]);
}

#[test]
fn all_faults_of_all_maps_are_reported() {
    let folder = Scratch::with(
        "faults",
        &[
            ("cellar.toml", HALL),
            ("Hall.toml", HALL),
            ("unknown.toml", &HALL.replace("#@.>#", "#@?>#")),
            ("ragged.toml", &HALL.replace("#@.>#", "#@.>##")),
            ("right.toml", HALL),
            (
                "space.toml",
                "start = { at = [0, 0, 0.5], heading = 0 }\n[[sphere]]\ncenter = [4, 0, 1]\n\
              radius = 1\ncolor = \"#c04030\"\n",
            ),
        ],
    );
    insta::assert_snapshot!(folder.fault());
}

#[test]
fn the_number_and_the_size_of_maps_have_limits() {
    let long = format!("{HALL}#{}", " ".repeat(MAX_MAP_BYTES as usize));
    let folder = Scratch::with("large", &[("large.toml", &long)]);
    assert_eq!(
        folder.fault(),
        "maps/large.toml is larger than 256 KiB, the limit for a host's map"
    );
    let full = &long[..MAX_MAP_BYTES as usize];
    let names: Vec<String> = (0..=MAX_MAPS).map(|number| format!("m{number}.toml")).collect();
    let files: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), full)).collect();
    let most = (MAX_BYTES / MAX_MAP_BYTES) as usize;
    let folder = Scratch::with("bytes", &files[..most]);
    assert_eq!(HostMaps::read(&folder.0).unwrap().0.len(), most);
    let folder = Scratch::with("more-bytes", &files[..=most]);
    assert_eq!(folder.fault(), "the maps in maps are larger than 4 MiB together: remove some");
    let files: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), HALL)).collect();
    let folder = Scratch::with("many", &files);
    assert_eq!(folder.fault(), "there are more than 100 maps in maps: remove some");
}

#[test]
fn entries_other_than_files_are_refused() {
    let folder = Scratch::with("absent", &[]);
    assert_eq!(HostMaps::read(&folder.0).unwrap().0.len(), 0);
    fs::create_dir(folder.0.join("deep.toml")).unwrap();
    assert!(folder.fault().starts_with("maps/deep.toml can't be read: "), "{}", folder.fault());
    let absent = HostMaps::read(&folder.0.join("absent")).unwrap_err();
    assert!(absent.contains("can't be read"), "{absent}");
}

#[test]
fn names_are_shown_without_control_characters() {
    let folder = Scratch::with("names", &[("a\u{1b}[31m\nb.toml", HALL)]);
    let sentence = r"maps/a\u{1b}[31m\nb.toml needs another name: 1 to 32 of the characters a to z, 0 to 9, - and _, then .toml";
    assert_eq!(folder.fault(), sentence);
    let folder = Scratch::with("daily", &[("daily-2026-11-28.toml", HALL)]);
    let sentence = "maps/daily-2026-11-28.toml needs another name: daily-2026-11-28 is the daily level of a day";
    assert_eq!(folder.fault(), sentence);
    let folder = Scratch::with("name", &[("\u{9b}.toml", HALL), ("wide.toml", "grid = 1\n")]);
    assert!(folder.fault().contains(r"\u{9b}.toml needs"));
}
