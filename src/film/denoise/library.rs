//! The C interface of Open Image Denoise 2, as far as one filter on the processor needs it.
//!
//! Functions are looked up by name in a library that is loaded at run time,
//! and called with pointers to pictures. Signatures are those of `oidn.h`, which all versions 2.x keep.
#![allow(unsafe_code)]

use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::ptr::null;

use super::DenoiseError;

/// `OIDN_DEVICE_TYPE_CPU`: it takes pictures in ordinary memory.
const CPU: c_int = 1;

/// `OIDN_FORMAT_FLOAT3`.
const FLOAT3: c_int = 3;

/// The names of the library, without its folder.
const NAMES: [&str; 4] = [
    "libOpenImageDenoise.so.2",
    "libOpenImageDenoise.so",
    "libOpenImageDenoise.2.dylib",
    "OpenImageDenoise.dll",
];

type Handle = *mut c_void;
type NewDevice = unsafe extern "C" fn(c_int) -> Handle;
type NewFilter = unsafe extern "C" fn(Handle, *const c_char) -> Handle;
type OnHandle = unsafe extern "C" fn(Handle);
type SetBool = unsafe extern "C" fn(Handle, *const c_char, bool);
type SetImage =
    unsafe extern "C" fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);
type GetError = unsafe extern "C" fn(Handle, *mut *const c_char) -> c_int;

/// The library with the functions that are used.
#[derive(Debug)]
pub(super) struct Library {
    new_device: NewDevice,
    commit_device: OnHandle,
    release_device: OnHandle,
    device_error: GetError,
    new_filter: NewFilter,
    set_image: SetImage,
    set_bool: SetBool,
    commit_filter: OnHandle,
    execute_filter: OnHandle,
    release_filter: OnHandle,
    /// What the functions are part of; it has to outlive them.
    _library: libloading::Library,
}

impl Library {
    /// Loads the library that `FLOE_OIDN` names, or the first that the system finds.
    pub(super) fn load() -> Result<Self, DenoiseError> {
        let mut tried = Vec::new();
        for name in candidates(std::env::var_os("FLOE_OIDN").map(PathBuf::from).as_deref()) {
            // SAFETY: loading runs the initialisers of a library that the user has installed or named for this purpose.
            match unsafe { libloading::Library::new(&name) }.and_then(Self::with_functions) {
                Ok(library) => return Ok(library),
                Err(error) => tried.push(format!("{}: {error}", name.display())),
            }
        }
        Err(DenoiseError::NotFound { tried: tried.join("; ") })
    }

    fn with_functions(library: libloading::Library) -> Result<Self, libloading::Error> {
        // SAFETY: the types are those of the functions of these names in `oidn.h` of version 2. Version 1 has no
        // `oidnSetFilterBool`, so it is refused here. The pointers are kept with the library that they point into.
        unsafe {
            Ok(Self {
                new_device: *library.get(b"oidnNewDevice\0")?,
                commit_device: *library.get(b"oidnCommitDevice\0")?,
                release_device: *library.get(b"oidnReleaseDevice\0")?,
                device_error: *library.get(b"oidnGetDeviceError\0")?,
                new_filter: *library.get(b"oidnNewFilter\0")?,
                set_image: *library.get(b"oidnSetSharedFilterImage\0")?,
                set_bool: *library.get(b"oidnSetFilterBool\0")?,
                commit_filter: *library.get(b"oidnCommitFilter\0")?,
                execute_filter: *library.get(b"oidnExecuteFilter\0")?,
                release_filter: *library.get(b"oidnReleaseFilter\0")?,
                _library: library,
            })
        }
    }

    /// Filters a picture of width x height pixels with its albedo and normals.
    pub(super) fn run(
        &self,
        size: [u32; 2],
        colour: &[[f32; 3]],
        guides: &[Vec<[f32; 3]>; 2],
    ) -> Result<Vec<[f32; 3]>, DenoiseError> {
        let [width, height] = size.map(|n| n as usize);
        let fits = |layer: &[[f32; 3]]| layer.len() == width * height;
        if !fits(colour) || !guides.iter().all(|guide| fits(guide)) {
            return Err(DenoiseError::Failed { reason: "the layers have different sizes".into() });
        }
        let mut output = vec![[0.0_f32; 3]; colour.len()];
        let layers = [(c"color", colour), (c"albedo", &guides[0]), (c"normal", &guides[1])];
        // SAFETY: every picture has width x height pixels of three tightly packed floats, as checked above, and outlives
        // the filter, which is released before this block ends. The library writes to `output` alone. Handles that it
        // could not make are null, which its functions take as errors that the device reports.
        unsafe {
            let device = (self.new_device)(CPU);
            (self.commit_device)(device);
            let filter = (self.new_filter)(device, c"RT".as_ptr());
            let set = |name: &CStr, pixels: *mut c_void| {
                (self.set_image)(filter, name.as_ptr(), pixels, FLOAT3, width, height, 0, 0, 0);
            };
            for (name, layer) in layers {
                set(name, layer.as_ptr().cast_mut().cast());
            }
            set(c"output", output.as_mut_ptr().cast());
            (self.set_bool)(filter, c"hdr".as_ptr(), true);
            (self.commit_filter)(filter);
            (self.execute_filter)(filter);
            let outcome = self.outcome(device);
            (self.release_filter)(filter);
            (self.release_device)(device);
            outcome?;
        }
        Ok(output)
    }

    /// The first error of a device.
    ///
    /// # Safety
    /// `device` is one of this library, or null.
    unsafe fn outcome(&self, device: Handle) -> Result<(), DenoiseError> {
        let mut message = null();
        // SAFETY: the library sets the message to a text that lives until the next call for this device, or leaves it.
        let reason = unsafe {
            if (self.device_error)(device, &raw mut message) == 0 {
                return Ok(());
            }
            if message.is_null() {
                "no reason".into()
            } else {
                CStr::from_ptr(message).to_string_lossy().into_owned()
            }
        };
        Err(DenoiseError::Failed { reason })
    }
}

/// Where the library may be.
fn candidates(named: Option<&Path>) -> Vec<PathBuf> {
    match named {
        Some(folder) if folder.is_dir() => NAMES.iter().map(|name| folder.join(name)).collect(),
        Some(file) => vec![file.into()],
        None => NAMES.iter().map(PathBuf::from).collect(),
    }
}
