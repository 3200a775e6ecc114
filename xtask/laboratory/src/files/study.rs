//! Studies: `study.toml` and the files that it names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use serde::Deserialize;

use fluoropose::film::{DisplayKind, FilmConstants, GivenFilm};
use fluoropose_phantom::implant::Side;

use super::name::check_file_name;
use super::role::Role;
use super::text::read_text;

/// A sequence of frames with one or more components.
#[derive(Debug, Deserialize)]
pub struct Study {
    /// What the study is called.
    pub name: String,
    /// Which knee.
    pub side: Option<Side>,
    /// Calibration of the frames, of either kind.
    pub calibration: PathBuf,
    /// Folder of frames; their names' order is their order in time.
    pub frames: Option<PathBuf>,
    /// Frames a second, where they are known.
    pub frames_per_s: Option<f64>,
    /// What a person states of the film; with its constants the components state their attenuation.
    pub film: Option<StatedFilm>,
    /// The components.
    #[serde(rename = "component", default)]
    pub components: Vec<Component>,
    #[serde(flatten)]
    others: BTreeMap<String, toml::Value>,
}

/// What a person states of a film. With curvature and blur all is stated, and nothing is estimated; otherwise what is left out is.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StatedFilm {
    /// Curvature of the display, one divided by grey values: 0 is linear, 1 / g logarithmic with g grey values for each factor
    /// of e.
    pub curvature: Option<f64>,
    /// Standard deviation of the blur, pixels.
    pub blur_px: Option<f64>,
    /// How intensities are shown, where the curvature itself is estimated.
    pub display: Option<StatedDisplay>,
}

/// How a display shows intensities, in a person's word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct StatedDisplay(DisplayKind);

impl TryFrom<String> for StatedDisplay {
    type Error = String;

    fn try_from(word: String) -> Result<Self, String> {
        let kind = DisplayKind::of_word(&word);
        let unknown = || format!("a display is linear, between or logarithmic, not '{word}'");
        kind.map(Self).ok_or_else(unknown)
    }
}

impl StatedFilm {
    /// The constants, where all are stated.
    pub fn constants(&self) -> Option<FilmConstants> {
        let (curvature, blur_px) = self.curvature.zip(self.blur_px)?;
        Some(FilmConstants { curvature, blur_px })
    }

    /// What is taken as stated while the rest is estimated.
    pub fn given(&self) -> GivenFilm {
        GivenFilm {
            display: self.display.map(|StatedDisplay(kind)| kind),
            blur_px: self.blur_px,
        }
    }

    fn check(&self) -> Result<()> {
        if self.curvature.is_some() && (self.display.is_some() || self.blur_px.is_none()) {
            bail!("[film]: curvature is stated with blur_px, and without display, which it tells");
        }
        let possible =
            |number: Option<f64>, least: f64| number.is_none_or(|x| x >= least && x.is_finite());
        if !possible(self.curvature, 0.0) || !possible(self.blur_px, f64::MIN_POSITIVE) {
            bail!("[film]: curvature is 0 or more and blur_px above 0");
        }
        Ok(())
    }
}

/// One implanted component of a study.
#[derive(Debug, Deserialize)]
pub struct Component {
    /// What it is called.
    pub name: String,
    /// Its model, mm.
    pub model: PathBuf,
    /// Which component of the knee it is, where its name does not say so.
    pub role: Option<Role>,
    /// Reference poses (.jts), a row a frame.
    pub reference: Option<PathBuf>,
    /// Which of the file's axes point anteriorly, superiorly and to the patient's right, as in "x y z", where its shape does
    /// not tell it rightly.
    pub axes: Option<String>,
    /// Rotations about x and y of the nominal view, degrees.
    #[serde(default)]
    pub nominal: Option<[f64; 2]>,
    /// Distance from the focus, mm, where it is known.
    pub distance_mm: Option<f64>,
    /// Attenuation of its metal, per mm, where the film is stated.
    pub attenuation: Option<f64>,
    /// Folders of masks by source; a row of the table each.
    #[serde(default)]
    pub masks: BTreeMap<String, PathBuf>,
    /// Folders of masks of unknown pixels, by the source whose masks they belong to.
    #[serde(default)]
    pub unknown: BTreeMap<String, PathBuf>,
    /// Pose files of other methods, rows of the same table.
    #[serde(default)]
    pub peer: BTreeMap<String, PathBuf>,
    #[serde(flatten)]
    others: BTreeMap<String, toml::Value>,
}

impl Component {
    /// Which component of the knee it is: by the key `role`, or by the names femur and tibia.
    pub fn role(&self) -> Option<Role> {
        self.role.or_else(|| Role::of_name(&self.name))
    }
}

impl Study {
    /// Reads a study and resolves the paths in it against its folder.
    ///
    /// # Errors
    /// Names the file and the key at fault.
    pub fn read(path: &Path) -> Result<Self> {
        let mut study: Self =
            toml::from_str(&read_text(path)?).with_context(|| format!("in {}", path.display()))?;
        let film = study.film.map_or(Ok(()), |film| film.check());
        film.with_context(|| format!("in {}", path.display()))?;
        let of_components = study.components.iter().flat_map(|c| c.others.keys());
        for key in study.others.keys().chain(of_components) {
            // A misspelt key must not pass unseen; a later format's key must not stop the rest.
            eprintln!(
                "{}: the key '{key}' is not known and left out",
                path.display()
            );
        }
        for component in &study.components {
            let sources = component.masks.keys().chain(component.peer.keys());
            for word in sources.chain([&component.name]) {
                check_file_name(word).with_context(|| format!("in {}", path.display()))?;
            }
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let resolve = |path: &mut PathBuf| *path = folder.join(&*path);
        resolve(&mut study.calibration);
        study.frames.as_mut().map(resolve);
        for component in &mut study.components {
            resolve(&mut component.model);
            component.reference.as_mut().map(resolve);
            component.masks.values_mut().for_each(resolve);
            component.unknown.values_mut().for_each(resolve);
            for source in component.unknown.keys() {
                if !component.masks.contains_key(source) {
                    bail!(
                        "{}: the component {} has unknown.{source} but no masks.{source}",
                        path.display(),
                        component.name
                    );
                }
            }
            component.peer.values_mut().for_each(resolve);
        }
        Ok(study)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Study> {
        let name = format!(
            "fluoropose-study-{}-{}.toml",
            std::process::id(),
            text.len()
        );
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, text).unwrap();
        let study = Study::read(&path);
        std::fs::remove_file(&path).unwrap();
        study
    }

    #[test]
    fn unknown_pixels_belong_to_a_source_of_masks() {
        let component = "name = 'left'\ncalibration = 'c.txt'\n[[component]]\nname = 'femur'\nmodel = 'f.stl'\n";
        let study = read(&format!(
            "{component}masks.hand = 'm'\nunknown.hand = 'u'\n"
        ));
        let unknown = &study.unwrap().components[0].unknown["hand"];
        assert_eq!(unknown, &std::env::temp_dir().join("u"));
        let stray = read(&format!(
            "{component}masks.hand = 'm'\nunknown.foot = 'u'\n"
        ));
        let message = stray.unwrap_err().to_string();
        assert!(message.contains("unknown.foot"), "{message}");
    }

    #[test]
    fn a_film_is_stated_in_whole_or_in_part() {
        let film = |keys: &str| {
            let study = read(&format!(
                "name = 'left'\ncalibration = 'c.txt'\n[film]\n{keys}\n"
            ))?;
            Ok::<_, anyhow::Error>(study.film.expect("it is there"))
        };
        let whole = film("curvature = 0.025\nblur_px = 0.8").unwrap();
        let constants = whole.constants().expect("all of them");
        assert_eq!((constants.curvature, constants.blur_px), (0.025, 0.8));
        let part = film("display = 'logarithmic'").unwrap();
        assert_eq!(part.constants(), None);
        assert_eq!(part.given().display, Some(DisplayKind::Logarithmic));
        assert_eq!(film("blur_px = 1.3").unwrap().given().blur_px, Some(1.3));
        for wrong in [
            "curvature = 0.025",
            "curvature = 0.025\nblur_px = 0.8\ndisplay = 'linear'",
            "blur_px = 0.0",
            "curvature = -1.0\nblur_px = 0.8",
            "display = 'bent'",
            "colour = 1",
        ] {
            assert!(film(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn names_that_lead_elsewhere_are_refused() {
        let head = "name = 'left'\ncalibration = 'c.txt'\n[[component]]\nmodel = 'f.stl'\n";
        for hostile in [
            "name = '../femur'",
            "name = '/tmp/femur'",
            "name = 'NUL'",
            "name = 'femur'\nmasks.'../m' = 'm'",
            "name = 'femur'\npeer.'a/b' = 'p.jts'",
        ] {
            let error = read(&format!("{head}{hostile}\n")).unwrap_err();
            assert!(
                format!("{error:#}").contains("is no name for a file"),
                "{error:#}"
            );
        }
    }

    #[test]
    fn a_role_is_told_or_follows_from_the_name() {
        let study = read(
            "name = 'left'\ncalibration = 'c.txt'\n\
             [[component]]\nname = 'Femur'\nmodel = 'f.stl'\n\
             [[component]]\nname = 'tray'\nrole = 'tibia'\nmodel = 't.stl'\n\
             [[component]]\nname = 'patella'\nmodel = 'p.stl'\n",
        );
        let components = study.unwrap().components;
        let roles: Vec<Option<Role>> = components.iter().map(Component::role).collect();
        assert_eq!(roles, [Some(Role::Femur), Some(Role::Tibia), None]);
    }
}
