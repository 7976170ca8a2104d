#include "rays/brute_force.h"

namespace panoptes::test {

namespace {

constexpr GLint kCountLocation = 8;  // beyond trace.comp's own

constexpr const char* kTraversal =
    "layout(location = 8) uniform uint triangle_count;\n"
    "const uint TRAVERSAL_WORDS = 1u;\n"
    "struct Traversal { uint next; };\n"
    "Traversal traversal_begin(Ray ray) { return Traversal(0u); }\n"
    "bool traverse(Ray ray, inout Traversal at, inout TracedHit hit, int budget) {\n"
    "  while (at.next < triangle_count) {\n"
    "    if (budget-- == 0) return false;\n"
    "    intersect(ray, at.next++, hit);\n"
    "#if ANY_HIT\n"
    "    if (hit.primitive != NO_PRIMITIVE) return true;\n"
    "#endif\n"
    "  }\n"
    "  return true;\n"
    "}\n"
    "void traversal_save(Traversal at, uint word) { put_word(word, at.next); }\n"
    "#if RESUMED\n"
    "Traversal traversal_load(Ray ray, uint word) { return Traversal(get_word(word)); }\n"
    "#endif\n";

}  // namespace

void BruteForceTracer::add_to(gl::ProgramSource& source) const {
  source.snippets["generated/tracer.glsl"] = kTraversal;
}

void BruteForceTracer::bind() const { glUniform1ui(kCountLocation, count_); }

}  // namespace panoptes::test
