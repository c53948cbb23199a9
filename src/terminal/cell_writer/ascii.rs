//! Substitutes for characters on terminals that show only ASCII.

/// The substitute of `symbol`, the text of a cell: the symbol if it is a single ASCII character,
/// otherwise a similar character or a question mark. The empty second cell of a wide character
/// becomes a space.
pub(crate) fn substitute(symbol: &str) -> char {
    let Some(character) = symbol.chars().next() else { return ' ' };
    match character {
        ' '..='~' => character,
        '─' | '━' | '═' | '╌' | '┄' | '–' | '—' | '−' => '-',
        '│' | '┃' | '║' | '╎' | '┆' => '|',
        '\u{2500}'..='\u{257f}' => '+',
        '←' | '◀' | '◂' | '‹' => '<',
        '→' | '▶' | '▸' | '›' => '>',
        '↑' | '▲' | '▴' => '^',
        '↓' | '▼' | '▾' => 'v',
        '↗' | '↙' => '/',
        '↖' | '↘' => '\\',
        '░' | '·' | '…' => '.',
        '▒' => ':',
        '\u{2580}'..='\u{259f}' => '#',
        '×' => 'x',
        '•' | '●' | '◆' | '■' => '*',
        '‘' | '’' | '′' => '\'',
        '“' | '”' | '„' | '«' | '»' | '″' => '"',
        '\u{a0}' => ' ',
        _ => '?',
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn any_cell_becomes_one_ascii_character(symbol in ".{0,3}") {
            let substitute = substitute(&symbol);
            prop_assert!(matches!(substitute, ' '..='~'));
            if let &[byte @ b' '..=b'~'] = symbol.as_bytes() {
                prop_assert_eq!(substitute, char::from(byte));
            }
        }
    }

    #[test]
    fn a_panel_stays_a_panel() {
        let panel = ["┌──┐", "│→↗│", "└──┘"];
        let shown = panel.map(|row| {
            row.chars()
                .map(|symbol| substitute(symbol.encode_utf8(&mut [0; 4])))
                .collect::<String>()
        });
        assert_eq!(shown, ["+--+", "|>/|", "+--+"]);
    }
}
