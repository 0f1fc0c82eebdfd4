// Material, MakeNamedMaterial, NamedMaterial.
#include "pbrt/suggest.h"
#include "scene/build.h"
#include "scene/reader.h"

#include <stdio.h>
#include <string.h>

enum { MAX_NAMES = 64 };

// `Shape "x" is not in this version; did you mean ... (known: ...)`
bool read_unknown_type(struct reader *reader, const struct call *call, const char *const *names,
                       int n) {
  char list[512] = "";
  size_t used = 0;
  for (int i = 0; i < n && used < sizeof list; i++)
    used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", names[i]);
  const char *nearest = suggest_name(call->type, names, n);
  return problem_at(reader->problem, call->type_place,
                    "%s \"%s\" is not in this version%s%s%s (known: %s)", call->name, call->type,
                    nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                    nearest ? "\"?" : "", list);
}

void read_note(const struct reader *reader, struct place place, const char *directive,
               const char *what) {
  FILE *notes = reader->options.notes;
  if (notes && !reader->in_later_instance)
    fprintf(notes, "%s:%d:%d: %s: %s\n", place.file, place.line, place.column, directive, what);
}

void read_leave_out(struct reader *reader, struct params *params, const char *name) {
  char what[128];
  if (!input_is_given(params, name)) return;
  snprintf(what, sizeof what, "\"%s\" is left out", name);
  if (reader->options.lenient)
    read_note(reader, params_place(params, name), params->directive, what);
  else
    params_complain(params, name, "\"%s\" is not in this version; --lenient leaves it out", name);
  params_any(params, name);
}

// Materials of pbrt-v4 that this version has not, and those of pbrt-v3: what comes nearest.
static const char *const other_materials[][2] = {
    {"hair", "conductor"},
    {"measured", "conductor"},
    {"subsurface", "coateddiffuse"},
    {"principled", "coateddiffuse"},
    {"disney", "coateddiffuse"},
    {"glass", "dielectric"},
    {"matte", "diffuse"},
    {"metal", "conductor"},
    {"mirror", "conductor"},
    {"plastic", "coateddiffuse"},
    {"substrate", "coateddiffuse"},
    {"translucent", "diffusetransmission"},
    {"uber", "coateddiffuse"},
};

static bool refuse_other(struct reader *reader, const struct call *call) {
  for (size_t i = 0; i < sizeof other_materials / sizeof *other_materials; i++)
    if (strcmp(other_materials[i][0], call->type) == 0)
      return problem_at(reader->problem, call->type_place,
                        "Material \"%s\" is not in this version; \"%s\" comes nearest", call->type,
                        other_materials[i][1]);
  return true;
}

// To pbrt "" and "none" are "interface".
static const struct material_type *find_material(struct reader *reader, struct call *call) {
  const char *names[MAX_NAMES];
  int n = 0;
  if (!*call->type || strcmp(call->type, "none") == 0) call->type = "interface";
  if (!refuse_other(reader, call)) return NULL;
  for (const struct material_type *const *type = material_types; *type && n < MAX_NAMES; type++) {
    if (strcmp((*type)->name, call->type) == 0) return *type;
    names[n++] = (*type)->name;
  }
  read_unknown_type(reader, call, names, n);
  return NULL;
}

static uint32_t add_row(struct reader *reader) {
  struct scene *scene = reader->builder.scene;
  scene->material = build_grow(reader->builder.arena, scene->material, scene->n_materials, 1,
                               sizeof *scene->material);
  scene->material[scene->n_materials] = (struct material){0};
  return scene->n_materials++;
}

// Its row first: what `read` looks up may be read into the same array.
static bool read_parameters(struct reader *reader, struct params *params,
                            const struct material_type *type, struct material *material) {
  struct scene_builder *builder = &reader->builder;
  material->type = type;
  builder->textured = false;
  builder->world_from_object = reader->now.world_from_object[START];
  read_leave_out(reader, params, "displacement");
  read_leave_out(reader, params, "normalmap");
  if (!type->read(builder, params, material) || !params_finish(params)) return false;
  if (builder->textured) material->needs |= MATERIAL_DETAIL;
  return true;
}

bool read_material(struct reader *reader, struct call *call) {
  const struct material_type *type = find_material(reader, call);
  struct material material = {0};
  if (!type || !read_parameters(reader, &call->params, type, &material)) return false;
  reader->now.material = add_row(reader);
  reader->builder.scene->material[reader->now.material] = material;
  return true;
}

// pbrt's: diffuse with reflectance 0.5, which is what "diffuse" without parameters is.
void read_default_material(struct reader *reader) {
  extern const struct material_type material_diffuse;
  struct params none = {.directive = "the default material", .problem = reader->problem};
  struct material material = {0};
  read_parameters(reader, &none, &material_diffuse, &material);
  reader->now.material = add_row(reader);
  reader->builder.scene->material[reader->now.material] = material;
}

// The row of a named material, which may have to wait for its definition.
static struct material_name *name_of(struct reader *reader, const char *name, struct place place) {
  uint32_t known = names_find(&reader->material_names, name);
  if (known == NAME_NONE) {
    known = names_add(&reader->material_names, &reader->lists, name);
    *arena_push(&reader->lists, &reader->material_name) =
        (struct material_name){.row = add_row(reader), .place = place};
  }
  return &reader->material_name.item[known];
}

// As in pbrt, the definition may follow.
bool read_named_material(struct reader *reader, struct call *call) {
  reader->now.material = name_of(reader, call->type, call->type_place)->row;
  return true;
}

// `string type` is what Material has before its parameters.
static bool take_type(struct reader *reader, struct call *call) {
  const char *type = params_string(&call->params, "type", NULL);
  if (!type)
    return params_complain(&call->params, "type", "\"string type\" is missing: say which material");
  call->type_place = params_place(&call->params, "type");
  call->type = type;
  return !reader->problem->text[0];
}

bool read_make_named_material(struct reader *reader, struct call *call) {
  const char *name = call->type;
  struct material_name *entry = name_of(reader, name, call->type_place);
  if (entry->is_made)
    return problem_at(reader->problem, call->type_place, "the material \"%s\" is already defined",
                      name);
  entry->is_made = true;
  const struct material_type *type = take_type(reader, call) ? find_material(reader, call) : NULL;
  struct material material = {0};
  if (!type || !read_parameters(reader, &call->params, type, &material)) return false;
  reader->builder.scene->material[entry->row] = material;
  *arena_push(reader->builder.arena, &reader->builder.materials) = (struct named_material){
      arena_string(reader->builder.arena, name, (ptrdiff_t)strlen(name)), entry->row};
  return true;
}

// At the end of the file.
bool read_check_materials(struct reader *reader) {
  for (ptrdiff_t k = 0; k < reader->material_name.count; k++) {
    const struct material_name *entry = &reader->material_name.item[k];
    const char *name = reader->material_names.item[k];
    if (entry->is_made) continue;
    struct names made = {0};
    for (ptrdiff_t i = 0; i < reader->material_name.count; i++)
      if (reader->material_name.item[i].is_made)
        *arena_push(&reader->lists, &made) = reader->material_names.item[i];
    return problem_at(reader->problem, entry->place, "unknown material \"%s\"%s", name,
                      names_suggest(&made, name).text);
  }
  return true;
}
