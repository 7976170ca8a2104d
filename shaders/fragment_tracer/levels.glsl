// The pyramid of depth bounds: cells of a level are 2^level pixels a side, those at the borders of a view less.
ivec2 level_size(int view, int level) { return (block.views[view].size.xy + (1 << level) - 1) >> level; }

int level_index(int view, int level, ivec2 cell) {
  int at = view * int(MOST_LEVELS) + level;
  return block.level_first[at >> 2][at & 3] + cell.y * level_size(view, level).x + cell.x;
}
