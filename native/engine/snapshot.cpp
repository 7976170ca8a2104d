#include "engine/snapshot.h"

#include "base/error.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace panoptes::engine {

namespace {

constexpr uint32_t kMagic = 0x53504e50;  // "PNPS"
// Raised whenever the order or the meaning of what is written below changes.
constexpr uint32_t kVersion = 19;

// One description serves both directions: transfer(archive, value) writes or reads.
class Writer {
 public:
  explicit Writer(const std::string& path) : file_(path, std::ios::binary), path_(path) {}
  void bytes(const void* data, size_t count) {
    file_.write(static_cast<const char*>(data), std::streamsize(count));
  }
  void finish() {
    file_.close();
    if (!file_) fail("snapshot '{}' cannot be written: check the folder and the free space", path_);
  }

 private:
  std::ofstream file_;
  std::string path_;
};

class Reader {
 public:
  explicit Reader(const std::string& path) : file_(path, std::ios::binary), path_(path) {
    std::error_code error;
    if (!file_ || !std::filesystem::is_regular_file(path, error))
      fail("snapshot '{}' cannot be opened: check the path", path_);
    left_ = std::filesystem::file_size(path);
  }
  void bytes(void* data, size_t count) {
    if (count > left_) fail("snapshot '{}' is cut off: write it again", path_);
    left_ -= count;
    file_.read(static_cast<char*>(data), std::streamsize(count));
  }
  // Sizes come from the file: never allocate more than it can still hold.
  void check_size(uint64_t count, size_t each) {
    if (each && count > left_ / each) damaged();
  }
  [[noreturn]] void damaged() const { fail("snapshot '{}' is damaged: write it again", path_); }

 private:
  std::ifstream file_;
  std::string path_;
  uint64_t left_ = 0;
};

template <class T>
concept Plain = std::is_trivially_copyable_v<T>;

template <class A, Plain T>
void transfer(A& a, T& value) {
  a.bytes(&value, sizeof value);
}

template <class A>
uint64_t transfer_size(A& a, uint64_t size, size_t each) {
  transfer(a, size);
  if constexpr (std::is_same_v<A, Reader>) a.check_size(size, each);
  return size;
}

template <class A>
void transfer(A& a, std::string& text) {
  text.resize(transfer_size(a, text.size(), 1));
  a.bytes(text.data(), text.size());
}

template <class A, Plain T>
void transfer(A& a, std::vector<T>& list) {
  list.resize(transfer_size(a, list.size(), sizeof(T)));
  a.bytes(list.data(), list.size() * sizeof(T));
}

template <class A>
void transfer(A& a, scene::Attribute& attribute) {
  transfer(a, attribute.name);
  transfer(a, attribute.channels);
  transfer(a, attribute.values);
}

template <class A, class T>
  requires(!Plain<T>)
void transfer(A& a, std::vector<T>& list) {
  list.resize(transfer_size(a, list.size(), 1));
  for (T& item : list) transfer(a, item);
}

template <class A>
void transfer(A& a, scene::Mesh& m) {
  transfer(a, m.name);
  transfer(a, m.positions);
  transfer(a, m.triangles);
  transfer(a, m.corner_normals);
  transfer(a, m.ranges);
  transfer(a, m.attributes);
  transfer(a, m.default_uv);
  transfer(a, m.default_color);
  transfer(a, m.bounds);
  transfer(a, m.texture_space);
  transfer(a, m.warning);
}

template <class A>
void transfer(A& a, scene::Image& i) {
  transfer(a, i.name);
  transfer(a, i.width);
  transfer(a, i.height);
  transfer(a, i.type);
  transfer(a, i.channels);
  transfer(a, i.srgb);
  // Coarser levels are made again.
  if constexpr (std::is_same_v<A, Reader>) {
    if (i.width < 1 || i.height < 1 || i.type > scene::PixelType::kFloat ||
        (i.channels != 1 && i.channels != 2 && i.channels != 4))
      a.damaged();
    a.check_size(uint64_t(i.width) * uint64_t(i.height), i.texel_bytes());
    i = scene::new_image(i.name, i.width, i.height, i.type, i.channels, i.srgb);
    a.bytes(i.pixels().data(), i.bytes());
    scene::make_levels(i);
  } else {
    const scene::Image whole = i.levels.empty() && i.reload ? i.reload() : i;
    if (whole.levels.empty()) fail("image '{}' has no pixels: reload it", i.name);
    a.bytes(whole.levels[0].pixels.get(), whole.bytes());
  }
}

template <class A>
void transfer(A& a, scene::Material& m) {
  transfer(a, m.name);
  transfer(a, m.code);
  transfer(a, m.params);
  transfer(a, m.textures);
  transfer(a, m.attributes);
  transfer(a, m.facts);
}

template <class A>
void transfer(A& a, scene::World& w) {
  transfer(a, w.code);
  transfer(a, w.params);
  transfer(a, w.textures);
  transfer(a, w.constant);
}

// Calls `item(id, value)` for each entry of a map that is written, or fills one that is read.
template <class A, class T>
void transfer(A& a, std::map<scene::Id, T>& map) {
  const uint64_t count = transfer_size(a, map.size(), 1);
  if constexpr (std::is_same_v<A, Reader>) {
    for (uint64_t i = 0; i < count; ++i) {
      scene::Id id = 0;
      transfer(a, id);
      transfer(a, map[id]);
    }
  } else {
    for (auto& [id, value] : map) {
      scene::Id key = id;
      transfer(a, key);
      transfer(a, value);
    }
  }
}

struct Contents {
  std::map<scene::Id, scene::Mesh> meshes;
  std::map<scene::Id, scene::Image> images;
  std::map<scene::Id, scene::Material> materials;
  std::vector<scene::Instance> instances;
  std::vector<scene::Id> material_table;
  std::vector<scene::Light> lights;
  scene::World world;
  RenderRequest request;
};

template <class A>
void transfer(A& a, Contents& c) {
  transfer(a, c.meshes);
  transfer(a, c.images);
  transfer(a, c.materials);
  transfer(a, c.instances);
  transfer(a, c.material_table);
  transfer(a, c.lights);
  transfer(a, c.world);
  transfer(a, c.request);
}

}  // namespace

void write_snapshot(const std::string& path, const scene::Scene& scene,
                    const RenderRequest& request) {
  const std::string temporary = path + ".part";
  try {
    Writer writer(temporary);
    uint32_t magic = kMagic, version = kVersion;
    transfer(writer, magic);
    transfer(writer, version);
    Contents contents{scene.meshes(),         scene.images(), scene.materials(), scene.instances(),
                      scene.material_table(), scene.lights(), scene.world(),     request};
    transfer(writer, contents);
    writer.finish();
    std::filesystem::rename(temporary, path);
  } catch (const std::filesystem::filesystem_error& error) {
    std::remove(temporary.c_str());
    fail("snapshot '{}' cannot be written ({}): check the folder and the free space", path,
         error.code().message());
  } catch (...) {
    std::remove(temporary.c_str());
    throw;
  }
}

RenderRequest read_snapshot(const std::string& path, scene::Scene& scene) {
  Reader reader(path);
  uint32_t magic = 0, version = 0;
  transfer(reader, magic);
  transfer(reader, version);
  if (magic != kMagic) fail("'{}' is no Panoptes snapshot: make one by 'panoptes snapshot'", path);
  if (version != kVersion)
    fail("snapshot '{}' is of version {} and this program reads version {}: write it again", path,
         version, kVersion);
  Contents c;
  transfer(reader, c);
  for (auto& [id, mesh] : c.meshes) scene.set_mesh(id, std::move(mesh));
  for (auto& [id, image] : c.images) scene.set_image(id, std::move(image));
  for (auto& [id, material] : c.materials) scene.set_material(id, std::move(material));
  scene.set_instances(std::move(c.instances), std::move(c.material_table));
  scene.set_lights(std::move(c.lights));
  scene.set_world(std::move(c.world));
  return c.request;
}

}  // namespace panoptes::engine
