//! The few functions of Embree 4 that the benchmark calls, found in its shared library at run time.
//!
//! All unsafe code of the benchmark is here. Names, numbers and layouts are those of `embree4/rtcore*.h`.
//! A [`Scene`] owns what it lent to Embree (device, vertices, indices), and Embree is told to run on one thread,
//! so that nothing is read after it was freed or while it is written.

#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::ptr;
use std::rc::Rc;

use floe::geometry::Ray;
use glam::Vec3;
use libloading::Library;

/// `RTCRayHit`: a ray, and what it met.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
pub struct RayHit {
    ray: RtcRay,
    hit: RtcHit,
}

#[derive(Clone, Copy)]
#[repr(C, align(16))]
struct RtcRay {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    t_far: f32,
    mask: u32,
    id: u32,
    flags: u32,
}

#[derive(Clone, Copy)]
#[repr(C, align(16))]
struct RtcHit {
    normal: [f32; 3],
    u: f32,
    v: f32,
    primitive: u32,
    geometry: u32,
    instance: u32,
    /// Since 4.4; older versions leave it alone.
    instance_primitive: u32,
}

/// `RTC_INVALID_GEOMETRY_ID`.
const INVALID: u32 = u32::MAX;

impl RayHit {
    /// A ray that has met nothing.
    pub fn new(ray: &Ray) -> Self {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let t_far = ray.t_max;
        Self {
            ray: RtcRay { origin, t_near: 0.0, direction, time: 0.0, t_far, mask: u32::MAX, id: 0, flags: 0 },
            hit: RtcHit {
                normal: [0.0; 3],
                u: 0.0,
                v: 0.0,
                primitive: INVALID,
                geometry: INVALID,
                instance: INVALID,
                instance_primitive: INVALID,
            },
        }
    }
}

/// How a scene is built and traced.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `RTC_BUILD_QUALITY_MEDIUM`, the default.
    Fast,
    /// The same with `RTC_SCENE_FLAG_ROBUST`, which does not leak at edges.
    Robust,
    /// Robust, and refitted when vertices move.
    RobustRefit,
}

type Handle = *mut c_void;

/// Functions by their names in the library.
struct Functions {
    release_device: unsafe extern "C" fn(Handle),
    device_error: unsafe extern "C" fn(Handle) -> c_int,
    new_scene: unsafe extern "C" fn(Handle) -> Handle,
    release_scene: unsafe extern "C" fn(Handle),
    set_scene_flags: unsafe extern "C" fn(Handle, c_int),
    set_scene_quality: unsafe extern "C" fn(Handle, c_int),
    commit_scene: unsafe extern "C" fn(Handle),
    new_geometry: unsafe extern "C" fn(Handle, c_int) -> Handle,
    release_geometry: unsafe extern "C" fn(Handle),
    set_geometry_quality: unsafe extern "C" fn(Handle, c_int),
    share_buffer: unsafe extern "C" fn(Handle, c_int, c_uint, c_int, *const c_void, usize, usize, usize),
    update_buffer: unsafe extern "C" fn(Handle, c_int, c_uint),
    commit_geometry: unsafe extern "C" fn(Handle),
    attach_geometry: unsafe extern "C" fn(Handle, Handle) -> c_uint,
    intersect: unsafe extern "C" fn(Handle, *mut RayHit, *mut c_void),
    occluded: unsafe extern "C" fn(Handle, *mut RtcRay, *mut c_void),
}

/// Embree on one thread.
pub struct Device {
    functions: Functions,
    handle: Handle,
    /// Keeps the functions in memory.
    _library: Library,
}

impl Device {
    /// Opens the library at `path`; others that it needs lie beside it. `config` is added to the device's.
    ///
    /// # Errors
    /// What cannot be opened, found, or started.
    pub fn open(path: &str, config: &str) -> Result<Rc<Self>, String> {
        let config = CString::new(format!("threads=1,set_affinity=0,{config}"))
            .map_err(|e| format!("EMBREE_CONFIG: {e}"))?;
        // SAFETY: the caller names a build of Embree 4, whose functions have these signatures; the library stays
        // open as long as they can be called.
        unsafe {
            let library = Library::new(path).map_err(|e| format!("EMBREE_LIBRARY: {e}"))?;
            macro_rules! function {
                ($name:literal) => {
                    *library.get($name).map_err(|e| format!("{path} is no Embree 4: {e}"))?
                };
            }
            let new_device: unsafe extern "C" fn(*const c_char) -> Handle = function!(b"rtcNewDevice\0");
            let functions = Functions {
                release_device: function!(b"rtcReleaseDevice\0"),
                device_error: function!(b"rtcGetDeviceError\0"),
                new_scene: function!(b"rtcNewScene\0"),
                release_scene: function!(b"rtcReleaseScene\0"),
                set_scene_flags: function!(b"rtcSetSceneFlags\0"),
                set_scene_quality: function!(b"rtcSetSceneBuildQuality\0"),
                commit_scene: function!(b"rtcCommitScene\0"),
                new_geometry: function!(b"rtcNewGeometry\0"),
                release_geometry: function!(b"rtcReleaseGeometry\0"),
                set_geometry_quality: function!(b"rtcSetGeometryBuildQuality\0"),
                share_buffer: function!(b"rtcSetSharedGeometryBuffer\0"),
                update_buffer: function!(b"rtcUpdateGeometryBuffer\0"),
                commit_geometry: function!(b"rtcCommitGeometry\0"),
                attach_geometry: function!(b"rtcAttachGeometry\0"),
                intersect: function!(b"rtcIntersect1\0"),
                occluded: function!(b"rtcOccluded1\0"),
            };
            // Only version 4 takes the arguments of a query last and optional.
            let _: unsafe extern "C" fn() = function!(b"rtcGetGeometryUserDataFromScene\0");
            let handle = new_device(config.as_ptr());
            if handle.is_null() {
                return Err(format!("{path}: no device"));
            }
            Ok(Rc::new(Self { functions, handle, _library: library }))
        }
    }

    fn check(&self) -> Result<(), String> {
        // SAFETY: the device is alive.
        let code = unsafe { (self.functions.device_error)(self.handle) };
        if code == 0 { Ok(()) } else { Err(format!("Embree reports error {code}")) }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: scenes hold the device, so that it goes last.
        unsafe { (self.functions.release_device)(self.handle) }
    }
}

/// A committed scene of one triangle mesh.
pub struct Scene {
    device: Rc<Device>,
    handle: Handle,
    geometry: Handle,
    /// Lent to Embree, with a vertex to spare at the end: it reads 16 bytes of each.
    positions: Vec<Vec3>,
    /// Lent to Embree.
    _triangles: Vec<[u32; 3]>,
}

impl Scene {
    /// Takes what [`padded`] made and a copy of the triangles, and builds.
    ///
    /// # Errors
    /// Embree's error number.
    pub fn build(
        device: &Rc<Device>,
        kind: Kind,
        positions: Vec<Vec3>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, String> {
        // RTC_SCENE_FLAG_DYNAMIC = 1, _ROBUST = 4; RTC_BUILD_QUALITY_LOW = 0, _MEDIUM = 1, _REFIT = 3. A geometry is
        // refitted only in scenes of low quality, which have a tree a geometry.
        let (flags, scene_quality, geometry_quality) = match kind {
            Kind::Fast => (0, 1, 1),
            Kind::Robust => (4, 1, 1),
            Kind::RobustRefit => (5, 0, 3),
        };
        let f = &device.functions;
        // SAFETY: the handles come from the same device; the scene returned owns both buffers, whose formats are
        // RTC_FORMAT_UINT3 = 0x5003 and RTC_FORMAT_FLOAT3 = 0x9003, and does not grow or shrink them.
        let (handle, geometry) = unsafe {
            let handle = (f.new_scene)(device.handle);
            (f.set_scene_flags)(handle, flags);
            (f.set_scene_quality)(handle, scene_quality);
            let geometry = (f.new_geometry)(device.handle, 0);
            (f.set_geometry_quality)(geometry, geometry_quality);
            (f.share_buffer)(geometry, 0, 0, 0x5003, triangles.as_ptr().cast(), 0, 12, triangles.len());
            (f.share_buffer)(geometry, 1, 0, 0x9003, positions.as_ptr().cast(), 0, 12, positions.len() - 1);
            (f.commit_geometry)(geometry);
            (f.attach_geometry)(handle, geometry);
            (f.commit_scene)(handle);
            (handle, geometry)
        };
        let scene = Self { device: Rc::clone(device), handle, geometry, positions, _triangles: triangles };
        device.check()?;
        Ok(scene)
    }

    /// Moves the vertices without telling Embree yet.
    pub fn set_positions(&mut self, positions: &[Vec3]) {
        self.positions[..positions.len()].copy_from_slice(positions);
    }

    /// Brings the tree up to date with the moved vertices.
    ///
    /// # Errors
    /// Embree's error number.
    pub fn update(&mut self) -> Result<(), String> {
        let f = &self.device.functions;
        // SAFETY: both handles are alive, and so is the buffer.
        unsafe {
            (f.update_buffer)(self.geometry, 1, 0);
            (f.commit_geometry)(self.geometry);
            (f.commit_scene)(self.handle);
        }
        self.device.check()
    }

    /// Distance to what the ray meets first.
    #[inline]
    pub fn closest(&self, ray: &RayHit) -> Option<f32> {
        let mut ray = *ray;
        // SAFETY: the scene is committed and the ray has the layout of RTCRayHit.
        unsafe { (self.device.functions.intersect)(self.handle, &raw mut ray, ptr::null_mut()) };
        (ray.hit.geometry != INVALID).then_some(ray.ray.t_far)
    }

    /// True when the ray meets anything.
    #[inline]
    pub fn occluded(&self, ray: &RayHit) -> bool {
        let mut ray = ray.ray;
        // SAFETY: the scene is committed and the ray has the layout of RTCRay.
        unsafe { (self.device.functions.occluded)(self.handle, &raw mut ray, ptr::null_mut()) };
        // A ray that is blocked comes back with its end at minus infinity.
        ray.t_far < 0.0
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        let f = &self.device.functions;
        // SAFETY: both were made by `build` and are released once, before the buffers.
        unsafe {
            (f.release_geometry)(self.geometry);
            (f.release_scene)(self.handle);
        }
    }
}

/// A copy with a vertex to spare, as Embree wants its buffers.
pub fn padded(positions: &[Vec3]) -> Vec<Vec3> {
    positions.iter().copied().chain([Vec3::ZERO]).collect()
}
