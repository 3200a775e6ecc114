//! Names, functions and tests switched off in a file of TypeScript or JavaScript.

use super::tokens::{Kind, Token};
use crate::facts::Facts;

/// What checks of single files look at.
pub fn facts(text: &str, tokens: &[Token]) -> Facts {
    let mut facts = Facts {
        lines: text.lines().count(),
        ..Facts::default()
    };
    for token in tokens {
        if let Some(word) = token.word() {
            facts.note_name(word, token.line);
        }
    }
    for three in tokens.windows(3) {
        if three[0].is_sign('.') && three[1].is_word("skip") && three[2].is_sign('(') {
            facts.unfinished.push((three[1].line, ".skip("));
        }
    }
    let partners = partners(tokens);
    for (at, token) in tokens
        .iter()
        .enumerate()
        .filter(|(_, token)| token.is_sign('{'))
    {
        if let (Some((name, line)), Some(close)) =
            (function_of(tokens, &partners, at), partners[at])
        {
            facts.note_function(name, line.min(token.line), tokens[close].line);
        }
    }
    facts
}

/// For each bracket the place of the one that closes or opens it.
fn partners(tokens: &[Token]) -> Vec<Option<usize>> {
    let mut partners = vec![None; tokens.len()];
    let mut open = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        match token.kind {
            Kind::Sign('(' | '{') => open.push(at),
            Kind::Sign(')' | '}') => {
                if let Some(start) = open.pop() {
                    partners[at] = Some(start);
                    partners[start] = Some(at);
                }
            }
            _ => {}
        }
    }
    partners
}

/// The name and first line of the function whose body a brace opens, as far as this can be told without types in
/// braces; a function without a name has an empty one.
fn function_of<'a>(
    tokens: &'a [Token],
    partners: &[Option<usize>],
    brace: usize,
) -> Option<(&'a str, usize)> {
    const STATEMENTS: [&str; 6] = ["catch", "for", "if", "switch", "while", "with"];
    let before = |steps: usize| brace.checked_sub(steps).map(|at| &tokens[at]);
    if before(1)?.is_sign('>') && before(2).is_some_and(|token| token.is_sign('=')) {
        return (!is_suite(&tokens[..brace])).then_some(("", tokens[brace].line));
    }
    let in_type = |token: &Token| match token.kind {
        Kind::Sign(sign) => "<>[]|&.,".contains(sign),
        Kind::Word(_) | Kind::Text(_) => true,
        Kind::Template => false,
    };
    let mut end = brace - 1;
    while end > 0 && in_type(&tokens[end]) {
        end -= 1;
    }
    if tokens[end].is_sign(':') && end + 1 < brace {
        end = end.checked_sub(1)?;
    } else if end + 1 != brace {
        return None;
    }
    let open = partners[end].filter(|_| tokens[end].is_sign(')'))?;
    let name = tokens[open.checked_sub(1)?].word()?;
    (!STATEMENTS.contains(&name)).then_some((name, tokens[open].line))
}

/// Whether these tokens end in `describe('..', () =>`: a list of tests is no function to be read at once.
fn is_suite(before: &[Token]) -> bool {
    match before {
        [.., call, open, text, comma, first, second, _, _] => {
            let no_parameters = first.is_sign('(') && second.is_sign(')');
            let after_text = text.text().is_some() && comma.is_sign(',');
            call.is_word("describe") && open.is_sign('(') && after_text && no_parameters
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::super::tokens::tokens;
    use super::*;

    fn facts_of(text: &str) -> Facts {
        facts(text, &tokens(text))
    }

    #[test]
    fn functions_are_measured_with_their_parameters() {
        let text = "export function one(\n  a: { b: number },\n): Promise<readonly A[]> {\n  if (a) {\n  }\n}\n\
                    class X {\n  get two(): void {\n  }\n}\nconst three = (a) => {\n  return { a };\n};\n\
                    const four = c ? f(x) : {\n};\n\
                    describe('five', () => {\n});";
        let told = facts_of(text).functions;
        let told: Vec<_> = told
            .iter()
            .map(|f| (f.name.as_str(), f.line, f.lines))
            .collect();
        assert_eq!(told, [("one", 1, 6), ("two", 8, 2), ("", 11, 3)]);
    }

    #[test]
    fn a_test_switched_off_is_seen() {
        let off =
            facts_of("// it.skip()\nit.skip('later', () => {});\n'.skip('; skip(x);").unfinished;
        assert_eq!(off, [(2, ".skip(")]);
    }
}
