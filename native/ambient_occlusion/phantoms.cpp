#include "ambient_occlusion/phantoms.h"

#include "rasterize/shadow_face.h"

#include <algorithm>
#include <cmath>

namespace panoptes::ambient_occlusion {

namespace {

using gpu_scene::LightView;

// How far to the side and behind the camera the pair stands, as shares of the focus: where the
// error against traced occlusion is least in a crammed room, a colonnade and an atrium. Farther to
// the side walls hide more, nearer the camera sees the same; farther behind there is less to see
// around what stands in the picture. The best is flat: .5 to .7 and .15 to .4 differ by a few
// percent.
constexpr double kSide = 0.55;
constexpr double kBack = 0.25;

// The pair shows what the camera shows from a third of the focus to three times it: most of what is
// seen where half of it is nearer and half of it farther than the focus.
constexpr double kDepths = 3;
// And half as much again, since what stands beside the picture darkens what is in it: a third to
// nine tenths of the occluders that the camera misses are not in its frustum. More is worth nothing
// at 256 texels, which become as much coarser.
constexpr double kBeyond = 1.5;

// Nearer than that to a wall (as a share of the way to it) nothing is seen but the wall.
constexpr double kRoom = 0.9;

// Looking more steeply than that (sine of the angle to the vertical), no direction is level and to
// the side for certain; the camera's own right is, near enough.
constexpr double kSteep = 0.05;

bool finite(const scene::Bounds& b) {
  return !b.empty() &&
         std::isfinite(glm::dot(glm::dvec3(b.high) - glm::dvec3(b.low), glm::dvec3(1)));
}

// Parallel to the ground and square to the camera's axis, to its right unless it is upside down.
glm::dvec3 level_right(const LightView& seen) {
  const glm::dvec3 level = glm::cross(seen.axis, {0, 0, 1});
  return glm::length(level) > kSteep ? glm::normalize(level) : seen.x;
}

// Depth of what the pair looks at.
double sane_focus(double focus, const LightView& seen, const scene::Bounds& bounds) {
  if (!std::isfinite(focus) || (seen.perspective && focus <= 0))
    focus = finite(bounds)
                ? glm::dot(0.5 * (glm::dvec3(bounds.low) + glm::dvec3(bounds.high)) - seen.origin,
                           seen.axis)
                : seen.near_depth;
  return std::clamp(focus, seen.near_depth, seen.far_depth);
}

// Depth of the last of the scene, or of what a camera sees where the scene has no bounds.
double last_depth(const glm::dvec3& origin, const glm::dvec3& axis, const scene::Bounds& bounds,
                  double otherwise) {
  if (!finite(bounds)) return otherwise;
  const glm::dvec3 low(bounds.low), high(bounds.high);
  const glm::dvec3 last{axis.x > 0 ? high.x : low.x, axis.y > 0 ? high.y : low.y,
                        axis.z > 0 ? high.z : low.z};
  return glm::dot(last - origin, axis) + 1e-3 * glm::length(high - low);
}

// How far one can go from `origin` along `direction` before leaving the bounds; without end if one
// is outside already.
double room_along(const glm::dvec3& origin, const glm::dvec3& direction,
                  const scene::Bounds& bounds) {
  double room = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (!(origin[i] > bounds.low[i] && origin[i] < bounds.high[i]))
      return std::numeric_limits<double>::infinity();
    const double wall = direction[i] > 0 ? bounds.high[i] : bounds.low[i];
    if (direction[i] != 0) room = std::min(room, (wall - origin[i]) / direction[i]);
  }
  return room;
}

// Gives `view` the window that holds `low` to `high` (units of half_x) and a little more.
void set_window(LightView& view, const glm::dvec2& low, const glm::dvec2& high) {
  const glm::dvec2 half = 0.5 * kBeyond * (high - low);
  view.half_x = half.x;
  view.half_y = half.y;
  view.shift = 0.5 * (low + high);
}

// The camera moved by `side` metres along `right` and by `back` away from the focus. It looks in
// the camera's own direction through a window that is shifted towards the focus, so that its near
// plane is the camera's: a wall behind the camera hides nothing, and nothing in front is cut away.
LightView beside(const LightView& seen, const glm::dvec3& right, double side, double back,
                 const glm::dvec2& depths, const scene::Bounds& bounds) {
  LightView view = seen;
  view.origin += side * right - back * seen.axis;
  view.near_depth = seen.near_depth + back;
  view.far_depth = std::max(last_depth(view.origin, view.axis, bounds, seen.far_depth + back),
                            1.001 * view.near_depth);
  const glm::dvec2 moved = side * glm::dvec2(glm::dot(right, seen.x), glm::dot(right, seen.y));
  const glm::dvec2 half = glm::abs(glm::dvec2(seen.half_x, seen.half_y));
  glm::dvec2 low(std::numeric_limits<double>::max()), high(-low);
  for (const double depth : {depths.x, depths.y}) {
    low = glm::min(low, (depth * (seen.shift - half) - moved) / (depth + back));
    high = glm::max(high, (depth * (seen.shift + half) - moved) / (depth + back));
  }
  set_window(view, low, high);
  return view;
}

// The orthographic camera turned about the point that it sees at the depth `focus` in the middle of
// its picture; `slope` is the tangent of the angle, above 0 if it comes to stand on the right.
LightView turned(const LightView& seen, const glm::dvec3& right, double slope, double focus,
                 const glm::dvec2& depths, const scene::Bounds& bounds) {
  const double cosine = 1.0 / std::sqrt(1.0 + slope * slope), sine = slope * cosine;
  // A vector's part along `right` and its part along the axis turn into each other.
  const auto turn = [&](const glm::dvec3& v) {
    const double r = glm::dot(v, right), a = glm::dot(v, seen.axis);
    return v + right * (r * (cosine - 1) - a * sine) + seen.axis * (a * (cosine - 1) + r * sine);
  };
  LightView view = seen;
  view.origin += focus * seen.axis + seen.shift.x * seen.x + seen.shift.y * seen.y;
  view.x = turn(seen.x);
  view.y = turn(seen.y);
  view.axis = turn(seen.axis);
  view.near_depth = (seen.near_depth - focus) * cosine;
  view.far_depth = last_depth(view.origin, view.axis, bounds, seen.far_depth - focus);
  view.far_depth =
      std::max(view.far_depth, view.near_depth + 1e-3 * (seen.far_depth - seen.near_depth));
  glm::dvec2 low(std::numeric_limits<double>::max()), high(-low);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p = (corner & 1 ? 1.0 : -1.0) * seen.half_x * seen.x +
                         (corner & 2 ? 1.0 : -1.0) * seen.half_y * seen.y +
                         ((corner & 4 ? depths.y : depths.x) - focus) * seen.axis;
    const glm::dvec2 place(glm::dot(p, view.x), glm::dot(p, view.y));
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  set_window(view, low, high);
  return view;
}

// Texels of a view's map: square ones, `resolution` along the longer side.
glm::ivec2 texels(const LightView& view, int resolution) {
  const glm::dvec2 half = glm::abs(glm::dvec2(view.half_x, view.half_y));
  return glm::max(glm::ivec2(glm::round(half * (resolution / std::max(half.x, half.y)))), 1);
}

}  // namespace

std::vector<LightView> phantom_pair(const gpu_scene::Camera& camera, double focus,
                                    const scene::Bounds& bounds) {
  const LightView seen = as_light_view(camera, {0, 0});
  const glm::dvec3 right = level_right(seen);
  focus = sane_focus(focus, seen, bounds);
  // What is seen is taken to be as deep as it is wide.
  const glm::dvec2 half = glm::abs(glm::dvec2(seen.half_x, seen.half_y));
  const double wide = 2 * std::max(half.x, half.y) * (seen.perspective ? focus : 1.0);
  glm::dvec2 depths(std::max(focus - wide, seen.near_depth), focus + wide);
  if (seen.perspective) {
    depths = {std::max(depths.x, focus / kDepths), std::min(depths.y, focus * kDepths)};
    const auto side = [&](double sign) {
      const double room = room_along(seen.origin, sign * right, bounds);
      return sign * std::min(kSide * focus, kRoom * room);
    };
    return {beside(seen, right, side(-1), kBack * focus, depths, bounds),
            beside(seen, right, side(1), kBack * focus, depths, bounds)};
  }
  // As steep as the other's, but so that what is seen half way from the near plane to the focus is
  // not cut away.
  const double across =
      half.x * std::abs(glm::dot(right, seen.x)) + half.y * std::abs(glm::dot(right, seen.y));
  const double slope = std::min(kSide / (1 + kBack), 0.5 * (focus - seen.near_depth) / across);
  return {turned(seen, right, -slope, focus, depths, bounds),
          turned(seen, right, slope, focus, depths, bounds)};
}

std::vector<LightView> phantom_cameras(const Settings& settings) {
  std::vector<LightView> views;
  for (int i = 0; i < settings.phantom_camera_count; ++i) {
    gpu_scene::Camera camera = settings.phantom_cameras[size_t(i)];
    camera.width = camera.height = 1;  // as if: a frustum does not depend on them
    views.push_back(as_light_view(camera, {0, 0}));
  }
  return views;
}

void PhantomMaps::render(const std::vector<LightView>& views, int resolution,
                         const shared::View& camera, const gpu_scene::GpuScene& scene,
                         gl::ProgramCache& programs, gl::PassTimer& timer,
                         gpu_scene::ViewBlock& view_block, bool keep) {
  if (maps_.resize(resolution, resolution, std::max(int(views.size()), 1))) keep = false;
  if (keep && views == drawn_) return;
  gl::PassScope scope(timer, "occlusion_phantom_views_draw");
  for (size_t i = 0; i < views.size(); ++i)
    // Shadow faces have the numbers from 1 on.
    maps_.draw(int(i), views[i], texels(views[i], resolution), -1.0f - float(i), camera, scene,
               programs, view_block);
  drawn_ = views;
  resolution_ = resolution;
}

std::vector<View> PhantomMaps::views(const glm::dvec3& camera_origin) const {
  std::vector<View> views;
  for (size_t i = 0; i < drawn_.size(); ++i) {
    shared::ShadowFace face =
        rasterize::shadow_face(drawn_[i], camera_origin, texels(drawn_[i], resolution_));
    face.half_extent.z = float(i);
    views.push_back({ViewKind::kPhantom, int(i), {face}, false});
  }
  return views;
}

}  // namespace panoptes::ambient_occlusion
