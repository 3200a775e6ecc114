//! The tokens of TypeScript, as far as imports and names need them: comments, regular expressions and the text of
//! templates are left out.

/// One token with the line it starts on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub kind: Kind,
    /// The line, counted from 1.
    pub line: usize,
}

/// Kinds of token.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Kind {
    /// A name, a keyword or a number.
    Word(String),
    /// The content of a string in quotes.
    Text(String),
    /// A template without its text; what it inserts follows as tokens.
    Template,
    /// One sign.
    Sign(char),
}

impl Token {
    /// Whether it is this name or keyword.
    pub fn is_word(&self, word: &str) -> bool {
        matches!(&self.kind, Kind::Word(own) if own == word)
    }

    /// Whether it is this sign.
    pub fn is_sign(&self, sign: char) -> bool {
        self.kind == Kind::Sign(sign)
    }

    /// The name or keyword, if it is one.
    pub fn word(&self) -> Option<&str> {
        match &self.kind {
            Kind::Word(word) => Some(word),
            _ => None,
        }
    }

    /// The content of the string, if it is one.
    pub fn text(&self) -> Option<&str> {
        match &self.kind {
            Kind::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// Splits a file into tokens. A quote or slash that closes on no later place of its line is a sign of its own, as in
/// the text of a page.
pub fn tokens(text: &str) -> Vec<Token> {
    let mut scanner = Scanner {
        rest: text,
        line: 1,
        tokens: Vec::new(),
        templates: Vec::new(),
    };
    while scanner.step() {}
    scanner.tokens
}

struct Scanner<'a> {
    rest: &'a str,
    line: usize,
    tokens: Vec<Token>,
    /// For each template that is open the number of braces open in what it inserts.
    templates: Vec<usize>,
}

impl Scanner<'_> {
    fn step(&mut self) -> bool {
        let Some(first) = self.rest.chars().next() else {
            return false;
        };
        match first {
            _ if first.is_whitespace() => self.skip(first.len_utf8()),
            _ if is_name(first) => self.name(),
            '/' if self.rest.starts_with("//") => {
                self.skip(self.rest.find('\n').unwrap_or(self.rest.len()))
            }
            '/' if self.rest.starts_with("/*") => {
                self.skip(self.rest.find("*/").map_or(self.rest.len(), |end| end + 2))
            }
            '/' if self.may_start_pattern() => self.pattern(),
            '"' | '\'' => self.string(first),
            '`' => {
                self.push(Kind::Template);
                self.skip(1);
                self.template();
            }
            '{' | '}' => self.brace(first),
            _ => self.sign(first),
        }
        true
    }

    fn push(&mut self, kind: Kind) {
        self.tokens.push(Token {
            kind,
            line: self.line,
        });
    }

    /// Passes over this many bytes.
    fn skip(&mut self, bytes: usize) {
        let (passed, rest) = self.rest.split_at(bytes);
        self.line += passed.bytes().filter(|byte| *byte == b'\n').count();
        self.rest = rest;
    }

    fn sign(&mut self, sign: char) {
        self.push(Kind::Sign(sign));
        self.skip(sign.len_utf8());
    }

    fn name(&mut self) {
        let end = self
            .rest
            .find(|letter| !is_name(letter))
            .unwrap_or(self.rest.len());
        self.push(Kind::Word(self.rest[..end].to_string()));
        self.skip(end);
    }

    fn string(&mut self, quote: char) {
        match self.end_on_line(quote, false) {
            Some(end) => {
                self.push(Kind::Text(self.rest[1..end].to_string()));
                self.skip(end + 1);
            }
            None => self.sign(quote),
        }
    }

    fn pattern(&mut self) {
        match self.end_on_line('/', true) {
            Some(end) => self.skip(end + 1),
            None => self.sign('/'),
        }
    }

    /// Where on this line the sign that opens the rest stands again; in patterns not between `[` and `]`.
    fn end_on_line(&self, close: char, has_classes: bool) -> Option<usize> {
        let (mut escaped, mut in_class) = (false, false);
        for (at, letter) in self.rest.char_indices().skip(1) {
            match letter {
                '\n' => return None,
                _ if escaped => escaped = false,
                '\\' => escaped = true,
                '[' if has_classes => in_class = true,
                ']' if has_classes => in_class = false,
                _ if letter == close && !in_class => return Some(at),
                _ => {}
            }
        }
        None
    }

    /// Whether a slash here starts a regular expression: it follows no value. After `<` it closes a tag.
    fn may_start_pattern(&self) -> bool {
        match self.tokens.last().map(|token| &token.kind) {
            None => true,
            Some(Kind::Sign(sign)) => "(,=:[!&|?{;".contains(*sign),
            Some(Kind::Word(word)) => matches!(word.as_str(), "return" | "typeof" | "case"),
            Some(Kind::Text(_) | Kind::Template) => false,
        }
    }

    fn brace(&mut self, sign: char) {
        let closes_insert = sign == '}' && self.templates.last() == Some(&0);
        if let Some(open) = self.templates.last_mut() {
            *open = if sign == '{' {
                *open + 1
            } else {
                open.saturating_sub(1)
            };
        }
        self.sign(sign);
        if closes_insert {
            self.templates.pop();
            self.template();
        }
    }

    /// Passes over the text of a template up to its end or to what it inserts.
    fn template(&mut self) {
        let mut escaped = false;
        for (at, letter) in self.rest.char_indices() {
            match letter {
                _ if escaped => escaped = false,
                '\\' => escaped = true,
                '`' => return self.skip(at + 1),
                '$' if self.rest[at..].starts_with("${") => {
                    self.skip(at + 1);
                    self.sign('{');
                    self.templates.push(0);
                    return;
                }
                _ => {}
            }
        }
        self.skip(self.rest.len());
    }
}

fn is_name(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_' || letter == '$'
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tokens in one line, strings in quotes.
    fn told(text: &str) -> String {
        let tell = |token: Token| match token.kind {
            Kind::Word(word) => word,
            Kind::Text(text) => format!("'{text}'"),
            Kind::Template => "`".to_string(),
            Kind::Sign(sign) => sign.to_string(),
        };
        tokens(text)
            .into_iter()
            .map(tell)
            .collect::<Vec<_>>()
            .join(" ")
    }

    #[test]
    fn comments_and_patterns_are_left_out() {
        assert_eq!(told("a // b 'c\n/* 'd' */ e / f / g"), "a e / f / g");
        assert_eq!(
            told(r#"x = /['"\/[/]]*/g.test("it's")"#),
            "x = g . test ( 'it's' )"
        );
        assert_eq!(told("(/\\/\\//)\nimport 'x'"), "( ) import 'x'");
    }

    #[test]
    fn templates_give_only_what_they_insert() {
        assert_eq!(
            told("a(`import 'x' ${b + `${c}'` + {d: 1}.d} // e`) + 'f'"),
            "a ( ` { b + ` { c } + { d : 1 } . d } ) + 'f'"
        );
    }

    #[test]
    fn text_of_a_page_swallows_nothing() {
        assert_eq!(
            told("<p>it's</p>\n<br />\nimport 'x'"),
            "< p > it ' s < / p > < br / > import 'x'"
        );
    }

    #[test]
    fn lines_are_counted_through_all_of_them() {
        let all = tokens("/*\n*/`\n${a}\n`\n'b'");
        let last = all.last().unwrap();
        assert_eq!((last.text(), last.line), (Some("b"), 5));
    }
}
