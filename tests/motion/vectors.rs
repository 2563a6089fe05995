//! Motions in the picture against the projections of points that are moved by hand.

use floe::driver::job::Job;
use floe::driver::tiles::{Sampling, render_pixels};
use floe::scene::assembly::FrameMesh;
use floe::scene::camera::Camera;
use floe::sequence::FrameNumber;
use glam::{DVec3, Vec2};

use crate::common::mesh::{Moving, sphere};
use crate::small::Folder;

const FPS: f64 = 30.0;

/// A linear field, which triangles interpolate exactly; metres a second in a file of millimetres.
fn velocity(p: DVec3) -> DVec3 {
    FPS * (DVec3::new(20.0, -10.0, 5.0) + DVec3::new(0.1 * p.z, 0.05 * p.x, -0.1 * p.y))
}

/// Where a point in the world is in a picture, in pixels.
fn place(camera: &Camera, origin: DVec3, size: [u32; 2], point: DVec3) -> Vec2 {
    let ndc = camera.world_to_ndc(origin) * point.as_vec3().extend(1.0);
    Vec2::new(ndc.x / ndc.w * size[0] as f32, ndc.y / ndc.w * size[1] as f32)
}

/// One sample a pixel, whose position the picture tells. Positions are good to 1e-6 of 4 m, and pixels to 1e-3 of one; the
/// motions are tens of pixels.
#[test]
fn motions_are_where_points_are_in_the_next_frame() {
    for camera in [
        "eye = [0.4, -4, 1.6]\ntarget = [0, 0, 0]\n",
        "eye = [{ frame = 0, eye = [0.4, -4, 1.6] }, { frame = 6, eye = [2, -3, 1], target = [0, 0, 0.3], vertical_fov = 30 }]\n\
         target = [0, 0, 0]\nturntable = { degrees_per_frame = 2 }\n",
    ] {
        let size = [48, 32];
        let folder = Folder::with_scene(&format!(
            "[frames]\npath = \"frames/frame_####.ply\"\nfps = {FPS}\nscale = 0.001\n[regions]\n1 = \"water\"\n\
             [media.water]\nior = 1.33\n[camera]\n{camera}vertical_fov = 40\nresolution = [48, 32]\n\
             [render]\nsamples = 1\n[output]\naovs = [\"motion\"]\n"
        ));
        let body = sphere(DVec3::ZERO, 900.0, 3);
        folder.write("frames/frame_0003.ply", body.moving_ply(velocity));
        let job = Job::open(&folder.path("scene.toml")).unwrap();
        let path = job.files[0].path.clone();
        let mesh = floe::mesh::read_with(&path, &job.world.velocity_name()).unwrap();
        let number = FrameNumber::from_integer(3).unwrap();
        let assembled = job.world.assemble(number, Some(FrameMesh { path, mesh }), None).unwrap();
        assert!(!assembled.frame.accel.is_in_motion(), "the shutter is closed");
        let sampling = Sampling::new(&job.world.description.render);
        let (image, _) = render_pixels(&assembled.frame, &sampling, &|_, _| ());
        let [now, next] = [3.0, 4.0].map(|frame| job.world.camera.at(frame));
        let (mut seen, mut longest) = (0, 0.0_f32);
        for pixel in image.pixels.iter().filter(|pixel| pixel.alpha == 1.0) {
            let p = pixel.position.as_dvec3();
            let moved = p + 0.001 * velocity(p * 1000.0) / FPS;
            let origin = job.world.origin;
            let expected = place(&next, origin, size, moved) - place(&now, origin, size, p);
            assert!(pixel.motion.distance(expected) < 2e-3, "{} and {expected}", pixel.motion);
            (seen, longest) = (seen + 1, longest.max(expected.length()));
        }
        assert!(seen > 200 && longest > 0.3, "{seen} pixels, {longest}");
    }
}
