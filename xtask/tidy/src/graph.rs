//! Which file of a source folder uses which.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Where a file uses another for the first time, and the name that it takes from there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Use {
    /// The line, counted from 1.
    pub line: usize,
    /// The name as it is written there.
    pub name: String,
}

/// The files of one source folder, and what each takes from another.
#[derive(Debug, Default)]
pub struct Graph {
    /// The source folder below the repository's root, such as `core/src`.
    pub src: String,
    /// Files below the source folder, such as `refine/solve.rs`.
    pub files: Vec<String>,
    /// For each pair (user, used) the first use. A file does not use itself.
    pub uses: BTreeMap<(usize, usize), Use>,
}

impl Graph {
    /// Notes that `from` uses `name`, which `to` defines; the first line of several is kept.
    pub fn note(&mut self, from: usize, to: usize, line: usize, name: &str) {
        if from == to {
            return;
        }
        let found = Use {
            line,
            name: name.to_string(),
        };
        let kept = self.uses.entry((from, to)).or_insert(found);
        if line < kept.line {
            *kept = Use {
                line,
                name: name.to_string(),
            };
        }
    }

    /// The files that `file` uses.
    pub fn used_by(&self, file: usize) -> impl Iterator<Item = usize> + '_ {
        self.uses
            .range((file, 0)..=(file, usize::MAX))
            .map(|((_, to), _)| *to)
    }

    /// A file with the line where it uses `to`: `core/src/refine/solve.rs:7 uses Pass`.
    pub fn tell(&self, from: usize, to: usize) -> String {
        let Use { line, name } = &self.uses[&(from, to)];
        format!("{}/{}:{line} uses {name}", self.src, self.files[from])
    }

    /// Files that use each other, directly or by way of others: each strongly connected component of more than one.
    pub fn knots(&self) -> Vec<Vec<usize>> {
        let mut placed: BTreeSet<usize> = BTreeSet::new();
        let mut knots = Vec::new();
        let reached: Vec<BTreeSet<usize>> =
            (0..self.files.len()).map(|file| self.reach(file)).collect();
        for file in 0..self.files.len() {
            if !reached[file].contains(&file) || placed.contains(&file) {
                continue;
            }
            let both_ways = |other: &usize| reached[*other].contains(&file);
            let knot: Vec<usize> = reached[file].iter().copied().filter(both_ways).collect();
            placed.extend(&knot);
            knots.push(knot);
        }
        knots
    }

    /// Every file that can be reached from `file` in one step or more.
    fn reach(&self, file: usize) -> BTreeSet<usize> {
        let mut reached = BTreeSet::new();
        let mut open: Vec<usize> = self.used_by(file).collect();
        while let Some(next) = open.pop() {
            if reached.insert(next) {
                open.extend(self.used_by(next));
            }
        }
        reached
    }

    /// The shortest cycle through files of a knot; the first of several, in the order of the files.
    pub fn shortest_cycle(&self, knot: &[usize]) -> Vec<usize> {
        knot.iter()
            .filter_map(|file| self.cycle_from(*file))
            .min_by_key(Vec::len)
            .unwrap_or_default()
    }

    fn cycle_from(&self, start: usize) -> Option<Vec<usize>> {
        let mut came_from = BTreeMap::new();
        let mut open = VecDeque::from([start]);
        while let Some(file) = open.pop_front() {
            for next in self.used_by(file) {
                if next == start {
                    return Some(path_back(&came_from, start, file));
                }
                if let std::collections::btree_map::Entry::Vacant(entry) = came_from.entry(next) {
                    entry.insert(file);
                    open.push_back(next);
                }
            }
        }
        None
    }

    /// A cycle as a sentence that names each use on the way.
    pub fn tell_cycle(&self, cycle: &[usize]) -> String {
        let steps = cycle.iter().zip(cycle.iter().cycle().skip(1));
        let mut told: Vec<String> = steps.map(|(from, to)| self.tell(*from, *to)).collect();
        told.push(format!("{}/{}", self.src, self.files[cycle[0]]));
        told.join(" -> ")
    }

    /// One error for each knot: its shortest cycle, and how many files hang in it.
    pub fn cycles(&self) -> Vec<String> {
        let tell = |knot: &Vec<usize>| {
            let cycle = self.tell_cycle(&self.shortest_cycle(knot));
            match knot.len() {
                2 => format!("cycle: {cycle}"),
                files => format!("cycle, the shortest among {files} files: {cycle}"),
            }
        };
        self.knots().iter().map(tell).collect()
    }
}

fn path_back(came_from: &BTreeMap<usize, usize>, start: usize, end: usize) -> Vec<usize> {
    let mut path = vec![end];
    let mut file = end;
    while file != start {
        file = came_from[&file];
        path.push(file);
    }
    path.reverse();
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(files: usize, uses: &[(usize, usize)]) -> Graph {
        let mut graph = Graph {
            src: "a/src".to_string(),
            files: (0..files).map(|file| format!("{file}.rs")).collect(),
            ..Graph::default()
        };
        for (line, (from, to)) in uses.iter().enumerate() {
            graph.note(*from, *to, line + 1, "Thing");
        }
        graph
    }

    #[test]
    fn a_tree_has_no_cycles() {
        assert!(
            graph(4, &[(0, 1), (0, 2), (1, 3), (2, 3)])
                .cycles()
                .is_empty()
        );
    }

    #[test]
    fn each_knot_tells_its_shortest_cycle() {
        let knotted = graph(6, &[(0, 1), (1, 2), (2, 0), (2, 1), (3, 0), (4, 5), (5, 4)]);
        assert_eq!(knotted.knots(), [vec![0, 1, 2], vec![4, 5]]);
        assert_eq!(
            knotted.cycles(),
            [
                "cycle, the shortest among 3 files: \
                 a/src/1.rs:2 uses Thing -> a/src/2.rs:4 uses Thing -> a/src/1.rs",
                "cycle: a/src/4.rs:6 uses Thing -> a/src/5.rs:7 uses Thing -> a/src/4.rs",
            ]
        );
    }

    #[test]
    fn the_first_line_of_several_is_kept() {
        let mut graph = graph(2, &[]);
        graph.note(0, 1, 9, "late");
        graph.note(0, 1, 3, "early");
        graph.note(0, 0, 1, "itself");
        assert_eq!(graph.tell(0, 1), "a/src/0.rs:3 uses early");
        assert_eq!(graph.uses.len(), 1);
    }
}
