//! The calls. Each checks its arguments, does its work where a panic is caught, and keeps what went wrong.
//!
//! The unsafe code of this file reads and writes where the caller points. What the caller promises is said at each call;
//! null and not aligned pointers are refused.
#![allow(unsafe_code)]

use std::ffi::{CStr, c_char};
use std::path::Path;
use std::ptr;
use std::slice;

use super::message;
use super::scene::Scene;
use super::status::{Failure, Status};
use crate::driver::Renderer;
use crate::driver::guard::caught;
use crate::mesh::{MeshSlices, Positions, RawMesh};

/// The version, such as "0.1.0". It is never freed.
#[unsafe(no_mangle)]
pub extern "C" fn floe_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// Opens a scene file. Its `frames.path` is not looked for: frames come from `floe_set_mesh`. `threads` is how many render,
/// 0 for all cores. The scene is freed by `floe_free`; `*scene` is null when the call fails.
///
/// # Safety
/// `path` is a text that ends with a zero, `scene` a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_scene_open(
    path: *const c_char,
    threads: u32,
    scene: *mut *mut Scene,
) -> Status {
    // SAFETY: the caller's promises are passed on.
    unsafe {
        opened(scene, || {
            let path = text(path, "path")?;
            Scene::new(threads, |options| Renderer::open(Path::new(path), options))
        })
    }
}

/// Opens the scene of a text, as a scene file has it. Files that it names are looked for in `folder`, the current one if
/// that is null. Otherwise as `floe_scene_open`.
///
/// # Safety
/// `scene_text` and, unless null, `folder` are texts that end with a zero, `scene` is a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_scene_parse(
    scene_text: *const c_char,
    folder: *const c_char,
    threads: u32,
    scene: *mut *mut Scene,
) -> Status {
    // SAFETY: the caller's promises are passed on.
    unsafe {
        opened(scene, || {
            let content = text(scene_text, "scene_text")?;
            let folder = if folder.is_null() { "" } else { text(folder, "folder")? };
            let file = Path::new(folder).join("scene in memory");
            Scene::new(threads, |options| Renderer::parse(content, &file, options))
        })
    }
}

/// Sets the mesh of the next frame, which `floe_render` takes: each frame needs one. The arrays are copied and may change
/// when the call is over.
///
/// `positions` has 3 numbers a vertex, in units of `frames.scale`; `velocities` 3 a vertex, in those units per second, or
/// is null. `triangles` has 3 vertex indices a triangle, counter-clockwise seen from its front; `labels` 2 a triangle, the
/// one in front and the one behind, or is null for a closed mesh whose inside is `frames.inside`.
///
/// # Safety
/// The scene is open; the arrays are as long as that and do not change meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_set_mesh(
    scene: *mut Scene,
    positions: *const f64,
    velocities: *const f32,
    vertex_count: usize,
    triangles: *const u32,
    labels: *const i32,
    triangle_count: usize,
) -> Status {
    // SAFETY: the caller's promises are passed on.
    unsafe {
        on(scene, |scene| {
            let positions = Positions::Double(tuples(positions, vertex_count, "positions")?);
            let vertices = (positions, velocities, vertex_count);
            scene.set_mesh(mesh_of(vertices, (triangles, labels, triangle_count))?)
        })
    }
}

/// As `floe_set_mesh`, with positions in single precision.
///
/// # Safety
/// As for `floe_set_mesh`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_set_mesh_float(
    scene: *mut Scene,
    positions: *const f32,
    velocities: *const f32,
    vertex_count: usize,
    triangles: *const u32,
    labels: *const i32,
    triangle_count: usize,
) -> Status {
    // SAFETY: the caller's promises are passed on.
    unsafe {
        on(scene, |scene| {
            let positions = Positions::Single(tuples(positions, vertex_count, "positions")?);
            let vertices = (positions, velocities, vertex_count);
            scene.set_mesh(mesh_of(vertices, (triangles, labels, triangle_count))?)
        })
    }
}

/// Renders the mesh as the frame of this number, which tells the place of a camera that moves, and the random numbers.
/// Nothing is denoised.
///
/// # Safety
/// The scene is open, and not freed before the call is over.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_render(scene: *mut Scene, frame: i64) -> Status {
    // SAFETY: the caller's promise is passed on.
    unsafe { on(scene, |scene| scene.render(frame)) }
}

/// Asks the frame that is being rendered to stop, or the next one where there is none; from any thread.
///
/// # Safety
/// The scene is open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_interrupt(scene: *mut Scene) -> Status {
    // SAFETY: the caller's promise is passed on.
    unsafe {
        on(scene, |scene| {
            scene.interrupt();
            Ok(())
        })
    }
}

/// Columns and rows of the pictures.
///
/// # Safety
/// The scene is open, `width` and `height` are places for numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_size(scene: *const Scene, width: *mut u32, height: *mut u32) -> Status {
    // SAFETY: the caller's promises are passed on; the places are checked.
    unsafe {
        on(scene, |scene| {
            let [columns, rows] = scene.resolution();
            put(width, columns, "width")?;
            put(height, rows, "height")
        })
    }
}

/// Copies the picture that was rendered last: red, green, blue and alpha of each pixel, row after row from the top, linear
/// Rec. 709. `float_count` has to be 4 times width times height.
///
/// # Safety
/// The scene is open, `rgba` a place for so many numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_pixels(scene: *const Scene, rgba: *mut f32, float_count: usize) -> Status {
    // SAFETY: the caller's promises are passed on; pointer and count are checked before anything is written.
    unsafe {
        on(scene, |scene| {
            let rendered = scene.rendered()?;
            let pixels = rendered.rgba();
            if float_count != 4 * pixels.len() {
                let message =
                    format!("float_count is {float_count}, but the picture has {} numbers", 4 * pixels.len());
                return Err(Failure::new(Status::BadArgument, message));
            }
            checked(rgba, "rgba")?;
            for (index, pixel) in pixels.enumerate() {
                ptr::copy_nonoverlapping(pixel.as_ptr(), rgba.add(4 * index), 4);
            }
            Ok(())
        })
    }
}

/// The estimated relative error of the picture that was rendered last, and the ends of its interval: NaN where fewer than
/// two replicates tell nothing, infinity where there is no upper end.
///
/// # Safety
/// The scene is open, the others are places for numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_relative_error(
    scene: *const Scene,
    estimate: *mut f64,
    low: *mut f64,
    high: *mut f64,
) -> Status {
    // SAFETY: the caller's promises are passed on; the places are checked.
    unsafe {
        on(scene, |scene| {
            let error = scene.rendered()?.record.relative_error;
            put(estimate, error.map_or(f64::NAN, |error| error.estimate), "estimate")?;
            put(low, error.map_or(f64::NAN, |error| error.low), "low")?;
            put(high, error.map_or(f64::NAN, |error| error.high), "high")
        })
    }
}

/// What the ledger says of the picture that was rendered last, as one JSON object: triangles, seconds, rays, warnings. Null
/// when there is no picture; else it stays until this thread asks again.
///
/// # Safety
/// The scene is open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_record(scene: *const Scene) -> *const c_char {
    let mut record = ptr::null();
    // SAFETY: the caller's promise is passed on.
    unsafe {
        on(scene, |scene| {
            let text = serde_json::to_string(&scene.rendered()?.record)
                .map_err(|error| Failure::new(Status::Internal, error.to_string()))?;
            record = message::lend_record(text);
            Ok(())
        });
    }
    record
}

/// Writes the picture that was rendered last, whole or not at all: a name that ends with .png is a PNG; one that ends with
/// .exr is OpenEXR, with a PNG beside it unless the scene says `output.png = false`.
///
/// # Safety
/// The scene is open, `path` a text that ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_write(scene: *const Scene, path: *const c_char) -> Status {
    // SAFETY: the caller's promises are passed on.
    unsafe {
        on(scene, |scene| {
            let path = Path::new(text(path, "path")?);
            let rendered = scene.rendered()?;
            let ends_with = |ending| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
            if ends_with("png") {
                return Ok(rendered.write_png(path)?);
            }
            if ends_with("exr") {
                return Ok(rendered.write(path)?);
            }
            let message = format!("{}: the name of a picture ends with .exr or .png", path.display());
            Err(Failure::new(Status::BadArgument, message))
        })
    }
}

/// Why the last call on this scene that failed did, from whichever thread it was; of a null `scene`, the last one of this
/// thread without a scene, such as `floe_scene_open`. Never null; it stays until this thread asks again.
///
/// # Safety
/// The scene is open, or null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_error_message(scene: *const Scene) -> *const c_char {
    // SAFETY: the caller's promise; a null pointer is no scene.
    let scene = unsafe { scene.as_ref() };
    let lent = caught(|| message::lend_message(scene.map_or_else(message::without_scene, Scene::message)));
    lent.unwrap_or(c"".as_ptr())
}

/// Frees a scene; null is nothing.
///
/// # Safety
/// The scene is open, no other thread uses it, and it is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floe_free(scene: *mut Scene) {
    if !scene.is_null() {
        // SAFETY: it was made by `Box::into_raw`, and the caller promises that nobody else has it.
        let scene = unsafe { Box::from_raw(scene) };
        // Threads that cannot be joined are no reason to end the process.
        let _ = caught(move || drop(scene));
    }
}

/// Puts a scene where the caller wants it.
unsafe fn opened(scene: *mut *mut Scene, open: impl FnOnce() -> Result<Scene, Failure>) -> Status {
    let outcome = flat(caught(|| {
        // SAFETY: the caller's promise; the pointer is checked.
        unsafe { put(scene, ptr::null_mut(), "scene") }?;
        let made = Box::into_raw(Box::new(open()?));
        // SAFETY: as before.
        unsafe { put(scene, made, "scene") }
    }));
    concluded(outcome, |message| message::keep_without_scene(&message))
}

/// Does some work on a scene.
unsafe fn on(scene: *const Scene, work: impl FnOnce(&Scene) -> Result<(), Failure>) -> Status {
    // SAFETY: the caller's promise; a null pointer is no scene.
    let Some(scene) = (unsafe { scene.as_ref() }) else {
        let failure = Failure::new(Status::BadArgument, "scene is null; open one first");
        return concluded(Err(failure), |message| message::keep_without_scene(&message));
    };
    concluded(flat(caught(|| work(scene))), |message| scene.keep_message(message))
}

/// A panic is a failure like another.
fn flat(outcome: Result<Result<(), Failure>, String>) -> Result<(), Failure> {
    let fault = |reason| format!("floe fails ({reason}), which is a fault of floe: please report it");
    outcome.unwrap_or_else(|reason| Err(Failure::new(Status::Internal, fault(reason))))
}

fn concluded(outcome: Result<(), Failure>, keep: impl FnOnce(String)) -> Status {
    match outcome {
        Ok(()) => Status::Ok,
        Err(Failure { status, message }) => {
            // A thread that is ending keeps no texts.
            let _ = caught(|| keep(message));
            status
        }
    }
}

type Vertices<'a> = (Positions<'a>, *const f32, usize);
type Triangles = (*const u32, *const i32, usize);

/// A copy of the caller's arrays.
unsafe fn mesh_of(
    (positions, velocities, vertices): Vertices<'_>,
    (triangles, labels, count): Triangles,
) -> Result<RawMesh, Failure> {
    // SAFETY: the caller's promises on the arrays; null ones are left out.
    let slices = unsafe {
        MeshSlices {
            positions,
            velocities: match velocities.is_null() {
                true => None,
                false => Some(tuples(velocities, vertices, "velocities")?),
            },
            triangles: tuples(triangles, count, "triangles")?,
            labels: match labels.is_null() {
                true => None,
                false => Some(tuples(labels, count, "labels")?),
            },
        }
    };
    Ok(slices.into())
}

/// Numbers of the caller, some at a time; of none the pointer may be anything.
unsafe fn tuples<'a, T, const N: usize>(
    first: *const T,
    count: usize,
    name: &str,
) -> Result<&'a [[T; N]], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    checked(first, name)?;
    if count > isize::MAX as usize / size_of::<[T; N]>() {
        let message = format!("{name}: {count} are more than fit into memory");
        return Err(Failure::new(Status::BadArgument, message));
    }
    // SAFETY: it is not null, aligned, no longer than an array can be, and as long as the caller promises.
    Ok(unsafe { slice::from_raw_parts(first.cast(), count) })
}

/// Writes where the caller wants it; nothing need be there before.
unsafe fn put<T: Copy>(place: *mut T, value: T, name: &str) -> Result<(), Failure> {
    checked(place, name)?;
    // SAFETY: it is neither null nor misaligned, and a place for a T as the caller promises.
    unsafe { place.write(value) };
    Ok(())
}

/// A text of the caller.
unsafe fn text<'a>(text: *const c_char, name: &str) -> Result<&'a str, Failure> {
    checked(text, name)?;
    // SAFETY: it is not null, and ends with a zero as the caller promises.
    let text = unsafe { CStr::from_ptr(text) };
    let message = format!("{name} is not UTF-8");
    text.to_str().map_err(|_| Failure::new(Status::BadArgument, message))
}

fn checked<T>(pointer: *const T, name: &str) -> Result<(), Failure> {
    let problem = match (pointer.is_null(), pointer.is_aligned()) {
        (true, _) => "is null",
        (_, false) => "is not aligned to the size of its numbers",
        _ => return Ok(()),
    };
    Err(Failure::new(Status::BadArgument, format!("{name} {problem}")))
}
