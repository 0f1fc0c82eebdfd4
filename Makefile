# `make help` lists the targets. Everything made goes to build/ and results/.
MAKEFLAGS += -rR --no-print-directory
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(shell nproc 2>/dev/null || echo 1)# a -j of the command line wins
endif
.SUFFIXES:
.DELETE_ON_ERROR:
SHELL = /bin/sh

# ---- what the user may set ----
BUILD = release# release | debug | asan | tsan | fuzz | coverage | aarch64
OPT.release = -O2
OPT.debug = -Og
OPT.asan = -O1
OPT.tsan = -O1
OPT.fuzz = -O1
OPT.coverage = -O1
OPT.aarch64 = -O2
OPT = $(OPT.$(BUILD))
CFLAGS_EXTRA =
INSTALL = yes# no: never call apt-get
QUALITY = default# of an experiment: default | paper
PREFIX = /usr/local
DESTDIR =
V =# 1 shows the commands

aarch64_root := build/aarch64-root# Debian's packages for it (tests/aarch64/root)
aarch64_gcc := aarch64-linux-gnu-gcc --sysroot=$(aarch64_root)
ifneq ($(filter default undefined,$(origin CC)),)
CC := $(if $(filter tsan fuzz coverage,$(BUILD)),clang,$(if $(filter aarch64,$(BUILD)),$(aarch64_gcc),gcc))
endif
AR = ar
ifeq ($(filter $(BUILD),release debug asan tsan fuzz coverage aarch64),)
$(error BUILD=$(BUILD): one of release, debug, asan, tsan, fuzz, coverage, aarch64)
endif

# ---- flags ----
FLAGS.release =
FLAGS.debug = -DASSERT_HOT
FLAGS.asan = -DASSERT_HOT -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
FLAGS.tsan = -fsanitize=thread -fno-omit-frame-pointer
FLAGS.fuzz = $(FLAGS.asan) -fsanitize=fuzzer-no-link
FLAGS.coverage = -fsanitize=fuzzer-no-link -fprofile-instr-generate -fcoverage-mapping
# No contraction and no builtins: the same bits from every compiler and level. No -march either.
CFLAGS := -std=c11 $(OPT) -g -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion \
  -ffp-contract=off -fno-builtin -fno-math-errno -fopenmp $(FLAGS.$(BUILD)) $(CFLAGS_EXTRA)
CPPFLAGS := -Isrc -I.
# NAME.lanes.c is compiled once for each of these (src/base/simd.h).
LANES.scalar =
LANES.avx2 = -mavx2
LANES.avx512 = -mavx512f -mavx512vl -mavx512dq -mavx512bw
levels := scalar $(if $(filter x86_64%,$(shell $(CC) -dumpmachine 2>/dev/null)),avx2 avx512)
LDLIBS := -lOpenEXRCore -lgsl -lgslcblas -lyaml -ljansson -lxxhash -lpng -ljpeg -lz -lm
# GNU's OpenMP is told how to wait (src/base/threads.c), for which it has to be a static library.
clang := $(if $(findstring clang,$(shell $(CC) --version 2>/dev/null)),clang)
gomp := $(if $(clang),,$(wildcard $(shell $(CC) -print-file-name=libgomp.a 2>/dev/null)))
LDLIBS += $(gomp) -Wl,--as-needed

# ---- files ----
out := build/$(BUILD)
gen := $(out)/gen
layers := $(shell cat src/ORDER)
folder = $(if $(filter analysis,$1),analysis,src/$1)
files = $(sort $(wildcard $1/*.c $1/*/*.c $1/*/*/*.c))
sources := $(foreach layer,$(layers),$(call files,$(call folder,$(layer))))
object = $(patsubst %.c,$(out)/obj/%.o,$1)
main := src/app/main.c
lanes_sources := $(filter %.lanes.c,$(sources))
lanes_objects = $(foreach level,$(levels),$(lanes_sources:%.lanes.c=$(out)/obj/%.$(level).o))
plain_sources := $(filter-out $(lanes_sources),$(sources))
objects := $(call object,$(filter-out $(main),$(plain_sources))) $(lanes_objects)
library := $(out)/libphotonlab.a
binary := $(if $(filter release,$(BUILD)),build/photonlab,$(out)/photonlab)
test_sources := $(sort $(wildcard tests/unit/*.c tests/statistical/*.c))
test_programs := $(test_sources:tests/%.c=$(out)/tests/%)
conformance_sources := $(sort $(wildcard tests/conformance/*.c))
conformance := $(out)/tests/conformance/conformance
fuzz_sources := $(sort $(wildcard tests/fuzz/*.c))
fuzz_programs := $(fuzz_sources:tests/%.c=$(out)/tests/%)
bench_sources := $(sort $(wildcard tests/bench/*.c tests/bench/part/*.c))
bench := $(out)/tests/bench/bench
cli_tests := $(filter-out tests/cli/lib.sh,$(sort $(wildcard tests/cli/*.sh)))

quiet = $(if $(V),,@printf '  %-4s %s\n' $1 $2;)
# Replaces $@ by what the recipe wrote to $@.new, only if it differs.
define keep
cmp -s $@.new $@ && rm $@.new || mv $@.new $@
endef

.PHONY: all FORCE
all: $(binary)

# ---- set-up: what is missing is installed once ----
cc_name := $(subst /,_,$(subst $() ,_,$(CC)))
packages_build := build/packages/$(cc_name).build
packages_test := build/packages/$(cc_name).test

$(packages_build): build/packages/$(cc_name).%: packages install-packages
	@mkdir -p $(@D)
	@CC="$(CC)" INSTALL="$(INSTALL)" ./install-packages build $(clang)
	@echo 'int main(void) { return 0; }' | $(CC) -fopenmp -x c - -o $@ || \
	  { echo 'photonlab: $(CC) has no OpenMP run time (Debian, clang: apt-get install libomp-dev)' >&2; exit 1; }

$(packages_test): packages install-packages | $(packages_build)
	@CC="$(CC)" INSTALL="$(INSTALL)" ./install-packages test
	@touch $@

ifeq ($(BUILD),aarch64)
packages_build := $(aarch64_root)/ready
packages_test := $(packages_build)
$(packages_build): packages install-packages tests/aarch64/root
	@CC=cc INSTALL="$(INSTALL)" ./install-packages cross
	@tests/aarch64/root $(@D)
	@touch $@
endif

# ---- generated: flags, list of objects, slots, version ----
$(gen):
	@mkdir -p $@

$(gen)/flags: FORCE | $(gen)
	@echo '$(CC) $(CFLAGS) $(LDLIBS)' >$@.new; $(keep)

$(gen)/objects: FORCE | $(gen)
	@printf '%s\n' $(objects) >$@.new; $(keep)

# A slot is a file in one of these folders; $(call slots,FOLDER) are the names in it.
slots = $(subst -,_,$(notdir $(basename $(sort $(wildcard $1/*.c)))))
define slot_table
  for name in $(call slots,$2); do echo "extern const struct $1_type $1_$$name;"; done; \
  echo "const struct $1_type *const $1_types[] = {"; \
  for name in $(call slots,$2); do echo "    &$1_$$name,"; done; \
  echo "    NULL};"
endef
define integrator_find

const struct integrator_type *integrator_find(const char *name) {
  for (int i = 0; integrator_types[i]; i++)
    if (!strcmp(integrator_types[i]->name, name)) return integrator_types[i];
  return NULL;
}
endef
export integrator_find

$(gen)/slots.c: FORCE | $(gen)
	@{ echo '// Written by the build from the names of the slot files.'; \
	echo '#include "integrator/integrator.h"'; echo '#include <string.h>'; \
	$(call slot_table,shape,src/scene/shape); \
	$(call slot_table,light,src/scene/light); \
	$(call slot_table,material,src/scene/material); \
	$(call slot_table,texture,src/scene/texture); \
	$(call slot_table,camera,src/scene/camera); \
	$(call slot_table,medium,src/scene/medium); \
	$(call slot_table,integrator,src/integrator); \
	echo "$$integrator_find"; } >$@.new; $(keep)

version = $(shell cat VERSION 2>/dev/null || git describe --always --dirty --tags 2>/dev/null || echo unknown)
c_string = "$(subst ",\",$(subst \,\\,$1))"
define version_c
// Written by the build.
#include "base/version.h"
const char photonlab_version[] = $(call c_string,$(version));
const char photonlab_compiler[] = $(call c_string,$(shell $(CC) --version 2>/dev/null | head -n 1));
const char photonlab_flags[] = $(call c_string,$(CFLAGS));
endef

$(gen)/version.c: FORCE | $(gen)
	$(file >$@.new,$(version_c))@$(keep)

# ---- compile and link ----
generated := $(gen)/slots.o $(gen)/version.o
$(generated): %.o: %.c $(gen)/flags | $(packages_build)
	@$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@

$(call object,$(plain_sources)): $(out)/obj/%.o: %.c $(gen)/flags | $(packages_build)
	@mkdir -p $(@D)
	$(call quiet,CC,$<)$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@

define lanes_rule
$(lanes_sources:%.lanes.c=$(out)/obj/%.$1.o): $(out)/obj/%.$1.o: %.lanes.c $(gen)/flags | $(packages_build)
	@mkdir -p $$(@D)
	$$(call quiet,CC,$$<)$$(CC) $$(CPPFLAGS) $$(CFLAGS) $(LANES.$1) -DSIMD=$1 -Wno-psabi -MMD -MP -c $$< -o $$@
endef
$(foreach level,$(levels),$(eval $(call lanes_rule,$(level))))

$(library): $(objects) $(gen)/slots.o $(gen)/objects
	@rm -f $@
	$(call quiet,AR,$@)$(AR) rcs $@ $(filter %.o,$^)

$(binary): $(call object,$(main)) $(gen)/version.o $(library)
	$(call quiet,LD,$@)$(CC) $(CFLAGS) $^ $(LDLIBS) -o $@

# The version changes with every commit: tests carry it, but are not linked again for it.
$(test_programs): $(out)/tests/%: $(out)/obj/tests/%.o $(library) | $(gen)/version.o
	@mkdir -p $(@D)
	$(call quiet,LD,$@)$(CC) $(CFLAGS) $(filter %.o,$^) $(library) $| $(LDLIBS) -lcmocka -o $@

$(conformance): $(call object,$(conformance_sources)) $(library) $(gen)/version.o
	@mkdir -p $(@D)
	$(call quiet,LD,$@)$(CC) $(CFLAGS) $^ $(LDLIBS) -o $@

# The statistics of the conformance test have a unit test.
$(out)/tests/unit/compare: $(call object,tests/conformance/compare.c)

$(call object,$(test_sources) $(conformance_sources)): $(out)/obj/%.o: %.c $(gen)/flags | $(packages_test)
	@mkdir -p $(@D)
	$(call quiet,CC,$<)$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@

-include $(patsubst %.o,%.d,$(lanes_objects) $(call object,$(plain_sources) $(test_sources) $(conformance_sources) $(fuzz_sources) $(bench_sources)) $(generated))

# ---- tests ----
.PHONY: test test-long conformance test-programs test-asan test-tsan test-bits test-plants validate
test-programs: $(test_programs)

# Folders of pbrt-v4's scenes and images; absent ones are skipped.
CONFORMANCE = ../shared/conformance
SCENES = ../shared/scenes
IMAGES =# of all scenes, not only of those that fail: 1
SCENE =# only those whose name contains this
folders = CONFORMANCE=$(CONFORMANCE) SCENES=$(SCENES)

test: $(binary) $(test_programs) $(conformance)
	@$(folders) PHOTONLAB=$(binary) PHOTONLAB_OBJECTS=$(out)/obj tests/run $(conformance) \
	  $(test_programs) $(cli_tests)

conformance: $(conformance)
	@$(if $(SCENE),:,[ ! -d $(CONFORMANCE) ] || $(folders) tests/conformance/pbrt-coat)
	@$(folders) OUTPUT=build/conformance $(conformance) --full $(if $(IMAGES),--images) \
	  $(if $(SCENE),--scene $(SCENE))

sanitized = TIME_LIMIT_S=900 tests/run $(test_sources:tests/%.c=build/$1/tests/%)
test-asan:
	@$(MAKE) BUILD=asan test-programs
	@$(call sanitized,asan)

# libomp tells the sanitizer of its barriers through archer; without it every one is a false race.
test-tsan:
	@$(MAKE) BUILD=tsan test-programs
	@OMP_TOOL_LIBRARIES="$$(clang -print-resource-dir)/../../libarcher.so" \
	  TSAN_OPTIONS=ignore_noninstrumented_modules=1 $(call sanitized,tsan)

# ---- fuzzing: clang's libFuzzer, one target a file in tests/fuzz ----
FUZZ_SECONDS = 60# for each target
packages_fuzz := build/packages/$(cc_name).fuzz

$(packages_fuzz): packages install-packages | $(packages_build)
	@CC="$(CC)" INSTALL="$(INSTALL)" ./install-packages fuzz clang
	@touch $@

$(fuzz_programs): $(out)/tests/%: $(out)/obj/tests/%.o $(library) $(gen)/version.o
	@mkdir -p $(@D)
	$(call quiet,LD,$@)$(CC) $(CFLAGS) -fsanitize=fuzzer $^ $(LDLIBS) -o $@

$(call object,$(fuzz_sources)): $(out)/obj/%.o: %.c $(gen)/flags | $(packages_fuzz)
	@mkdir -p $(@D)
	$(call quiet,CC,$<)$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@

.PHONY: fuzz fuzz-coverage fuzz-programs
fuzz-programs: $(fuzz_programs)

fuzz:
	@$(MAKE) BUILD=fuzz fuzz-programs
	@FUZZ_SECONDS=$(FUZZ_SECONDS) tests/fuzz/run $(fuzz_sources:tests/%.c=build/fuzz/tests/%)

# Of the readers of files, by the corpora and what `make fuzz` has added to them.
fuzz-coverage:
	@$(MAKE) BUILD=coverage fuzz-programs
	@tests/fuzz/coverage $(fuzz_sources:tests/%.c=build/coverage/tests/%)

# Tests that take more samples if asked, and with them the tolerances that theory states.
long_tests := $(filter $(shell grep -l TEST_LONG tests/unit/*.c tests/statistical/*.c),$(test_sources))
long_programs := $(long_tests:tests/%.c=$(out)/tests/%)
test-long: $(long_programs)
	@TEST_LONG=1 TIME_LIMIT_S=3600 tests/run $(long_programs)

unit_programs := $(filter $(out)/tests/unit/%,$(test_programs))
.PHONY: unit-programs test-aarch64
unit-programs: $(unit_programs)

test-bits: $(binary) $(unit_programs)
	@TIME_LIMIT_S=1800 PHOTONLAB=$(binary) UNIT_PROGRAMS="$(unit_programs)" tests/run tests/bits

# aarch64 and an x86-64 without AVX, emulated. Pages that are reserved cost the emulator time and memory.
emulated = CFLAGS_EXTRA='$(CFLAGS_EXTRA) -DRESERVE_BITS=28'
aarch64 = $(MAKE) BUILD=aarch64 $(emulated) CC=

test-aarch64: $(binary)
	@$(aarch64)'$(aarch64_gcc)' $(aarch64_root)/ready || \
	  { echo '0 passed, 0 failed: skipped, the packages for aarch64 are not to be had'; exit; }; \
	$(aarch64)'$(aarch64_gcc)' all unit-programs && \
	{ ! command -v clang >/dev/null || \
	  $(aarch64)'clang --target=aarch64-linux-gnu --sysroot=$(aarch64_root)' out=build/aarch64-clang; } && \
	$(MAKE) out=build/x86-64 binary=build/x86-64/photonlab $(emulated) && \
	EMULATOR=qemu-aarch64-static QEMU_LD_PREFIX=$(CURDIR)/$(aarch64_root) OMP_NUM_THREADS=1 \
	  TIME_LIMIT_S=1800 PHOTONLAB=$(binary) \
	  tests/run tests/aarch64/bits.sh $(unit_programs:$(out)/%=build/aarch64/%)

test-plants:
	@tests/plants/run

validate: $(binary)
	$(binary) validate

# ---- benchmarks: tests/bench, a part a file in part/ ----
BENCH =# the beginning of PART/ROW, as the table names them: only these
REPETITIONS =# of each row; empty: the parts' own
PERF = ../shared/perf# folder of scenes that pbrt-v4 was timed on; an absent one is skipped
embree_header := $(wildcard /usr/include/embree3/rtcore.h)
EMBREE = $(if $(embree_header),1)# 1: rays against Embree, too; it is installed if need be
FIGURES = build/bench.csv

$(gen)/bench.c: FORCE | $(gen)
	@{ echo '// Written by the build from the names of the files in tests/bench/part.'; \
	echo '#include "tests/bench/bench.h"'; echo '#include <stddef.h>'; \
	$(call slot_table,part,tests/bench/part); } >$@.new; $(keep)

$(gen)/embree: FORCE | $(gen)
	@echo '$(EMBREE)' >$@.new; $(keep)
	@$(if $(EMBREE),$(if $(embree_header),,CC="$(CC)" INSTALL="$(INSTALL)" ./install-packages peer))

$(gen)/bench.o: $(gen)/bench.c $(gen)/flags
	@$(CC) $(CPPFLAGS) $(CFLAGS) -c $< -o $@

$(call object,tests/bench/embree.c): CPPFLAGS += $(if $(EMBREE),-DBENCH_EMBREE)
$(call object,tests/bench/embree.c): $(gen)/embree
$(call object,$(bench_sources)): $(out)/obj/%.o: %.c $(gen)/flags | $(packages_build)
	@mkdir -p $(@D)
	$(call quiet,CC,$<)$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@

# Rays are counted where the walks ask for them.
$(bench): $(call object,$(bench_sources)) $(gen)/bench.o $(library) $(gen)/version.o
	@mkdir -p $(@D)
	$(call quiet,LD,$@)$(CC) $(CFLAGS) -Wl,--wrap=bvh_closest,--wrap=bvh_blockers $^ $(LDLIBS) $(if $(EMBREE),-lembree3) -o $@

.PHONY: bench bench-compare bench-skip bench-program
bench-program: $(bench)

bench: $(bench)
	@$(bench) --perf "$(PERF)" --csv "$(FIGURES)" $(addprefix --repetitions ,$(REPETITIONS)) $(BENCH)

# What each skip saves.
bench-skip: BENCH = skip
bench-skip: FIGURES = build/bench-skip.csv
bench-skip: bench

bench-compare: bench
	@tests/bench/compare tests/bench/figures.csv "$(FIGURES)"

# ---- experiments ----
# make experiment-NAME runs experiments/NAME.yaml, fits and plots it into results/NAME. One that has to be
# run in another way says how in experiments/NAME.sh PHOTONLAB RESULTS QUALITY.
experiments := $(patsubst experiments/%.yaml,experiment-%,$(sort $(wildcard experiments/*.yaml)))
RESULTS = results/$*

define run_fit_plot
$(binary) run experiments/$*.yaml -o $(RESULTS) --quality $(QUALITY)
$(binary) fit $(RESULTS)
$(binary) plot $(RESULTS)
endef

.PHONY: $(experiments) paper-figures
$(experiments): experiment-%: $(binary)
	$(if $(wildcard experiments/$*.sh),$(folders) experiments/$*.sh $(binary) $(RESULTS) $(QUALITY),$(run_fit_plot))

# One after the other, each by all threads; those after one that fails are still made.
figures_of = $(if $(filter command,$(origin RESULTS)),$(RESULTS),results)
paper-figures: $(binary)
	@made= failed=; \
	for name in $(experiments:experiment-%=%); do \
	  if $(MAKE) experiment-$$name RESULTS=$(figures_of)/$$name; \
	  then made="$$made $(figures_of)/$$name/figures/*.pdf"; else failed="$$failed $$name"; fi; \
	done; \
	[ -z "$$made" ] || ls -1 $$made; \
	[ -z "$$failed" ] || { echo "photonlab: failed:$$failed" >&2; exit 1; }

experiment-%:
	@echo 'photonlab: there is no experiments/$*.yaml; there are: $(experiments)' >&2; exit 1

# ---- install, distribute ----
share = $(DESTDIR)$(PREFIX)/share

.PHONY: install uninstall dist clean help
install: $(binary)
	install -d $(DESTDIR)$(PREFIX)/bin $(share)/man/man1 $(share)/photonlab
	install -m 755 $(binary) $(DESTDIR)$(PREFIX)/bin/photonlab
	install -m 644 src/app/photonlab.1 $(share)/man/man1/photonlab.1
	cp -R scenes experiments paper-figures $(share)/photonlab

uninstall:
	rm -f $(DESTDIR)$(PREFIX)/bin/photonlab $(share)/man/man1/photonlab.1
	rm -rf $(share)/photonlab

# What is committed, and a file VERSION in place of the history.
dist: name = photonlab-$(shell git describe --always --tags)
dist:
	@mkdir -p build
	@git describe --always --tags >build/VERSION
	git archive --prefix=$(name)/ --add-file=build/VERSION -o build/$(name).tar.gz HEAD

clean:
	rm -rf build

help:
	@echo 'make                   build/photonlab; installs Debian packages that are missing'
	@echo 'make test              all tests: N passed, N failed'
	@echo 'make test-long         the statistical ones again with more samples, at theory'"'"'s tolerances'
	@echo 'make test-asan         unit and statistical tests under address and undefined sanitizers'
	@echo 'make test-tsan         the same under the thread sanitizer (clang)'
	@echo 'make fuzz              FUZZ_SECONDS=60 for each reader of files; fuzz-coverage: lines reached'
	@echo 'make test-bits         the same bytes from gcc -O1, -O3, clang and every instruction set'
	@echo 'make test-aarch64      unit tests and the same bytes on aarch64 and a plain x86-64, emulated'
	@echo 'make test-plants       plants known bugs in a copy and checks that the tests find them'
	@echo 'make conformance       images against pbrt-v4, as precise as the stored ones (CONFORMANCE=folder'
	@echo '                       SCENES=folder SCENE=name IMAGES=1)'
	@echo 'make bench             what everything costs (BENCH=PART[/ROW] EMBREE=1 PERF=folder);'
	@echo '                       bench-compare: against tests/bench/figures.csv; bench-skip: what is skipped'
	@echo 'make validate          the built-in checks against closed forms'
	@echo 'make experiment-NAME   runs experiments/NAME.yaml, fits, plots; into results/NAME'
	@for name in $(experiments); do echo "                         $$name"; done
	@echo 'make paper-figures     all of them, one after the other; says where each figure is'
	@echo 'make install           PREFIX=/usr/local DESTDIR='
	@echo 'make uninstall | dist | clean'
	@echo
	@echo 'BUILD=release|debug|asan|tsan|fuzz|coverage|aarch64  CC=gcc|clang  OPT=-O2  CFLAGS_EXTRA=  V=1'
	@echo 'INSTALL=no (never call apt-get)  QUALITY=default|paper  RESULTS=folder'
