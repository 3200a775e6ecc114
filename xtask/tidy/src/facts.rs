//! What the checks of single files need to know of one, whatever its language.

use std::collections::BTreeMap;

/// A file of code in numbers and names.
#[derive(Debug, Default)]
pub struct Facts {
    /// How many lines it has.
    pub lines: usize,
    /// Each name in its code with the first line it stands on.
    pub names: BTreeMap<String, usize>,
    /// Its functions.
    pub functions: Vec<Function>,
    /// What switches a test off or stands for code to come, each with its line.
    pub unfinished: Vec<(usize, &'static str)>,
}

/// A function from its first line to its last.
#[derive(Debug, PartialEq, Eq)]
pub struct Function {
    /// Its name, if it has one.
    pub name: String,
    /// The line it starts on.
    pub line: usize,
    /// How many lines it has.
    pub lines: usize,
}

impl Facts {
    /// Notes a name where it stands for the first time.
    pub fn note_name(&mut self, name: &str, line: usize) {
        if !self.names.contains_key(name) {
            self.names.insert(name.to_string(), line);
        }
    }

    /// Notes a function from its first line to its last.
    pub fn note_function(&mut self, name: &str, first: usize, last: usize) {
        let name = name.to_string();
        let lines = last + 1 - first;
        self.functions.push(Function {
            name,
            line: first,
            lines,
        });
    }
}
