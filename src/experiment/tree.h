// A YAML file as a tree of plain nodes that know their places. libyaml stays in tree.c.
#ifndef EXPERIMENT_TREE_H
#define EXPERIMENT_TREE_H

#include "base/arena.h"
#include "base/file.h"
#include "base/problem.h"

#include <stdbool.h>

enum node_kind { NODE_SCALAR, NODE_LIST, NODE_MAPPING };

struct node {
  enum node_kind kind;
  struct place place;
  const char *text;          // scalars
  int count;                 // lists: items; mappings: pairs
  struct node **key, **item; // [count]; key of mappings only, all scalars, all different
};

// One document whose root is a mapping. Anchors and aliases are resolved.
bool tree_read(struct text, const char *path, struct arena *, struct node **root, struct problem *);

// A node in a message: its text on one line and not too long, "a list" or "a mapping".
const char *node_show(const struct node *, struct arena *);

#endif
