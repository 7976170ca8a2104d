// Software rasterisers take memory in pieces for the triangles of a pass, and give it back when they are drawn.
#pragma once

namespace panoptes::gl {

// Lets the calling thread have these pieces again at once where the process uses jemalloc (version 5), as Blender does.
// That merges free pieces that are neighbours, and then takes none of less than a 64th of the whole out of them: each
// pass gets new pages from the system, which on llvmpipe takes as long as drawing. From now on the thread's memory is
// merged only up to a few megabytes. Does nothing with other allocators, or a second time on one thread.
void keep_heap_in_pieces();

}  // namespace panoptes::gl
