//! The graph as text, for people who look for what to cut.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::graph::Graph;
use crate::layers::{Layers, module_path};

/// The prefix of the files asked for: empty for the whole graph; none when the graph was not asked for.
pub fn asked_for(graph: &Graph, wanted: &str) -> Option<String> {
    let folder = graph.src.trim_end_matches("src").trim_end_matches('/');
    if wanted == folder || wanted == graph.src {
        return Some(String::new());
    }
    let below = wanted.strip_prefix(&graph.src)?.strip_prefix('/')?;
    let known = graph.files.iter().any(|file| file.starts_with(below));
    known.then(|| below.to_string())
}

/// Every file under a prefix with what it uses, room by room, then the uses that hold files in cycles.
pub fn graph(graph: &Graph, layers: Option<&Layers>, below: &str) -> String {
    let mut rooms: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (file, name) in graph
        .files
        .iter()
        .enumerate()
        .filter(|(_, name)| name.starts_with(below))
    {
        let top_folder = || module_path(name).split('/').next().unwrap_or(name);
        let room = layers.map_or_else(top_folder, |layers| layers.room_of(name));
        rooms.entry(room).or_default().push(file);
    }
    let mut text = format!("{}\n", graph.src);
    for (room, files) in rooms {
        let _ = writeln!(text, "\n  {room}");
        for from in files {
            let _ = writeln!(text, "    {}", graph.files[from]);
            for to in graph.used_by(from) {
                let found = &graph.uses[&(from, to)];
                let _ = writeln!(
                    text,
                    "      -> {}  {} (line {})",
                    graph.files[to], found.name, found.line
                );
            }
        }
    }
    for knot in graph.knots().iter().filter(|knot| {
        knot.iter()
            .any(|file| graph.files[*file].starts_with(below))
    }) {
        let _ = writeln!(
            text,
            "\n  {} files that hang together in cycles",
            knot.len()
        );
        for (from, to) in graph
            .uses
            .keys()
            .filter(|(from, to)| knot.contains(from) && knot.contains(to))
        {
            let _ = writeln!(
                text,
                "    {} of {}",
                graph.tell(*from, *to),
                graph.files[*to]
            );
        }
    }
    text
}
