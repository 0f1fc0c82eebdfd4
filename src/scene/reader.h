// The reader's inside: a scene file is a sequence of directives (read.c); each is a row of
// directives[] whose function (in the other files read_*.c) changes the state.
#ifndef SCENE_READER_H
#define SCENE_READER_H

#include "pbrt/lexer.h"
#include "scene/names.h"
#include "scene/read.h"

// Ends of the interval in which things move (TransformTimes).
enum { START, END, N_ENDS };

// An AreaLightSource directive: the light of each shape that follows.
struct area_light {
  const struct light_type *type;
  struct params params;
};

// What an Attribute directive gives defaults for.
enum target { NO_TARGET, FOR_SHAPE, FOR_LIGHT, FOR_MATERIAL, FOR_MEDIUM, FOR_TEXTURE, N_TARGETS };

// Parameters of directives to come, newest first.
struct defaults {
  const struct param *item;
  int count;
};

// What AttributeBegin saves.
struct attributes {
  struct transform world_from_object[N_ENDS]; // the current transformation matrices
  bool active[N_ENDS];                        // those that transformations change
  bool reverse_orientation;
  uint32_t material;
  const struct area_light *area_light; // or NULL
  const char *inside, *outside;        // media: a name, or NULL or "" for none
  struct defaults defaults[N_TARGETS];
};

// By AttributeBegin or ObjectBegin.
struct saved_attributes {
  struct attributes attributes;
  const char *directive;
  struct place begin;
};

// A named coordinate system: what CoordSysTransform sets the current transformation to.
struct coordinate_system {
  struct transform world_from_object[N_ENDS];
};

// A shape as it waits in an object's definition.
struct object_shape {
  const struct shape_type *type;
  struct params params;
  struct attributes attributes;
};

struct object {
  struct {
    struct object_shape *item;
    ptrdiff_t count, capacity;
  } shapes;
  bool used;
};

// An ObjectInstance directive.
struct instance {
  const char *name;
  struct place place, name_place;
  struct transform world_from_object[N_ENDS];
};

// A material named so far, made or not.
struct material_name {
  uint32_t row;
  bool is_made;
  struct place place; // where it was first named
};

// A light to be read when the scene is complete.
struct pending_light {
  const struct light_type *type;
  struct params params;
  struct transform world_from_object;
  bool reverse_orientation;
  uint32_t shape;  // area lights: its emitter's row
  uint32_t medium; // around it, as in the file
};

struct reader {
  struct lexer lexer;
  struct scene_builder builder;
  struct problem *problem;
  struct scene_options options;
  struct arena lists;            // what lives as long as the reader
  const struct reading *reading; // the files that are open
  int n_files;                   // read so far
  struct attributes now;
  struct {
    struct saved_attributes *item;
    ptrdiff_t count, capacity;
  } saved;
  ptrdiff_t saved_outside; // those of the files that import this one
  struct names coordinate_systems;
  struct {
    struct coordinate_system *item;
    ptrdiff_t count, capacity;
  } coordinate_system; // by number
  struct names material_names;
  struct {
    struct material_name *item;
    ptrdiff_t count, capacity;
  } material_name; // by number
  struct names float_texture_names, spectrum_texture_names, media;
  struct names objects;
  struct {
    struct object *item;
    ptrdiff_t count, capacity;
  } object;                 // by number
  bool in_later_instance;   // of an object, whose shapes were read before
  struct object *in_object; // whose definition this is, or NULL
  struct {
    struct instance *item;
    ptrdiff_t count, capacity;
  } instances;
  struct {
    struct pending_light *item;
    ptrdiff_t count, capacity;
  } lights;
  struct place world_begin;                               // line 0: not yet
  struct place camera, film, sampler, integrator, filter; // line 0: not given
  const double *screen_window;                            // Camera's, or NULL
  double iso;                                             // Film's
  double frame_aspect_ratio;                              // 0: not given
  double transform_times[N_ENDS];
  int64_t sampler_seed, option_seed; // -1: not given
  bool no_pixel_jitter;              // Option
};

// A file that is being read; the one with the Include or Import is `outer`.
struct reading {
  const char *path;
  const struct reading *outer;
};

// One directive as it stands in the file.
struct call {
  struct place place;
  const char *name; // "Translate"
  const char *type; // `Shape "sphere"` -> "sphere"; NULL if it has none
  struct place type_place;
  const char *value; // Option; MediumInterface's second name or NULL
  struct place value_place;
  const char *title, *kind; // Texture "title" "kind" "type"
  struct place title_place, kind_place;
  double number[16];    // Translate, Transform, ...
  struct params params; // of directives with a type
  struct arena scratch; // free while the directive runs
};

struct directive {
  const char *name;
  enum { ANYWHERE, BEFORE_WORLD, IN_WORLD } where;
  enum { BARE, NUMBERS, MATRIX, WORD, NAME, NAMES, NAME_VALUE, PARAMETERS, TEXTURE } form;
  int n_numbers;
  bool keep;          // the scene may point to its parameters
  enum target target; // whose defaults apply
  bool (*run)(struct reader *, struct call *);
};

bool read_look_at(struct reader *, struct call *);
bool read_translate(struct reader *, struct call *);
bool read_rotate(struct reader *, struct call *);
bool read_scale(struct reader *, struct call *);
bool read_identity(struct reader *, struct call *);
bool read_transform(struct reader *, struct call *);
bool read_concat_transform(struct reader *, struct call *);
bool read_active_transform(struct reader *, struct call *);
bool read_transform_times(struct reader *, struct call *);
bool read_coordinate_system(struct reader *, struct call *);
bool read_coord_sys_transform(struct reader *, struct call *);

bool read_attribute_begin(struct reader *, struct call *);
bool read_attribute_end(struct reader *, struct call *);
bool read_attribute(struct reader *, struct call *);
bool read_reverse_orientation(struct reader *, struct call *);
bool read_world_begin(struct reader *, struct call *);

bool read_include(struct reader *, struct call *);
bool read_import(struct reader *, struct call *);
bool read_object_begin(struct reader *, struct call *);
bool read_object_end(struct reader *, struct call *);
bool read_object_instance(struct reader *, struct call *);

bool read_camera(struct reader *, struct call *);
bool read_film(struct reader *, struct call *);
bool read_pixel_filter(struct reader *, struct call *);
bool read_sampler(struct reader *, struct call *);
bool read_integrator(struct reader *, struct call *);
bool read_color_space(struct reader *, struct call *);
bool read_accelerator(struct reader *, struct call *);
bool read_option(struct reader *, struct call *);

bool read_shape(struct reader *, struct call *);
bool read_material(struct reader *, struct call *);
bool read_named_material(struct reader *, struct call *);
bool read_make_named_material(struct reader *, struct call *);
bool read_texture(struct reader *, struct call *);
bool read_make_named_medium(struct reader *, struct call *);
bool read_medium_interface(struct reader *, struct call *);
bool read_light_source(struct reader *, struct call *);
bool read_area_light_source(struct reader *, struct call *);

// pbrt lets the last directive of a kind win, which hides mistakes. False: it was given before.
bool read_only_once(struct reader *, const struct call *, struct place *given);

// What pbrt assumes where the file says nothing; then, at the end of the file, what could not be
// checked before it.
void read_default_transform(struct reader *);
void read_default_options(struct reader *);
bool read_finish_options(struct reader *);
void read_default_film(struct reader *);
bool read_finish_film(struct reader *);
void read_default_material(struct reader *);

// The directives of a file up to its end.
bool read_directives(struct reader *, struct arena scratch);

// From the directive's name to the token behind what belongs to it.
bool read_parse_call(struct reader *, const struct directive *, struct arena *, struct call *);

// Pushes and pops attributes; `begin` and `end` are the directives that do so.
void read_push_attributes(struct reader *, const struct call *);
bool read_pop_attributes(struct reader *, const struct call *, const char *begin);
bool read_all_popped(struct reader *, ptrdiff_t outside);

// Gives the call the defaults that Attribute set for its directive.
void read_apply_defaults(const struct reader *, enum target, struct arena *, struct call *);

// Rows of the media on a shape's sides; of what surrounds the camera or light. False: one is
// unknown (problem set).
bool read_shape_media(struct reader *, const struct attributes *, const struct params *,
                      uint32_t *inside, uint32_t *outside);
bool read_outside(struct reader *, const struct call *, uint32_t *row);

// Says what was left out, once for all instances of an object.
void read_note(const struct reader *, struct place, const char *directive, const char *what);
// A parameter that changes the image and that we do not know: refused, or left out if so asked.
void read_leave_out(struct reader *, struct params *, const char *name);

// `Shape "x" is not in this version` and what is.
bool read_unknown_type(struct reader *, const struct call *, const char *const *names, int n);

// Whether every material that was named was made.
bool read_check_materials(struct reader *);

bool read_is_moving(const struct transform world_from_object[N_ENDS]);
void read_name_coordinate_system(struct reader *, const char *name,
                                 const struct transform world_from_object[N_ENDS]);

// Adds a shape's primitives to the scene, with the attributes it had in the file.
bool read_place_shape(struct reader *, const struct shape_type *, const struct attributes *,
                      struct params *, uint32_t *row);
// The same for one that moves: instance(time) * its own(time).
bool read_place_moving_shape(struct reader *, const struct shape_type *, const struct attributes *,
                             const struct transform instance[N_ENDS], struct params *);
// Adds the primitives of every ObjectInstance.
bool read_instances(struct reader *);

// What scene_read_text does, with a reader that has its arenas, problem and options.
bool read_all(struct reader *, const char *path, const char *folder, struct text,
              struct arena scratch);

// scene_read on the file's text; `folder` (ending in /, or empty) is where the files it names are,
// NULL: it may name none. `lists` and `scratch` are free again when it returns.
bool scene_read_text(const char *path, const char *folder, struct text, struct arena *,
                     struct arena lists, struct arena scratch, struct scene *, struct problem *);

// Tables and lights, when every directive has been read.
bool scene_finish(struct reader *);

#endif
