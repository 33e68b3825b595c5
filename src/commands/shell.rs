//! Commands as they are shown to be typed.

/// A word as a shell takes it.
pub(super) fn in_shell(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+%@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.into()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_for_shells() {
        for (word, shown) in [
            ("speed=5kn,15kn", "speed=5kn,15kn"),
            ("speed=5..25 kn", "'speed=5..25 kn'"),
            ("a=\"it's\"", "'a=\"it'\\''s\"'"),
            ("", "''"),
        ] {
            assert_eq!(in_shell(word), shown);
        }
    }
}
