//! The text of a scene for frames that have none: a camera that frames them, light, and media for their
//! labels.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use glam::{DVec3, Vec3};

use super::FieldOfView;
use super::framing::{automatic_placement, usable};

/// Size in metres at which the coefficients of the default media are meant as they are written here.
const REFERENCE_SIZE: f64 = 2.0;

/// Absorption of further fluids: amber, green, rose, violet, yellow, turquoise.
const FAINT_COLOURS: [[f64; 3]; 6] = [
    [0.05, 0.20, 0.60],
    [0.50, 0.08, 0.35],
    [0.08, 0.50, 0.25],
    [0.25, 0.45, 0.08],
    [0.06, 0.10, 0.70],
    [0.60, 0.10, 0.12],
];

/// Writes the scene file of frames that have none.
///
/// `frames_path` goes into `frames.path`; `bounds` are those of the first frame and `labels` the labels in it
/// (0, the outside, may be among them). `box_walls` are the corners of a simulated box with faces on its
/// planes. Label 1 is sea water, 2 is ice, others are clear fluids of faint colours. Coefficients go with the
/// inverse of the size of the bounds, so that a tank of 0.15 m and a sea of 100 m look alike.
pub fn default_scene(
    frames_path: &str,
    bounds: (DVec3, DVec3),
    labels: &[i32],
    box_walls: Option<(DVec3, DVec3)>,
) -> String {
    let (min, max) = usable(bounds);
    let size = (max - min).max_element();
    let mut labels: BTreeSet<i32> = labels.iter().copied().filter(|&label| label != 0).collect();
    if labels.is_empty() {
        // Closed meshes without labels hold label 1.
        labels.insert(1);
    }
    let mut text = frames_table(frames_path);
    text += &regions_table(&labels);
    if let Some((min, max)) = box_walls.filter(|(min, max)| min.cmplt(*max).all()) {
        text += &domain_table(min, max);
    }
    for &label in &labels {
        text += &medium_table(label, REFERENCE_SIZE / size);
    }
    text += LIGHTS;
    text + &camera_table((min, max), size)
}

fn frames_table(path: &str) -> String {
    let path = toml::Value::String(path.to_owned());
    format!(
        "# Written by floe because these frames had no scene. Change what you like: it is not written again.\n\n\
         [frames]\npath = {path}\nfps = 24\nscale = 1.0                    # metres per unit of the frame files\n\
         up = \"z\"\n"
    )
}

fn regions_table(labels: &BTreeSet<i32>) -> String {
    let mut text =
        "\n[regions]                      # label in the frame files = medium; 0 is the outside\n0 = \"air\"\n"
            .to_owned();
    for &label in labels {
        let _ = writeln!(text, "{label} = \"{}\"", medium_name(label));
    }
    text
}

fn domain_table(min: DVec3, max: DVec3) -> String {
    // Every digit: faces are on the box's planes only if the planes are where the simulator has them.
    format!(
        "\n[domain]                       # the simulated box\nbox = [[{}, {}, {}], [{}, {}, {}]]\n\
         walls = {{ sides = \"keep\", bottom = \"keep\", top = \"keep\" }}   # keep, open or opaque; sides also extend\n",
        min.x, min.y, min.z, max.x, max.y, max.z
    )
}

fn medium_name(label: i32) -> String {
    match label {
        1 => "sea".to_owned(),
        2 => "ice".to_owned(),
        label if label < 0 => format!("fluid_minus_{}", label.unsigned_abs()),
        label => format!("fluid_{label}"),
    }
}

/// One medium; `scale` multiplies its coefficients.
fn medium_table(label: i32, scale: f64) -> String {
    let (ior, absorption) = match label {
        1 => (1.33, [0.35, 0.07, 0.03]),
        2 => (1.31, [0.25, 0.10, 0.06]),
        label => (1.4, faint_colour(label)),
    };
    let rgb = |rgb: [f64; 3]| format!("[{}]", rgb.map(|c| significant(c * scale)).join(", "));
    let absorption = format!("absorption = {}", rgb(absorption));
    let mut text = format!("\n[media.{}]\nior = {ior}\n", medium_name(label));
    let _ = writeln!(text, "{absorption:<30} # 1/m: red, green, blue");
    if label == 1 {
        let _ = writeln!(text, "scattering = {}", rgb([0.10, 0.11, 0.12]));
        text += "phase = { kind = \"henyey-greenstein\", g = 0.9 }\n";
    } else if label == 2 {
        let scattering = format!("scattering = {}", significant(8.0 * scale));
        let _ = writeln!(text, "{scattering:<30} # bubbles");
        text += "phase = { kind = \"henyey-greenstein\", g = 0.86 }\n";
    }
    text
}

/// Labels next to each other differ in hue, those a whole cycle apart in depth.
fn faint_colour(label: i32) -> [f64; 3] {
    let count = FAINT_COLOURS.len() as i64;
    let (cycle, hue) = (i64::from(label).div_euclid(count), i64::from(label).rem_euclid(count));
    let depth = 1.0 + 0.4 * (cycle.unsigned_abs() % 8) as f64;
    FAINT_COLOURS[hue as usize].map(|c| c * depth)
}

const LIGHTS: &str = "
[sun]
direction = [-0.5, -0.35, 0.8]   # towards the sun
angular_diameter = 0.53        # degrees
irradiance = [2.2, 2.05, 1.85]

[sky]
radiance = [0.45, 0.6, 0.8]
";

fn camera_table(bounds: (DVec3, DVec3), size: f64) -> String {
    let fov = FieldOfView::Vertical(40.0);
    let placement = automatic_placement(bounds, Vec3::Z, fov, [640, 360]);
    // Three digits of the size: a rounding of 1e-3 of it cannot be seen in the margin.
    let decimals = (3.0 - libm::log10(size)).ceil().clamp(0.0, 15.0) as usize;
    let point =
        |p: DVec3| format!("[{}, {}, {}]", short(p.x, decimals), short(p.y, decimals), short(p.z, decimals));
    format!(
        "\n[camera]                       # sees the bounds of the first frame with a fifth of margin\neye = {}\n\
         target = {}\nvertical_fov = 40              # degrees\nresolution = [640, 360]\n\n\
         [render]\nsamples = 64\n",
        point(placement.eye),
        point(placement.target)
    )
}

/// A number with some decimals, without zeros at the end.
fn short(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A number above 0 with two digits that count.
fn significant(number: f64) -> String {
    let rounded = format!("{number:.1e}");
    let plain = rounded.parse::<f64>().unwrap_or(number);
    if (1e-4..1e6).contains(&plain) { format!("{plain}") } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::super::framing::tests::extent;
    use super::super::{AbsorptionDescription, SceneDescription, Wall};
    use super::*;
    use crate::mesh::Region;
    use crate::optics::RefractiveIndex;
    use crate::spectrum::Spectrum;
    use proptest::prelude::*;
    use std::path::Path;

    const UNIT: (DVec3, DVec3) = (DVec3::NEG_ONE, DVec3::ONE);

    fn parse(text: &str) -> SceneDescription {
        SceneDescription::parse(text, Path::new("scene.toml")).unwrap_or_else(|e| panic!("{e}\n{text}"))
    }

    proptest! {
        #[test]
        fn any_frames_get_a_scene_that_parses(
            path in "[^\\s\\x00-\\x20]{1,12}", centre in prop::array::uniform3(-1e6f64..1e6), exponent in -4i32..7,
            labels in prop::collection::vec(-5i32..1000, 0..9),
        ) {
            let half = DVec3::splat(0.5 * 10f64.powi(exponent));
            let bounds = (DVec3::from(centre) - half, DVec3::from(centre) + half);
            let scene = parse(&default_scene(&path, bounds, &labels, Some(bounds)));
            prop_assert_eq!(&scene.frames.as_ref().unwrap().path, &path);
            let p = scene.camera.placement.unwrap();
            let extent = extent(bounds, &p, DVec3::Z, scene.camera.fov, scene.camera.resolution);
            // The file rounds each coordinate by at most 5e-4 of the size, and the box is 1.5 sizes away or more.
            prop_assert!((extent - 1.0 / 1.2).abs() < 2e-3, "{}", extent);
            let domain = scene.domain.unwrap();
            prop_assert_eq!((domain.min, domain.max), bounds);
            prop_assert_eq!((domain.sides, domain.bottom, domain.top), (Wall::Keep, Wall::Keep, Wall::Keep));
            for label in labels {
                let medium = &scene.regions[&Region(label)];
                prop_assert!(scene.media.contains_key(medium));
            }
        }
    }

    #[test]
    fn labels_become_media() {
        let text = default_scene("frames", UNIT, &[2, 7, 0, 1, -3, 3, 7], None);
        let scene = parse(&text);
        let regions: Vec<(i32, &str)> = scene.regions.iter().map(|(r, m)| (r.0, m.as_str())).collect();
        let names =
            [(-3, "fluid_minus_3"), (0, "air"), (1, "sea"), (2, "ice"), (3, "fluid_3"), (7, "fluid_7")];
        assert_eq!(regions, names);
        assert!(scene.domain.is_none());
        assert_eq!(scene.media["ice"].ior, RefractiveIndex::Constant(1.31));
        assert_eq!(scene.media["ice"].scattering, Spectrum::Constant(8.0));
        let colours =
            ["fluid_minus_3", "fluid_3", "fluid_7"].map(|name| scene.media[name].absorption.clone());
        assert!(colours.iter().all(Option::is_some));
        assert!(colours[0] != colours[1] && colours[1] != colours[2] && colours[0] != colours[2]);
        // Meshes without labels, and those whose only label is the outside, have label 1.
        assert_eq!(parse(&default_scene("f", UNIT, &[0], None)).regions[&Region(1)], "sea");
        // A box without volume is none.
        assert!(parse(&default_scene("f", UNIT, &[], Some((DVec3::ZERO, DVec3::X)))).domain.is_none());
    }

    #[test]
    fn optical_depth_does_not_depend_on_the_size() {
        for size in [0.15, 2.0, 100.0, 1e5] {
            let text = default_scene("f", (DVec3::ZERO, DVec3::splat(size)), &[1, 2], None);
            let sea = &parse(&text).media["sea"];
            let Some(AbsorptionDescription::Spectrum(Spectrum::Rgb([red, ..]))) = sea.absorption else {
                panic!()
            };
            // Two digits that count: within 5 percent.
            assert!((f64::from(red) * size / 0.7 - 1.0).abs() < 0.05, "{size}: {red}");
        }
    }

    #[test]
    fn empty_bounds_are_framed_too() {
        let (inf, zero) = (DVec3::INFINITY, DVec3::ZERO);
        for bounds in [(inf, -inf), (zero, zero), (zero, DVec3::NAN)] {
            assert!(parse(&default_scene("f", bounds, &[1], None)).camera.placement.is_some());
        }
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([short(1.5, 4), short(-0.00001, 3), short(120.0, 0)], ["1.5", "0", "120"]);
        assert_eq!(
            [0.35, 4.66667, 8.0, 1e-7, 123456.0, 3.2e9].map(significant),
            ["0.35", "4.7", "8", "1.0e-7", "120000", "3.2e9"]
        );
        let text = default_scene("frames/frame_####.ply", UNIT, &[1, 2], Some(UNIT));
        assert!(text.lines().all(|line| line.len() <= 110), "{text}");
    }
}
