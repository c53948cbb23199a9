//! Words in diagnostics: in quotes, and with the most similar known word.

/// Longer than any misspelt name.
const LONGEST_NAME: usize = 40;

/// The most similar of `known` to `word`, if any is similar: with at most one edit for every three
/// letters.
pub fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    if word.len() > LONGEST_NAME {
        return None;
    }
    let slips_allowed = (word.chars().count() / 3).max(1);
    let slips = |name: &&str| strsim::damerau_levenshtein(word, name);
    let name = known.iter().copied().min_by_key(slips)?;
    (slips(&name) <= slips_allowed && name.len() > slips_allowed).then_some(name)
}

/// `word` in double quotes, with non-printing characters escaped, shortened if it is long.
pub fn quoted(word: &str) -> String {
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
