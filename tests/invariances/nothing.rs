//! Surfaces that bend nothing, with the same on both sides.

use glam::DVec3;

use crate::bodies::{CLEAR, Media, Place, TURBID, around, bodies, tables};
use crate::common::render::{Rendered, prepare};
use crate::pictures::assert_alike;
use crate::small::{Folder, cuboid, ply};

/// The scene with a box over the bodies and one in the water, of media that are like those around them.
fn with_boxes(media: Media, material: Option<&str>) -> Rendered {
    let mut text = tables(Place::HERE, media, "");
    for (mesh, front, back) in [("over.ply", "air", "other_air"), ("within.ply", "water", "other_water")] {
        if let Some(kind) = material {
            text += &format!(
                "[[surfaces]]\nmesh = \"{mesh}\"\nnormals = \"flat\"\nfront = \"{front}\"\nback = \"{back}\"\n\
                 material = {{ kind = \"{kind}\" }}\n"
            );
        }
    }
    let water = text.find("[media.water]").unwrap();
    let after = text[water..].find("[media.ice]").unwrap() + water;
    let other = text[water..after].replace("water", "other_water");
    let folder = Folder::with_scene(&format!(
        "{text}{other}[media.other_air]\nior = 1\n\
         [regions]\n0 = \"air\"\n1 = \"water\"\n2 = \"ice\"\n"
    ));
    folder
        .write("over.ply", ply(&cuboid(DVec3::new(-0.9, -1.3, 0.7), DVec3::new(1.0, 1.1, 1.3))))
        .write("within.ply", ply(&cuboid(DVec3::new(-0.7, -0.3, -0.4), DVec3::new(-0.3, 0.3, 0.3))))
        .frame(1, &bodies());
    around(&folder, Place::HERE);
    prepare(&folder.path("scene.toml")).render(32, 1)
}

#[test]
fn boundaries_of_nothing_are_not_seen() {
    for (name, media) in [("clear", CLEAR), ("turbid", TURBID)] {
        let expected = with_boxes(media, None);
        for kind in ["null", "dielectric"] {
            assert_alike(&format!("{name}, {kind}"), &expected, &with_boxes(media, Some(kind)));
        }
    }
}

/// A lamp in air that scatters without end: most paths never come back, and are ended by roulette when they are farther out
/// than all there is is wide. Within a box of the same air they are followed, as far as its walls.
#[test]
fn a_lamp_in_endless_fog_shines_as_in_a_large_box_of_it() {
    let picture = |more: &str, samples, seed| {
        let folder = Folder::with_scene(&format!(
            "[media.air]\nior = 1\nscattering = 0.6\n[media.more_air]\nior = 1\nscattering = 0.6\n\
             [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = [3, 2, 1] }}\n\
             [camera]\neye = [0.4, -3, 0.9]\ntarget = [0, 0, 0]\nvertical_fov = 60\nresolution = [16, 12]\n{more}"
        ));
        folder.write("lamp.ply", ply(&cuboid(DVec3::splat(-0.7), DVec3::splat(0.7))));
        folder.write("far.ply", ply(&cuboid(DVec3::splat(-10.0), DVec3::splat(10.0))));
        prepare(&folder.path("scene.toml")).render(samples, seed)
    };
    let flights = |picture: &Rendered, samples: u32| {
        (picture.counters.rays + picture.counters.untraced) / u64::from(16 * 12 * samples)
    };
    let endless = picture("", 64, 1);
    let boxed = picture(
        "[[surfaces]]\nmesh = \"far.ply\"\nfront = \"air\"\nback = \"more_air\"\nmaterial = { kind = \"null\" }\n",
        16,
        2,
    );
    println!(
        "{} and {} flights a path, means {} {}",
        flights(&endless, 64),
        flights(&boxed, 16),
        endless.mean().0,
        boxed.mean().0
    );
    assert_alike("fog", &boxed, &endless);
    assert!(flights(&endless, 64) < 20_000, "a path would have 400,000 without roulette");
}
