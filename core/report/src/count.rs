//! Numbers of things in words.

/// So many of something: one is not several.
#[must_use]
pub fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_not_several() {
        let told = [0, 1, 2].map(|count| counted(count, "knee"));
        assert_eq!(told, ["0 knees", "1 knee", "2 knees"]);
    }
}
