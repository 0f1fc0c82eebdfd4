#include "experiment/tree.h"

#include <string.h>
#include <yaml.h>

// No experiment needs more; it bounds the recursion below.
enum { MAX_DEPTH = 16 };

struct walk {
  yaml_document_t *document;
  const char *path;
  struct arena *arena;
  struct problem *problem;
  struct node **done; // by libyaml's number, so that aliases share
  bool *open;         // being converted: met again, it contains itself
};

static struct place place_of(const char *path, yaml_mark_t mark) {
  return (struct place){path, (int)mark.line + 1, (int)mark.column + 1};
}

static bool convert(struct walk *, int number, int depth, struct node **);

static bool convert_list(struct walk *walk, const yaml_node_t *from, int depth, struct node *node) {
  const yaml_node_item_t *item = from->data.sequence.items.start;
  node->kind = NODE_LIST;
  node->count = (int)(from->data.sequence.items.top - item);
  node->item = arena_new(walk->arena, struct node *, node->count);
  for (int j = 0; j < node->count; j++)
    if (!convert(walk, item[j], depth + 1, &node->item[j])) return false;
  return true;
}

// libyaml lets keys repeat, and be lists.
static bool check_key(struct walk *walk, const struct node *node, int pair) {
  const struct node *key = node->key[pair];
  if (key->kind != NODE_SCALAR)
    return problem_at(walk->problem, key->place, "a key must be a name, not %s",
                      node_show(key, walk->arena));
  for (int j = 0; j < pair; j++)
    if (strcmp(node->key[j]->text, key->text) == 0)
      return problem_at(walk->problem, key->place, "key \"%s\" is already in line %d",
                        node_show(key, walk->arena), node->key[j]->place.line);
  return true;
}

static bool convert_mapping(struct walk *walk, const yaml_node_t *from, int depth,
                            struct node *node) {
  const yaml_node_pair_t *pair = from->data.mapping.pairs.start;
  node->kind = NODE_MAPPING;
  node->count = (int)(from->data.mapping.pairs.top - pair);
  node->key = arena_new(walk->arena, struct node *, node->count);
  node->item = arena_new(walk->arena, struct node *, node->count);
  for (int j = 0; j < node->count; j++)
    if (!convert(walk, pair[j].key, depth + 1, &node->key[j]) || !check_key(walk, node, j) ||
        !convert(walk, pair[j].value, depth + 1, &node->item[j]))
      return false;
  return true;
}

static bool convert_node(struct walk *walk, const yaml_node_t *from, int depth, struct node *node) {
  if (from->type == YAML_SEQUENCE_NODE) return convert_list(walk, from, depth, node);
  if (from->type == YAML_MAPPING_NODE) return convert_mapping(walk, from, depth, node);
  node->text = arena_string(walk->arena, (const char *)from->data.scalar.value,
                            (ptrdiff_t)from->data.scalar.length);
  return true;
}

static bool convert(struct walk *walk, int number, int depth, struct node **out) {
  const yaml_node_t *from = yaml_document_get_node(walk->document, number);
  struct place place = place_of(walk->path, from->start_mark);
  if (walk->open[number]) return problem_at(walk->problem, place, "this contains itself");
  if (depth > MAX_DEPTH) return problem_at(walk->problem, place, "nested too deeply");
  if (!walk->done[number]) {
    struct node *node = arena_new(walk->arena, struct node, 1);
    node->place = place;
    walk->open[number] = true;
    if (!convert_node(walk, from, depth, node)) return false;
    walk->open[number] = false;
    walk->done[number] = node;
  }
  *out = walk->done[number];
  return true;
}

// A byte that is no text has an offset instead of a mark.
static struct place place_of_offset(struct text text, const char *path, size_t offset) {
  struct place place = {path, 1, 1};
  for (size_t j = 0; j < offset && j < (size_t)text.length; j++) {
    place.column++;
    if (text.data[j] == '\n') place = (struct place){path, place.line + 1, 1};
  }
  return place;
}

static bool complain(const yaml_parser_t *parser, struct text text, const char *path,
                     struct problem *problem) {
  if (parser->error == YAML_MEMORY_ERROR) die("out of memory: libyaml cannot read %s", path);
  struct place place = parser->error == YAML_READER_ERROR
                           ? place_of_offset(text, path, parser->problem_offset)
                           : place_of(path, parser->problem_mark);
  return problem_at(problem, place, "not YAML: %s", parser->problem);
}

static bool convert_document(yaml_document_t *document, const char *path, struct arena *arena,
                             struct node **root, struct problem *problem) {
  if (!yaml_document_get_root_node(document))
    return problem_at(problem, (struct place){path, 1, 1}, "the file is empty");
  ptrdiff_t n = document->nodes.top - document->nodes.start + 1; // numbered from 1
  struct walk walk = {document,
                      path,
                      arena,
                      problem,
                      arena_new(arena, struct node *, n),
                      arena_new(arena, bool, n)};
  if (!convert(&walk, 1, 0, root)) return false;
  return (*root)->kind == NODE_MAPPING ||
         problem_at(problem, (*root)->place, "keys and values expected, not %s",
                    node_show(*root, arena));
}

static bool check_end(yaml_parser_t *parser, struct text text, const char *path,
                      struct problem *problem) {
  yaml_document_t document;
  if (!yaml_parser_load(parser, &document)) return complain(parser, text, path, problem);
  const yaml_node_t *root = yaml_document_get_root_node(&document);
  struct place place = place_of(path, document.start_mark);
  yaml_document_delete(&document);
  return !root || problem_at(problem, place, "a second document; one is read");
}

bool tree_read(struct text text, const char *path, struct arena *arena, struct node **root,
               struct problem *problem) {
  yaml_parser_t parser;
  yaml_document_t document;
  if (!yaml_parser_initialize(&parser)) die("out of memory: libyaml cannot read %s", path);
  yaml_parser_set_input_string(&parser, (const unsigned char *)text.data, (size_t)text.length);
  bool ok = yaml_parser_load(&parser, &document);
  if (!ok) {
    complain(&parser, text, path, problem);
  } else {
    ok = convert_document(&document, path, arena, root, problem) &&
         check_end(&parser, text, path, problem);
    yaml_document_delete(&document);
  }
  yaml_parser_delete(&parser);
  return ok;
}

const char *node_show(const struct node *node, struct arena *arena) {
  enum { SHOWN = 60 };
  if (node->kind != NODE_SCALAR) return node->kind == NODE_LIST ? "a list" : "a mapping";
  bool cut = strlen(node->text) > SHOWN;
  char *text = arena_format(arena, "%.*s%s", SHOWN, node->text, cut ? "..." : "");
  for (char *c = text; *c; c++)
    if ((unsigned char)*c < ' ' || *c == 127) *c = '?';
  return text;
}
