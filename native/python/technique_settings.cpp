#include "python/technique_settings.h"

#include "python/dict.h"

namespace panoptes::python {

ambient_occlusion::Settings occlusion_settings(const py::dict& dict) {
  namespace ao = ambient_occlusion;
  ao::Settings s;
  Members members(dict, "ambient occlusion");
  members.read("estimator", s.estimator, ao::kEstimatorNames);
  members.read("distance", s.distance);
  members.read("strength", s.strength);
  members.read("samples", s.samples);
  members.read("importance_sampling", s.importance_sampling);
  members.read("initial_samples", s.initial_samples);
  members.read("secondary_views", s.secondary_views);
  members.read("phantoms", s.phantoms, ao::kPhantomsNames);
  members.read("phantom_resolution", s.phantom_resolution);
  s.phantom_camera_count = members.read_list(
      "phantom_cameras", ao::kMostPhantomCameras, "phantom cameras", [&](int i, const py::dict& item) {
        gpu_scene::Camera& camera = s.phantom_cameras[size_t(i)];
        camera.world_to_camera = wide_matrix(item, "view");
        camera.projection = wide_matrix(item, "projection");
      });
  members.read("filter", s.filter, ao::kFilterNames);
  members.read("deep_shadows", s.deep_shadows);
  members.read("picture", s.picture, ao::kPictureNames);
  members.check_all_known();
  return s;
}

radiance_cache::Settings cache_settings(const py::dict& dict) {
  namespace rc = radiance_cache;
  rc::Settings s;
  Members members(dict, "the radiance cache");
  members.read("enabled", s.enabled);
  members.read("bounces", s.bounces);
  members.read("resolution", s.resolution);
  members.read("voxels", s.voxels);
  members.read("cascades", s.cascades);
  members.read("encoding", s.encoding, rc::kEncodingNames);
  members.read("luminance", s.luminance);
  members.read("chrominance", s.chrominance);
  s.region_count = members.read_list(
      "regions", rc::kMostRegions, "regions of indirect light", [&](int i, const py::dict& item) {
        rc::Region& region = s.regions[size_t(i)];
        Members scales(item, "a region of indirect light");
        scales.read("world_to_box", region.world_to_box);
        scales.read("luminance", region.luminance);
        scales.read("chrominance", region.chrominance);
        scales.check_all_known();
      });
  members.read("first_bounce", s.first_bounce, rc::kFirstBounceNames);
  members.read("directions", s.directions);
  members.read("march_steps", s.march_steps);
  members.read("voxel_fill", s.voxel_fill);
  members.read("occupancy", s.occupancy, rc::kOccupancyNames);
  members.read("depth_stride", s.depth_stride);
  members.read("dilate", s.dilate);
  members.read("walls", s.walls);
  members.read("rsm_samples", s.rsm_samples);
  members.read("rsm_resolution", s.rsm_resolution);
  members.read("rsm_spread", s.rsm_spread);
  members.read("rsm_mixed", s.rsm_mixed);
  members.read("blend", s.blend);
  members.read("rebuild_every", s.rebuild_every);
  members.read("picture", s.picture, rc::kPictureNames);
  members.check_all_known();
  return s;
}

specular_rays::Settings specular_settings(const py::dict& dict) {
  specular_rays::Settings s;
  Members members(dict, "specular rays");
  members.read("mode", s.mode, specular_rays::kModeNames);
  members.read("roughness", s.roughness);
  members.check_all_known();
  return s;
}

fragment_tracer::Settings fragment_settings(const py::dict& dict) {
  namespace ft = fragment_tracer;
  ft::Settings s;
  Members members(dict, "fragment tracing");
  members.read("views", s.views, ft::kViewsNames);
  members.read("side", s.side);
  members.read("camera_width", s.camera_width);
  members.read("storage", s.storage, ft::kStorageNames);
  members.read("buckets", s.buckets);
  members.read("bounds", s.bounds, ft::kBoundsNames);
  members.read("layers", s.layers);
  members.read("decoupled", s.decoupled);
  members.read("skipping", s.skipping);
  members.read("binary_search", s.binary_search);
  members.read("walk", s.walk, ft::kWalkNames);
  members.read("steps", s.steps);
  members.read("thickness", s.thickness);
  members.read("by_plane", s.by_plane);
  members.check_all_known();
  return s;
}

}  // namespace panoptes::python
