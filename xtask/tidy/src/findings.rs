//! What the checks find.

/// What is wrong with the sources.
#[derive(Debug, Default)]
pub struct Findings {
    /// What must not stay.
    pub errors: Vec<String>,
    /// Files and functions that are longer than is good for them.
    pub long: Vec<String>,
}

impl Findings {
    /// Adds what another check found.
    pub fn extend(&mut self, other: Self) {
        self.errors.extend(other.errors);
        self.long.extend(other.long);
    }
}
