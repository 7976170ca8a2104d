// Ray visibility: who is hidden from the camera still casts a shadow, and the other way round.
#include "gl/counters.h"
#include "support.h"

namespace panoptes::test {
namespace {

using film::Pass;

const gpu_scene::Camera kAbove = orthographic({0, 0, 5}, {0, 0, 0}, 2, 32, 32);
// Seen from above the blocker is left of the middle, its shadow right of it.
constexpr int kBlockerX = 8, kShadowX = 24, kY = 16;

// A white floor and a red square in a slanting sun. `alpha` says whether the square's material may
// discard fragments.
struct Blocked {
  explicit Blocked(bool alpha) {
    s.add_object(floor_at(0, 3), {s.add_material(lambert())});
    const Id red = s.add_material(alpha ? alpha_card({1, 0, 0, 1}) : lambert({1, 0, 0}));
    blocker = s.instances.size();
    s.add_object(quad({-1, 0, 2}, {0.75f, 0, 0}, {0, 0.75f, 0}), {red});
    s.lights = {sun({1, 0, -1}, 2)};
  }
  Picture with(uint32_t visibility) {
    s.instances[blocker].visibility = visibility;
    return render(s, request(kAbove, {Pass::kDiffCol, Pass::kDiffDir}));
  }
  TestScene s;
  size_t blocker = 0;
};

bool shows_blocker(const Picture& p) { return p.value(Pass::kDiffCol, kBlockerX, kY, 1) == 0; }
bool shows_shadow(const Picture& p) { return p.value(Pass::kDiffDir, kShadowX, kY) == 0; }

TEST(Visibility, FollowsTheCamerasAndTheShadowsBits) {
  for (const bool alpha : {false, true}) {
    SCOPED_TRACE(alpha ? "alpha" : "opaque");
    Blocked blocked(alpha);
    for (uint32_t bits = 0; bits <= shared::SEEN_BY_ALL; ++bits) {
      const Picture p = blocked.with(bits);
      EXPECT_EQ(shows_blocker(p), bool(bits & shared::SEEN_BY_CAMERA)) << bits;
      EXPECT_EQ(shows_shadow(p), bool(bits & shared::SEEN_BY_SHADOW)) << bits;
      EXPECT_EQ(p.value(Pass::kDiffCol, kShadowX, kY, 1), 1) << "the floor is always there";
    }
  }
}

TEST(Visibility, OfOtherRaysChangesNothingHere) {
  for (const bool alpha : {false, true}) {
    SCOPED_TRACE(alpha ? "alpha" : "opaque");
    Blocked blocked(alpha);
    const Picture all = blocked.with(shared::SEEN_BY_ALL),
                  two = blocked.with(shared::SEEN_BY_CAMERA | shared::SEEN_BY_SHADOW);
    for (Pass pass : {Pass::kCombined, Pass::kDiffCol, Pass::kDiffDir})
      EXPECT_EQ(all[pass], two[pass]);
  }
}

TEST(Visibility, IsAnEditThatCompilesNothing) {
  for (const bool alpha : {false, true}) {
    SCOPED_TRACE(alpha ? "alpha" : "opaque");
    Blocked blocked(alpha);
    blocked.with(shared::SEEN_BY_ALL);
    const int64_t programs = gl::counters().programs;
    for (uint32_t bits : {shared::SEEN_BY_SHADOW, shared::SEEN_BY_CAMERA, shared::SEEN_BY_ALL}) {
      blocked.s.instances[blocked.blocker].visibility = bits;
      shared_engine().edit(
          [&](scene::Scene& scene) { scene.set_instances(blocked.s.instances, blocked.s.table); });
      const Picture p = render(request(kAbove, {Pass::kDiffCol, Pass::kDiffDir}));
      EXPECT_EQ(shows_blocker(p), bool(bits & shared::SEEN_BY_CAMERA)) << bits;
      EXPECT_EQ(shows_shadow(p), bool(bits & shared::SEEN_BY_SHADOW)) << bits;
    }
    EXPECT_EQ(gl::counters().programs, programs);
  }
}

TEST(Visibility, WithoutAnyBitIsNoPartOfTheScene) {
  for (const bool alpha : {false, true}) {
    SCOPED_TRACE(alpha ? "alpha" : "opaque");
    Blocked blocked(alpha);
    blocked.with(0);
    shared_engine().edit([&](scene::Scene& scene) {
      EXPECT_EQ(scene.facts().instances, 1);
      EXPECT_FALSE(scene.facts().alpha);
      expect_error([&] { scene.set_instances({{1, glm::mat4(1), 0, 64}}, {}); }, "visibility 64");
    });
  }
}

}  // namespace
}  // namespace panoptes::test
