// How a variant of the A-buffer lies in memory, in words of 4 bytes (Table 6.2 of the thesis, derived anew in
// native/fragment_tracer/settings.h). LINKS: 0 arrays, 1 to the next fragment, 2 to the previous one as well. BUCKETS: of
// a pixel, 0 for none. DECOUPLED: what is read of hits alone lies in a buffer of its own.

// A pixel: with buckets the bits of its depth bounds; then first and count of an array, or the heads of its lists and
// behind them their tails.
#if BUCKETS
const int HEADS_AT = 2, TAILS_AT = BUCKETS, PIXEL_WORDS = 2 + BUCKETS * LINKS;
#elif LINKS == 1
const int PIXEL_WORDS = 1;
#else
const int TAILS_AT = 1, PIXEL_WORDS = 2;
#endif

// A node: the depth; the links, or an array's way to the data; the data.
#if DECOUPLED
const int NODE_WORDS = 1 + (LINKS == 0 ? 1 : LINKS);
#else
const int DATA_AT = 1 + LINKS, NODE_WORDS = DATA_AT + 3;
#endif
