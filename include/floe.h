// Renders fluid interfaces that are in memory. Written by cbindgen from src/capi; README.md tells how to use it.

#ifndef FLOE_H
#define FLOE_H

#include <stddef.h>
#include <stdint.h>

// How a call ended. `floe_error_message` has the words.
typedef enum {
  // It did what it was to do.
  FLOE_STATUS_OK = 0,
  // A pointer is null or not aligned, a text is not UTF-8, a count or a number is none that there can be.
  FLOE_STATUS_BAD_ARGUMENT = 2,
  // There is no mesh to be rendered, or no picture yet.
  FLOE_STATUS_TOO_EARLY = 3,
  // A mesh, or a file that the scene names, is wrong.
  FLOE_STATUS_BAD_DATA = 65,
  // A file is not there.
  FLOE_STATUS_MISSING = 66,
  // floe itself or the machine failed.
  FLOE_STATUS_INTERNAL = 70,
  // A picture cannot be created.
  FLOE_STATUS_CANNOT_CREATE = 73,
  // A picture cannot be written.
  FLOE_STATUS_CANNOT_WRITE = 74,
  // `floe_interrupt` stopped it.
  FLOE_STATUS_INTERRUPTED = 75,
  // The scene is wrong, or has no medium for a label of the mesh.
  FLOE_STATUS_BAD_SCENE = 78,
} FloeStatus;

// A scene that is open.
typedef struct FloeScene FloeScene;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version, such as "0.1.0". It is never freed.
const char *floe_version(void);

// Opens a scene file. Its `frames.path` is not looked for: frames come from `floe_set_mesh`. `threads` is how many render,
// 0 for all cores. The scene is freed by `floe_free`; `*scene` is null when the call fails.
//
// # Safety
// `path` is a text that ends with a zero, `scene` a place for a pointer.
FloeStatus floe_scene_open(const char *path,
                           uint32_t threads,
                           FloeScene **scene);

// Opens the scene of a text, as a scene file has it. Files that it names are looked for in `folder`, the current one if
// that is null. Otherwise as `floe_scene_open`.
//
// # Safety
// `scene_text` and, unless null, `folder` are texts that end with a zero, `scene` is a place for a pointer.
FloeStatus floe_scene_parse(const char *scene_text,
                            const char *folder,
                            uint32_t threads,
                            FloeScene **scene);

// Sets the mesh of the next frame, which `floe_render` takes: each frame needs one. The arrays are copied and may change
// when the call is over.
//
// `positions` has 3 numbers a vertex, in units of `frames.scale`; `velocities` 3 a vertex, in those units per second, or
// is null. `triangles` has 3 vertex indices a triangle, counter-clockwise seen from its front; `labels` 2 a triangle, the
// one in front and the one behind, or is null for a closed mesh whose inside is `frames.inside`.
//
// # Safety
// The scene is open; the arrays are as long as that and do not change meanwhile.
FloeStatus floe_set_mesh(FloeScene *scene,
                         const double *positions,
                         const float *velocities,
                         size_t vertex_count,
                         const uint32_t *triangles,
                         const int32_t *labels,
                         size_t triangle_count);

// As `floe_set_mesh`, with positions in single precision.
//
// # Safety
// As for `floe_set_mesh`.
FloeStatus floe_set_mesh_float(FloeScene *scene,
                               const float *positions,
                               const float *velocities,
                               size_t vertex_count,
                               const uint32_t *triangles,
                               const int32_t *labels,
                               size_t triangle_count);

// Renders the mesh as the frame of this number, which tells the place of a camera that moves, and the random numbers.
// Nothing is denoised.
//
// # Safety
// The scene is open, and not freed before the call is over.
FloeStatus floe_render(FloeScene *scene,
                       int64_t frame);

// Asks the frame that is being rendered to stop, or the next one where there is none; from any thread.
//
// # Safety
// The scene is open.
FloeStatus floe_interrupt(FloeScene *scene);

// Columns and rows of the pictures.
//
// # Safety
// The scene is open, `width` and `height` are places for numbers.
FloeStatus floe_size(const FloeScene *scene, uint32_t *width, uint32_t *height);

// Copies the picture that was rendered last: red, green, blue and alpha of each pixel, row after row from the top, linear
// Rec. 709. `float_count` has to be 4 times width times height.
//
// # Safety
// The scene is open, `rgba` a place for so many numbers.
FloeStatus floe_pixels(const FloeScene *scene,
                       float *rgba,
                       size_t float_count);

// The estimated relative error of the picture that was rendered last, and the ends of its interval: NaN where fewer than
// two replicates tell nothing, infinity where there is no upper end.
//
// # Safety
// The scene is open, the others are places for numbers.
FloeStatus floe_relative_error(const FloeScene *scene,
                               double *estimate,
                               double *low,
                               double *high);

// What the ledger says of the picture that was rendered last, as one JSON object: triangles, seconds, rays, warnings. Null
// when there is no picture; else it stays until this thread asks again.
//
// # Safety
// The scene is open.
const char *floe_record(const FloeScene *scene);

// Writes the picture that was rendered last, whole or not at all: a name that ends with .png is a PNG; one that ends with
// .exr is OpenEXR, with a PNG beside it unless the scene says `output.png = false`.
//
// # Safety
// The scene is open, `path` a text that ends with a zero.
FloeStatus floe_write(const FloeScene *scene,
                      const char *path);

// Why the last call on this scene that failed did, from whichever thread it was; of a null `scene`, the last one of this
// thread without a scene, such as `floe_scene_open`. Never null; it stays until this thread asks again.
//
// # Safety
// The scene is open, or null.
const char *floe_error_message(const FloeScene *scene);

// Frees a scene; null is nothing.
//
// # Safety
// The scene is open, no other thread uses it, and it is not used again.
void floe_free(FloeScene *scene);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* FLOE_H */
