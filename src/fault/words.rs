//! How a fault speaks of words that somebody wrote: quoted, and with the word they may have meant.

/// Longer than anything that could be a misspelt name.
const LONGEST_NAME: usize = 40;

/// The one of `known` that `word` most likely was meant to be, if any is near: at most one slip
/// for every three letters.
pub(crate) fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    if word.len() > LONGEST_NAME {
        return None;
    }
    let slips_allowed = (word.chars().count() / 3).max(1);
    let slips = |name: &&str| strsim::damerau_levenshtein(word, name);
    let name = known.iter().copied().min_by_key(slips)?;
    (slips(&name) <= slips_allowed && name.len() > slips_allowed).then_some(name)
}

/// `word` between double quotes, what does not print escaped, and what is long cut short.
pub(crate) fn quoted(word: &str) -> String {
    match word.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => format!("{:?}…", &word[..end]),
        None => format!("{word:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEYS: &[&str] = &["title", "ceiling", "floor", "grid"];

    #[test]
    fn a_slip_has_a_nearest_name() {
        for (slip, name) in
            [("titel", "title"), ("celing", "ceiling"), ("Floor", "floor"), ("gridd", "grid")]
        {
            assert_eq!(nearest(slip, KEYS), Some(name), "{slip}");
        }
    }

    #[test]
    fn another_word_has_none() {
        for word in ["", "x", "walls", "ceilinggniliec", &"floor".repeat(1_000_000)] {
            assert_eq!(nearest(word, KEYS), None);
        }
        assert_eq!(nearest("grid", &[]), None);
    }

    #[test]
    fn a_quote_prints_on_one_short_line() {
        assert_eq!(quoted("a\n\u{1b}[31m"), r#""a\n\u{1b}[31m""#);
        assert_eq!(quoted(&"ä".repeat(1000)), format!("\"{}\"…", "ä".repeat(40)));
    }
}
