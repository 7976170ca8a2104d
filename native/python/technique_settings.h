// Settings of techniques out of dictionaries with the names of their members. Each
// throws Error when a name is unknown or a value of the wrong type; ranges are checked later, with
// the whole request.
#pragma once

#include "ambient_occlusion/settings.h"
#include "fragment_tracer/settings.h"
#include "python/convert.h"
#include "radiance_cache/settings.h"
#include "specular_rays/settings.h"

namespace panoptes::python {

// `phantom_cameras`: a list of {'view', 'projection'}, 4x4 each.
ambient_occlusion::Settings occlusion_settings(const py::dict& dict);

// `regions`: a list of {'world_to_box': 4x4, 'luminance', 'chrominance'}.
radiance_cache::Settings cache_settings(const py::dict& dict);

specular_rays::Settings specular_settings(const py::dict& dict);

fragment_tracer::Settings fragment_settings(const py::dict& dict);

}  // namespace panoptes::python
