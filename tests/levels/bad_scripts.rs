//! The reports on scripts with faults: one for each file in `tests/bad_scripts`.

use std::fs;

use cellcaster::game::Script;
use proptest::prelude::*;

#[test]
fn every_bad_script_is_refused_with_a_report() {
    let mut count = 0;
    for entry in fs::read_dir("tests/bad_scripts").unwrap() {
        let path = entry.unwrap().path();
        let content = fs::read(&path).unwrap();
        let faults = Script::from_bytes(content, &path.display().to_string()).unwrap_err();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        insta::assert_snapshot!(name, faults);
        count += 1;
    }
    assert!(count >= 5, "where are the bad scripts?");
}

proptest! {
    #[test]
    fn every_text_is_a_script_or_has_faults(text in r"([0-9.]{0,3}|s|steps|level|seed|difficulty|hard| |\n|#|\[|\]|forward|stand|run|ä|\t|\PC){0,30}") {
        if let Err(faults) = Script::parse(&text, "it") {
            prop_assert!(faults.len() >= 1 && faults.to_string().starts_with("error: "));
        }
    }
}
