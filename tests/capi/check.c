// What tests/capi.rs asks of the library for C.
//
//     check SCENE FOLDER     renders frames 3 and 4 of a box with two scenes on two threads, writes their pixels into
//                            FOLDER/pixels_0 and FOLDER/pixels_1, and tries everything that has to be refused

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "floe.h"

#define CHECK(condition)                                                  \
  do {                                                                    \
    if (!(condition)) {                                                   \
      fprintf(stderr, "line %d: %s is not so\n", __LINE__, #condition);   \
      exit(1);                                                            \
    }                                                                     \
  } while (0)

enum { WIDTH = 24, HEIGHT = 16, FLOATS = 4 * WIDTH * HEIGHT };

static const uint32_t TRIANGLES[12][3] = {
    {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},
};

// A box that grows by an eighth a frame, so that single precision has its numbers too.
struct box {
  double positions[8][3];
  float single[8][3];
  float velocities[8][3];
  int32_t labels[12][2];
};

static struct box box(int frame) {
  struct box box;
  for (int corner = 0; corner < 8; corner++) {
    for (int axis = 0; axis < 3; axis++) {
      double sign = corner >> axis & 1 ? 1 : -1;
      box.positions[corner][axis] = sign * (0.25 + frame / 8.0);
      box.single[corner][axis] = (float)box.positions[corner][axis];
      box.velocities[corner][axis] = (float)sign;
    }
  }
  for (int triangle = 0; triangle < 12; triangle++) {
    box.labels[triangle][0] = 0;
    box.labels[triangle][1] = 1;
  }
  return box;
}

static FloeStatus set(FloeScene *scene, const struct box *box) {
  return floe_set_mesh(scene, &box->positions[0][0], &box->velocities[0][0], 8, &TRIANGLES[0][0], &box->labels[0][0], 12);
}

static void says(FloeScene *scene, const char *part) {
  const char *message = floe_error_message(scene);
  if (strstr(message, part) == NULL) {
    fprintf(stderr, "\"%s\" is not in \"%s\"\n", part, message);
    exit(1);
  }
}

static FloeScene *opened(const char *text) {
  FloeScene *scene;
  FloeStatus status = floe_scene_parse(text, NULL, 1, &scene);
  if (status != FLOE_STATUS_OK) fprintf(stderr, "%s\n", floe_error_message(NULL));
  CHECK(status == FLOE_STATUS_OK && scene != NULL);
  return scene;
}

struct job {
  const char *scene;
  const char *folder;
  int number;
};

static void *render(void *argument) {
  const struct job *job = argument;
  FloeScene *scene = opened(job->scene);
  char path[1024];
  snprintf(path, sizeof path, "%s/pixels_%d", job->folder, job->number);
  FILE *file = fopen(path, "wb");
  CHECK(file != NULL);
  for (int frame = 3; frame <= 4; frame++) {
    struct box now = box(frame);
    // One scene has its positions in double precision, the other in single precision.
    FloeStatus status = job->number == 0 ? set(scene, &now)
                                         : floe_set_mesh_float(scene, &now.single[0][0], &now.velocities[0][0], 8,
                                                               &TRIANGLES[0][0], &now.labels[0][0], 12);
    CHECK(status == FLOE_STATUS_OK);
    CHECK(floe_render(scene, frame) == FLOE_STATUS_OK);
    float pixels[FLOATS];
    CHECK(floe_pixels(scene, pixels, FLOATS) == FLOE_STATUS_OK);
    CHECK(fwrite(pixels, sizeof pixels, 1, file) == 1);
  }
  CHECK(fclose(file) == 0);
  floe_free(scene);
  return NULL;
}

static void two_scenes_on_two_threads(const char *scene, const char *folder) {
  struct job jobs[2] = {{scene, folder, 0}, {scene, folder, 1}};
  pthread_t threads[2];
  for (int i = 0; i < 2; i++) CHECK(pthread_create(&threads[i], NULL, render, &jobs[i]) == 0);
  for (int i = 0; i < 2; i++) CHECK(pthread_join(threads[i], NULL) == 0);
}

static void openings_are_refused(const char *text) {
  FloeScene *scene = (FloeScene *)&scene;
  CHECK(floe_scene_open(NULL, 1, &scene) == FLOE_STATUS_BAD_ARGUMENT && scene == NULL);
  says(NULL, "path is null");
  CHECK(floe_scene_open("no/such/scene.toml", 1, &scene) == FLOE_STATUS_MISSING && scene == NULL);
  says(NULL, "no/such/scene.toml");
  CHECK(floe_scene_parse(text, NULL, 1, NULL) == FLOE_STATUS_BAD_ARGUMENT);
  says(NULL, "scene is null");
  CHECK(floe_scene_parse(text, NULL, (uint32_t)-1, &scene) == FLOE_STATUS_BAD_ARGUMENT);
  says(NULL, "threads is 4294967295");
  CHECK(floe_scene_parse("\xff", NULL, 1, &scene) == FLOE_STATUS_BAD_ARGUMENT);
  says(NULL, "scene_text is not UTF-8");
  CHECK(floe_scene_parse("[rendr]\n", "some/folder", 1, &scene) == FLOE_STATUS_BAD_SCENE);
  says(NULL, "some/folder");
  says(NULL, "render");
  CHECK(floe_render(NULL, 1) == FLOE_STATUS_BAD_ARGUMENT);
  says(NULL, "scene is null");
  CHECK(floe_record(NULL) == NULL);
  floe_free(NULL);
}

static void what_comes_too_early_is_refused(FloeScene *scene) {
  float pixels[FLOATS];
  double number;
  CHECK(floe_render(scene, 1) == FLOE_STATUS_TOO_EARLY);
  says(scene, "floe_set_mesh");
  CHECK(floe_pixels(scene, pixels, FLOATS) == FLOE_STATUS_TOO_EARLY);
  CHECK(floe_relative_error(scene, &number, &number, &number) == FLOE_STATUS_TOO_EARLY);
  CHECK(floe_write(scene, "early.exr") == FLOE_STATUS_TOO_EARLY);
  CHECK(floe_record(scene) == NULL);
  says(scene, "there is no picture");
}

static void wrong_meshes_are_refused(FloeScene *scene) {
  struct box now = box(1);
  const double *positions = &now.positions[0][0];
  const uint32_t *triangles = &TRIANGLES[0][0];
  CHECK(floe_set_mesh(scene, NULL, NULL, 8, triangles, NULL, 12) == FLOE_STATUS_BAD_ARGUMENT);
  says(scene, "positions is null");
  CHECK(floe_set_mesh(scene, positions, NULL, 8, NULL, NULL, 12) == FLOE_STATUS_BAD_ARGUMENT);
  says(scene, "triangles is null");
  const double *beside = (const double *)((const char *)positions + 1);
  CHECK(floe_set_mesh(scene, beside, NULL, 7, triangles, NULL, 1) == FLOE_STATUS_BAD_ARGUMENT);
  says(scene, "not aligned");
  CHECK(floe_set_mesh(scene, positions, NULL, (size_t)-1, triangles, NULL, 12) == FLOE_STATUS_BAD_ARGUMENT);
  says(scene, "more than fit");
  CHECK(floe_set_mesh(scene, positions, NULL, 7, triangles, NULL, 12) == FLOE_STATUS_BAD_DATA);
  says(scene, "triangle 2: vertex index 7, but there are 7");
  now.positions[5][1] = NAN;
  CHECK(set(scene, &now) == FLOE_STATUS_BAD_DATA);
  says(scene, "vertex 5: the coordinates [0.375, NaN, 0.375] are not finite");
  CHECK(floe_render(scene, 1) == FLOE_STATUS_TOO_EARLY);

  now = box(1);
  now.labels[4][1] = 77;
  CHECK(set(scene, &now) == FLOE_STATUS_OK);
  CHECK(floe_render(scene, 1) == FLOE_STATUS_BAD_SCENE);
  says(scene, "label 77 has no medium");
  CHECK(floe_set_mesh(scene, NULL, NULL, 0, NULL, NULL, 0) == FLOE_STATUS_OK);
  CHECK(floe_render(scene, 1) == FLOE_STATUS_OK);
  CHECK(strstr(floe_record(scene), "the mesh has no triangles") != NULL);
}

static void pictures_go_where_they_fit(FloeScene *scene, const char *folder) {
  struct box now = box(1);
  uint32_t width, height;
  float pixels[FLOATS];
  double estimate, low, high;
  char path[1024];
  CHECK(set(scene, &now) == FLOE_STATUS_OK);
  CHECK(floe_render(scene, INT64_MAX) == FLOE_STATUS_BAD_ARGUMENT);
  CHECK(floe_render(scene, -7) == FLOE_STATUS_OK);
  CHECK(floe_size(scene, &width, NULL) == FLOE_STATUS_BAD_ARGUMENT);
  CHECK(floe_size(scene, &width, &height) == FLOE_STATUS_OK && width == WIDTH && height == HEIGHT);
  CHECK(floe_pixels(scene, pixels, FLOATS - 1) == FLOE_STATUS_BAD_ARGUMENT);
  says(scene, "1536");
  CHECK(floe_pixels(scene, NULL, FLOATS) == FLOE_STATUS_BAD_ARGUMENT);
  CHECK(floe_relative_error(scene, &estimate, &low, &high) == FLOE_STATUS_OK);
  CHECK(low <= estimate && estimate <= high);
  CHECK(strstr(floe_record(scene), "\"frame\":\"-7\"") != NULL);
  CHECK(floe_write(scene, "picture.jpg") == FLOE_STATUS_BAD_ARGUMENT);
  says(scene, ".exr or .png");
  snprintf(path, sizeof path, "%s/pixels_0/picture.png", folder);
  CHECK(floe_write(scene, path) == FLOE_STATUS_CANNOT_CREATE);
  snprintf(path, sizeof path, "%s/picture.exr", folder);
  CHECK(floe_write(scene, path) == FLOE_STATUS_OK);
  // A frame that fails leaves no picture of another one.
  CHECK(floe_render(scene, 2) == FLOE_STATUS_TOO_EARLY);
  CHECK(floe_pixels(scene, pixels, FLOATS) == FLOE_STATUS_TOO_EARLY);
}

static void *render_long(void *scene) {
  CHECK(floe_render(scene, 1) == FLOE_STATUS_INTERRUPTED);
  return NULL;
}

// The mesh of the next frame is set while a frame is rendered that would take hours, which is then stopped.
static void frames_are_interrupted(const char *text) {
  struct box now = box(1);
  char longer[4096];
  snprintf(longer, sizeof longer, "%s\n[render]\nsamples = 100000000\n", text);
  FloeScene *scene = opened(longer);
  CHECK(set(scene, &now) == FLOE_STATUS_OK);
  pthread_t thread;
  CHECK(pthread_create(&thread, NULL, render_long, scene) == 0);
  CHECK(set(scene, &now) == FLOE_STATUS_OK);
  CHECK(floe_interrupt(scene) == FLOE_STATUS_OK);
  CHECK(pthread_join(thread, NULL) == 0);
  says(scene, "stopped");
  floe_free(scene);
}

int main(int count, char **arguments) {
  CHECK(count == 3 && floe_version() != NULL);
  const char *text = arguments[1], *folder = arguments[2];
  two_scenes_on_two_threads(text, folder);
  openings_are_refused(text);
  FloeScene *scene = opened(text);
  what_comes_too_early_is_refused(scene);
  wrong_meshes_are_refused(scene);
  pictures_go_where_they_fit(scene, folder);
  floe_free(scene);
  frames_are_interrupted(text);
  return 0;
}
