//! Which lines of a program's output tell by what it failed.

/// How a program tells of each failure: by a line, and some that follow it.
struct Telling {
    begins: fn(&str) -> bool,
    ends: fn(&str) -> bool,
    /// Lines that say nothing to somebody who knows which test it is.
    is_noise: fn(&str) -> bool,
    most: usize,
}

/// Lines of a failure; a longer one can be read where it happened.
const MOST: usize = 12;
/// Lines of an output that tells of no failure in a way that is known.
const LAST: usize = 15;

/// Tests of cargo, or what did not compile.
pub(crate) fn of_cargo(output: &str) -> Vec<String> {
    let tests = Telling {
        begins: |line| line.starts_with("---- ") && line.ends_with(" ----"),
        ends: |line| line.starts_with("failures:") || line.starts_with("test result:"),
        is_noise: |line| line.starts_with("note: run with"),
        most: MOST,
    };
    tests.or_errors(output)
}

/// Compilers, linters, and whatever begins a line of an error with that word.
pub(crate) fn of_others(output: &str) -> Vec<String> {
    let errors = Telling {
        begins: |line| line.starts_with("error"),
        ends: str::is_empty,
        is_noise: |_| false,
        most: MOST,
    };
    let told = errors.in_text(output);
    if !told.is_empty() {
        return told;
    }
    let lines: Vec<&str> = output
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    let last = &lines[lines.len().saturating_sub(LAST)..];
    last.iter().map(|line| (*line).to_owned()).collect()
}

/// Tests of Node's runner, of which the last part of its output tells once more.
pub(crate) fn of_node(output: &str) -> Vec<String> {
    let tests = Telling {
        begins: |line| line.starts_with("✖ "),
        ends: |line| line.starts_with("test at "),
        is_noise: |line| {
            line.contains("node:internal") || line.contains("at async step") || is_property(line)
        },
        most: MOST,
    };
    let failing = output.split_once("failing tests:").map(|(_, last)| last);
    match failing {
        Some(failing) => tests.or_errors(failing),
        None => of_others(output),
    }
}

/// A property of the error as Node prints it: the sentence has said it.
fn is_property(line: &str) -> bool {
    [
        "generatedMessage:",
        "code:",
        "actual:",
        "expected:",
        "operator:",
        "diff:",
        "}",
    ]
    .iter()
    .any(|property| line.starts_with(property))
}

/// Tests of vitest.
pub(crate) fn of_vitest(output: &str) -> Vec<String> {
    let tests = Telling {
        begins: |line| line.starts_with("FAIL "),
        ends: |line| line.starts_with("⎯⎯"),
        is_noise: |_| false,
        most: MOST,
    };
    tests.or_errors(output)
}

/// Tests of Python's unittest.
pub(crate) fn of_unittest(output: &str) -> Vec<String> {
    let tests = Telling {
        begins: |line| line.starts_with("FAIL: ") || line.starts_with("ERROR: "),
        ends: |line| line.starts_with("====") || line.starts_with("Ran "),
        is_noise: |line| line.starts_with("----"),
        most: MOST,
    };
    tests.or_errors(output)
}

impl Telling {
    fn or_errors(&self, output: &str) -> Vec<String> {
        let told = self.in_text(output);
        if told.is_empty() {
            of_others(output)
        } else {
            told
        }
    }

    fn in_text(&self, output: &str) -> Vec<String> {
        let mut told = Vec::new();
        let mut left = 0;
        for line in output.lines() {
            let words = line.trim();
            if (self.begins)(words) {
                left = self.most;
                told.push(words.to_owned());
            } else if (self.ends)(words) {
                left = 0;
            } else if left > 0 && !words.is_empty() && !(self.is_noise)(words) {
                left -= 1;
                told.push(format!("    {words}"));
            }
        }
        told
    }
}

/// The text without the escape sequences that colour a terminal.
pub(crate) fn without_colours(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("\u{1b}[") {
        plain.push_str(before);
        rest = after.split_once('m').map_or("", |(_, after)| after);
    }
    plain + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_of_cargo_are_told_by_their_names() {
        let output = "running 2 tests\ntest a::b ... FAILED\n\nfailures:\n\n---- a::b stdout ----\n\nthread 'a::b' panicked at core/src/a.rs:3:5:\nleft is not right\n\
            note: run with `RUST_BACKTRACE=1`\n\n\nfailures:\n    a::b\n\ntest result: FAILED. 1 passed; 1 failed\n";
        let told = [
            "---- a::b stdout ----",
            "    thread 'a::b' panicked at core/src/a.rs:3:5:",
            "    left is not right",
        ];
        assert_eq!(of_cargo(output), told);
    }

    #[test]
    fn what_does_not_compile_is_told_and_else_the_end() {
        let output = "   Compiling a\nerror[E0308]: mismatched types\n --> a.rs:1:1\n\nwarning: build failed\n";
        assert_eq!(
            of_cargo(output),
            ["error[E0308]: mismatched types", "    --> a.rs:1:1"]
        );
        assert_eq!(of_others("one\n\ntwo\n"), ["one", "two"]);
    }

    #[test]
    fn tests_of_node_are_told_without_the_inside_of_its_runner() {
        let output = "✖ the tab (4 ms)\nℹ fail 1\n\n✖ failing tests:\n\ntest at support/browser.mjs:100:11\n✖ the tab (4 ms)\n  AssertionError [ERR_ASSERTION]: no mouse\n  \n      \
            at Stage.readout (file:///stage.mjs:36:5)\n      at async Test.run (node:internal/test_runner/test:797:9) {\n    generatedMessage: false,\n    code: 'ERR_ASSERTION',\n  }\n";
        let told = [
            "✖ the tab (4 ms)",
            "    AssertionError [ERR_ASSERTION]: no mouse",
            "    at Stage.readout (file:///stage.mjs:36:5)",
        ];
        assert_eq!(of_node(output), told);
        assert_eq!(
            of_node("SyntaxError: no comma\n"),
            ["SyntaxError: no comma"]
        );
    }

    #[test]
    fn tests_of_the_page_and_of_python_are_told() {
        let output = "⎯⎯⎯ Failed Tests 1 ⎯⎯⎯\n\n FAIL  tests/a.test.ts > adds\nAssertionError: expected 1 to be 2\n\n⎯⎯⎯⎯[1/1]⎯\n\n Tests  1 failed\n";
        let told = [
            "FAIL  tests/a.test.ts > adds",
            "    AssertionError: expected 1 to be 2",
        ];
        assert_eq!(of_vitest(output), told);
        let output = "test_a (t.T) ... FAIL\n\n======\nFAIL: test_a (t.T)\n------\nTraceback (most recent call last):\nAssertionError: 1 != 2\n\n------\nRan 1 test in 1s\n";
        let told = [
            "FAIL: test_a (t.T)",
            "    Traceback (most recent call last):",
            "    AssertionError: 1 != 2",
        ];
        assert_eq!(of_unittest(output), told);
    }
}
