//! Image files as other programs see them: written by the film, read back with the formats' own readers.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::fs;
use std::path::Path;

use exr::prelude::{
    AnyChannels, AttributeValue, FlatSamples, Image, Layer, LineOrder, Text, read_first_flat_layer_from_file,
};
use floe::film::exr::encode_exr;
use floe::film::{FAR_DEPTH, FilmError, FrameImage, ImageMetadata, Pixel, write_frame};
use floe::scene::description::Aov;
use glam::{Mat4, Vec2, Vec3};

const ALL: [Aov; 6] = [Aov::Albedo, Aov::Normal, Aov::Position, Aov::Depth, Aov::Variance, Aov::Motion];

/// Different numbers in every pixel and channel, negative ones among them.
fn frame(width: u32, height: u32) -> FrameImage {
    let mut image = FrameImage::new(width, height);
    for (i, pixel) in image.pixels.iter_mut().enumerate() {
        let t = i as f32 / (width * height) as f32;
        *pixel = Pixel {
            rgb: Vec3::new(t - 0.1, 2.0 * t, 0.37 + 1e-3 * (i % 7) as f32),
            alpha: t,
            albedo: Vec3::new(0.2, t, 0.9),
            normal: Vec3::new(0.6 * t, -0.8, t),
            position: Vec3::new(10.0 * t, -3.0, 1.0 / (t + 0.1)),
            depth: if i % 5 == 0 { FAR_DEPTH } else { 3.0 + t },
            motion: Vec2::new(-8.0 * t, 0.5),
            variance: Vec3::new(1e-4 * t, 1e-6, 1e-8),
            luminance_variance: 1e-6,
            deviations: [5e-4, -5e-4, 5e-4, -5e-4],
            samples: 64 + (i % 3) as u32,
            replicates: 4,
            rejected: 0,
        };
    }
    image
}

fn metadata() -> ImageMetadata {
    let attributes =
        [("scene", "Bølge.toml"), ("seed", "0"), ("integrator", "path"), ("samples", "64"), ("note", "")];
    ImageMetadata {
        frame_number: 1234,
        fps: 23.976,
        world_to_camera: Mat4::from_translation(Vec3::new(1.0, 2.0, 3.0)),
        world_to_ndc: Mat4::from_scale(Vec3::new(0.5, -0.5, 1.0)),
        attributes: attributes.map(|(name, value)| (String::from(name), String::from(value))).to_vec(),
    }
}

type ReadBack = Image<Layer<AnyChannels<FlatSamples>>>;

fn written(folder: &Path, image: &FrameImage, aovs: &[Aov]) -> ReadBack {
    let path = folder.join("shot.1234.exr");
    write_frame(image, &metadata(), &path, None, aovs, 0.0).unwrap();
    read_first_flat_layer_from_file(&path).unwrap()
}

#[test]
fn every_number_of_every_channel_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    // 37 rows: two whole blocks of 16 and a rest.
    let image = frame(23, 37);
    let back = written(folder.path(), &image, &ALL);
    let channels = &back.layer_data.channel_data.list;
    type Value = fn(&Pixel) -> f32;
    let expected: [(&str, Value); 20] = [
        ("A", |p| p.alpha),
        ("B", |p| p.rgb.z),
        ("G", |p| p.rgb.y),
        ("N.X", |p| p.normal.x),
        ("N.Y", |p| p.normal.y),
        ("N.Z", |p| p.normal.z),
        ("P.X", |p| p.position.x),
        ("P.Y", |p| p.position.y),
        ("P.Z", |p| p.position.z),
        ("R", |p| p.rgb.x),
        ("Z", |p| p.depth),
        ("albedo.B", |p| p.albedo.z),
        ("albedo.G", |p| p.albedo.y),
        ("albedo.R", |p| p.albedo.x),
        ("motion.X", |p| p.motion.x),
        ("motion.Y", |p| p.motion.y),
        ("samples", |p| p.samples as f32),
        ("variance.B", |p| p.variance.z),
        ("variance.G", |p| p.variance.y),
        ("variance.R", |p| p.variance.x),
    ];
    assert_eq!(channels.len(), expected.len());
    for (channel, (name, value)) in channels.iter().zip(expected) {
        assert_eq!(channel.name.to_string(), name);
        assert!(matches!(channel.sample_data, FlatSamples::F32(_)), "{name} is not 32-bit float");
        let numbers: Vec<f32> = channel.sample_data.values_as_f32().collect();
        let wanted: Vec<f32> = image.pixels.iter().map(value).collect();
        assert_eq!(numbers, wanted, "{name}");
    }
}

#[test]
fn layers_that_are_not_asked_for_are_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let names = |aovs: &[Aov]| -> Vec<String> {
        let back = written(folder.path(), &frame(5, 4), aovs);
        back.layer_data.channel_data.list.iter().map(|c| c.name.to_string()).collect()
    };
    assert_eq!(names(&[]), ["A", "B", "G", "R"]);
    assert_eq!(names(&[Aov::Depth]), ["A", "B", "G", "R", "Z"]);
}

#[test]
fn attributes_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let back = written(folder.path(), &frame(5, 4), &[]);
    let own = &back.layer_data.attributes;
    assert_eq!(own.frames_per_second, Some((24_000, 1001)));
    assert_eq!(own.software_name, Some(Text::from(format!("floe {}", env!("CARGO_PKG_VERSION")).as_str())));
    assert_eq!(own.world_to_camera.unwrap()[12..], [1.0, 2.0, 3.0, 1.0]);
    assert_eq!(own.world_to_normalized_device.unwrap()[..6], [0.5, 0.0, 0.0, 0.0, 0.0, -0.5]);
    assert_eq!((&own.capture_date, &own.owner, &own.comments, own.utc_offset), (&None, &None, &None, None));
    let code = back.attributes.time_code.unwrap();
    // 1234 = 51 * 24 + 10.
    assert_eq!((code.hours, code.minutes, code.seconds, code.frame, code.drop_frame), (0, 0, 51, 10, false));
    assert_eq!(back.attributes.chromaticities.unwrap().white.0, 0.3127);
    assert_eq!(back.layer_data.encoding.line_order, LineOrder::Increasing);

    let text = |name: &str| own.other[&Text::from(name)].to_text().unwrap().as_slice().to_vec();
    assert_eq!(own.other[&Text::from("imageCounter")], AttributeValue::I32(1234));
    assert_eq!(text("floe:scene"), "Bølge.toml".as_bytes());
    assert_eq!(text("floe:seed"), b"0");
    assert_eq!(text("floe:note"), b"");
    let mut names: Vec<String> = own.other.keys().map(Text::to_string).collect();
    names.sort();
    let own_names = "floe:checksum floe:integrator floe:note floe:samples floe:scene floe:seed imageCounter";
    assert_eq!(names.join(" "), own_names);
}

#[test]
fn bytes_are_the_same_on_any_number_of_threads() {
    let image = frame(67, 131);
    let bytes = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| encode_exr(&image, &metadata(), &ALL, Path::new("shot.exr")).unwrap())
    };
    let one = bytes(1);
    // Several times: the encoder's own map of attributes has another order each time.
    for threads in [1, 2, 2, 3, 4, 1, 2] {
        assert!(bytes(threads) == one, "{threads} threads give other bytes");
    }
}

#[test]
fn a_png_shows_the_sky_in_srgb() {
    let folder = tempfile::tempdir().unwrap();
    let mut image = FrameImage::new(40, 24);
    image.pixels.fill(Pixel { rgb: Vec3::splat(0.18), alpha: 0.0, ..Pixel::EMPTY });
    image.pixels[0].rgb = Vec3::ZERO;
    image.pixels[1].rgb = Vec3::splat(1e9);
    let (exr, png) = (folder.path().join("a.exr"), folder.path().join("b/a.png"));
    write_frame(&image, &metadata(), &exr, Some(&png), &[], 0.0).unwrap();
    let picture = image::open(&png).unwrap();
    assert_eq!(picture.color(), image::ColorType::Rgb8);
    let picture = picture.to_rgb8();
    assert_eq!(picture.dimensions(), (40, 24));
    assert_eq!((picture.get_pixel(0, 0).0, picture.get_pixel(1, 0).0), ([0; 3], [255; 3]));
    // sRGB of 0.18 is 117.6 of 255.
    assert!(picture.pixels().skip(2).all(|p| [[117; 3], [118; 3]].contains(&p.0)));
}

#[test]
fn a_frame_that_cannot_be_written_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let exr = folder.path().join("shot.exr");
    fs::create_dir(&exr).unwrap();
    let error = write_frame(&frame(5, 4), &metadata(), &exr, None, &[], 0.0).unwrap_err();
    assert!(matches!(error, FilmError::CannotWrite { .. }), "{error}");
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["shot.exr"]);

    // The PNG fails first: the finished OpenEXR file must not take its name.
    let (good, bad) = (folder.path().join("good.exr"), folder.path().join("bad.png"));
    fs::create_dir(&bad).unwrap();
    write_frame(&frame(5, 4), &metadata(), &good, Some(&bad), &[], 0.0).unwrap_err();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn frames_and_names_that_the_format_cannot_hold_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shot.exr");
    let error = write_frame(&FrameImage::new(0, 3), &metadata(), &path, None, &[], 0.0).unwrap_err();
    assert!(error.to_string().contains("0 x 3"), "{error}");
    let mut long = metadata();
    long.attributes.push((String::from("a_name_that_is_much_too_long"), String::new()));
    let error = write_frame(&frame(2, 2), &long, &path, None, &[], 0.0).unwrap_err();
    assert!(matches!(error, FilmError::Attribute { .. }), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
