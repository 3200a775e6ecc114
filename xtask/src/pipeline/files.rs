//! Reading and writing the files of a study.

use std::fs;
use std::path::{Path, PathBuf};

use crate::implant::Triangles;
use anyhow::{Context, Result, bail};
use fluoropose::camera::calibration::Calibration;
use fluoropose::image::mask::{Mask, MaskError, MaskMut, Word, words_needed};
use fluoropose::image::region::largest_region;
use fluoropose::mesh::edges::{
    EdgeBox, EdgeGroup, Edges, MeshEdge, edges_needed, groups_needed, link,
};
use fluoropose::mesh::{Mesh, Model};
use fluoropose::pose::jts;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose_decode::{decode_mask, decode_model};

/// Reads a whole file.
///
/// # Errors
/// Names the file.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}

/// Reads a text file.
///
/// # Errors
/// Names the file.
pub fn read_text(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
}

/// The name of a file without its folder.
pub fn name_of(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// A model's surface.
#[derive(Clone, Debug)]
pub struct Surface {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Of a closed surface: what its silhouettes are drawn from.
    edges: Option<(Vec<EdgeBox>, Vec<EdgeGroup>)>,
}

impl Surface {
    fn new(vertices: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self> {
        let mesh = Mesh::new(&vertices, &triangles)?;
        let mut room = vec![MeshEdge::default(); edges_needed(&mesh)];
        let mut boxes = vec![EdgeBox::default(); groups_needed(&mesh)];
        let mut groups = vec![EdgeGroup::default(); groups_needed(&mesh)];
        let edges = link(&mesh, &mut room, &mut boxes, &mut groups).map(|edges| edges.parts());
        let edges = edges.map(|(boxes, groups)| (boxes.to_vec(), groups.to_vec()));
        Ok(Self {
            vertices,
            triangles,
            edges,
        })
    }

    /// As the core takes it.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub fn mesh(&self) -> Result<Model<'_>> {
        let mesh = Mesh::new(&self.vertices, &self.triangles)?;
        let edges = self.edges.as_ref();
        let edges = edges.and_then(|(boxes, groups)| Edges::new(boxes, groups));
        Ok(edges.map_or(mesh.into(), |edges| Model::with_edges(mesh, edges)))
    }
}

impl TryFrom<Triangles> for Surface {
    type Error = anyhow::Error;

    fn try_from(made: Triangles) -> Result<Self> {
        Self::new(made.vertices, made.triangles)
    }
}

/// Reads an STL, OBJ or PLY model. What was left out of the file is said on standard error.
///
/// # Errors
/// Names the file and what is wrong with it.
pub fn read_model(path: &Path) -> Result<Surface> {
    let model = decode_model(&read(path)?, &name_of(path))?;
    for note in &model.notes {
        eprintln!("{}: {note}", path.display());
    }
    Surface::new(model.vertices, model.triangles)
}

/// Reads a `JT_INTCALIB` or camera-matrix calibration.
///
/// # Errors
/// Names the file and the line.
pub fn read_calibration(path: &Path) -> Result<Calibration> {
    Calibration::parse(&read_text(path)?).with_context(|| format!("in {}", path.display()))
}

/// Specks are at most this part of the silhouette, percent.
const SPECK_SHARE: u64 = 10;

/// A silhouette with its own memory.
#[derive(Clone, Debug)]
pub struct MaskBuffer {
    words: Vec<Word>,
    width: usize,
    height: usize,
}

impl MaskBuffer {
    /// An empty mask of `width` x `height` pixels.
    ///
    /// # Errors
    /// For a shape that no mask has.
    pub fn new(width: usize, height: usize) -> Result<Self> {
        let mut words = vec![0; words_needed(width, height)];
        MaskMut::new(&mut words, width, height)?;
        Ok(Self {
            words,
            width,
            height,
        })
    }

    /// A copy of a mask.
    pub fn copy_of(mask: &Mask<'_>) -> Self {
        Self {
            words: mask.words().to_vec(),
            width: mask.width(),
            height: mask.height(),
        }
    }

    /// The mask of which each pixel is `rule` of the same pixels of two masks, bit by bit; `rule`
    /// must leave 0 where both are 0.
    ///
    /// # Errors
    /// Where the two differ in size.
    pub fn combined(&self, other: &Self, rule: impl Fn(Word, Word) -> Word) -> Result<Self> {
        if (self.width, self.height) != (other.width, other.height) {
            bail!(MaskError::Sizes);
        }
        let pairs = self.words.iter().zip(&other.words);
        Ok(Self {
            words: pairs.map(|(&a, &b)| rule(a, b)).collect(),
            ..*self
        })
    }

    /// Draws into the cleared mask.
    pub fn draw<T>(&mut self, draw: impl FnOnce(&mut MaskMut<'_>) -> T) -> T {
        let mut mask = MaskMut::new(&mut self.words, self.width, self.height)
            .expect("the shape was checked when the buffer was made");
        draw(&mut mask)
    }

    /// The mask without specks: its largest region alone where all else is at most a tenth of
    /// it, as a network or a threshold leaves it; otherwise unchanged, because a silhouette in
    /// two halves is no matter of specks. Returns the number of pixels dropped.
    ///
    /// # Errors
    /// For a shape that no mask has.
    pub fn drop_specks(&mut self) -> Result<u64> {
        let blank = || Self::new(self.width, self.height);
        let (mut rest, mut current, mut largest) = (blank()?, blank()?, blank()?);
        let dropped = rest.draw(|rest| {
            current.draw(|current| {
                largest.draw(|out| largest_region(&self.mask(), rest, current, out))
            })
        });
        if dropped > SPECK_SHARE * (self.mask().area() - dropped) / 100 {
            return Ok(0);
        }
        *self = largest;
        Ok(dropped)
    }

    /// What has been drawn.
    pub fn mask(&self) -> Mask<'_> {
        Mask::new(&self.words, self.width, self.height)
            .expect("drawing keeps the bits beyond a row's end clear")
    }
}

/// Reads a mask image.
///
/// # Errors
/// Names the file and what is wrong with it.
pub fn read_mask(path: &Path) -> Result<MaskBuffer> {
    let image = decode_mask(&read(path)?, &name_of(path))?;
    let (width, height) = (image.width as usize, image.height as usize);
    let mut buffer = MaskBuffer::new(width, height)?;
    buffer.draw(|mask| {
        for (row, pixels) in image.pixels.chunks_exact(width).enumerate() {
            for (column, &pixel) in pixels.iter().enumerate() {
                mask.set(column, row, pixel != 0);
            }
        }
    });
    Ok(buffer)
}

/// The files of a folder in name order: the order of the frames.
///
/// # Errors
/// When the folder cannot be listed or holds no file.
pub fn files_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries =
        fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<_>>()?;
    files.retain(|path| path.is_file() && !name_of(path).starts_with('.'));
    files.sort();
    if files.is_empty() {
        bail!("{} holds no files", folder.display());
    }
    Ok(files)
}

/// Reads the poses of a `.jts` file, a row a frame; [`known_pose`] tells which are none.
///
/// # Errors
/// Names the file and the line.
pub fn read_poses(path: &Path) -> Result<Vec<EulerPose>> {
    let text = read_text(path)?;
    let poses: Result<Vec<_>, _> = jts::read(&text).and_then(Iterator::collect);
    let poses = poses.with_context(|| format!("in {}", path.display()))?;
    if poses.is_empty() {
        bail!("{} holds no poses", path.display());
    }
    Ok(poses)
}

/// The pose of a row of a `.jts` file: six zeros stand for none.
pub fn known_pose(row: &EulerPose) -> Option<Pose> {
    (*row != EulerPose::default()).then(|| Pose::from(*row))
}

/// Writes poses as `.jts`; the default, six zeros, for a frame without one.
///
/// # Errors
/// Names the file.
pub fn write_poses(path: &Path, poses: &[EulerPose]) -> Result<()> {
    let mut text = String::new();
    jts::write_heading(&mut text)?;
    for pose in poses {
        jts::write_row(&mut text, pose)?;
    }
    write_text(path, &text)
}

/// Writes a text file.
///
/// # Errors
/// Names the file.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}

/// Writes a table as JSON where `--json` asked for it.
///
/// # Errors
/// Names the file.
pub fn write_json(path: Option<&Path>, table: &impl serde::Serialize) -> Result<()> {
    let Some(path) = path else { return Ok(()) };
    let mut text = serde_json::to_string_pretty(table)?;
    text.push('\n');
    write_text(path, &text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn squares(sides: &[usize]) -> MaskBuffer {
        let mut buffer = MaskBuffer::new(200, 100).unwrap();
        buffer.draw(|mask| {
            for (index, &side) in sides.iter().enumerate() {
                for pixel in 0..side * side {
                    mask.set(70 * index + pixel % side, 5 + pixel / side, true);
                }
            }
        });
        buffer
    }

    #[test]
    fn specks_go_and_halves_stay() {
        let mut specked = squares(&[50, 3]);
        assert_eq!(specked.drop_specks().unwrap(), 9);
        assert_eq!(specked.mask().area(), 2500);
        let mut halves = squares(&[50, 40]);
        assert_eq!(halves.drop_specks().unwrap(), 0);
        assert_eq!(halves.mask().area(), 4100);
        let mut empty = squares(&[]);
        assert_eq!(empty.drop_specks().unwrap(), 0);
    }
}
