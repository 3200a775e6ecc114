use super::guards::DOUBTED;
use super::solver::Drawings;
use super::unknowns::Vector;
use super::*;
use crate::film::lines::{INNER, POINTS, STEP};
use crate::film::profile::READINGS;
use std::vec::Vec;

/// Path through a plate of this thickness, mm, with a rounded rim, `inside` pixels from its end; a pixel is 0.34 mm.
fn path(thickness: f64, inside: f64) -> f64 {
    let radius = thickness / 2.0;
    let off = (radius - 0.34 * inside).clamp(0.0, radius);
    2.0 * libm::sqrt(radius * radius - off * off)
}

/// Oracle: intensity behind a rim, twenty places to the pixel.
struct Rim {
    thickness: f64,
    attenuation: f64,
    blur_px: f64,
}

impl Rim {
    fn intensity(&self, along: f64) -> f64 {
        let passed = |along: f64| {
            let path = path(self.thickness, -along);
            libm::pow(1.0 + 0.25 * self.attenuation * path, -4.0)
        };
        let (mut sum, mut weights) = (0.0, 0.0);
        for k in -120..=120 {
            let off = f64::from(k) / 20.0;
            let weight = libm::exp(-off * off / (2.0 * self.blur_px * self.blur_px));
            sum += weight * passed(along + off);
            weights += weight;
        }
        // Scattered light, and tissue that is not the same everywhere.
        0.08 + (0.7 + 0.01 * along) * sum / weights
    }
}

/// Profiles of rims of many thicknesses, shown as a display does; where each lies is off by up to a pixel.
fn profiles(component: u8, attenuation: f64, shown: impl Fn(f64) -> f64) -> Vec<FilmProfile> {
    let one = |number: usize| {
        let thickness = 2.0 + 0.17 * (number % 60) as f64;
        let rim = Rim {
            thickness,
            attenuation,
            blur_px: 1.1,
        };
        let off = ((number * 7) % 20) as f64 / 10.0 - 1.0;
        let grey = |k: usize| shown(rim.intensity(FilmProfile::along(k) - off)) as f32;
        let mut mean = [0.0; READINGS];
        mean.iter_mut()
            .enumerate()
            .for_each(|(k, mean)| *mean = grey(k));
        FilmProfile {
            component,
            frame: (number / 30) as u16,
            mean,
            paths: core::array::from_fn(|k: usize| path(thickness, INNER - STEP * k as f64) as f32),
            ..FilmProfile::default()
        }
    };
    const _: () = assert!(POINTS == 81);
    (0..120).map(one).collect()
}

/// The same with edges that an unsharp mask of this amount and radius (pixels) enhances: of grey values, by the definition.
fn enhanced(
    component: u8,
    attenuation: f64,
    shown: impl Fn(f64) -> f64,
    [amount, radius]: [f64; 2],
) -> Vec<FilmProfile> {
    const REACH: i32 = 150;
    let mut all = profiles(component, attenuation, |_| 0.0);
    for (number, profile) in all.iter_mut().enumerate() {
        let rim = Rim {
            thickness: 2.0 + 0.17 * (number % 60) as f64,
            attenuation,
            blur_px: 1.1,
        };
        let grey: Vec<f64> = (-REACH..=REACH)
            .map(|k| shown(rim.intensity(f64::from(k) / 5.0)))
            .collect();
        let at = |along: f64| {
            let place = (5.0 * along + f64::from(REACH)).clamp(0.0, f64::from(2 * REACH - 1));
            let part = place - libm::floor(place);
            grey[place as usize] * (1.0 - part) + grey[place as usize + 1] * part
        };
        let smooth = |along: f64| {
            let offs = (-100..=100).map(|k| f64::from(k) / 5.0);
            let weighed = offs.map(|off| {
                let weight = libm::exp(-0.5 * (off / radius) * (off / radius));
                (weight * at(along + off), weight)
            });
            let (sum, weights) = weighed.fold((0.0, 0.0), |(sum, all), (x, weight)| {
                (sum + x, all + weight)
            });
            sum / weights
        };
        let off = ((number * 7) % 20) as f64 / 10.0 - 1.0;
        for (k, mean) in profile.mean.iter_mut().enumerate() {
            let along = FilmProfile::along(k) - off;
            *mean = (at(along) + amount * (at(along) - smooth(along))) as f32;
        }
    }
    all
}

#[test]
fn enhanced_edges_are_told_from_a_curved_display() {
    for (shown, curvature) in [(linear as fn(f64) -> f64, 0.0), (logarithmic, 1.0 / 38.0)] {
        let mut all = enhanced(0, 0.7, shown, [0.8, 3.0]);
        all.extend(enhanced(1, 0.2, shown, [0.8, 3.0]));
        let film = estimate(&mut all, 2).expect("told");
        let Sharpening { amount, radius_px } = film.constants.sharpening;
        assert!((amount - 0.8).abs() < 0.25, "{film:?}");
        assert!((radius_px - 3.0).abs() < 1.0, "{film:?}");
        let off = (film.constants.curvature - curvature) * film.contrast;
        assert!(off.abs() < 0.4, "{off} {film:?}");
        assert_eq!(film.display, DisplayKnowledge::Told);
        assert!(std::format!("{film}").contains("edges enhanced"), "{film}");
    }
}

fn logarithmic(intensity: f64) -> f64 {
    214.0 + 38.0 * libm::log(intensity)
}

fn linear(intensity: f64) -> f64 {
    250.0 * intensity
}

fn both(first: fn(f64) -> f64, second: fn(f64) -> f64) -> Option<FilmEstimate> {
    let mut all = profiles(0, 0.7, first);
    all.extend(profiles(1, 0.2, second));
    estimate(&mut all, 2)
}

#[test]
fn the_units_of_grey_values_do_not_matter() {
    let wide = |intensity: f64| 257.0 * logarithmic(intensity) + 1000.0;
    let [film, same] = [both(logarithmic, logarithmic), both(wide, wide)].map(|f| f.expect("told"));
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
    near(257.0 * same.constants.curvature, film.constants.curvature);
    near(same.constants.blur_px, film.constants.blur_px);
    near(same.residual / 257.0, film.residual);
    for component in 0..2 {
        near(same.attenuation[component], film.attenuation[component]);
    }
}

#[test]
fn the_constants_of_a_logarithmic_film_are_found() {
    let film = both(logarithmic, logarithmic).expect("told");
    let FilmConstants {
        curvature,
        blur_px,
        sharpening,
        ..
    } = film.constants;
    assert_eq!(sharpening, Sharpening::default(), "nobody enhanced edges");
    assert_eq!(film.display, DisplayKnowledge::Told);
    assert!((38.0 * curvature - 1.0).abs() < 0.15, "{curvature}");
    assert!((blur_px / 1.1 - 1.0).abs() < 0.08, "{blur_px}");
    for (found, wanted) in film.attenuation.iter().zip([0.7, 0.2]) {
        assert!((found / wanted - 1.0).abs() < 0.25, "{found} for {wanted}");
    }
    assert!(
        std::format!("{film}").starts_with("logarithmic film"),
        "{film}"
    );
}

#[test]
fn the_constants_of_a_linear_film_are_found() {
    let film = both(linear, linear).expect("told");
    let FilmConstants {
        curvature,
        blur_px,
        sharpening,
        ..
    } = film.constants;
    assert_eq!(sharpening, Sharpening::default(), "nobody enhanced edges");
    assert!(curvature.abs() < 0.001, "{curvature}");
    assert!((blur_px / 1.1 - 1.0).abs() < 0.05, "{blur_px}");
    assert_eq!(std::format!("{film}"), "nearly linear film, blur 1.1 px");
}

#[test]
fn components_that_contradict_each_other_leave_the_display_untold() {
    let film = both(linear, logarithmic).expect("something is told");
    if film.display == DisplayKnowledge::Told {
        // Between both: then it must not be curved much.
        assert!(
            film.constants.curvature * film.contrast < DOUBTED,
            "{film:?}"
        );
    } else {
        assert_eq!(film.constants.curvature, 0.0);
    }
    // And what is not told is uncertain.
    let sure = both(logarithmic, logarithmic).expect("told");
    assert!(
        film.display == DisplayKnowledge::Told || film.covariance[0][0] > sure.covariance[0][0]
    );
}

#[test]
fn nothing_is_told_by_frames_without_metal_or_by_few_profiles() {
    let mut flat = profiles(0, 0.7, |_| 90.0);
    assert_eq!(estimate(&mut flat, 1), None);
    let mut bright = profiles(0, 0.7, |intensity| 250.0 - linear(intensity));
    assert_eq!(estimate(&mut bright, 1), None);
    let mut few = profiles(0, 0.7, linear);
    assert_eq!(estimate(&mut few[..20], 1), None);
}

#[test]
fn a_frame_whose_pose_is_wrong_is_left_out() {
    let mut all = profiles(0, 0.7, linear);
    all.extend(profiles(1, 0.2, linear));
    // Paths that are not those of the profiles.
    for profile in all.iter_mut().filter(|p| p.component == 1 && p.frame == 2) {
        profile.paths = core::array::from_fn(|k| if k % 8 < 4 { 9.0 } else { 0.0 });
    }
    let film = estimate(&mut all, 2).expect("told");
    assert!(film.constants.curvature.abs() < 0.001, "{film:?}");
    let out = all.iter().filter(|profile| !profile.used);
    assert!(out.clone().count() >= 30 && out.clone().any(|p| p.component == 1 && p.frame == 2));
}

#[cfg(feature = "alloc")]
#[test]
fn constants_stand_by_what_they_were_learnt_from_and_fall_by_films_of_others() {
    let film = both(linear, linear).expect("told");
    let known = [film.model(0), film.model(1)];
    let leads = |models: &[FilmModel], shown: fn(f64) -> f64| {
        let mut all = profiles(0, 0.7, shown);
        all.extend(profiles(1, 0.2, shown));
        standing::leads_elsewhere(&mut all, models, GivenFilm::default())
    };
    assert!(!leads(&known, linear));
    assert!(leads(&known, logarithmic));
    for denser in [0.07, 0.6] {
        let mut other = known;
        other[1].attenuation = denser;
        assert!(leads(&other, linear), "{denser}");
    }
    assert!(!leads(&[], linear), "nothing is known that could fall");
}

#[test]
fn one_component_alone_tells_a_curved_display_from_enhanced_edges() {
    let alone =
        |stated| estimate_with(&mut profiles(0, 0.7, logarithmic), 1, stated).expect("told");
    let display = Some(DisplayKind::Logarithmic);
    let stated = GivenFilm {
        display,
        ..GivenFilm::default()
    };
    for (stated, wanted) in [
        (GivenFilm::default(), DisplayKnowledge::Told),
        (stated, DisplayKnowledge::Stated),
    ] {
        let film = alone(stated);
        assert_eq!(film.display, wanted);
        let curvature = film.constants.curvature;
        assert!((38.0 * curvature - 1.0).abs() < 0.3, "{curvature}");
        assert_eq!(film.constants.sharpening, Sharpening::default());
    }
}

#[test]
fn what_is_stated_of_a_display_holds() {
    for (display, wanted) in [
        (DisplayKind::Linear, "linear film, as stated"),
        (DisplayKind::Between, "film between linear and logarithmic"),
    ] {
        let mut all = profiles(0, 0.7, logarithmic);
        all.extend(profiles(1, 0.2, logarithmic));
        let stated = GivenFilm {
            display: Some(display),
            blur_px: Some(0.9),
        };
        let film = estimate_with(&mut all, 2, stated).expect("told");
        assert_eq!(
            DisplayKind::of(film.constants.curvature * film.contrast),
            display
        );
        assert!((film.constants.blur_px - 0.9).abs() < 1e-9, "{film:?}");
        assert!(std::format!("{film}").starts_with(wanted), "{film}");
    }
}

fn fit(profiles: &mut [FilmProfile], sharpened: bool) -> Fit<'_> {
    Fit {
        contrast: contrast(profiles).expect("dark"),
        profiles,
        components: 2,
        only: None,
        every: 1,
        hold: false,
        sharpened,
        given: GivenFilm::default(),
    }
}

/// Constants beside those of [`logarithmic`] films and metals, in the solver's numbers.
fn beside() -> Vector {
    let mut at = [-1.2; UNKNOWNS];
    (at[CURVATURE], at[BLUR], at[2], at[3]) = (0.8, 0.3, -0.6, -1.9);
    (at[AMOUNT], at[RADIUS]) = (0.3, 1.2);
    at
}

/// What is expected beforehand too: of so few profiles it is a large part.
#[test]
fn the_right_side_is_half_the_slope_of_what_is_minimised() {
    for sharpened in [false, true] {
        let mut all = profiles(0, 0.7, logarithmic);
        all.truncate(24);
        all.extend(profiles(1, 0.2, logarithmic).into_iter().take(24));
        let mut fit = fit(&mut all, sharpened);
        let at = beside();
        fit.find_shifts(&at);
        let right = fit.look(&at).expect("told").right;
        for unknown in 0..UNKNOWNS {
            let held = !sharpened && (unknown == AMOUNT || unknown == RADIUS);
            let mut cost = |by: f64| {
                let mut near = at;
                near[unknown] += by;
                fit.look(&near).expect("told").cost
            };
            const LITTLE: f64 = 0.01;
            let slope = (cost(LITTLE) - cost(-LITTLE)) / (2.0 * LITTLE);
            let half = if held { 0.0 } else { -slope / 2.0 };
            // Slopes are taken forward over 0.03.
            let near = (right[unknown] - half).abs() < 0.06 * half.abs() + 0.02;
            assert!(near, "{sharpened} {unknown}: {} for {half}", right[unknown]);
        }
    }
}

/// Oracle: pulls of eight profiles in a row are added before they are squared.
#[test]
fn stretches_of_eight_profiles_err_as_one() {
    let mut all = profiles(0, 0.7, logarithmic);
    all.truncate(43);
    let mut fit = fit(&mut all, false);
    let at = beside();
    fit.find_shifts(&at);
    let spread = fit.look(&at).expect("told").spread;
    // Of the shifts that were found.
    let drawings = Drawings::of(&fit, &at);
    let noise = 1.0 / (fit.cost(1.0).exp() - 1.0);
    let pull = |profile: &FilmProfile| {
        let (explained, slopes) = fit.explained(profile, &drawings).expect("explained");
        let weight = 1.0 / (noise + explained.squares());
        let along = slopes[1].iter().zip(explained.residuals);
        -weight * f64::from(along.map(|(a, b)| a * b).sum::<f32>())
    };
    let stretches = fit.profiles.chunks(8);
    let wanted: f64 = stretches
        .map(|stretch| stretch.iter().map(pull).sum::<f64>())
        .map(|pull| pull * pull)
        .sum();
    // What is expected of a blur has a deviation of 0.8.
    let found = spread[BLUR][BLUR] - 1.0 / 0.64;
    assert!((found / wanted - 1.0).abs() < 0.01, "{found} for {wanted}");
}

#[test]
fn frames_that_cost_more_than_the_better_half_are_left_out_and_no_others() {
    let mut all = profiles(0, 0.7, logarithmic);
    // Noise of which frames have some and one has much.
    for (k, profile) in all.iter_mut().enumerate() {
        let frame = k / 24;
        profile.frame = frame as u16;
        let swing = [1.0, 1.05, 6.0, 1.0, 0.95][frame];
        for (reading, mean) in profile.mean.iter_mut().enumerate() {
            *mean += swing * [1.0, -1.0][(reading * reading + k) % 3 % 2];
        }
    }
    let mut fit = fit(&mut all, false);
    let mut at = beside();
    (at[CURVATURE], at[BLUR], at[2]) = (1.3, libm::log(1.1), libm::log(0.7));
    fit.find_shifts(&at);
    fit.improve(&mut at, 6);
    assert!(fit.leave_out_costly(&at));
    assert!(
        all.iter()
            .all(|profile| profile.used == (profile.frame != 2))
    );
}

/// However late in a film its pose is wrong.
#[test]
fn of_a_long_film_too_frames_that_cost_more_are_left_out() {
    const FRAMES: u16 = 600;
    let few = &profiles(0, 0.7, logarithmic)[20..22];
    let mut all: Vec<FilmProfile> = Vec::new();
    for frame in 0..FRAMES {
        all.extend(few.iter().map(|&profile| FilmProfile { frame, ..profile }));
    }
    let is_wrong = |frame: u16| [5, 256, 301, FRAMES - 1].contains(&frame);
    for profile in all.iter_mut().filter(|profile| is_wrong(profile.frame)) {
        for (reading, mean) in profile.mean.iter_mut().enumerate() {
            *mean += [6.0, -6.0][reading % 2];
        }
    }
    let mut fit = fit(&mut all, false);
    let mut at = beside();
    (at[CURVATURE], at[BLUR], at[2]) = (1.3, libm::log(1.1), libm::log(0.7));
    fit.find_shifts(&at);
    assert!(fit.leave_out_costly(&at));
    for profile in &all {
        assert_eq!(profile.used, !is_wrong(profile.frame), "{}", profile.frame);
    }
}

#[test]
fn deviations_are_as_wide_as_what_is_told_of_the_display() {
    use DisplayKnowledge::{Told, Untold};
    let of = |k, display, sharpened| least_deviation(k, (display, sharpened), -1.5);
    assert_eq!(of(CURVATURE, Untold, true), 0.6);
    assert_eq!(of(CURVATURE, Told, false), 0.06);
    assert!((of(CURVATURE, Told, true) - 0.45).abs() < 1e-12);
    assert_eq!([BLUR, 2, 3].map(|k| of(k, Told, false)), [0.05, 0.1, 0.1]);
    assert_eq!([AMOUNT, RADIUS].map(|k| of(k, Told, false)), [0.0; 2]);
    assert_eq!([AMOUNT, RADIUS].map(|k| of(k, Told, true)), [0.1; 2]);
}
