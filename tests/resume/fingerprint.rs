//! What changes the fingerprint of a frame, and what does not.

use floe::driver::{Fingerprints, FrameSource, Identity, Job, RenderOptions, read_identity};
use glam::DVec3;

use super::small::{Folder, cube, cuboid, labelled, ply, scene};

/// Frames 1 and 2, a floor, a lamp for each frame and a plume for each frame.
fn folder() -> Folder {
    let folder = Folder::with_scene(&scene(
        "[media.ice]\ndensity = { grid = \"plume_####.nrrd\", box = [[-1, -1, -1], [1, 1, 1]] }\nscattering = 2\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = { kind = \"diffuse\" }\n\
         [[surfaces]]\nmesh = \"lamp_####.ply\"\nmaterial = { kind = \"emitter\", radiance = 1 }\n\
         [[sun]]\ndirection = [0, 0, 1]\nirradiance = 1\n[[sun]]\ndirection = [0, 1, 1]\nirradiance = 2\n",
    ));
    for number in 1..=2 {
        folder.frame(number, &labelled(cube(), 0, 1));
        folder.write(&format!("lamp_{number:04}.ply"), ply(&cuboid(DVec3::splat(1.0), DVec3::splat(1.2))));
        folder.write(&format!("plume_{number:04}.nrrd"), plume(1.0));
    }
    folder.write("floor.ply", ply(&cuboid(DVec3::new(-3.0, -3.0, -3.0), DVec3::new(3.0, 3.0, -2.0))));
    folder
}

fn plume(value: f32) -> Vec<u8> {
    let head = "NRRD0004\ntype: float\ndimension: 3\nsizes: 1 1 1\nendian: little\nencoding: raw\n\n";
    [head.as_bytes(), &value.to_le_bytes()].concat()
}

fn identity(folder: &Folder, number: usize, options: &RenderOptions) -> Identity {
    let job = Job::open(&folder.path("scene.toml")).unwrap();
    let fingerprints = Fingerprints::new(&job.world, &options.settings(&job.world.description.render));
    FrameSource::read(&job.world, &fingerprints, &job.tasks()[number - 1]).unwrap().identity
}

/// Asserts that a change to the folder gives frame 1 another fingerprint, or not.
fn check(what: &str, changes: bool, change: impl FnOnce(&Folder) -> &Folder) {
    let folder = folder();
    let options = RenderOptions::default();
    let before = identity(&folder, 1, &options);
    change(&folder);
    let after = identity(&folder, 1, &options);
    assert_eq!(before.fingerprint != after.fingerprint, changes, "{what}");
}

fn edit<'a>(folder: &'a Folder, from: &str, to: &str) -> &'a Folder {
    let text = String::from_utf8(folder.read("scene.toml")).unwrap();
    assert!(text.contains(from), "{text}");
    folder.write("scene.toml", text.replace(from, to))
}

#[test]
fn what_changes_pixels_changes_the_fingerprint() {
    for (from, to) in [
        ("samples = 4", "samples = 5"),
        ("samples = 4", "samples = 4\nseed = 1"),
        ("samples = 4", "samples = 4\nintegrator = \"fog\""),
        ("samples = 4", "samples = 4\nphotons = { count = 7 }"),
        ("ior = 1.33", "ior = 1.3301"),
        ("[0.6, 0.7, 0.8]", "[0.6, 0.7, 0.9]"),
        ("resolution = [16, 9]", "resolution = [16, 10]"),
        ("eye = [0.4, -4, 0.9]", "eye = [0.4, -4, 0.8]"),
        ("1 = \"water\"", "1 = \"ice\""),
        ("radiance = 1 }", "radiance = 2 }"),
        ("irradiance = 2", "irradiance = 3"),
        ("[render]", "[output]\naovs = [\"Z\"]\n[render]"),
        ("frame_####.ply\"", "frame_####.ply\"\nfps = 25"),
    ] {
        check(to, true, |folder| edit(folder, from, to));
    }
    let other = ply(&cuboid(DVec3::splat(-0.8), DVec3::splat(0.7)));
    for name in ["frames/frame_0001.ply", "floor.ply", "lamp_0001.ply"] {
        check(name, true, |folder| folder.write(name, &other));
    }
    check("plume", true, |folder| folder.write("plume_0001.nrrd", plume(2.0)));
}

#[test]
fn what_changes_no_pixel_does_not_change_the_fingerprint() {
    for (from, to) in [
        ("samples = 4", "# enough\nsamples   =   4"),
        ("samples = 4", "samples = 4\nseed = 0\nfilter = \"box\""),
        ("[render]", "[output]\npath = \"a/b_####.exr\"\npng = false\nexposure = 2\n[render]"),
        ("\"frames/frame_####.ply\"", "\"frames\""),
    ] {
        check(to, false, |folder| edit(folder, from, to));
    }
    check("the order of keys", false, |folder| {
        edit(folder, "eye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]", "target = [0, 0, 0]\neye = [0.4, -4, 0.9]")
    });
    let other = ply(&cuboid(DVec3::splat(-0.8), DVec3::splat(0.7)));
    for name in ["frames/frame_0002.ply", "lamp_0002.ply", "frames/frame_0003.ply"] {
        check(name, false, |folder| folder.write(name, &other));
    }
    check("dates", false, |folder| folder.write("floor.ply", folder.read("floor.ply")));
}

#[test]
fn overrides_count_as_if_the_scene_said_so() {
    let folder = folder();
    // In one sequence of samples, where a frame begins follows from what the scene itself says.
    edit(&folder, "samples = 4", "seed_mode = \"frame\"\nsamples = 4");
    let overridden = RenderOptions { samples: Some(9), seed: Some(3), ..RenderOptions::default() };
    let before = identity(&folder, 1, &overridden);
    assert_ne!(before.fingerprint, identity(&folder, 1, &RenderOptions::default()).fingerprint);
    edit(&folder, "samples = 4", "samples = 9\nseed = 3");
    assert_eq!(before, identity(&folder, 1, &RenderOptions::default()));
}

#[test]
fn frames_of_the_same_mesh_are_told_apart() {
    let folder = folder();
    let (a, b) =
        (identity(&folder, 1, &RenderOptions::default()), identity(&folder, 2, &RenderOptions::default()));
    assert_eq!(a.mesh_hash, b.mesh_hash);
    assert_ne!(a.fingerprint, b.fingerprint);
}

/// The digest of "abc" is that of the standard's example.
#[test]
fn the_mesh_hash_is_the_one_of_sha256sum() {
    let folder = folder();
    folder.write("frames/frame_0001.ply", "abc");
    let hash = identity(&folder, 1, &RenderOptions::default()).mesh_hash;
    assert_eq!(hash, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

#[test]
fn pictures_say_which_frame_they_are() {
    let folder = folder();
    folder.render(RenderOptions::default());
    for number in 1..=2 {
        let expected = identity(&folder, number, &RenderOptions::default());
        assert_eq!(read_identity(&folder.path(&format!("out/frame_000{number}.exr"))), Some(expected));
    }
    assert_eq!(read_identity(&folder.path("floor.ply")), None);
    assert_eq!(read_identity(&folder.path("nothing.exr")), None);
}

/// Bodies as frames 1 and 2, or 1 and 3, whose velocities follow from each other.
fn moving(second: u32) -> Folder {
    let tables = "[frames]\npath = \"frames/frame_####.ply\"\nvelocity = \"frames\"\n\
                  [camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [16, 9]\nshutter = 0.5\n";
    let folder = Folder::with_scene(&scene(tables));
    folder.frame(1, &labelled(cube(), 0, 1));
    folder.frame(second, &labelled(cuboid(DVec3::splat(-0.7), DVec3::splat(0.9)), 0, 1));
    folder
}

/// The same way takes twice the time: velocities are half as large.
#[test]
fn the_time_to_the_next_frame_counts() {
    let options = RenderOptions::default();
    let [near, far] = [2, 3].map(|second| identity(&moving(second), 1, &options));
    assert_ne!(near.fingerprint, far.fingerprint);
    assert_eq!(near, identity(&moving(2), 1, &options));
}

/// A triangle of FLIP Fluids, or its velocities.
fn triples(lists: &[&[[f32; 3]]], indices: &[[i32; 3]]) -> Vec<u8> {
    let list = |list: &&[[f32; 3]]| {
        let numbers = list.as_flattened().iter().flat_map(|n| n.to_le_bytes());
        (list.len() as i32).to_le_bytes().into_iter().chain(numbers).collect::<Vec<u8>>()
    };
    let mut bytes: Vec<u8> = lists.iter().flat_map(list).collect();
    bytes.extend((indices.len() as i32).to_le_bytes());
    bytes.extend(indices.as_flattened().iter().flat_map(|i| i.to_le_bytes()));
    bytes
}

/// Two meshes a frame; velocities lie beside the first, or the same ones beside the second.
#[test]
fn velocities_count_for_the_mesh_that_they_lie_beside() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let folder = Folder::with_scene(
        "[media.water]\nior = 1.33\n[media.ice]\nior = 1.31\n[sky]\nradiance = 1\n[camera]\neye = [0.4, -4, 0.9]\n\
         target = [0, 0, 0]\nresolution = [16, 9]\nshutter = 0.5\n[[meshes]]\npath = \"a/######.bobj\"\n\
         inside = \"water\"\n[[meshes]]\npath = \"b/######.bobj\"\ninside = \"ice\"\n",
    );
    for mesh in ["a", "b"] {
        folder.write(&format!("{mesh}/000001.bobj"), triples(&[&corners], &[[0, 1, 2]]));
    }
    let job = Job::open(&folder.path("scene.toml")).unwrap();
    let fingerprints = Fingerprints::new(&job.world, &job.world.description.render);
    let source = || FrameSource::read(&job.world, &fingerprints, &job.tasks()[0]).unwrap();
    let speeds = triples(&[&[[1.0, 2.0, 3.0]; 3]], &[]);
    let of = |beside: Option<&str>| {
        let names = ["a", "b"].map(|mesh| format!("{mesh}/velocity000001.bobj"));
        names.iter().for_each(|name| drop(std::fs::remove_file(folder.path(name))));
        beside.map(|mesh| folder.write(&format!("{mesh}/velocity000001.bobj"), &speeds));
        source().identity.fingerprint
    };
    let [none, first, second] = [None, Some("a"), Some("b")].map(of);
    assert!(none != first && none != second && first != second, "{none} {first} {second}");
    // What was hashed is what counts: a file may come or go before the mesh is parsed.
    let hashed = source();
    of(None);
    let bare = source();
    of(Some("a"));
    let has = |source: FrameSource| -> Vec<bool> {
        source.parse(&job.world).unwrap().meshes.iter().map(|m| m.mesh.velocities.is_some()).collect()
    };
    assert_eq!(has(bare), [false, false]);
    assert_eq!(has(hashed), [false, true]);
}
