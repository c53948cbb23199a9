use std::collections::BTreeSet;

use proptest::prelude::*;

use super::*;

#[test]
fn names_may_use_many_scripts() {
    for text in [
        "Ada",
        "bob_7",
        "Zoë",
        "Łukasz",
        "Вася",
        "Ελένη",
        "Անի",
        "ნინო",
        "漢字",
        "ひらがな",
        "カタカナ",
        "한국어",
        "ada漢字",
        "x-1",
        "sixteen_columns1",
        "漢字漢字漢字漢字",
    ] {
        assert_eq!(Name::new(text).map(|name| name.to_string()), Ok(text.to_owned()));
    }
    // Compatibility forms become the plain characters, and decomposed letters are composed.
    assert_eq!(Name::new("Ａｄａ").unwrap().as_str(), "Ada");
    assert_eq!(Name::new("Zoe\u{308}").unwrap().as_str(), "Zoë");
}

#[test]
fn invalid_names_are_refused_with_a_sentence() {
    let mut sentences = BTreeSet::new();
    for (text, fault) in [
        ("", NameFault::Short),
        ("a", NameFault::Short),
        ("seventeen_columns", NameFault::Long),
        ("漢字漢字漢字漢字a", NameFault::Long),
        ("a b", NameFault::Character(' ')),
        ("a\u{0}b", NameFault::Character('\0')),
        ("a\u{1b}[31m", NameFault::Character('\u{1b}')),
        ("a\u{202e}b", NameFault::Character('\u{202e}')),
        ("a\u{200b}b", NameFault::Character('\u{200b}')),
        ("a\u{300}\u{301}\u{302}b", NameFault::Character('\u{301}')),
        ("'; DROP TABLE accounts; --", NameFault::Character('\'')),
        ("שלום", NameFault::Character('ש')),
        ("ab😀", NameFault::Character('😀')),
        ("\u{e000}ab", NameFault::Character('\u{e000}')),
        ("7seas", NameFault::Begin),
        ("-ab", NameFault::Begin),
        ("ab-", NameFault::End),
        ("pаypal", NameFault::Mixed),
        ("Server", NameFault::Reserved),
        ("Аdmin", NameFault::Mixed),
        ("guest-12", NameFault::Reserved),
        ("GUESTS", NameFault::Reserved),
        ("r00t", NameFault::Reserved),
        ("adrnin", NameFault::Reserved),
    ] {
        assert_eq!(Name::new(text), Err(fault), "{text:?}");
        let sentence = fault.to_string();
        assert!(sentence.ends_with('.') && sentence.lines().count() == 1, "{sentence:?}");
        assert_eq!(printable(&sentence, 100), sentence);
        sentences.insert(sentence);
    }
    assert!(sentences.len() > 12);
    assert_eq!(Name::new(&"a".repeat(1 << 20)), Err(NameFault::Long));
}

#[test]
fn names_that_look_alike_share_a_key() {
    let look_alike =
        |one: &str, other: &str| Name::new(one).unwrap().looks_like(&Name::new(other).unwrap());
    for (one, other) in [
        ("Bob", "bOB"),
        ("Bill", "BiIl"),
        ("bi1l", "bill"),
        ("rnary", "mary"),
        ("Boss", "Воѕѕ"),
        ("СССР", "cccp"),
        ("straße", "STRASSE"),
        ("zoo", "z00"),
        ("Igor", "igor"),
        ("Σας", "σασ"),
    ] {
        assert!(look_alike(one, other) && look_alike(other, one), "{one} {other}");
    }
    for (one, other) in [("Bob", "Rob"), ("Ada", "Ada1"), ("a-b", "a_b"), ("漢字", "漢宇")] {
        assert!(!look_alike(one, other), "{one} {other}");
    }
}

#[test]
fn an_account_cannot_have_a_guest_name() {
    for number in [0, 1, u32::MAX] {
        let name = Name::of_guest(number);
        assert!(name.is_reserved() && name.as_str().width() <= Name::MAX_COLUMNS);
    }
}

/// Texts that are often valid names.
fn texts() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<String>(),
        "[a-zA-Z0-9_-]{1,17}",
        "[a-zA-ZàéïöüßıſIl1O0А-яёҰαιοΣςσ漢字かカ가-각\u{300}\u{301}_-]{1,12}",
    ]
}

#[test]
fn every_kind_of_character_is_kept_or_dropped_by_one_rule() {
    for (text, kept) in [
        // Control characters, including the introducers of escape sequences.
        ("\u{1b}]0;title\u{7}\u{9b}31m\u{7f}\0", "]0;title31m"),
        // All kinds of blanks and line breaks.
        ("a\u{a0}\u{2003}\r\n\u{2028}\u{3000}b", "a b"),
        // Combining marks, with and without a letter.
        ("e\u{301} z\u{301}\u{302}\u{303} q\u{301} \u{20dd} \u{fe0f}", "é ź q"),
        // Directional overrides, isolates and marks.
        ("\u{202a}a\u{202b}b\u{202c}c\u{202d}d\u{202e}e", "abcde"),
        ("\u{2066}a\u{2067}b\u{2068}c\u{2069}d\u{200e}e\u{200f}f\u{61c}g", "abcdefg"),
        // Invisible characters.
        ("a\u{200b}\u{200c}\u{200d}\u{2060}\u{feff}\u{ad}\u{3164}\u{2800}b", "ab"),
        // Tags, private-use and unassigned characters, and noncharacters.
        ("a\u{e0041}\u{e000}\u{f0000}\u{10fffd}\u{378}\u{fffe}b", "ab"),
        // Wide characters, and families of emoji, which fall apart.
        ("日本 \u{1f468}\u{200d}\u{1f469}", "日本 \u{1f468}\u{1f469}"),
        // A line may contain look-alikes. Only `Name` rejects them.
        ("раураl ⅰ①Ａ", "раураl ⅰ①Ａ"),
        // Characters that terminals draw over their neighbours or join with them.
        ("a\u{fdfa}\u{fdfd}\u{2e3b}\u{1242b}b", "ab"),
        ("\u{1f1eb}\u{1f1f7} \u{1f44d}\u{1f3fd}", "\u{1f44d}"),
        ("שלום عليكم", "שלום عليكم"),
    ] {
        assert_eq!(printable(text, 80), kept, "{text:?}");
    }
    assert_eq!(printable("ab 日本", 6), "ab 日");
    assert_eq!(printable("ab 日", 3), "ab");
    assert_eq!(printable("日", 1), "");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2048))]

    #[test]
    fn every_name_is_printable_and_round_trips(text in texts()) {
        if let Ok(name) = Name::new(&text) {
            let text = name.as_str();
            prop_assert!((Name::MIN_COLUMNS..=Name::MAX_COLUMNS).contains(&text.width()));
            prop_assert_eq!(printable(text, Name::MAX_COLUMNS), text);
            prop_assert_eq!(Name::new(text), Ok(name.clone()));
            prop_assert_eq!(Name::kept(text), name);
        }
    }

    #[test]
    fn names_with_different_keys_have_different_skeletons(one in texts(), other in texts()) {
        if let (Ok(one), Ok(other)) = (Name::new(&one), Name::new(&other)) {
            let skeleton = |name: &Name| -> String {
                skeleton(name.as_str()).collect()
            };
            let lower_case = |name: &Name| name.as_str().to_lowercase();
            if !one.looks_like(&other) {
                prop_assert_ne!(skeleton(&one), skeleton(&other));
                prop_assert_ne!(lower_case(&one), lower_case(&other));
            }
            prop_assert_eq!(one.looks_like(&other), other.looks_like(&one));
            prop_assert!(one.looks_like(&one));
        }
    }

    #[test]
    fn names_that_differ_in_case_look_alike(text in texts()) {
        if let Ok(name) = Name::new(&text) {
            for other in [name.as_str().to_uppercase(), name.as_str().to_lowercase()] {
                if let Ok(other) = Name::new(&other) {
                    prop_assert!(name.looks_like(&other), "{} {}", name, other);
                }
            }
        }
    }

    #[test]
    fn printable_text_fits_its_columns(text in any::<String>(), columns in 0..40_usize) {
        let line = printable(&text, columns);
        prop_assert!(line.chars().map(|c| c.width().unwrap()).sum::<usize>() <= columns);
        prop_assert!(line.chars().all(|c| !c.is_control() && c.width() != Some(0)));
        prop_assert!(line.trim() == line && !line.contains("  "));
        prop_assert_eq!(printable(&line, columns), line);
    }
}
