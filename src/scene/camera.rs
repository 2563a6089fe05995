//! The camera: a pinhole, or a thin lens.
//!
//! ```text
//! pinhole:  o = eye,       d = c,             c = forward + tan(fov_x / 2) ((2 x / W - 1) right + (1 - 2 y / H) (H / W) up)
//! lens:     o = eye + l,   d = f c - l                                                        [PHARR23 section 5.2.3]
//! ```
//! with (x, y) in pixels from the upper left corner of the picture, l on a disc of the aperture's diameter perpendicular to
//! the view, and f the depth at which all rays of a point of the picture meet: there the picture is sharp.

use glam::{DVec3, Mat4, Vec2, Vec3, Vec4};

use crate::geometry::Ray;
use crate::geometry::elementary::tan;
use crate::sampling::warp;
use crate::scene::description::FieldOfView;

/// A camera at a point, in metres from the scene's origin.
#[derive(Clone, Debug)]
pub struct Camera {
    eye: Vec3,
    forward: Vec3,
    right: Vec3,
    up: Vec3,
    /// Tangents of half the field of view, across and down.
    extent: Vec2,
    resolution: [u32; 2],
    /// Radius of the lens, and the depth that is in focus.
    lens: Option<(f32, f32)>,
}

impl Camera {
    /// A camera at `eye` that looks at `target`; both relative to the scene's origin.
    ///
    /// An `up` along the line of sight is replaced by whatever axis is farthest from it.
    pub fn new(eye: DVec3, target: DVec3, up: Vec3, fov: FieldOfView, resolution: [u32; 2]) -> Self {
        let forward = (target - eye).normalize();
        let up = up.as_dvec3();
        let up = if forward.cross(up).length() > 1e-6 * up.length() { up } else { farthest_axis(forward) };
        let right = forward.cross(up).normalize();
        let [width, height] = resolution.map(|n| n as f32);
        let half = |degrees: f32| tan(0.5 * degrees.to_radians());
        let extent = match fov {
            FieldOfView::Horizontal(degrees) => Vec2::new(half(degrees), half(degrees) * height / width),
            FieldOfView::Vertical(degrees) => Vec2::new(half(degrees) * width / height, half(degrees)),
        };
        Self {
            eye: eye.as_vec3(),
            forward: forward.as_vec3(),
            right: right.as_vec3(),
            up: right.cross(forward).as_vec3(),
            extent,
            resolution,
            lens: None,
        }
    }

    /// The same camera with a lens of a diameter that sees sharp at a depth, both in metres; no diameter is a pinhole.
    #[must_use]
    pub fn with_lens(self, aperture: f32, focus: f32) -> Self {
        Self { lens: (aperture > 0.0).then_some((0.5 * aperture, focus)), ..self }
    }

    /// False for a pinhole.
    pub fn has_lens(&self) -> bool {
        self.lens.is_some()
    }

    /// Points at the rim of the lens, or the pinhole.
    pub fn rim(&self) -> impl Iterator<Item = Vec3> {
        let radius = self.lens.map_or(0.0, |lens| lens.0);
        let sides = [self.right, self.up, -self.right, -self.up].map(|side| self.eye + side * radius);
        sides.into_iter().take(if radius > 0.0 { 4 } else { 1 })
    }

    /// Width and height in pixels.
    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    /// Where the camera is.
    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    /// The ray from the middle of the lens through a point of the picture, in pixels from the upper left corner.
    pub fn ray(&self, x: f32, y: f32) -> Ray {
        Ray::new(self.eye, self.towards(x, y).normalize())
    }

    /// The ray from a point of the lens, drawn with `u`.
    pub fn ray_through_lens(&self, x: f32, y: f32, u: [f32; 2]) -> Ray {
        let Some((radius, focus)) = self.lens else { return self.ray(x, y) };
        let on_disc = warp::disc(u) * radius;
        let on_lens = self.right * on_disc.x + self.up * on_disc.y;
        Ray::new(self.eye + on_lens, (self.towards(x, y) * focus - on_lens).normalize())
    }

    /// Towards a point of the picture, one metre deep.
    #[inline]
    fn towards(&self, x: f32, y: f32) -> Vec3 {
        let [width, height] = self.resolution.map(|n| n as f32);
        let across = self.right * (self.extent.x * (2.0 * x / width - 1.0));
        let down = self.up * (self.extent.y * (1.0 - 2.0 * y / height));
        self.forward + across + down
    }

    /// Where a point is in the picture, in pixels from the upper left corner, seen through the middle of the lens.
    pub fn pixel(&self, point: Vec3) -> Vec2 {
        let [width, height] = self.resolution.map(|n| n as f32);
        let relative = point - self.eye;
        let scaled = relative.dot(self.forward) * self.extent;
        let x = relative.dot(self.right) / scaled.x;
        let y = relative.dot(self.up) / scaled.y;
        Vec2::new(0.5 * (1.0 + x) * width, 0.5 * (1.0 - y) * height)
    }

    /// Depth of a point along the viewing axis, in metres.
    pub fn depth(&self, point: Vec3) -> f32 {
        (point - self.eye).dot(self.forward)
    }

    /// World (metres, true origin) to camera space: x right, y up, z along the view. `origin` is the scene's.
    pub fn world_to_camera(&self, origin: DVec3) -> Mat4 {
        let eye = origin + self.eye.as_dvec3();
        let axes = [self.right, self.up, self.forward].map(Vec3::as_dvec3);
        let rows = axes.map(|a| a.as_vec3().extend(-a.dot(eye) as f32));
        Mat4::from_cols(rows[0], rows[1], rows[2], Vec4::W).transpose()
    }

    /// World to the picture: after division by w, (0, 0) is its upper left corner and (1, 1) its lower right one.
    pub fn world_to_ndc(&self, origin: DVec3) -> Mat4 {
        let project = Mat4::from_cols(
            Vec4::X * (0.5 / self.extent.x),
            Vec4::Y * (-0.5 / self.extent.y),
            Vec4::new(0.5, 0.5, 1.0, 1.0),
            Vec4::ZERO,
        );
        project * self.world_to_camera(origin)
    }
}

fn farthest_axis(direction: DVec3) -> DVec3 {
    let a = direction.abs();
    if a.x <= a.y && a.x <= a.z {
        DVec3::X
    } else if a.y <= a.z {
        DVec3::Y
    } else {
        DVec3::Z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ray_formula_of_a_stated_camera() {
        // eye, target, fov and basis of a camera whose vectors were computed elsewhere in double precision.
        let camera = Camera::new(
            DVec3::new(0.3, 0.9, 4.0),
            DVec3::ZERO,
            Vec3::Y,
            FieldOfView::Horizontal(40.0),
            [96, 72],
        );
        let right = Vec3::new(0.997_199_3, 0.0, -0.074_789_95);
        let up = Vec3::new(-0.016_373_53, 0.975_741_3, -0.218_313_77);
        let forward = Vec3::new(-0.072_975_64, -0.218_926_92, -0.973_008_5);
        let half = 20.0_f32.to_radians().tan();
        for (x, y) in [(0.0, 0.0), (48.0, 36.0), (90.25, 3.5)] {
            let want = forward + half * ((2.0 * x / 96.0 - 1.0) * right + (1.0 - 2.0 * y / 72.0) * 0.75 * up);
            assert!((camera.ray(x, y).direction - want.normalize()).length() < 1e-6);
        }
    }

    #[test]
    fn matrices_take_a_ray_to_its_pixel() {
        let origin = DVec3::new(100.0, -50.0, 8.0);
        let eye = DVec3::new(0.25, 0.5, -0.125);
        let camera =
            Camera::new(eye, DVec3::new(1.0, 2.0, 3.0), Vec3::Z, FieldOfView::Vertical(50.0), [64, 32]);
        let point = camera.ray(16.0, 8.0).at(5.0);
        let world = point + origin.as_vec3();
        let ndc = camera.world_to_ndc(origin) * world.extend(1.0);
        assert!((ndc.w - camera.depth(point)).abs() < 1e-3);
        // Pixel (16, 8) of 64 x 32 is a quarter of the way across and down.
        assert!((ndc.x / ndc.w - 0.25).abs() < 1e-4 && (ndc.y / ndc.w - 0.25).abs() < 1e-4);
    }

    /// Rays from all over the lens meet at the depth in focus and nowhere else: at depth z the blur is a disc of diameter
    /// aperture |z / f - 1|.
    #[test]
    fn a_lens_is_sharp_at_its_depth_of_focus_only() {
        let pinhole = Camera::new(DVec3::ZERO, DVec3::X, Vec3::Z, FieldOfView::Vertical(50.0), [64, 32]);
        let camera = pinhole.clone().with_lens(0.2, 3.0);
        let towards = pinhole.ray(20.0, 25.0).direction;
        for i in 0..200_u32 {
            let u = [i as f32 / 200.0, (i * 89 % 200) as f32 / 200.0];
            let ray = camera.ray_through_lens(20.0, 25.0, u);
            let beside = |depth: f32| {
                ray.at((depth - ray.origin.x) / ray.direction.x).distance(towards * (depth / towards.x))
            };
            assert!(beside(3.0) < 1e-6);
            let offset = ray.origin.length();
            assert!(ray.origin.x == 0.0 && offset <= 0.1 * 1.000_001);
            // Of a metre some 20 roundings.
            assert!((beside(1.5) - 0.5 * offset).abs() < 2e-6 && (beside(9.0) - 2.0 * offset).abs() < 2e-6);
        }
        assert_eq!(pinhole.ray_through_lens(3.0, 4.0, [0.9, 0.1]).direction, pinhole.ray(3.0, 4.0).direction);
    }

    #[test]
    fn pixels_are_where_rays_come_from() {
        let camera = Camera::new(
            DVec3::new(1.0, 2.0, 3.0),
            DVec3::ZERO,
            Vec3::Y,
            FieldOfView::Horizontal(70.0),
            [640, 360],
        );
        for pixel in [Vec2::new(0.0, 0.0), Vec2::new(320.5, 11.25), Vec2::new(639.0, 359.0)] {
            assert!(camera.pixel(camera.ray(pixel.x, pixel.y).at(7.0)).distance(pixel) < 1e-3);
        }
    }

    #[test]
    fn looking_straight_up_still_has_a_picture() {
        let camera = Camera::new(DVec3::ZERO, DVec3::Z, Vec3::Z, FieldOfView::Vertical(40.0), [4, 4]);
        assert!(camera.ray(1.0, 2.0).direction.is_finite());
    }
}
