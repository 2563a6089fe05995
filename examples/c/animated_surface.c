// Rings in a pool that no file holds, rendered from C.
//
//     animated_surface [FOLDER [FRAMES [WIDTH]]]     writes FOLDER/frame_0001.png and so on
//
// Run it in the folder of floe, where the tiles of the pool are. README.md tells how it is built.

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "floe.h"

enum { SQUARES = 48, ROW = SQUARES + 1, SHEET = ROW * ROW };

// A surface over a bottom of as many vertices, and sides between their rims.
enum { VERTICES = 2 * SHEET, TRIANGLES = 4 * SQUARES * SQUARES + 8 * SQUARES };

static double positions[VERTICES][3];
static uint32_t triangles[TRIANGLES][3];
static int32_t labels[TRIANGLES][2];

static const char *const SCENE =
    "[regions]\n"
    "1 = 'water'\n"
    "[media.water]\n"
    "ior = 1.333\n"
    "absorption = [0.3, 0.06, 0.02]\n"
    "[sun]\n"
    "direction = [0.3, -0.45, 0.85]\n"
    "irradiance = [1.0, 0.95, 0.85]\n"
    "[sky]\n"
    "radiance = [0.08, 0.11, 0.16]\n"
    "[camera]\n"
    "eye = [0.5, -3.6, 3.2]\n"
    "target = [0, -0.1, -0.5]\n"
    "horizontal_fov = 46\n"
    "resolution = [%d, %d]\n"
    "[render]\n"
    "samples = 16\n"
    "[output]\n"
    "exposure = 1.2\n"
    "[[surfaces]]\n"
    "mesh = 'sequences/pool/tiles.ply'\n"
    "normals = 'flat'\n"
    "material = { kind = 'diffuse', reflectance = [0.62, 0.74, 0.78] }\n"
    "[[surfaces]]\n"
    "mesh = 'sequences/pool/deck.ply'\n"
    "normals = 'flat'\n"
    "material = { kind = 'diffuse', reflectance = [0.45, 0.40, 0.34] }\n";

// Ripples, and the rings of a drop that fell at time 0.
static double height(double x, double y, double time) {
  double ripples = 0.012 * sin(5 * x + 3 * y + 4 * time) + 0.01 * sin(6 * y - 4 * x + 5 * time);
  double behind = hypot(x - 0.3, y + 0.2) - 1.1 * time;
  return ripples + 0.03 * exp(-(behind / 0.25) * (behind / 0.25)) * cos(14 * behind);
}

static void move_surface(double time) {
  for (int vertex = 0; vertex < VERTICES; vertex++) {
    int column = vertex % SHEET % ROW, row = vertex % SHEET / ROW;
    double *position = positions[vertex];
    position[0] = 3.1 * column / SQUARES - 1.55;
    position[1] = 3.1 * row / SQUARES - 1.55;
    position[2] = vertex < SHEET ? height(position[0], position[1], time) : -1.3;
  }
}

// A triangle with air, label 0, in front and water, label 1, behind.
static void add_triangle(int *count, int a, int b, int c) {
  triangles[*count][0] = (uint32_t)a;
  triangles[*count][1] = (uint32_t)b;
  triangles[*count][2] = (uint32_t)c;
  labels[*count][0] = 0;
  labels[*count][1] = 1;
  *count += 1;
}

static void add_side(int *count, int a, int b) {
  add_triangle(count, a, a + SHEET, b + SHEET);
  add_triangle(count, a, b + SHEET, b);
}

static void connect(void) {
  int count = 0;
  for (int row = 0; row < SQUARES; row++) {
    for (int column = 0; column < SQUARES; column++) {
      int a = row * ROW + column;
      add_triangle(&count, a, a + 1, a + ROW + 1);
      add_triangle(&count, a, a + ROW + 1, a + ROW);
      add_triangle(&count, a + SHEET, a + ROW + 1 + SHEET, a + 1 + SHEET);
      add_triangle(&count, a + SHEET, a + ROW + SHEET, a + ROW + 1 + SHEET);
    }
  }
  for (int i = 0; i < SQUARES; i++) {
    add_side(&count, i, i + 1);
    add_side(&count, SQUARES * ROW + i + 1, SQUARES * ROW + i);
    add_side(&count, (i + 1) * ROW, i * ROW);
    add_side(&count, i * ROW + SQUARES, (i + 1) * ROW + SQUARES);
  }
}

int main(int count, char **arguments) {
  const char *folder = count > 1 ? arguments[1] : "out/animated_surface";
  int frames = count > 2 ? atoi(arguments[2]) : 8;
  int width = count > 3 ? atoi(arguments[3]) : 320;

  char text[2048];
  snprintf(text, sizeof text, SCENE, width, width * 5 / 8);
  FloeScene *scene;
  if (floe_scene_parse(text, NULL, 0, &scene) != FLOE_STATUS_OK) {
    fprintf(stderr, "%s\n", floe_error_message(NULL));
    return 1;
  }

  connect();
  for (int frame = 1; frame <= frames; frame++) {
    char path[1024];
    snprintf(path, sizeof path, "%s/frame_%04d.png", folder, frame);
    move_surface(frame / 8.0);
    FloeStatus status = floe_set_mesh(scene, &positions[0][0], NULL, VERTICES, &triangles[0][0], &labels[0][0], TRIANGLES);
    if (status == FLOE_STATUS_OK) status = floe_render(scene, frame);
    if (status == FLOE_STATUS_OK) status = floe_write(scene, path);
    if (status != FLOE_STATUS_OK) {
      fprintf(stderr, "frame %d: %s\n", frame, floe_error_message(scene));
      floe_free(scene);
      return status;
    }
    double error, low, high;
    floe_relative_error(scene, &error, &low, &high);
    printf("%s: error %.1f %%\n", path, 100 * error);
  }
  floe_free(scene);
  return 0;
}
