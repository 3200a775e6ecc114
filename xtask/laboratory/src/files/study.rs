//! Studies: `study.toml` and the files that it names.

mod absent;
mod keys;
mod sizes;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use serde::Deserialize;

use fluoropose::film::{DisplayKind, FilmConstants, GivenFilm, MOST_BLUR_PX};
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::suspected_unit;
use fluoropose_phantom::implant::Side;

use super::name::check_file_name;
use absent::why_absent;
use keys::Checked;

use super::model::{Unit, read_model_in};
use super::role::Role;
use super::stated_axes::axes_doubt;
use super::stated_geometry::stated_by;
use super::text::read_text;

/// So many letters in which a name differs may be slips.
const NEARLY: usize = 2;

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
    /// The study file.
    #[serde(skip)]
    file: PathBuf,
    /// Lines of its keys.
    #[serde(skip)]
    lines: BTreeMap<String, usize>,
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
        Some(FilmConstants::plain(curvature, blur_px))
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
        let possible = |number: Option<f64>, [least, most]: [f64; 2]| {
            number.is_none_or(|number| (least..=most).contains(&number))
        };
        if !possible(self.curvature, [0.0, 1.0])
            || !possible(self.blur_px, [f64::MIN_POSITIVE, MOST_BLUR_PX])
        {
            bail!(
                "[film]: curvature is 0 to 1, and blur_px above 0 and at most {MOST_BLUR_PX}: of a film that is blurred more, frames in larger pixels tell as much"
            );
        }
        Ok(())
    }
}

/// One implanted component of a study.
#[derive(Debug, Deserialize)]
pub struct Component {
    /// What it is called.
    pub name: String,
    /// The file of its model.
    pub model: PathBuf,
    /// The unit of length of that file, where it is stated: millimetres otherwise, which a size may speak against.
    pub unit: Option<Unit>,
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
}

impl Component {
    /// Which component of the knee it is: by the key `role`, or by the names femur and tibia.
    pub fn role(&self) -> Option<Role> {
        self.role.or_else(|| Role::of_name(&self.name))
    }

    /// The unit of length of its model's file.
    pub fn unit(&self) -> Unit {
        self.unit.unwrap_or_default()
    }

    /// Its name, its model's file and that file's unit: for what goes wrong with its lengths.
    pub fn words(&self) -> String {
        let (name, file, unit) = (&self.name, self.model.display(), self.unit().word());
        format!(
            "the component {name}, {file}, read with unit = \"{unit}\" (under its [[component]] in the study)"
        )
    }

    /// Its model in millimetres. What there is to say of the file is said on standard error.
    ///
    /// # Errors
    /// Names the file and what is wrong with it; a size that speaks for another unit is, where none is stated: no pose would be good.
    pub fn read_model(&self) -> Result<OwnedModel> {
        let (owned, remarks) = self.read_model_and_remarks()?;
        for remark in remarks {
            eprintln!("{}: {remark}", self.model.display());
        }
        Ok(owned)
    }

    /// The same with what there is to say, a sentence each.
    ///
    /// # Errors
    /// Those of [`Self::read_model`].
    pub fn read_model_and_remarks(&self) -> Result<(OwnedModel, Vec<String>)> {
        let (owned, mut remarks) = read_model_in(&self.model, self.unit(), self.role())?;
        let bounds = owned.as_model().bounds();
        match suspected_unit(&bounds) {
            Some(suspected) if self.unit.is_none() => {
                let words = Unit::of(suspected).into_iter();
                let words: Vec<_> = words.map(|unit| format!("unit = \"{unit}\"")).collect();
                bail!(
                    "{}: the model would be {:.3} mm across, which is no knee component's size: state {} under its [[component]] in the study, or unit = \"mm\" where it is so small",
                    self.model.display(),
                    2.0 * bounds.radius,
                    words.join(" or ")
                )
            }
            _ => {
                let stated = self.role().zip(self.axes.as_deref());
                remarks.extend(stated.and_then(|(role, words)| axes_doubt(&owned, role, words)));
                Ok((owned, remarks))
            }
        }
    }
}

impl Study {
    /// Reads a study and resolves the paths in it against its folder. What there is to say of its keys is said on standard error.
    ///
    /// # Errors
    /// Names the file, the line, the key at fault and what was expected.
    pub fn read(path: &Path) -> Result<Self> {
        let (study, remarks) = Self::with_remarks(path)?;
        for remark in remarks {
            eprintln!("in {}: {remark}", path.display());
        }
        Ok(study)
    }

    /// The same where what there is to say of its keys is said elsewhere.
    ///
    /// # Errors
    /// Those of [`Study::read`].
    pub fn read_quietly(path: &Path) -> Result<Self> {
        Ok(Self::with_remarks(path)?.0)
    }

    /// The same with what there is to say of its keys, a sentence each.
    ///
    /// # Errors
    /// Those of [`Study::read`].
    pub fn with_remarks(path: &Path) -> Result<(Self, Vec<String>)> {
        Self::of(&read_text(path)?, path).with_context(|| format!("in {}", path.display()))
    }

    fn of(text: &str, path: &Path) -> Result<(Self, Vec<String>)> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let checked = Checked::of(text).map_err(|error| {
            let frames = keys::frames_without_calibration(text, &error);
            match frames.and_then(|frames| stated_by(&found_in(folder, &frames))) {
                Some(stated) => anyhow!("{error}: {stated}"),
                None => error,
            }
        })?;
        let mut study: Self = toml::from_str(text)?;
        study.lines = checked.lines;
        study.file = path.to_owned();
        study.film.map_or(Ok(()), |film| film.check())?;
        study.check_names()?;
        let mut remarks = checked.remarks;
        remarks.extend(study.without_role());
        remarks.extend(study.half_stated());
        remarks.extend(study.of_one_role());
        study.resolve(folder)?;
        Ok((study, remarks))
    }

    /// The folder of the frames.
    ///
    /// # Errors
    /// Where the study names none.
    pub fn frames_folder(&self) -> Result<&Path> {
        self.frames.as_deref().with_context(|| self.lacks("frames"))
    }

    /// Which knee it is.
    ///
    /// # Errors
    /// Where the study does not say.
    pub fn known_side(&self) -> Result<Side> {
        self.side.with_context(|| self.lacks("side"))
    }

    /// Whether it has both components of a knee.
    pub fn is_knee(&self) -> bool {
        let has = |role| self.components.iter().any(|one| one.role() == Some(role));
        has(Role::Femur) && has(Role::Tibia)
    }

    /// That a key is missing, in words.
    pub fn lacks(&self, key: &str) -> String {
        format!("in {}: {}", self.file.display(), keys::missing(key))
    }

    /// Whether what all work on a study needs is there: calibration and models, and what else was asked for.
    ///
    /// # Errors
    /// Names the first file that is not there, with the key and its line.
    pub fn check_files(&self, frames: Option<&Path>) -> Result<()> {
        let models = self.components.iter().enumerate();
        let models = models.map(|(number, one)| (format!("component.{number}.model"), &*one.model));
        let calibration = ("calibration".to_owned(), &*self.calibration);
        let frames = frames.map(|folder| ("frames".to_owned(), folder));
        for (key, path) in [calibration].into_iter().chain(models).chain(frames) {
            if !path.exists() {
                let name = key.rsplit('.').next().unwrap_or(&key);
                bail!(
                    "in {}: {}{name}: there is no {}{}",
                    self.file.display(),
                    self.line(&key),
                    path.display(),
                    why_absent(path)
                );
            }
        }
        Ok(())
    }

    /// `line N: ` of a key.
    fn line(&self, key: &str) -> String {
        let line = self.lines.get(key);
        line.map_or(String::new(), |line| format!("line {line}: "))
    }

    /// Components that are perhaps meant for one of a knee, but are called otherwise: a sentence each, without its full stop.
    fn without_role(&self) -> Vec<String> {
        let others = self.components.iter().enumerate();
        let others = others.filter(|(_, one)| one.role().is_none());
        let remark = |(number, one): (usize, &Component)| {
            let name = one.name.to_lowercase();
            let meant = ["femur", "tibia"].into_iter().find(|role| {
                name.starts_with(&role[..3]) || keys::distance(&name, role) <= NEARLY
            })?;
            let line = self.line(&format!("component.{number}"));
            Some(format!(
                "{line}the component {:?} is neither femur nor tibia by its name, and in no joint: if it is meant, state role = {meant:?}",
                one.name
            ))
        };
        others.filter_map(remark).collect()
    }

    /// Components beside another of the same role: a sentence each, without its full stop.
    fn of_one_role(&self) -> Vec<String> {
        let remark = |(number, one): (usize, &Component)| {
            let role = one.role()?;
            let before = &self.components[..number];
            let first = before.iter().position(|other| other.role() == Some(role))?;
            let line = |number: usize| self.line(&format!("component.{number}"));
            Some(format!(
                "{}the component {:?} is a second {}, beside {:?} ({}): joint numbers are those of the first alone, and two of one model are found in one place",
                line(number),
                one.name,
                match role {
                    Role::Femur => "femur",
                    Role::Tibia => "tibia",
                },
                before[first].name,
                line(first).trim_end_matches(": "),
            ))
        };
        let all = self.components.iter().enumerate();
        all.filter_map(remark).collect()
    }

    /// The component of a name.
    ///
    /// # Errors
    /// Names those that there are.
    pub fn component(&self, name: &str) -> Result<&Component> {
        let found = self.components.iter().find(|one| one.name == name);
        found.with_context(|| {
            let names = self.components.iter().map(|one| one.name.as_str());
            let names: Vec<&str> = names.collect();
            format!(
                "the study has no component {name}: it has {}",
                names.join(", ")
            )
        })
    }

    /// Components whose attenuation does not go with what is stated of the film: a sentence each, without its full stop.
    fn half_stated(&self) -> Vec<String> {
        let is_whole = self.film.is_some_and(|film| film.constants().is_some());
        let others = self.components.iter().enumerate();
        let others = others.filter(|(_, one)| one.attenuation.is_some() != is_whole);
        let remark = |(number, one): (usize, &Component)| {
            let line = self.line(&format!("component.{number}"));
            let told = match is_whole {
                true => {
                    "states no attenuation, as in attenuation = 0.7, which goes with [film] curvature and blur_px: what the film shows of it is not known, and its depth is off by millimetres"
                }
                false => {
                    "states an attenuation, which is left out: it goes with [film] curvature and blur_px, without which all of it is estimated"
                }
            };
            format!("{line}component {}: {told}", one.name)
        };
        others.map(remark).collect()
    }

    /// Names become names of files, and tell components apart.
    fn check_names(&self) -> Result<()> {
        for (number, component) in self.components.iter().enumerate() {
            let line = |number: usize| self.line(&format!("component.{number}"));
            let sources = component.masks.keys().chain(component.peer.keys());
            for word in sources.chain([&component.name]) {
                check_file_name(word).with_context(|| format!("{}component", line(number)))?;
            }
            let same =
                |other: &Component| other.name.to_lowercase() == component.name.to_lowercase();
            if let Some(first) = self.components[..number].iter().position(same) {
                bail!(
                    "{}there is another component {:?} ({}{:?}): give each a name of its own, which its files bear",
                    line(number),
                    component.name,
                    line(first),
                    self.components[first].name
                );
            }
        }
        Ok(())
    }

    fn resolve(&mut self, folder: &Path) -> Result<()> {
        let resolve = |path: &mut PathBuf| *path = found_in(folder, path);
        resolve(&mut self.calibration);
        self.frames.as_mut().map(resolve);
        for component in &mut self.components {
            resolve(&mut component.model);
            component.reference.as_mut().map(resolve);
            component.masks.values_mut().for_each(resolve);
            component.unknown.values_mut().for_each(resolve);
            component.peer.values_mut().for_each(resolve);
            let stray = component.unknown.keys();
            let stray = stray.filter(|source| !component.masks.contains_key(*source));
            if let Some(source) = stray.into_iter().next() {
                bail!(
                    "the component {} has unknown.{source} but no masks.{source}",
                    component.name
                );
            }
        }
        Ok(())
    }
}

/// Where a path of a study leads: against its folder. One that was written with backslashes on another system leads there too, as in the page.
fn found_in(folder: &Path, written: &Path) -> PathBuf {
    let path = folder.join(written);
    match written.to_str().filter(|text| text.contains('\\')) {
        Some(text) if !path.exists() => folder.join(text.replace('\\', "/")),
        _ => path,
    }
}

#[cfg(test)]
mod tests;
