// What ray tracers have in common: a structure over a list of triangles, and GLSL that walks it.
//
// A tracer is chosen when a program is compiled. Its GLSL file, which shaders/tracing/trace.comp
// includes as generated/tracer.glsl, defines
//
//     const uint TRAVERSAL_WORDS;                       words that save() writes, as traversal_words()
//     struct Traversal { ... };                         where a ray is in the structure
//     Traversal traversal_begin(Ray ray);
//     bool traverse(Ray ray, inout Traversal at, inout TracedHit hit, int budget);
//     void traversal_save(Traversal at, uint word);     by put_word(word + i, value)
//     Traversal traversal_load(Ray ray, uint word);     by get_word(word + i), with RESUMED 1 only
//
// traverse() looks for what `ray` meets before hit.t, by intersect() of tracing/intersect.glsl, which
// keeps the closest (with ANY_HIT 1: whatever is met ends the search); by intersect_corners() if the
// structure has triangles of its own. It returns true when it is through, and false after about
// `budget` iterations of all its loops together: the ray is then saved and goes on in another
// dispatch, since llvmpipe cuts an invocation off after 65 535 iterations and no dispatch may hold up
// a GPU. It says COUNT_STEP for each node or cell and COUNT_LIST(cell, length) for each list, which
// count with COUNT_WORK 1 only.
#pragma once

#include "gl/pass_timer.h"
#include "gl/program.h"
#include "tracing/triangle_list.h"

#include <cstdint>

namespace panoptes::tracing {

// Texture units and bindings of a program that traces. Units from kStructureUnit to kRayUnit - 1 and
// the uniform block kStructureBlock are the tracer's own.
inline constexpr int kTriangleUnit = 0, kStructureUnit = 1, kRayUnit = 6;
inline constexpr unsigned kStructureBlock = 2;

class Tracer {
 public:
  virtual ~Tracer() = default;

  // Makes the structure anew. `triangles` must stay as they are for as long as rays are traced.
  // Throws Error, saying what would fit, when the device has no room for it.
  virtual void build(const TriangleList& triangles, gl::ProgramCache& programs,
                     gl::PassTimer& timer) = 0;
  // Puts the traversal and its constants into a program.
  virtual void add_to(gl::ProgramSource& source) const = 0;
  // Binds what the traversal reads, for the program in use.
  virtual void bind() const = 0;
  // Words of a ray's place in the structure, as its GLSL saves it.
  virtual uint32_t traversal_words() const = 0;
  // Held by the structure as it is built, without the list of triangles.
  virtual int64_t bytes() const = 0;
};

}  // namespace panoptes::tracing
