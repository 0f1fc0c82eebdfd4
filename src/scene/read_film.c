// Camera, Film and PixelFilter. What one says may depend on the other, so the window and the
// exposure are worked out when all have been read.
#include "scene/camera.h"
#include "scene/reader.h"

#include <float.h>
#include <string.h>

bool read_only_once(struct reader *reader, const struct call *call, struct place *given) {
  if (given->line > 0)
    return problem_at(reader->problem, call->place, "a second %s (the first is in line %d)",
                      call->name, given->line);
  *given = call->place;
  return true;
}

static bool wrong_type(struct reader *reader, const struct call *call, const char *advice) {
  return problem_at(reader->problem, call->type_place, "%s \"%s\" is not in this version; %s",
                    call->name, call->type, advice);
}

void read_default_film(struct reader *reader) {
  struct scene *scene = reader->builder.scene;
  struct params none = {.directive = "PixelFilter", .problem = reader->problem};
  scene->camera = (struct camera){.type = camera_find("perspective"),
                                  .world_from_camera = transform_identity(),
                                  .width = 1280,
                                  .height = 720,
                                  .full_width = 1280,
                                  .full_height = 720,
                                  .fov = 90,
                                  .shutter_close = 1};
  scene->filter.type = filter_find("gaussian");
  scene->filter.type->read(&scene->filter, &none);
  reader->iso = 100;
}

// ---- camera ----
static void read_shutter(struct params *params, struct camera *camera) {
  camera->shutter_open = params_float(params, "shutteropen", 0);
  camera->shutter_close = params_float(params, "shutterclose", 1);
  if (!(camera->shutter_open < camera->shutter_close))
    params_complain(params, "shutterclose",
                    "shutterclose must be later than shutteropen: the shutter is never open");
}

static void read_lens(struct params *params, struct camera *camera) {
  camera->lens_radius = params_float(params, "lensradius", 0);
  camera->focal_distance = params_float(params, "focaldistance", 1e6);
  if (camera->lens_radius < 0)
    params_complain(params, "lensradius", "lensradius must not be negative");
  if (!(camera->focal_distance > 0))
    params_complain(params, "focaldistance", "focaldistance must be positive");
}

static void read_screen(struct params *params, struct reader *reader) {
  ptrdiff_t count;
  reader->frame_aspect_ratio = params_float(params, "frameaspectratio", 0);
  if (reader->frame_aspect_ratio < 0)
    params_complain(params, "frameaspectratio", "frameaspectratio must be positive");
  const double *window = reader->screen_window =
      params_array(params, "float", "screenwindow", &count);
  if (window && count != 4)
    params_complain(params, "screenwindow", "screenwindow needs 4 numbers, has %td", count);
  else if (window && (window[0] == window[1] || window[2] == window[3]))
    params_complain(params, "screenwindow", "screenwindow is x0 x1 y0 y1; it has no area");
}

// World from camera is what moves: pbrt interpolates the inverse of the current transformations.
static void place_camera(struct reader *reader, struct camera *camera) {
  struct transform world_from_camera[N_ENDS];
  for (int end = START; end < N_ENDS; end++)
    transform_invert(reader->now.world_from_object[end], &world_from_camera[end]);
  read_name_coordinate_system(reader, "camera", world_from_camera);
  camera->animation = animation_new(world_from_camera[START], world_from_camera[END]);
  camera->world_from_camera = world_from_camera[START];
}

bool read_camera(struct reader *reader, struct call *call) {
  struct params *params = &call->params;
  struct camera *camera = &reader->builder.scene->camera;
  if (!read_only_once(reader, call, &reader->camera) ||
      !read_outside(reader, call, &reader->builder.scene->camera_medium))
    return false;
  camera->type = camera_find(call->type);
  if (!camera->type)
    return wrong_type(reader, call,
                      "use \"perspective\" (with lensradius and focaldistance a thin lens), "
                      "\"orthographic\" or \"spherical\"");
  if (!camera->type->read(camera, params)) return false;
  read_shutter(params, camera);
  if (camera->type->has_lens) {
    read_lens(params, camera);
    read_screen(params, reader);
  }
  place_camera(reader, camera);
  return params_finish(params);
}

// ---- film ----
// An image larger than this in either direction is a mistake in the file.
enum { MAX_RESOLUTION = 65536 };

static int read_resolution(struct params *params, const char *name, int fallback) {
  int64_t pixels = params_integer(params, name, fallback);
  if (pixels >= 1 && pixels <= MAX_RESOLUTION) return (int)pixels;
  params_complain(params, name, "%s must be from 1 to %d", name, MAX_RESOLUTION);
  return fallback;
}

// The image is the pixels x0 <= x < x1, y0 <= y < y1 of the film.
static bool crop(struct camera *camera, const int bounds[4]) {
  camera->crop_x = bounds[0], camera->width = bounds[1] - bounds[0];
  camera->crop_y = bounds[2], camera->height = bounds[3] - bounds[2];
  return camera->width > 0 && camera->height > 0;
}

static void read_pixel_bounds(struct params *params, struct camera *camera) {
  ptrdiff_t count;
  int bounds[4];
  const double *given = params_array(params, "integer", "pixelbounds", &count);
  if (!given) return;
  const int limit[4] = {camera->full_width, camera->full_width, camera->full_height,
                        camera->full_height};
  bool inside = count == 4;
  for (int k = 0; k < 4 && inside; k++) {
    inside = given[k] >= 0 && given[k] <= limit[k];
    bounds[k] = inside ? (int)given[k] : 0;
  }
  if (!inside || !crop(camera, bounds))
    params_complain(params, "pixelbounds",
                    "pixelbounds is x0 x1 y0 y1, 0 <= x0 < x1 <= xresolution, and y likewise");
}

// The pixels from ceil(x0 resolution) to ceil(x1 resolution) - 1, worked out in float as pbrt does:
// in double 0.07 of 100 pixels begins at pixel 8.
static int crop_pixel(double share, int resolution) {
  float at = (float)share * (float)resolution;
  int pixel = (int)at;
  return (float)pixel < at ? pixel + 1 : pixel;
}

static void read_crop_window(struct params *params, struct camera *camera) {
  ptrdiff_t count;
  const double *w = params_array(params, "float", "cropwindow", &count);
  if (!w) return;
  bool inside = count == 4;
  for (int k = 0; k < 4 && inside; k++) inside = w[k] >= 0 && w[k] <= 1;
  if (inside) {
    int x = w[0] < w[1] ? 0 : 1, y = w[2] < w[3] ? 2 : 3; // pbrt takes them in either order
    const int bounds[4] = {
        crop_pixel(w[x], camera->full_width), crop_pixel(w[1 - x], camera->full_width),
        crop_pixel(w[y], camera->full_height), crop_pixel(w[5 - y], camera->full_height)};
    inside = crop(camera, bounds);
  }
  if (!inside)
    params_complain(params, "cropwindow",
                    "cropwindow is x0 x1 y0 y1 in [0, 1] with at least a pixel inside");
}

// Sensors other than pbrt's default measure colours of their own, and white balance changes them.
static void read_sensor(struct params *params, struct reader *reader) {
  if (strcmp(params_string(params, "sensor", "cie1931"), "cie1931") != 0)
    read_leave_out(reader, params, "sensor");
  if (params_float(params, "whitebalance", 0) != 0) read_leave_out(reader, params, "whitebalance");
  if (params_float(params, "maxcomponentvalue", DBL_MAX) < (double)FLT_MAX)
    read_leave_out(reader, params, "maxcomponentvalue"); // a clamp darkens the image
  reader->iso = params_float(params, "iso", 100);
  if (!(reader->iso > 0)) params_complain(params, "iso", "iso must be positive");
}

// Films that write the same colours and more besides. Only the colours are written.
static bool read_other_film(struct reader *reader, struct call *call) {
  struct params *params = &call->params;
  if (strcmp(call->type, "gbuffer") != 0 && strcmp(call->type, "spectral") != 0)
    return wrong_type(reader, call, "use \"rgb\"");
  if (!reader->options.lenient)
    return wrong_type(reader, call, "use \"rgb\", or --lenient, which writes its colours only");
  read_note(reader, call->place, call->params.directive, "only its colours are written");
  params_string(params, "coordinatesystem", NULL);
  params_integer(params, "nbuckets", 0);
  params_float(params, "lambdamin", 0);
  params_float(params, "lambdamax", 0);
  return true;
}

bool read_film(struct reader *reader, struct call *call) {
  struct params *params = &call->params;
  struct scene *scene = reader->builder.scene;
  struct camera *camera = &scene->camera;
  if (!read_only_once(reader, call, &reader->film)) return false;
  if (strcmp(call->type, "rgb") != 0 && !read_other_film(reader, call)) return false;
  camera->width = camera->full_width = read_resolution(params, "xresolution", 1280);
  camera->height = camera->full_height = read_resolution(params, "yresolution", 720);
  read_pixel_bounds(params, camera);
  bool bounded = camera->width < camera->full_width || camera->height < camera->full_height;
  read_crop_window(params, camera);
  if (bounded && params_any(params, "cropwindow"))
    params_complain(params, "cropwindow", "cropwindow and pixelbounds: give one");
  scene->settings.filename = params_string(params, "filename", NULL);
  params_bool(params, "savefp16", true); // how pbrt stores; we always store 32 bits
  params_float(params, "diagonal", 35);  // only a realistic camera has a use for it
  read_sensor(params, reader);
  return params_finish(params);
}

// ---- filter ----
bool read_pixel_filter(struct reader *reader, struct call *call) {
  struct filter *filter = &reader->builder.scene->filter;
  if (!read_only_once(reader, call, &reader->filter)) return false;
  filter->type = filter_find(call->type);
  if (!filter->type)
    return wrong_type(reader, call,
                      "use \"gaussian\", \"triangle\" or \"box\" (mitchell and sinc are negative "
                      "in places, so no sample can be drawn from them)");
  return filter->type->read(filter, &call->params) && params_finish(&call->params);
}

bool read_finish_film(struct reader *reader) {
  struct scene *scene = reader->builder.scene;
  struct camera *camera = &scene->camera;
  double aspect = reader->frame_aspect_ratio, screen[4];
  if (aspect == 0) aspect = (double)camera->full_width / camera->full_height;
  camera_screen(aspect, screen);
  if (reader->screen_window) memcpy(screen, reader->screen_window, sizeof screen);
  camera->type->set_window(camera, screen);
  scene->settings.exposure = (camera->shutter_close - camera->shutter_open) * reader->iso / 100;
  return true;
}
