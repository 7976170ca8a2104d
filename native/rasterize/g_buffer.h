// The camera's visibility and G-buffer: which triangle each pixel shows, and the surface there.
//
// Triangle ids are rasterised first; then pixels are sorted into one bin a material, and each
// material program runs over its own bin, pulling attributes by id. So a material is evaluated once
// a pixel whatever the depth complexity, and the same code serves hits of rays.
#pragma once

#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "plan/effect.h"

namespace panoptes::rasterize {

// Where a view is drawn to, as far as the raster programs differ.
struct RasterProgramOptions {
  bool depth_only = false;
};
gl::ProgramSource raster_program(const gpu_scene::GpuMaterial* material,
                                 const RasterProgramOptions& options);

// What the surfaces must hold; the rest is neither allocated nor computed.
struct GBufferOptions {
  bool glossy = false;
  bool emission = false;
  bool transmission = false;
  bool layers = false;  // a coat or a sheen
  // What of this a frame's plan runs.
  static GBufferOptions of(const plan::Effects& plan);
  // Adds the macros that g_buffer.glsl asks for.
  void add_defines(gl::ProgramSource& source) const;
  // Of a surface that a ray has met, as tracing/surface_record.glsl and base/lobes.glsl have it.
  int64_t record_bytes() const;
  bool operator==(const GBufferOptions&) const = default;
};
gl::ProgramSource surface_program(const gpu_scene::GpuMaterial& material,
                                  const GBufferOptions& options);
// Programs that sort pixels: "bin_count", "bin_offsets", "bin_scatter".
gl::ProgramSource bin_program(const char* name);

class GBuffer {
 public:
  // (Re)allocates when the size or the options differ from the last call's.
  void resize(int width, int height, const GBufferOptions& options);
  // The same without room for surfaces: what is found and sorted is all.
  void resize_visibility(int width, int height);

  // Finds the triangle and the depth of each pixel for the view that is set in the ViewBlock.
  void rasterize(const gpu_scene::GpuScene& scene, gl::ProgramCache& programs,
                 gl::PassTimer& timer);
  // The same for views of lamps too; the caller times it.
  void draw(gpu_scene::ViewKind kind, const gpu_scene::GpuScene& scene, gl::ProgramCache& programs);
  // Sorts what was found by material, for programs that include rasterize/bins.glsl. shade() does so
  // itself.
  void sort_pixels(const gpu_scene::GpuScene& scene, gl::ProgramCache& programs);
  // Evaluates the materials of what rasterize() found.
  void shade(const gpu_scene::GpuScene& scene, gl::ProgramCache& programs, gl::PassTimer& timer);

  // For programs that include rasterize/bins.glsl and read the G-buffer. Call with the program in
  // use; sets the uniform `material_count`.
  void bind_bins() const;
  void bind_surfaces() const;
  void bind_visibility() const;

  // Runs the program in use over all pixels that show a surface, over those that show none, or over
  // those of one material.
  void dispatch_surfaces() const;
  void dispatch_background() const;
  void dispatch_material(uint32_t material) const { dispatch_bin(material); }

  const gl::Texture& emission() const { return emission_; }
  const gl::Texture& depth() const { return depth_; }  // reversed: 0 where no surface is
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  void dispatch_bin(uint32_t bin) const;

  int width_ = 0, height_ = 0;
  GBufferOptions options_;
  uint32_t material_count_ = 0;
  const gl::Buffer* records_ = nullptr;
  gl::Texture visibility_, depth_, position_, normals_, diffuse_, specular_, emission_, transmission_, layers_;
  gl::Framebuffer framebuffer_;
  gl::Buffer bins_, pixels_;
};

}  // namespace panoptes::rasterize
