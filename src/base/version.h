// What this binary is; written by the build.
#ifndef BASE_VERSION_H
#define BASE_VERSION_H

extern const char photonlab_version[];  // git describe, or the tarball's VERSION
extern const char photonlab_compiler[]; // first line of `cc --version`
extern const char photonlab_flags[];    // what every object was compiled with

#endif
