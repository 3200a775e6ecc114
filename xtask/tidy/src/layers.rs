//! Rooms, and the order in which they may use one another.
//!
//! `layers.txt` beside a source folder names its rooms, the lowest first: folders or files below the source
//! folder, without ending. Several on one line are of one layer and may not use one another. `#` starts a comment.
//! The crate's root (`lib`, `main`, programs in `bin`) stands above all rooms.

use anyhow::{Result, ensure};

use crate::graph::Graph;

/// The rooms of a source folder, each with its layer, 0 being the lowest.
#[derive(Debug)]
pub struct Layers {
    rooms: Vec<(String, usize)>,
}

/// Where a file stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Room(usize),
    Top,
    Nowhere,
}

impl Layers {
    /// Reads a `layers.txt`.
    ///
    /// Errors when a room is named twice.
    pub fn parse(text: &str) -> Result<Self> {
        let mut rooms: Vec<(String, usize)> = Vec::new();
        for (layer, line) in text.lines().enumerate() {
            let named = line.split('#').next().unwrap_or_default();
            for room in named.split_whitespace() {
                let twice = rooms.iter().any(|(other, _)| other == room);
                ensure!(!twice, "line {}: `{room}` is named twice", layer + 1);
                rooms.push((room.to_string(), layer));
            }
        }
        Ok(Self { rooms })
    }

    /// The room of a file by the longest prefix, or a word for where it stands instead.
    pub fn room_of(&self, file: &str) -> &str {
        match self.place(file) {
            Place::Room(room) => &self.rooms[room].0,
            Place::Top => "top",
            Place::Nowhere => "no room",
        }
    }

    fn place(&self, file: &str) -> Place {
        let path = module_path(file);
        if matches!(path, "lib" | "main") || path.starts_with("bin/") {
            return Place::Top;
        }
        let holds = |room: &str| {
            path.strip_prefix(room)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        let inside = self
            .rooms
            .iter()
            .enumerate()
            .filter(|(_, (room, _))| holds(room));
        inside
            .max_by_key(|(_, (room, _))| room.len())
            .map_or(Place::Nowhere, |(room, _)| Place::Room(room))
    }

    /// Uses of a room above or beside, files in no room, and rooms without a file.
    pub fn errors(&self, graph: &Graph) -> Vec<String> {
        let places: Vec<Place> = graph.files.iter().map(|file| self.place(file)).collect();
        let mut errors = Vec::new();
        for (file, place) in graph.files.iter().zip(&places) {
            if *place == Place::Nowhere {
                errors.push(format!("{}/{file} is in no room of layers.txt", graph.src));
            }
        }
        for (room, (name, _)) in self.rooms.iter().enumerate() {
            if !places.contains(&Place::Room(room)) {
                errors.push(format!(
                    "{}: room `{name}` of layers.txt holds no file",
                    graph.src
                ));
            }
        }
        for (from, to) in graph.uses.keys() {
            if let Some(fault) = self.fault(places[*from], places[*to]) {
                let told = graph.tell(*from, *to);
                errors.push(format!(
                    "{told} of {}/{}: {fault}",
                    graph.src, graph.files[*to]
                ));
            }
        }
        errors
    }

    /// What is wrong with a use, if anything is.
    fn fault(&self, from: Place, to: Place) -> Option<String> {
        let Place::Room(from) = from else {
            return None;
        };
        let (user, own_layer) = &self.rooms[from];
        match to {
            Place::Nowhere => None,
            Place::Top => Some(format!("room `{user}` is below the crate's root")),
            Place::Room(to) if to == from => None,
            Place::Room(to) => {
                let (used, layer) = &self.rooms[to];
                let how = match layer.cmp(own_layer) {
                    std::cmp::Ordering::Less => return None,
                    std::cmp::Ordering::Equal => "beside",
                    std::cmp::Ordering::Greater => "below",
                };
                Some(format!("room `{user}` is {how} room `{used}`"))
            }
        }
    }
}

/// A file's path as a module: without its ending, and for a folder's own file that of the folder.
pub fn module_path(file: &str) -> &str {
    let path = file.rsplit_once('.').map_or(file, |(path, _)| path);
    path.strip_suffix("/mod")
        .or_else(|| path.strip_suffix("/index"))
        .unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILES: [&str; 5] = [
        "lib.rs",
        "math.rs",
        "image/mod.rs",
        "image/mask.rs",
        "search/query.rs",
    ];

    fn graph(uses: &[(usize, usize)]) -> Graph {
        let mut graph = Graph {
            src: "a/src".to_string(),
            files: FILES.map(String::from).to_vec(),
            ..Graph::default()
        };
        for (from, to) in uses {
            graph.note(*from, *to, 1, "Thing");
        }
        graph
    }

    fn errors(layers: &str, uses: &[(usize, usize)]) -> Vec<String> {
        Layers::parse(layers).unwrap().errors(&graph(uses))
    }

    #[test]
    fn uses_of_rooms_below_and_of_the_own_room_are_fine() {
        let uses = [(0, 3), (0, 1), (3, 1), (2, 3), (4, 3), (4, 1)];
        assert!(errors("math # below all\n\nimage\nsearch", &uses).is_empty());
    }

    #[test]
    fn a_use_of_a_room_above_or_beside_is_an_error() {
        let up = errors("math\nimage\nsearch", &[(3, 4)]);
        assert_eq!(
            up,
            [
                "a/src/image/mask.rs:1 uses Thing of a/src/search/query.rs: room `image` is below room `search`"
            ]
        );
        let beside = errors("math\nimage search", &[(3, 4)]);
        assert!(beside[0].ends_with("room `image` is beside room `search`"));
        let root = errors("math\nimage search", &[(1, 0)]);
        assert!(root[0].ends_with("room `math` is below the crate's root"));
    }

    #[test]
    fn a_file_in_no_room_and_an_empty_room_are_errors() {
        assert_eq!(
            errors("math image", &[]),
            ["a/src/search/query.rs is in no room of layers.txt"]
        );
        assert_eq!(
            errors("math\nimage search\nimages", &[]),
            ["a/src: room `images` of layers.txt holds no file"]
        );
        assert!(Layers::parse("math\nmath").is_err());
    }

    #[test]
    fn the_longest_prefix_says_the_room() {
        let layers = Layers::parse("image\nimage/mask").unwrap();
        assert_eq!(layers.room_of("image/mask.rs"), "image/mask");
        assert_eq!(layers.room_of("image/mod.rs"), "image");
        assert_eq!(layers.room_of("images.rs"), "no room");
        assert_eq!(layers.room_of("main.rs"), "top");
    }
}
