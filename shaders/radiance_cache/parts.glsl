// A cell's texels stand once for all light; or, with CACHE_SPLIT, for the world's and then for bounced.
#if CACHE_SPLIT
#define CACHE_PARTS 2
#else
#define CACHE_PARTS 1
#endif
