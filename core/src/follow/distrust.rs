//! Why a pose of a film is to be looked at, in one word and in a sentence.

use core::fmt;

use super::sides::Rival;
use crate::finder::Doubt;
use crate::joint::beside::Beside;
use crate::joint::impossible::Impossible;
use crate::mesh::anatomy::KneeComponent;

/// Why a pose is to be looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distrust {
    /// Another pose is as likely.
    Side(Rival),
    /// The ways from both ends lead to different poses: degrees.
    Ways(f64),
    /// It lies off the way between the frames on both sides: degrees, mm.
    Jump(f64, f64),
    /// The frames beside it, one at the end of a film, may be another pose's themselves, so that it says little that they agree.
    Beside,
    /// Of so many poses of the film only so few stand by themselves: what is wrong with the others may be in all.
    Few {
        /// Those that do.
        good: usize,
        /// All.
        poses: usize,
    },
    /// The edges are fainter than elsewhere in the film: part of the usual strength.
    Faint(f64),
    /// The edges lie farther off than elsewhere: pixels, and in the film's better frames.
    Apart(f64, f64),
    /// Only this part of the outline is met by edges.
    Unmet(f64),
    /// Only this part of the outline is in the frame.
    Cut(f64),
    /// The outline does not determine the pose: standard deviation of the rotation, degrees.
    Undetermined(f64),
    /// Both components cannot lie so far apart along the view: mm against what is usual in the film.
    Depths(f64),
    /// The same against what a joint allows.
    Joint(f64),
    /// It lies so far behind the detector, mm.
    Behind(f64),
    /// The model is so wide, mm, as no component of a knee is.
    ImplausibleSize(f64),
    /// The model has the shape of this component, which is the other one.
    Shape(KneeComponent),
    /// Its joint with the femur would do this, which no knee does.
    Knee(Impossible),
    /// The other component lies beside it as in no knee: the picture may be mirrored.
    Mirrored(Beside),
}

impl Distrust {
    /// The word for it in tables.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Side(_) => "ambiguous",
            Self::Ways(_) => "two ways",
            Self::Jump(..) => "jump",
            Self::Beside => "neighbours",
            Self::Few { .. } => "few",
            Self::Faint(_) => "faint",
            Self::Apart(..) | Self::Unmet(_) => "residual",
            Self::Cut(_) => "cut off",
            Self::Undetermined(_) => "undetermined",
            Self::Depths(_) | Self::Joint(_) | Self::Behind(_) => "depths",
            Self::Shape(_) => "shape",
            Self::ImplausibleSize(_) => "unit",
            Self::Knee(_) | Self::Mirrored(_) => "joint",
        }
    }

    /// Whether the doubt is that another pose may be the right one.
    #[cfg(any(feature = "alloc", test))]
    pub(super) fn is_of_another_pose(&self) -> bool {
        matches!(
            self,
            Self::Side(_) | Self::Ways(_) | Self::Jump(..) | Self::Beside
        )
    }
}

impl fmt::Display for Distrust {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Side(Rival::Mirrored) => f.write_str("its mirror image fits as well"),
            Self::Side(Rival::Elsewhere) => f.write_str(
                "another pose some degrees away, which is not its mirror image, fits as well",
            ),
            Self::Ways(deg) => write!(
                f,
                "the ways from both ends of the film come to poses {deg:.1} degrees apart"
            ),
            Self::Jump(deg, mm) => write!(
                f,
                "it lies {deg:.1} degrees and {mm:.1} mm off the way between the frames beside it"
            ),
            Self::Beside => f.write_str(
                "the frames next to it are doubtful too, so that their agreement proves little",
            ),
            Self::Few { good, poses } => write!(
                f,
                "only {good} of the film's {poses} poses of this component stand by themselves, and what is wrong with the others may be in all of them"
            ),
            Self::Faint(part) => {
                let percent = 100.0 * part;
                write!(
                    f,
                    "its edges have {percent:.0} % of the strength that is usual in this film"
                )
            }
            Self::Apart(px, usual_px) => write!(
                f,
                "the edges lie {px:.2} px off the outline, {usual_px:.2} px in the better frames of this film"
            ),
            Self::Unmet(part) => {
                let percent = 100.0 * part;
                write!(f, "only {percent:.0} % of the outline is met by edges")
            }
            Self::Cut(part) => {
                let percent = 100.0 * part;
                write!(
                    f,
                    "only {percent:.0} % of the outline is in the frame and not hidden"
                )
            }
            Self::Undetermined(deg) => write!(
                f,
                "the outline leaves {deg:.1} degrees of the rotation open (standard deviation)"
            ),
            Self::Depths(mm) => write!(
                f,
                "it lies {mm:.0} mm farther from the other component along the view than is usual in this film"
            ),
            Self::Joint(mm) => write!(
                f,
                "it lies {mm:.0} mm behind the other component along the view, which no joint does"
            ),
            Self::Behind(mm) => Doubt::Behind { mm }.fmt(f),
            Self::ImplausibleSize(mm) => Doubt::ImplausibleSize { mm }.fmt(f),
            Self::Knee(what) => what.fmt(f),
            Self::Mirrored(beside) => beside.fmt(f),
            Self::Shape(shape) => {
                let is = match shape {
                    KneeComponent::Femur => "femoral component",
                    KneeComponent::Tibia => "tibial tray",
                };
                write!(
                    f,
                    "its model has the shape of a {is}, were the models swapped?"
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_told(distrust: Distrust, word: &str, parts: &[&str]) {
        let told = std::format!("{distrust}");
        assert!(parts.iter().all(|part| told.contains(part)), "{told}");
        assert!(!told.ends_with('.') && distrust.word() == word, "{told}");
    }

    #[test]
    fn what_a_frame_says_of_its_outline_is_told_with_its_figures() {
        let residual = "residual";
        assert_told(
            Distrust::Faint(0.254),
            "faint",
            &["have 25 % of the strength"],
        );
        let px = &["1.26 px off", "0.31 px in the better"];
        assert_told(Distrust::Apart(1.257, 0.31), residual, px);
        assert_told(
            Distrust::Unmet(0.62),
            residual,
            &["only 62 % of the outline is met"],
        );
        assert_told(
            Distrust::Cut(0.058),
            "cut off",
            &["only 6 % of the outline is in"],
        );
        assert_told(
            Distrust::Undetermined(4.04),
            "undetermined",
            &["leaves 4.0 degrees"],
        );
        assert_told(Distrust::Behind(980.0), "depths", &["980"]);
    }

    #[test]
    fn what_other_poses_say_against_one_is_told_with_its_figures() {
        assert_told(Distrust::Ways(1.54), "two ways", &["1.5 degrees apart"]);
        assert_told(
            Distrust::Jump(2.25, 3.21),
            "jump",
            &["2.2 degrees", "3.2 mm off"],
        );
        let few = Distrust::Few { good: 2, poses: 17 };
        assert_told(few, "few", &["only 2 of", "17 poses"]);
        let depths = &["-41 mm farther", "usual in this film"];
        assert_told(Distrust::Depths(-41.4), "depths", depths);
        assert_told(
            Distrust::Joint(61.2),
            "depths",
            &["61 mm behind", "no joint does"],
        );
        assert_told(
            Distrust::Side(Rival::Mirrored),
            "ambiguous",
            &["mirror image fits as well"],
        );
        assert_told(
            Distrust::Side(Rival::Elsewhere),
            "ambiguous",
            &["not its mirror image"],
        );
        assert_told(
            Distrust::Shape(KneeComponent::Femur),
            "shape",
            &["a femoral component"],
        );
        assert_told(
            Distrust::Shape(KneeComponent::Tibia),
            "shape",
            &["a tibial tray"],
        );
    }
}
