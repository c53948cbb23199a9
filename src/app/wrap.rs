//! Line wrapping for panels.

/// Wraps `text` into lines of up to `width` characters, between words, and within words that are
/// longer.
pub(crate) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut room = width;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if room < width {
            if length < room {
                lines[..].last_mut().into_iter().for_each(|line| line.push(' '));
                room -= 1;
            } else {
                lines.push(String::new());
                room = width;
            }
        }
        for character in word.chars() {
            if room == 0 {
                lines.push(String::new());
                room = width;
            }
            lines[..].last_mut().into_iter().for_each(|line| line.push(character));
            room -= 1;
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_filled_to_the_width() {
        for (text, width, lines) in [
            ("", 5, &[""][..]),
            ("one two three", 7, &["one two", "three"]),
            ("one two three", 13, &["one two three"]),
            ("abcdefgh i", 3, &["abc", "def", "gh", "i"]),
            ("ä ö", 1, &["ä", "ö"]),
        ] {
            assert_eq!(wrapped(text, width), lines, "{text} in {width}");
        }
    }
}
