#include "ambient_occlusion/occlusion.h"

#include <fmt/format.h>

namespace panoptes::ambient_occlusion {

namespace {

// The G-buffer's positions and normals are all that is read of it.
const rasterize::GBufferOptions kNoMore;

gl::ProgramSource compute(const char* name, const char* file) {
  gl::ProgramSource source;
  source.name = name;
  source.stages = {{GL_COMPUTE_SHADER, file}};
  return source;
}

}  // namespace

gl::ProgramSource sample_program(const SampleOptions& options) {
  gl::ProgramSource source = compute("ambient occlusion", "ambient_occlusion/sample.comp");
  source.defines = {"ALCHEMY 0", "SSAO 1", "HBAO 2", "OBSCURANCE 3",
                    fmt::format("ESTIMATOR {}", options.obscurance ? 3 : int(options.estimator)),
                    fmt::format("HBAO_SLICES {}", kHbaoSlices),
                    fmt::format("HBAO_STEPS {}", kHbaoSteps),
                    fmt::format("CAMERA_VIEW {}", int(options.view == ViewKind::kCamera)),
                    fmt::format("PHANTOM {}", int(options.view == ViewKind::kPhantom)),
                    fmt::format("CUBE {}", int(options.cube)),
                    fmt::format("CASCADES {}", int(options.cascades)),
                    fmt::format("IMPORTANCE {}", int(options.importance_sampling)),
                    fmt::format("BENT_NORMALS {}", int(options.bent_normals)),
                    fmt::format("PROBES {}", int(options.probes))};
  kNoMore.add_defines(source);
  return source;
}

gl::ProgramSource combine_program(bool bent_normals) {
  gl::ProgramSource source = compute("ambient occlusion of all views",
                                     "ambient_occlusion/combine.comp");
  source.defines = {fmt::format("BENT_NORMALS {}", int(bent_normals))};
  kNoMore.add_defines(source);
  return source;
}

gl::ProgramSource filter_program() {
  gl::ProgramSource source = compute("ambient occlusion filter", "ambient_occlusion/filter.comp");
  kNoMore.add_defines(source);
  return source;
}

gl::ProgramSource picture_program(Picture picture, const film::Film& film) {
  gl::ProgramSource source = compute("ambient occlusion picture", "ambient_occlusion/picture.comp");
  source.defines = {"WEIGHTS 1", "SAMPLES 2", "CONTRIBUTION 3", "BENT_NORMALS 4", "SINGLE_VIEW 5",
                    fmt::format("PICTURE {}", int(picture))};
  film.add_defines(source);
  return source;
}

}  // namespace panoptes::ambient_occlusion
