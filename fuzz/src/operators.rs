//! Texts that operators and visitors write: a configuration, a name, a range of addresses, a
//! script. The first byte chooses the kind, and the others are the text.

use cellcaster_server::accounts::{AccountKey, AddressPrefix, Name, printable, verify};
use cellcaster_server::config::Config;

use crate::faults::check_faults;

/// The largest size in bytes of a script that is verified. Playing a longer script takes minutes.
const MAX_SCRIPT: usize = 60;

/// Reads a text in the way that the first byte chooses.
pub fn run(data: &[u8]) {
    let Some((kind, content)) = data.split_first() else { return };
    let text = String::from_utf8_lossy(content);
    match kind % 3 {
        0 => {
            if let Err(faults) = Config::parse(&text, "host.toml") {
                check_faults(&faults);
            }
        }
        1 => names(&text),
        _ => {
            if text.len() <= MAX_SCRIPT && !text.contains("000") {
                _ = verify(&text, |_| None);
            }
        }
    }
}

fn names(text: &str) {
    let shown = printable(text, 40);
    assert!(!shown.contains(char::is_control), "{shown:?}");
    assert_eq!(printable(&shown, 40), shown, "shown again");
    if let Ok(name) = Name::new(text) {
        assert_eq!(Name::new(name.as_str()).as_ref(), Ok(&name));
        assert!(name.looks_like(&name));
        assert!(!name.as_str().contains(char::is_control));
    }
    if let Some(prefix) = AddressPrefix::parse(text) {
        assert_eq!(AddressPrefix::parse(&prefix.to_string()), Some(prefix));
    }
    _ = AccountKey::parse(text);
}
