// The module that the add-on loads: plain arrays in, plain arrays out. Inputs are copied while the
// GIL is held; it is released around everything that waits or works. Every error is a
// panoptes_native.Error with cause and remedy.
#include "engine/engine.h"
#include "engine/snapshot.h"
#include "gl/counters.h"
#include "image_io/image_io.h"
#include "image_io/pieces.h"
#include "python/convert.h"
#include "python/mesh.h"
#include "python/post.h"

namespace panoptes::python {

namespace {

using engine::Engine;
using engine::Job;
using scene::Id;
using scene::Scene;

// Runs `change`, which owns all that it needs, on the scene, without the GIL and without waiting.
template <class F>
void edit(Engine& engine, F&& change) {
  py::gil_scoped_release release;
  post(engine, std::forward<F>(change));
}

std::vector<glm::mat4> matrices_of(const Array<float>& array) {
  if (array.size() % 16 != 0) fail("matrices must have shape (N, 4, 4): please report it");
  std::vector<glm::mat4> result(size_t(array.size()) / 16);
  for (size_t i = 0; i < result.size(); ++i)
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) result[i][c][r] = array.data()[i * 16 + size_t(r * 4 + c)];
  return result;
}

void set_instances(Engine& engine, const Array<int64_t>& meshes, const Array<float>& matrices,
                   const Array<int>& material_offsets, const Array<int64_t>& material_table,
                   const std::optional<Array<uint8_t>>& visibility,
                   const std::optional<Array<float>>& scales) {
  const std::vector<glm::mat4> places = matrices_of(matrices);
  if (places.size() != size_t(meshes.size()) || places.size() != size_t(material_offsets.size()) ||
      (visibility && places.size() != size_t(visibility->size())) ||
      (scales && places.size() * 2 != size_t(scales->size())))
    fail("instances were handed over with arrays of different lengths: please report it");
  std::vector<scene::Instance> instances(places.size());
  for (size_t i = 0; i < places.size(); ++i) {
    instances[i] = {meshes.data()[i], places[i], material_offsets.data()[i]};
    if (visibility) instances[i].visibility = visibility->data()[i];
    if (scales) instances[i].indirect_scale = {scales->data()[i * 2], scales->data()[i * 2 + 1]};
  }
  std::vector<Id> table(material_table.data(), material_table.data() + material_table.size());
  edit(engine, [instances = std::move(instances), table = std::move(table)](Scene& scene) mutable {
    scene.set_instances(std::move(instances), std::move(table));
  });
}

void set_instance_matrices(Engine& engine, const Array<int>& indices,
                           const Array<float>& matrices) {
  std::vector<glm::mat4> places = matrices_of(matrices);
  std::vector<int> list(indices.data(), indices.data() + indices.size());
  edit(engine, [list = std::move(list), places = std::move(places)](Scene& scene) { scene.set_instance_matrices(list, places); });
}

void set_instance_scales(Engine& engine, const Array<int>& indices, const Array<float>& scales) {
  const auto values = rows<glm::vec2>(scales, "scales", 2);
  std::vector<glm::vec2> copied(values.begin(), values.end());
  std::vector<int> list(indices.data(), indices.data() + indices.size());
  edit(engine, [list = std::move(list), copied = std::move(copied)](Scene& scene) { scene.set_instance_scales(list, copied); });
}

void set_material(Engine& engine, Id id, const std::string& name, const std::string& code,
                  const Array<float>& values, const py::list& textures, const py::dict& facts) {
  scene::Material material{name, code, params(values), texture_uses(textures), {}, {}};
  const auto flag = [&](const char* key, bool otherwise) {
    return facts.contains(key) ? facts[key].cast<bool>() : otherwise;
  };
  material.facts = {flag("alpha", false),      flag("emission", false),
                    flag("emission_varies", true), flag("normal_map", false),
                    flag("glossy", true),      flag("transmission", false),
                    flag("layers", false)};
  if (facts.contains("least_roughness"))
    material.facts.least_roughness = facts["least_roughness"].cast<float>();
  if (facts.contains("attributes"))
    material.attributes = facts["attributes"].cast<std::vector<std::string>>();
  edit(engine, [id, material = std::move(material)](Scene& scene) mutable { scene.set_material(id, std::move(material)); });
}

void set_world(Engine& engine, const std::string& code, const Array<float>& values,
               const py::list& textures, const std::optional<std::array<float, 3>>& constant) {
  scene::World world{code, params(values), texture_uses(textures), std::nullopt};
  if (constant) world.constant = glm::vec3((*constant)[0], (*constant)[1], (*constant)[2]);
  edit(engine, [world = std::move(world)](Scene& scene) mutable { scene.set_world(std::move(world)); });
}

// T: uint8_t or float; bytes stay bytes.
template <class T>
void set_image_pixels(Engine& engine, Id id, const std::string& name, const py::array_t<T>& pixels,
                      bool srgb, const std::string& alpha) {
  if (pixels.ndim() != 3 || pixels.shape(2) != 4)
    fail("image '{}' must have shape (H, W, 4): please report it", name);
  const auto values = Array<T>::ensure(pixels);
  scene::Image image = scene::make_image(name, int(values.shape(1)), int(values.shape(0)),
                                         std::span(values.data(), size_t(values.size())), srgb,
                                         alpha_mode(alpha));
  edit(engine, [id, image = std::move(image)](Scene& scene) mutable { scene.set_image(id, std::move(image)); });
}

// (height, width, channels) of a job's picture.
py::array array_of(const Job& job, std::vector<float> pixels, int channels) {
  const auto* owned = new std::vector<float>(std::move(pixels));
  const py::capsule owner(owned, [](void* p) { delete static_cast<std::vector<float>*>(p); });
  const py::ssize_t height = job.request().camera.height, width = job.request().camera.width;
  return py::array_t<float>({height, width, py::ssize_t(channels)}, owned->data(), owner);
}

py::array read_pass(const Job& job, const std::string& name) {
  const film::Pass pass = film::find_pass(name);
  std::vector<float> pixels;
  {
    py::gil_scoped_release release;
    pixels = job.read(pass);
  }
  return array_of(job, std::move(pixels), film::info(pass).channels);
}

// None while there is nothing.
py::object read_shown(const Job& job) {
  std::vector<float> pixels;
  {
    py::gil_scoped_release release;
    pixels = job.read_shown();
  }
  return pixels.empty() ? py::none() : py::object(array_of(job, std::move(pixels), 4));
}

// Pieces on their way from a job into a file; Python only carries them.
struct KeptPieces {
  std::shared_ptr<const film::Pieces> pieces;
};

// `layers`: (name, settings, Job.pieces()) of each view layer.
void add_pieces(const std::string& source, const std::string& target, const py::list& layers) {
  std::vector<image_io::LayerPieces> list;
  for (const auto& item : layers) {
    const auto [name, settings, kept] = item.cast<std::tuple<std::string, std::string, KeptPieces>>();
    if (!kept.pieces) fail("layer '{}' was rendered without pieces: please report it", name);
    list.push_back({name, settings, kept.pieces});
  }
  py::gil_scoped_release release;
  image_io::add_pieces(source, target, list);
}

py::list find_pieces(const std::string& path) {
  py::list result;
  for (const image_io::LayerRange& layer : image_io::find_pieces(path))
    result.append(py::make_tuple(layer.layer, layer.settings, layer.first, layer.last));
  return result;
}

std::vector<std::string> merge_pieces(const std::vector<std::string>& sources,
                                      const std::string& target) {
  py::gil_scoped_release release;
  return image_io::merge_pieces(sources, target);
}

void bind_pieces(py::module_& m) {
  py::class_<KeptPieces>(m, "Pieces", "What a job keeps of its samples for merging.");
  m.def("add_pieces", &add_pieces, py::arg("source"), py::arg("target"), py::arg("layers"),
        "Writes an OpenEXR picture to another file with pieces behind it; layers are (name, settings, "
        "pieces).");
  m.def("find_pieces", &find_pieces, py::arg("path"),
        "(layer, settings, first sample, last sample exclusive) of all layers with pieces in a file.");
  m.def("merge_pieces", &merge_pieces, py::arg("sources"), py::arg("target"),
        "Merges files in the order of their samples; returns the channels that were left out.");
}

py::dict counters() {
  const gl::Counters& c = gl::counters();
  py::dict d;
  d["uploads"] = c.uploads.load();
  d["uploaded_bytes"] = c.uploaded_bytes.load();
  d["programs"] = c.programs.load();
  d["buffers"] = c.buffers.load();
  d["textures"] = c.textures.load();
  d["memory_bytes"] = c.memory_bytes.load();
  return d;
}

void bind_job(py::module_& m) {
  const auto no_gil = py::call_guard<py::gil_scoped_release>();
  py::class_<Job, std::shared_ptr<Job>>(m, "Job", "One frame under way, or ended.")
      .def("progress", &Job::progress, "Share of the samples that are done, 0 to 1.")
      .def("status", &Job::status, "What runs now, for a status line.")
      .def("wait", &Job::wait, py::arg("seconds"), no_gil,
           "Waits at most so long; True when the job has ended, however it ended.")
      .def("cancel", &Job::cancel, "Asks the job to stop; it does so within one pass.")
      .def("cancelled", &Job::cancelled)
      .def("samples_ready", &Job::samples_ready, "Samples in what read() gives.")
      .def("has_look", &Job::has_look,
           "Whether read('Combined') gives a picture, if only of the simplest effects, with no sample.")
      .def("first_sample_seconds", &Job::first_sample_seconds,
           "How long the frame took to its first sample; 0 while there is none.")
      .def("finish", &Job::check, "Raises Error when the render failed.")
      .def("read", &read_pass, py::arg("name"),
           "float32 array (height, width, channels) of a pass, row 0 at the bottom.")
      .def("read_shown", &read_shown,
           "The same of what a 3D View shows while paths take over the request's picture 'smooth', four channels; None "
           "while there is none.")
      .def("pieces", [](const Job& job) { return KeptPieces{job.pieces()}; },
           "What the ended job kept for add_pieces(); empty unless the request had 'pieces'.")
      .def("stats", [](const Job& job) {
        const std::string json = job.stats().to_json();
        return py::module_::import("json").attr("loads")(json);
      });
}

py::class_<Engine> bind_engine(py::module_& m) {
  const auto no_gil = py::call_guard<py::gil_scoped_release>();
  py::class_<Engine> type(m, "Engine", "A render thread with its own OpenGL context, and its scene.");
  type.def(py::init([](bool prefer_software) {
             py::gil_scoped_release release;
             return std::make_unique<Engine>(gl::ContextOptions{prefer_software});
           }),
           py::arg("prefer_software") = false)
      .def_property_readonly("device", [](const Engine& e) { return e.device().renderer; })
      .def_property_readonly("spoiled", &Engine::spoiled,
                             "Whether the graphics driver has failed: another engine should take its place.")
      .def("close", &Engine::close, no_gil, "Stops the render thread. Idempotent.")
      .def("counters", [](const Engine&) { return counters(); })
      .def("remove_mesh", [](Engine& e, Id id) { edit(e, [id](Scene& s) { s.remove_mesh(id); }); })
      .def("set_instances", &set_instances, py::arg("mesh_ids"), py::arg("matrices"),
           py::arg("material_offsets"), py::arg("material_table"),
           py::arg("visibility") = py::none(), py::arg("indirect_scales") = py::none())
      .def("set_instance_matrices", &set_instance_matrices, py::arg("indices"), py::arg("matrices"))
      .def("set_instance_scales", &set_instance_scales, py::arg("indices"), py::arg("scales"))
      .def("set_material", &set_material, py::arg("id"), py::arg("name"), py::arg("code"),
           py::arg("params"), py::arg("textures"), py::arg("facts"))
      .def("set_material_params",
           [](Engine& e, Id id, const Array<float>& values, float least_roughness) {
             std::vector<glm::vec4> list = params(values);
             edit(e, [id, list = std::move(list), least_roughness](Scene& s) mutable {
               s.set_material_params(id, std::move(list), least_roughness);
             });
           },
           py::arg("id"), py::arg("params"), py::arg("least_roughness") = 0.0f)
      .def("remove_material",
           [](Engine& e, Id id) { edit(e, [id](Scene& s) { s.remove_material(id); }); })
      .def("set_image_file",
           [](Engine& e, Id id, const std::string& name, const std::string& path, bool srgb,
              const std::string& alpha) {
             py::gil_scoped_release release;
             scene::Image image = image_io::load_file(name, path, srgb, alpha_mode(alpha));
             post(e, [id, image = std::move(image)](Scene& s) mutable { s.set_image(id, std::move(image)); });
             e.upload_images();
           })
      .def("set_image_encoded",
           [](Engine& e, Id id, const std::string& name, const py::bytes& data, bool srgb,
              const std::string& alpha) {
             auto copy = std::make_shared<const std::string>(data);
             py::gil_scoped_release release;
             scene::Image image = image_io::load_memory(name, copy, srgb, alpha_mode(alpha));
             post(e, [id, image = std::move(image)](Scene& s) mutable { s.set_image(id, std::move(image)); });
             e.upload_images();
           })
      .def("set_image_pixels", &set_image_pixels<uint8_t>, py::arg("id"), py::arg("name"),
           py::arg("pixels").noconvert(), py::arg("srgb"), py::arg("alpha"))
      .def("set_image_pixels", &set_image_pixels<float>, py::arg("id"), py::arg("name"),
           py::arg("pixels"), py::arg("srgb"), py::arg("alpha"))
      .def("remove_image", [](Engine& e, Id id) { edit(e, [id](Scene& s) { s.remove_image(id); }); })
      .def("set_lights",
           [](Engine& e, const py::list& list) {
             std::vector<scene::Light> lights;
             for (const auto& item : list)
               lights.push_back(light(py::reinterpret_borrow<py::dict>(item)));
             edit(e, [lights = std::move(lights)](Scene& s) mutable { s.set_lights(std::move(lights)); });
           })
      .def("set_world", &set_world, py::arg("code"), py::arg("params"), py::arg("textures"),
           py::arg("constant") = py::none())
      .def("render",
           [](Engine& e, const py::dict& dict) {
             engine::RenderRequest r = request(dict);
             engine::TakeOver over = take_over(dict);
             py::gil_scoped_release release;
             return e.render(std::move(r), std::move(over));
           })
      .def("write_snapshot", [](Engine& e, const std::string& path, const py::dict& dict) {
        const engine::RenderRequest r = request(dict);
        py::gil_scoped_release release;
        e.edit([&](Scene& s) { engine::write_snapshot(path, s, r); });
      });
  return type;
}

}  // namespace

PYBIND11_MODULE(panoptes_native, m) {
  m.doc() = "Native part of the Panoptes render engine.";
  m.attr("__version__") = PANOPTES_VERSION;
  py::register_exception<Error>(m, "Error", PyExc_RuntimeError);
  bind_pieces(m);
  bind_job(m);
  py::class_<Engine> engine = bind_engine(m);
  bind_meshes(m, engine);
}

}  // namespace panoptes::python
