//! Implants' models, with the libraries of their views.

use std::collections::HashMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Context, Result};
use fluoropose::camera::Camera;
use fluoropose::mesh::OwnedModel;
use fluoropose_laboratory::files::{Role, read_model_and_remarks, shape_doubt};
use fluoropose_laboratory::finding::{Finder, Method, ViewOptions, build_library};
use fluoropose_laboratory::options::Pair;
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::failure::python_error;

/// Which views a library holds, and for which frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Views {
    pub(crate) nominal: Option<[f64; 2]>,
    pub(crate) distance_mm: f64,
}

/// A library and the model that it is of.
pub(crate) struct Owned {
    library: Vec<u8>,
    model: Arc<OwnedModel>,
    camera: Camera,
}

self_cell::self_cell!(
    /// A library, checked, with all that is known of its model: opening it takes longer than finding a pose.
    pub(crate) struct Opened {
        owner: Owned,

        #[covariant]
        dependent: Finder,
    }
);

impl Opened {
    /// Opens a library of a model for frames of a camera.
    pub(crate) fn of(library: Vec<u8>, model: Arc<OwnedModel>, camera: Camera) -> Result<Self> {
        let owner = Owned {
            library,
            model,
            camera,
        };
        Self::try_new(owner, |owner| {
            Finder::open(
                &owner.library,
                owner.model.as_model(),
                owner.camera,
                Method::default(),
            )
        })
    }

    /// What finds poses.
    pub(crate) fn finder(&self) -> &Finder<'_> {
        self.borrow_dependent()
    }
}

/// Libraries by what they were built for.
type Libraries = Arc<Mutex<HashMap<String, Arc<Opened>>>>;

/// A model.
#[pyclass(frozen, module = "fluoropose._native")]
pub(crate) struct Model {
    pub(crate) model: Arc<OwnedModel>,
    remarks: Vec<String>,
    libraries: Libraries,
}

impl Model {
    fn of(model: OwnedModel, remarks: Vec<String>) -> Self {
        Self {
            model: Arc::new(model),
            remarks,
            libraries: Libraries::default(),
        }
    }

    /// Gives the library of some views when it is wanted; it is built once.
    pub(crate) fn library(
        &self,
        camera: Camera,
        views: Views,
    ) -> impl FnOnce() -> Result<Arc<Opened>> + Send + 'static {
        let (model, libraries) = (self.model.clone(), self.libraries.clone());
        let key = format!("{views:?} {camera:?}");
        move || {
            let kept = || libraries.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(found) = kept().get(&key) {
                return Ok(found.clone());
            }
            let options = ViewOptions {
                nominal: views.nominal.map(Pair),
                ..ViewOptions::default()
            };
            let built = build_library(model.as_model(), camera, &options, views.distance_mm)?;
            let opened = Arc::new(Opened::of(built.bytes, model, camera)?);
            kept().insert(key, opened.clone());
            Ok(opened)
        }
    }
}

#[pymethods]
impl Model {
    /// Reads an STL, OBJ or PLY file, mm.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let read = py.detach(|| read_model_and_remarks(&path));
        let (model, remarks) = read.map_err(python_error)?;
        Ok(Self::of(model, remarks))
    }

    /// A model of vertices (mm, n x 3) and triangles (n x 3 vertex numbers). `remarks` is what a file told of it.
    #[new]
    #[pyo3(signature = (vertices, triangles, remarks=None))]
    fn new(
        vertices: PyReadonlyArray2<'_, f32>,
        triangles: PyReadonlyArray2<'_, u32>,
        remarks: Option<Vec<String>>,
    ) -> PyResult<Self> {
        let (vertices, triangles) = (vertices.as_array(), triangles.as_array());
        let model = OwnedModel::new(
            vertices.iter().copied().collect(),
            triangles.iter().copied().collect(),
        );
        let model = model.map_err(python_error)?;
        let remarks = remarks.unwrap_or_else(|| model.remarks());
        Ok(Self::of(model, remarks))
    }

    /// What a copy in another process is made from; it builds libraries of its own.
    #[allow(clippy::type_complexity, reason = "the arguments of `new`")]
    fn __getnewargs__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(
        Bound<'py, PyArray2<f32>>,
        Bound<'py, PyArray2<u32>>,
        Vec<String>,
    )> {
        Ok((self.vertices(py)?, self.triangles(py)?, self.remarks()))
    }

    /// Nothing changes it, and its libraries are kept.
    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// Vertices, mm.
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        rows(py, self.model.as_model().vertices().as_flattened().to_vec())
    }

    /// Vertex numbers of each triangle.
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        rows(
            py,
            self.model.as_model().triangles().as_flattened().to_vec(),
        )
    }

    /// SHA-256 of vertices and triangles, hexadecimal.
    fn digest(&self) -> String {
        self.model
            .as_model()
            .digest()
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    }

    /// What there is to say of the surface, a sentence each.
    fn remarks(&self) -> Vec<String> {
        self.remarks.clone()
    }

    /// What is doubtful of it as the component `femur` or `tibia`.
    fn doubt(&self, role: &str) -> Option<String> {
        shape_doubt(&self.model, Role::of_name(role)?)
    }

    /// Writes it as binary PLY, which keeps every bit.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        write_ply(&self.model, &path).map_err(python_error)
    }
}

fn rows<T: numpy::Element>(py: Python<'_>, numbers: Vec<T>) -> PyResult<Bound<'_, PyArray2<T>>> {
    use numpy::PyArrayMethods;
    let count = numbers.len() / 3;
    numbers.into_pyarray(py).reshape([count, 3])
}

fn write_ply(model: &OwnedModel, path: &Path) -> Result<()> {
    let model = model.as_model();
    let (vertices, triangles) = (model.vertices(), model.triangles());
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\ncomment mm\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        vertices.len(),
        triangles.len()
    )
    .into_bytes();
    vertices
        .iter()
        .flatten()
        .for_each(|number| bytes.extend(number.to_le_bytes()));
    for triangle in triangles {
        bytes.push(3);
        triangle
            .iter()
            .for_each(|corner| bytes.extend(corner.to_le_bytes()));
    }
    let mut file =
        std::fs::File::create(path).with_context(|| format!("cannot write {}", path.display()))?;
    file.write_all(&bytes)
        .with_context(|| format!("cannot write {}", path.display()))
}

/// `femur` or `tibia`.
pub(crate) fn role_of(word: &str) -> PyResult<Role> {
    Role::of_name(word)
        .ok_or_else(|| PyValueError::new_err(format!("role is 'femur' or 'tibia', not '{word}'")))
}
