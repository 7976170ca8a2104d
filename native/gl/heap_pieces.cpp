#include "gl/heap_pieces.h"

#include <dlfcn.h>

#include <cstddef>

namespace panoptes::gl {

namespace {

// Of jemalloc's interface, version 5 (its manual, "arena.<i>.extent_hooks"); a hook that returns true has declined.
struct Hooks;
using Merge = bool (*)(Hooks*, void*, size_t, void*, size_t, bool, unsigned);
struct Hooks {
  void* others[8];  // alloc, dalloc, destroy, commit, decommit, purge_lazy, purge_forced, split
  Merge merge;
};
using Control = int (*)(const char*, void*, size_t*, void*, size_t);

// llvmpipe's pieces have 64 KiB and a little; a 64th of this is less.
constexpr size_t kMostMerged = size_t(4) << 20;

Hooks* usual = nullptr;

bool merge_little(Hooks*, void* a, size_t a_bytes, void* b, size_t b_bytes, bool committed, unsigned arena) {
  return a_bytes + b_bytes > kMostMerged || usual->merge(usual, a, a_bytes, b, b_bytes, committed, arena);
}

// The number of an arena of jemalloc's with these hooks, one for all threads that want it; 0 where there is none.
unsigned arena_of_pieces() {
  static const unsigned made = []() -> unsigned {
    const auto control = reinterpret_cast<Control>(dlsym(RTLD_DEFAULT, "mallctl"));
    size_t bytes = sizeof usual;
    if (!control || control("arena.0.extent_hooks", &usual, &bytes, nullptr, 0) != 0 || !usual) return 0;
    static Hooks hooks = *usual;
    hooks.merge = merge_little;
    Hooks* ours = &hooks;
    unsigned arena = 0;
    bytes = sizeof arena;
    return control("arenas.create", &arena, &bytes, &ours, sizeof ours) == 0 ? arena : 0;
  }();
  return made;
}

}  // namespace

void keep_heap_in_pieces() {
  unsigned arena = arena_of_pieces();
  if (arena == 0) return;
  const auto control = reinterpret_cast<Control>(dlsym(RTLD_DEFAULT, "mallctl"));
  control("thread.arena", nullptr, nullptr, &arena, sizeof arena);
}

}  // namespace panoptes::gl
