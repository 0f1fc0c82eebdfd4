// The reader's inside: a scene file is a sequence of directives (read.c); each is a row of
// directives[] whose function (read_transform.c, read_options.c, read_world.c) changes the state.
#ifndef SCENE_READER_H
#define SCENE_READER_H

#include "pbrt/lexer.h"
#include "scene/read.h"

// An AreaLightSource directive: the light of each shape that follows.
struct area_light {
  const struct light_type *type;
  struct params params;
};

// What AttributeBegin saves.
struct attributes {
  struct transform world_from_object; // the current transformation matrix
  bool reverse_orientation;
  uint32_t material;
  const struct area_light *area_light; // or NULL
};

struct saved_attributes {
  struct attributes attributes;
  struct place begin;
};

// A light to be read when the scene is complete.
struct pending_light {
  const struct light_type *type;
  struct params params;
  struct transform world_from_object;
  bool reverse_orientation;
  uint32_t shape; // area lights: its emitter's row
};

struct reader {
  struct lexer lexer;
  struct scene_builder builder;
  struct problem *problem;
  struct arena lists; // what lives as long as the reader
  struct attributes now;
  struct {
    struct saved_attributes *item;
    ptrdiff_t count, capacity;
  } saved;
  struct {
    struct pending_light *item;
    ptrdiff_t count, capacity;
  } lights;
  struct place world_begin;                                            // line 0: not yet
  struct place camera, film, sampler, integrator, filter, color_space; // line 0: not given
  const double *screen_window; // Camera's, to be compared with the default; or NULL
  double frame_aspect_ratio;   // 0: not given
  int64_t sampler_seed;        // -1: not given
};

// One directive as it stands in the file.
struct call {
  struct place place;
  const char *name; // "Translate"
  const char *type; // `Shape "sphere"` -> "sphere"; NULL if it has none
  struct place type_place;
  double number[16];    // Translate, Transform, ...
  struct params params; // of directives with a type
};

struct directive {
  const char *name;
  enum { ANYWHERE, BEFORE_WORLD, IN_WORLD } where;
  enum { BARE, NUMBERS, MATRIX, NAME, PARAMETERS } form;
  int n_numbers;
  bool keep; // its parameters are needed after it was read
  bool (*run)(struct reader *, struct call *);
};

bool read_look_at(struct reader *, struct call *);
bool read_translate(struct reader *, struct call *);
bool read_rotate(struct reader *, struct call *);
bool read_scale(struct reader *, struct call *);
bool read_identity(struct reader *, struct call *);
bool read_transform(struct reader *, struct call *);
bool read_concat_transform(struct reader *, struct call *);
bool read_attribute_begin(struct reader *, struct call *);
bool read_attribute_end(struct reader *, struct call *);
bool read_reverse_orientation(struct reader *, struct call *);
bool read_world_begin(struct reader *, struct call *);

bool read_camera(struct reader *, struct call *);
bool read_film(struct reader *, struct call *);
bool read_pixel_filter(struct reader *, struct call *);
bool read_sampler(struct reader *, struct call *);
bool read_integrator(struct reader *, struct call *);
bool read_color_space(struct reader *, struct call *);

bool read_shape(struct reader *, struct call *);
bool read_material(struct reader *, struct call *);
bool read_light_source(struct reader *, struct call *);
bool read_area_light_source(struct reader *, struct call *);

// What pbrt assumes where the file says nothing; then, at the end of the file, what could not be
// checked before it.
void read_default_options(struct reader *);
bool read_finish_options(struct reader *);
void read_default_material(struct reader *);

// scene_read on the file's text; `folder` (ending in /, or empty) is where the files it names are,
// NULL: it may name none. `lists` and `scratch` are free again when it returns.
bool scene_read_text(const char *path, const char *folder, struct text, struct arena *,
                     struct arena lists, struct arena scratch, struct scene *, struct problem *);

// Tables and lights, when every directive has been read.
bool scene_finish(struct reader *);

#endif
