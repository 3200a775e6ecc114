//! What a file of TypeScript imports, passes on and defines.

use std::collections::BTreeSet;

use super::tokens::{Token, tokens};

/// A name taken from another file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Import {
    /// What the other file calls it; `*` for all of it or for what it does.
    pub name: String,
    /// The name it goes by here; for a re-export outside.
    pub local: String,
    /// The other file as it is written.
    pub from: String,
    /// The line.
    pub line: usize,
}

/// A file, as far as others can tell.
#[derive(Debug, Default)]
pub struct Module {
    /// What it uses itself.
    pub imports: Vec<Import>,
    /// What it only passes on: `export .. from`.
    pub re_exports: Vec<Import>,
    /// Exported names beside the names they have inside.
    pub exports: Vec<(String, String)>,
    /// The names it declares and exports.
    pub declared: BTreeSet<String>,
}

impl Module {
    /// Reads a file.
    pub fn parse(text: &str) -> Self {
        Self::from_tokens(&tokens(text))
    }

    /// Reads the tokens of a file.
    pub fn from_tokens(tokens: &[Token]) -> Self {
        let mut module = Self::default();
        for at in 0..tokens.len() {
            let is_member = at > 0 && tokens[at - 1].is_sign('.');
            let rest = &tokens[at + 1..];
            if tokens[at].is_word("import") && !is_member {
                module.import(rest, tokens[at].line);
            } else if tokens[at].is_word("export") && !is_member {
                module.export(rest);
            }
        }
        module
    }

    fn import(&mut self, rest: &[Token], line: usize) {
        let whole = |from: &str| Import {
            name: "*".into(),
            local: String::new(),
            from: from.into(),
            line,
        };
        match rest {
            [first, ..] if first.text().is_some() => self.imports.extend(first.text().map(whole)),
            [first, second, ..] if first.is_sign('(') => {
                self.imports.extend(second.text().map(whole))
            }
            [first, ..] if first.is_sign('.') || first.is_sign(':') => {}
            _ => self.imports.extend(clause(rest)),
        }
    }

    fn export(&mut self, rest: &[Token]) {
        let opens = |token: &Token| token.is_sign('{') || token.is_sign('*');
        let is_list = match rest {
            [first, ..] if opens(first) => true,
            [first, second, ..] => first.is_word("type") && opens(second),
            _ => false,
        };
        if !is_list {
            self.declared.extend(declared_name(rest));
            return;
        }
        let found = clause(rest);
        if found.is_empty() {
            let list = rest.iter().take_while(|token| !token.is_sign('}'));
            self.exports
                .extend(names(&list.cloned().collect::<Vec<_>>()));
        }
        self.re_exports.extend(found);
    }
}

/// The names of `A, { B as C }, * as d from 'file'`; none when no file follows.
fn clause(rest: &[Token]) -> Vec<Import> {
    let end = rest.iter().position(|token| {
        token.is_word("from") || token.is_sign(';') || token.is_sign('=') || token.is_sign('(')
    });
    let Some(end) = end.filter(|end| rest[*end].is_word("from")) else {
        return Vec::new();
    };
    let Some(from) = rest.get(end + 1).and_then(Token::text) else {
        return Vec::new();
    };
    let line = rest[end + 1].line;
    let taken = names(&rest[..end]).into_iter();
    taken
        .map(|(local, name)| Import {
            name,
            local,
            from: from.to_string(),
            line,
        })
        .collect()
}

/// The names of a clause as they are called on the side of its file and on the other: (`C`, `B`) of `{ B as C }`.
fn names(clause: &[Token]) -> Vec<(String, String)> {
    let open = clause
        .iter()
        .position(|token| token.is_sign('{'))
        .unwrap_or(clause.len());
    let mut found = Vec::new();
    for part in clause.split(|token| token.is_sign(',') || token.is_sign('{') || token.is_sign('}'))
    {
        let star = part.iter().any(|token| token.is_sign('*'));
        let mut words: Vec<&str> = part.iter().filter_map(Token::word).collect();
        if words.len() > 1 && words[0] == "type" && words[1] != "as" {
            words.remove(0);
        }
        let in_braces = part.first().is_some_and(|first| {
            clause[open..]
                .iter()
                .any(|token| std::ptr::eq(token, first))
        });
        let last = words.last().copied().unwrap_or_default().to_string();
        match words.first() {
            _ if star => found.push((last, "*".to_string())),
            Some(first) if in_braces => found.push((last, (*first).to_string())),
            Some(first) if *first != "type" => found.push((last, "default".to_string())),
            _ => {}
        }
    }
    found
}

/// The name after `export`: of `const`, `function`, `class`, a type, or `default`.
fn declared_name(rest: &[Token]) -> Option<String> {
    const BEFORE: [&str; 12] = [
        "abstract",
        "async",
        "class",
        "const",
        "declare",
        "enum",
        "function",
        "interface",
        "let",
        "namespace",
        "type",
        "var",
    ];
    let is_name = |token: &&Token| {
        !(token.is_sign('*') || token.word().is_some_and(|word| BEFORE.contains(&word)))
    };
    rest.iter()
        .find(is_name)
        .and_then(Token::word)
        .map(String::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(imports: &[Import]) -> Vec<String> {
        let tell = |import: &Import| format!("{} {} {}", import.line, import.name, import.from);
        imports.iter().map(tell).collect()
    }

    #[test]
    fn every_form_of_import_is_read() {
        let module = Module::parse(
            "import D, { A as B, type C } from './a';\nimport type { E } from './e';\nimport * as f from \"./f\";\n\
             import './g';\nconst h = await import('./h');\ntype I = import('./i').I;\nimport {\n  J,\n  K,\n} from './j';\n\
             import type L from './l';\nimport { type } from './m';",
        );
        assert_eq!(
            told(&module.imports),
            [
                "1 default ./a",
                "1 A ./a",
                "1 C ./a",
                "2 E ./e",
                "3 * ./f",
                "4 * ./g",
                "5 * ./h",
                "6 * ./i",
                "10 J ./j",
                "10 K ./j",
                "11 default ./l",
                "12 type ./m",
            ]
        );
        assert_eq!(module.imports[1].local, "B");
    }

    #[test]
    fn what_is_no_import_is_not_read() {
        let module = Module::parse(
            "// import { A } from './a';\nconst b = `import './b'`;\nnew Worker(new URL('./c.ts', import.meta.url));\n\
             x.import('./d'); const e = { import: './e' }; load(import.meta, './f');",
        );
        assert!(module.imports.is_empty(), "{:?}", module.imports);
    }

    #[test]
    fn exports_are_declared_or_passed_on() {
        let module = Module::parse(
            "import { P } from './p';\nexport { A, B as C } from './a';\nexport * from './b';\nexport type { D } from './d';\n\
             export { P, q as R };\nexport const e = 1;\nexport async function f(from: string) {}\nexport default g;\n\
             export abstract class H {}\nexport type I = { from: 'x' };\nexport * as j from './j';",
        );
        assert_eq!(
            told(&module.re_exports),
            ["2 A ./a", "2 B ./a", "3 * ./b", "4 D ./d", "11 * ./j"]
        );
        assert_eq!(module.re_exports[1].local, "C");
        let pair = |a: &str, b: &str| (a.to_string(), b.to_string());
        assert_eq!(module.exports, [pair("P", "P"), pair("R", "q")]);
        assert_eq!(
            module
                .declared
                .iter()
                .map(String::as_str)
                .collect::<Vec<_>>(),
            ["H", "I", "default", "e", "f"]
        );
    }
}
