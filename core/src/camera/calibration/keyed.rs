//! Keys and numbers of a text, whether YAML, XML, JSON or an assignment of MATLAB's: what a calibration holds needs no more of these forms.

/// A part of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'t> {
    /// A name that something follows: `name:`, `"name":`, `name =` or `<name`.
    Key(&'t str),
    /// A number; not a number where the file says so.
    Number(f64),
    /// Anything else.
    Word,
}

/// The keys and numbers of a text in their order.
pub(super) struct Tokens<'t> {
    rest: &'t str,
    /// `#` and `%` begin notes.
    has_notes: bool,
}

impl<'t> Tokens<'t> {
    pub(super) fn of(text: &'t str) -> Self {
        Self {
            rest: text,
            has_notes: !text.trim_start().starts_with(['{', '<']),
        }
    }

    /// Leaves out what stands before and with `end`; all where it does not come.
    fn skip_to(&mut self, end: &str) {
        let place = self.rest.find(end);
        self.rest = place.map_or("", |place| &self.rest[place + end.len()..]);
    }

    /// The next letters that are no mark.
    fn take_word(&mut self) -> &'t str {
        let is_end = |letter: char| letter.is_whitespace() || MARKS.contains(letter);
        let end = self.rest.find(is_end).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        word
    }

    /// Whether a colon or an equals sign comes next on the line.
    fn is_key_before(&self) -> bool {
        let next = self.rest.trim_start_matches(['"', '\'', ' ', '\t']);
        next.starts_with([':', '='])
    }
}

/// What parts words and numbers.
const MARKS: &str = "[](){}<>,;:=\"'!|*";

impl<'t> Iterator for Tokens<'t> {
    type Item = Token<'t>;

    fn next(&mut self) -> Option<Token<'t>> {
        loop {
            self.rest = self.rest.trim_start();
            let first = self.rest.chars().next()?;
            if self.has_notes && (first == '#' || first == '%') {
                self.skip_to("\n");
            } else if self.rest.starts_with("<!--") {
                self.skip_to("-->");
            } else if self.rest.starts_with("<?") || self.rest.starts_with("</") {
                self.skip_to(">");
            } else if let Some(rest) = self.rest.strip_prefix('<') {
                self.rest = rest;
                return Some(Token::Key(self.take_word()));
            } else if MARKS.contains(first) {
                self.rest = &self.rest[first.len_utf8()..];
            } else {
                let word = self.take_word();
                // A dash alone begins an entry of a list.
                if word != "-" {
                    return Some(self.token_of(word));
                }
            }
        }
    }
}

impl<'t> Tokens<'t> {
    fn token_of(&self, word: &'t str) -> Token<'t> {
        let unsigned = word.trim_start_matches(['-', '+', '.']);
        let is_none = ["nan", "inf"].into_iter();
        if let Ok(number) = word.parse() {
            Token::Number(number)
        } else if is_none
            .into_iter()
            .any(|name| unsigned.eq_ignore_ascii_case(name))
        {
            Token::Number(f64::NAN)
        } else if self.is_key_before() {
            Token::Key(word)
        } else {
            Token::Word
        }
    }
}
