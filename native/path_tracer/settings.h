// What an artist may choose of path tracing; the names and meanings of limits are Cycles'.
#pragma once

namespace panoptes::path_tracer {

// How often light may be scattered on its way, 0 .. 1024; after `total` times, or so many times by
// one kind of lobe, a path ends with what the surface it meets emits. Layers that let light pass
// straight on count for themselves: behind `transparent` of them a path ends, and no light comes
// through.
struct Bounces {
  int total = 8;
  int diffuse = 8, glossy = 8, transmission = 8;
  int transparent = 16;
  bool operator==(const Bounces&) const = default;
};

struct Settings {
  Bounces bounces;
  float clamp_direct = 0;    // most that one sample of a pixel may get, by its largest channel; 0: all
  float clamp_indirect = 0;  // the same of light that was scattered more than once
  // Glossy surfaces that are met after an unlikely turn look rougher, by the factor that the
  // likelihood falls short of 1 / this: the sparkle of caustics becomes a glow. 0: never; 1: as Cycles.
  float filter_glossy = 1;
  // Lamps cast shadows by maps in place of rays: the thesis' fast option, section 7.3.
  bool shadow_maps = false;
  // The camera's rays are rasterised in place of traced: sharp everywhere, one place in the pixel for
  // all pixels of a sample.
  bool raster_primary = false;
  float ao_distance = 10;    // m, how far the AO pass looks; not positive: to the end

  // Throws Error with a sentence when a value is out of range.
  void check() const;
  bool operator==(const Settings&) const = default;
};

}  // namespace panoptes::path_tracer
