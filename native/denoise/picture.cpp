#include "denoise/picture.h"

namespace panoptes::denoise {

using film::Pass;

film::PassSet features(bool blurred) {
  film::PassSet passes;
  for (Pass pass : {Pass::kNormal, Pass::kDiffCol, Pass::kGlossCol, Pass::kTransCol, Pass::kEmit, Pass::kEnv})
    passes.set(size_t(pass));
  passes.set(size_t(Pass::kPosition), !blurred);
  return passes;
}

Picture gather(const film::Film& film, std::span<const float> noisy, std::span<const float> variance, float exposure,
               bool blurred) {
  const auto sum_of = [&](std::initializer_list<Pass> passes) {
    std::vector<float> sum;
    for (Pass pass : passes) {
      const std::vector<float> values = film.read(pass, exposure);
      sum.resize(values.size());
      for (size_t i = 0; i < values.size(); ++i) sum[i] += values[i];
    }
    return sum;
  };
  return {film.width(), film.height(), noisy, variance, sum_of({Pass::kEmit, Pass::kEnv}),
          sum_of({Pass::kDiffCol, Pass::kGlossCol, Pass::kTransCol}), film.read(Pass::kNormal, 1),
          blurred ? std::vector<float>() : film.read(Pass::kPosition, 1)};
}

}  // namespace panoptes::denoise
