// The simplest tracer: every ray is tested with every triangle. Slow, and the judge of the others:
// it shares their intersection test, so whatever they find otherwise their structure lost or made
// up.
#pragma once

#include "tracing/tracer.h"

namespace panoptes::test {

class BruteForceTracer : public tracing::Tracer {
 public:
  void build(const tracing::TriangleList& triangles, gl::ProgramCache&, gl::PassTimer&) override {
    count_ = triangles.count();
  }
  void add_to(gl::ProgramSource& source) const override;
  void bind() const override;
  uint32_t traversal_words() const override { return 1; }
  int64_t bytes() const override { return 0; }

 private:
  uint32_t count_ = 0;
};

}  // namespace panoptes::test
