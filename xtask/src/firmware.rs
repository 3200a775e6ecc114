//! What the firmware proof holds in flash: a library of the built-in femur, implants of both components, outlines of them.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use fluoropose::camera::Camera;
use fluoropose::canonical::CanonicalSpec;
use fluoropose::image::border::follow_border;
use fluoropose::image::contour::{Contour, Point};
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::implant::write_implant;
use fluoropose::library::{Builder, ViewAxis, ViewGrid, ViewScratch};
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::mesh::{Model, OwnedModel};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::render::{Projected, render, scratch_needed};

use fluoropose_phantom::implant::{self, Triangles};

/// Columns and rows of the firmware's frame, pixels.
const FRAME_SIDE: usize = 512;
/// Most vertices of an outline that the firmware has room for.
const MAX_POINTS: usize = 1024;
/// From focus to detector, mm.
const PRINCIPAL_DISTANCE_MM: f64 = 1000.0;
/// Pixel pitch at the detector, mm.
const PITCH_MM: f64 = 0.4;
/// From focus to implant in the library's views, mm.
const LIBRARY_DISTANCE_MM: f64 = 900.0;

/// How finely the implant is made that the firmware holds: some 7000 triangles, as real ones have.
const IMPLANT_RESOLUTION: f64 = 0.7;

/// Between views from all directions, degrees.
const ALL_ROUND_DEG: f64 = 10.0;

/// Rotation about x and y in the middle of the library's views, degrees: as
/// the pose on the frame before would give it.
const NOMINAL_DEG: [f64; 2] = [3.0, -4.0];

/// The pose whose silhouette the outline is: off the axis, nearer than the views, between them.
pub(crate) const TRUTH: EulerPose = EulerPose {
    x_mm: 12.0,
    y_mm: -9.0,
    z_mm: -870.0,
    z_rot_deg: 25.0,
    x_rot_deg: 3.4,
    y_rot_deg: -4.3,
};

/// Writes what the proof may hold into `folder`, unless it is there already with these contents: a library and an outline of the femoral
/// component, implants of both, and one with views from all directions.
pub(crate) fn write_inputs(folder: &Path) -> Result<()> {
    let camera = Camera::from_principal_distance(
        FRAME_SIDE,
        FRAME_SIDE,
        PRINCIPAL_DISTANCE_MM,
        PITCH_MM,
        [0.0; 2],
    )?;
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let write = |name: &str, bytes: &[u8]| write_if_changed(&folder.join(name), bytes);
    let (fine, coarse) = (implant::Parameters::default(), coarse());
    let [femur, tibia] = [implant::femur(&fine)?, implant::tibia(&fine)?];
    let mesh = Model::from_triangles(&femur.vertices, &femur.triangles)?;
    write("femur.library", &library(mesh, camera)?)?;
    write("femur.outline", &outline(&mesh, &camera)?)?;
    let coarser = implant::femur(&coarse)?;
    write("femur.implant", &implant_file(&coarser, camera, window())?)?;
    let all_round = ViewGrid::sphere(ALL_ROUND_DEG);
    write(
        "all_round.implant",
        &implant_file(&coarser, camera, all_round)?,
    )?;
    let mesh = Model::from_triangles(&tibia.vertices, &tibia.triangles)?;
    write("tibia.outline", &outline(&mesh, &camera)?)?;
    let coarser = implant::tibia(&coarse)?;
    write("tibia.implant", &implant_file(&coarser, camera, window())?)
}

/// Parameters of the implants that the firmware holds.
fn coarse() -> implant::Parameters {
    implant::Parameters {
        resolution: IMPLANT_RESOLUTION,
        ..implant::Parameters::default()
    }
}

/// 7 x 9 views, 5 degrees apart: enough for refinement.
fn window() -> ViewGrid {
    let axis = |count: usize| ViewAxis {
        first: -5.0 * (count / 2) as f64,
        step: 5.0,
        count,
    };
    ViewGrid {
        x: axis(7),
        y: axis(9),
    }
}

/// All that refinement needs, with views in a frame of 64 x 64 pixels.
fn implant_file(shape: &Triangles, camera: Camera, grid: ViewGrid) -> Result<Vec<u8>> {
    let numbers = |triples: &[[f32; 3]]| triples.iter().flatten().copied().collect();
    let triangles = shape.triangles.iter().flatten().copied().collect();
    let owned = OwnedModel::new(numbers(&shape.vertices), triangles)?;
    let model = owned.as_model();
    let library = compact(model, camera, CanonicalSpec::COARSE, grid)?;
    let planes = symmetry_planes(model.mesh());
    Ok(write_implant(&model, &library, &planes, 0.0)?)
}

/// A compact library.
fn compact(
    model: Model<'_>,
    camera: Camera,
    canonical: CanonicalSpec,
    grid: ViewGrid,
) -> Result<Vec<u8>> {
    let builder = Builder::new(model, camera, canonical, grid, LIBRARY_DISTANCE_MM)?;
    let mut scratch = ViewScratch {
        projected: &mut vec![Projected::default(); builder.projected_needed()],
        render: &mut vec![0; builder.render_words_needed()],
        canonical: &mut vec![0; canonical.words_needed()],
    };
    let mut packed = Vec::new();
    for view in 0..builder.views() {
        let mut bytes = vec![0; builder.packed_most()];
        let length = builder.pack_view(view, &mut scratch, &mut bytes)?;
        bytes.truncate(length);
        packed.push(bytes);
    }
    let packed: Vec<&[u8]> = packed.iter().map(Vec::as_slice).collect();
    let assembly = builder.assemble(&packed)?;
    let mut bytes = vec![0; assembly.bytes_needed()];
    assembly.write(scratch.canonical, &mut bytes)?;
    Ok(bytes)
}

/// The views of Walker et al. 1996, 31 x 41 of them a degree apart, in a frame of 128 x 128 pixels: what a pose takes that is not
/// refined.
fn library(mesh: Model<'_>, camera: Camera) -> Result<Vec<u8>> {
    let grid = ViewGrid::default();
    let grid = ViewGrid {
        x: grid.x.shifted(NOMINAL_DEG[0]),
        y: grid.y.shifted(NOMINAL_DEG[1]),
    };
    compact(mesh, camera, CanonicalSpec::new(128, 3750)?, grid)
}

/// The silhouette at [`TRUTH`] as a polygon through the middles of its border's sides.
fn outline(mesh: &Model<'_>, camera: &Camera) -> Result<Vec<u8>> {
    let mut words = vec![0; words_needed(FRAME_SIDE, FRAME_SIDE)];
    let mut mask = MaskMut::new(&mut words, FRAME_SIDE, FRAME_SIDE)?;
    let mut scratch = vec![Projected::default(); scratch_needed(mesh)];
    render(mesh, camera, &Pose::from(TRUTH), &mut scratch, &mut mask)?;
    let mut border: Contour<MAX_POINTS> = Contour::new();
    follow_border(&mask.as_mask(), &mut border)?;
    let next = border.iter().cycle().skip(1);
    let middles = border.iter().zip(next).map(|(a, b)| Point {
        column: (a.column + b.column) / 2.0,
        row: (a.row + b.row) / 2.0,
    });
    Ok(middles
        .flat_map(|point| [point.column, point.row])
        .flat_map(f64::to_le_bytes)
        .collect())
}

/// Leaves the file's time alone where nothing changed, so that cargo does not build the firmware again.
fn write_if_changed(file: &Path, bytes: &[u8]) -> Result<()> {
    if fs::read(file).is_ok_and(|found| found == bytes) {
        return Ok(());
    }
    fs::write(file, bytes).with_context(|| format!("cannot write {}", file.display()))
}

/// What the proof found, read back from its lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Proof {
    /// The first pose.
    pub pose: Pose,
}

impl Proof {
    /// Reads the first pose, with every bit, from the lines that the firmware writes.
    ///
    /// Errors when one of its six numbers is missing.
    pub(crate) fn read(lines: &str) -> Result<Self> {
        let number = |name: &str| {
            let value = lines.lines().find_map(|line| bits(line, name));
            value.with_context(|| format!("the proof has no line `{name}`"))
        };
        let euler = EulerPose {
            x_mm: number("x mm")?,
            y_mm: number("y mm")?,
            z_mm: number("z mm")?,
            z_rot_deg: number("z_rot deg")?,
            x_rot_deg: number("x_rot deg")?,
            y_rot_deg: number("y_rot deg")?,
        };
        Ok(Self {
            pose: Pose::from(euler),
        })
    }
}

/// The number in `name: 1.500000 (3ff8000000000000)`, from its bits; none where what people read is not what the language writes of it.
fn bits(line: &str, name: &str) -> Option<f64> {
    let value = line.trim().strip_prefix(name)?.strip_prefix(": ")?;
    let (decimals, hex) = value.strip_suffix(')')?.split_once(" (")?;
    let value = u64::from_str_radix(hex, 16).ok().map(f64::from_bits)?;
    (decimals == format!("{value:.6}")).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_pose_is_read_from_its_bits() {
        let numbers = [
            "x mm",
            "y mm",
            "z mm",
            "z_rot deg",
            "x_rot deg",
            "y_rot deg",
        ];
        let mut lines = String::from("view 5: reversed false\n");
        for (index, name) in numbers.iter().enumerate() {
            // What people read is rounded; the bits count.
            let value = index as f64 + 0.123_456_789;
            lines += &format!("  {name}: {value:.6} ({:016x})\n", value.to_bits());
        }
        lines += "  x mm: 9.000000 (4022000000000000)\n";
        let proof = Proof::read(&lines).unwrap();
        assert_eq!(
            proof.pose.translation,
            [0.123_456_789, 1.123_456_789, 2.123_456_789]
        );
        let misread = lines
            .replace("x mm: 0.1", "x mm: 0.2")
            .replace("9.000000", "9.1");
        assert!(Proof::read(&misread).is_err());
        let missing = lines.replace("z mm", "depth");
        assert!(
            Proof::read(&missing)
                .unwrap_err()
                .to_string()
                .contains("z mm")
        );
    }

    #[test]
    fn the_outline_is_valid_and_fits_the_firmware() {
        let folder = std::env::temp_dir().join(format!("fluoropose-inputs-{}", std::process::id()));
        write_inputs(&folder).unwrap();
        let bytes = fs::read(folder.join("femur.outline")).unwrap();
        let count = bytes.len() / 16;
        assert!(
            (100..=MAX_POINTS).contains(&count) && bytes.len().is_multiple_of(16),
            "{count}"
        );
        let library = fs::read(folder.join("femur.library")).unwrap();
        let library = fluoropose::library::Library::open(&library).unwrap();
        assert_eq!(library.views(), 31 * 41);
        fs::remove_dir_all(folder).unwrap();
    }
}
