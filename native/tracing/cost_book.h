// What ray tracers cost on this device, as measured while they run, and which one of them a frame
// should take.
//
// A structure that builds fast serves geometry that moves; one that traces fast pays for itself when
// many rays follow. Which is which depends on the device and the scene, so nothing is assumed for
// longer than until it has been measured.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace panoptes::tracing {

class CostBook {
 public:
  // Of structures over `triangles` triangles, and of tracing `rays` rays. Later measurements count as
  // much as all earlier ones together, since scenes differ. Nothing is learnt from less than 1000 of
  // either, which is mostly overhead.
  void add_build(const std::string& tracer, uint32_t triangles, double ms);
  void add_trace(const std::string& tracer, int64_t rays, double ms);

  // The tracer of `candidates` (not empty) that will have cost least after `rays` rays. `built` is
  // the one whose structure stands already, or empty. What has not been measured costs what
  // bench rays showed on llvmpipe, in proportion.
  std::string choose(std::span<const std::string> candidates, const std::string& built,
                     uint32_t triangles, int64_t rays) const;

 private:
  struct Cost {
    double build = 0, trace = 0;  // ns a triangle, ns a ray; 0: not measured
  };
  static void learn(double& known, double measured);

  std::map<std::string, Cost> costs_;
};

}  // namespace panoptes::tracing
