#include "walk/light_path.h"

const struct light_path_row light_paths[LIGHT_PATHS] = {
    {"emitted", "L S* E: lights seen directly, in mirrors and through clear glass",
     LIGHT_PATH_EMITTED},
    {"direct", "L D S* E: light that nothing but the surface or medium seen has scattered",
     LIGHT_PATH_DIRECT},
    {"caustics", "L S+ D S* E: light that mirrors and clear glass alone have sent there",
     LIGHT_PATH_CAUSTICS},
    {"indirect", "the rest: light that other surfaces or a medium have scattered before",
     LIGHT_PATH_INDIRECT},
};
