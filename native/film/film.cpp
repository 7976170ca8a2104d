#include "film/film.h"

#include "base/error.h"

#include <algorithm>
#include <numeric>

namespace panoptes::film {

void Film::start(int width, int height, const PassSet& wanted, const FilmOptions& options) {
  const PassSet passes = with_divisors(wanted);
  const bool fits = sums_ && width == width_ && height == height_ && passes == passes_ &&
                    options.moments == options_.moments;
  width_ = width;
  height_ = height;
  passes_ = passes;
  options_ = options;
  if (!fits) allocate();
  const float zero[4] = {0, 0, 0, 0};
  glClearTexImage(sums_.id(), 0, GL_RGBA, GL_FLOAT, zero);
  spoiled_.clear();
  block_samples_ = 0;
  blocks_ = {};
  block_moments_.clear();
  counts_ = {};
  active_list_.clear();
  active_ = gl::Buffer();
  active_count_ = 0;
  if (options.noise_threshold > 0) {
    counts_.each.assign(size_t(width) * size_t(height), 0);
    active_list_.resize(counts_.each.size());
    std::iota(active_list_.begin(), active_list_.end(), 0u);
    active_ = gl::Buffer(std::span<const uint32_t>(active_list_));
    active_count_ = int(active_list_.size());
  }
}

void Film::allocate() {
  sums_ = gl::Texture();
  layout_ = Layout(size_t(width_) * size_t(height_), passes_);
  int count = 0;
  for (int i = 0; i < kPassCount; ++i)
    if (layout_.holds(Pass(i))) layers_[i] = count++;
  moments_layer_ = count;
  if (options_.moments) ++count;
  summed_layers_ = count;
  for (int i = 0; i < kPassCount; ++i)
    if (passes_[size_t(i)] && kPasses[size_t(i)].kind == PassKind::kFirst) layers_[i] = count++;
  sums_ = gl::Texture({GL_TEXTURE_2D_ARRAY, GL_RGBA32F, width_, height_, count, 1});
  if (!spoiled_) spoiled_ = gl::Buffer(sizeof(uint32_t));
}

void Film::add_defines(gl::ProgramSource& source) const {
  for (int i = 0; i < kPassCount; ++i)
    if (passes_[size_t(i)] && !kPasses[size_t(i)].define.empty())
      source.defines.push_back(fmt::format("{} {}", kPasses[size_t(i)].define, layers_[i]));
  if (options_.moments) source.defines.push_back(fmt::format("FILM_MOMENTS {}", moments_layer_));
}

void Film::bind() const {
  sums_.bind_image(7, GL_WRITE_ONLY);
  sums_.bind(8);
  glBindSampler(8, 0);  // one of a material's images may still sit there
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 15, spoiled_.id());
}

void Film::end_sample(uint32_t index) {
  if (counts_.all > 0 && index != next_sample_)
    fail("sample {} follows on sample {}: please report it", index, next_sample_ - 1);
  next_sample_ = index + 1;
  ++counts_.all;
  ++block_samples_;
  // What comes before can be merged only with single samples, up to the first block's end.
  const uint32_t begun_at = next_sample_ - counts_.all;
  const bool apart = options_.pieces && begun_at % kBlock != 0 &&
                     begun_at / kBlock == index / kBlock;
  if (next_sample_ % kBlock == 0 || apart) {
    finish_block();
    if (options_.noise_threshold > 0 && counts_.all >= kBlock) choose_active();
  }
}

void Film::finish_block() {
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  Piece block{next_sample_ - block_samples_, next_sample_, std::vector<float>(layout_.total())};
  for (int i = 0; i < kPassCount; ++i) {
    if (!layout_.holds(Pass(i))) continue;
    const std::vector<float> sums = layer(layers_[i], kPasses[size_t(i)].channels);
    std::copy(sums.begin(), sums.end(), block.sums.begin() + std::ptrdiff_t(layout_.begin(Pass(i))));
  }
  if (options_.moments) block_moments_ = moments();
  counts_.each = counts().each;
  blocks_.add(std::move(block));
  clear_block();
}

void Film::clear_block() {
  const float zero[4] = {0, 0, 0, 0};
  glClearTexSubImage(sums_.id(), 0, 0, 0, 0, width_, height_, summed_layers_, GL_RGBA, GL_FLOAT,
                     zero);
  block_samples_ = 0;
}

void Film::choose_active() {
  active_list_ = noisy_pixels(block_moments_, counts_, width_, height_, options_.noise_threshold);
  active_count_ = int(active_list_.size());
  if (!active_list_.empty())
    active_.write(0, int64_t(active_list_.size() * sizeof(uint32_t)), active_list_.data());
}

std::vector<float> Film::layer(int index, int channels) const {
  const size_t pixels = size_t(width_) * size_t(height_);
  std::vector<float> values(pixels * 4);
  glGetTextureSubImage(sums_.id(), 0, 0, 0, index, width_, height_, 1, GL_RGBA, GL_FLOAT,
                       GLsizei(values.size() * sizeof(float)), values.data());
  if (channels == 4) return values;
  for (size_t i = 0; i < pixels; ++i)
    for (size_t c = 0; c < size_t(channels); ++c)
      values[i * size_t(channels) + c] = values[i * 4 + c];
  values.resize(pixels * size_t(channels));
  return values;
}

std::vector<float> Film::total(Pass pass) const {
  const int index = layers_[size_t(pass)], channels = info(pass).channels;
  if (blocks_.empty()) return layer(index, channels);
  std::vector<float> sums = blocks_.total(layout_.begin(pass), layout_.size(pass));
  if (block_samples_ > 0) accumulate(sums, layer(index, channels));
  return sums;
}

SampleCounts Film::counts() const {
  SampleCounts counts = counts_;
  for (uint32_t pixel : active_list_) counts.each[pixel] += block_samples_;
  return counts;
}

std::vector<Moments> Film::moments() const {
  std::vector<Moments> result = block_moments_;
  result.resize(size_t(width_) * size_t(height_));
  if (block_samples_ == 0) return result;
  const std::vector<float> sums = layer(moments_layer_, 2);
  for (size_t i = 0; i < result.size(); ++i) {
    result[i].sum += double(sums[2 * i]);
    result[i].squares += double(sums[2 * i + 1]);
  }
  return result;
}

std::vector<float> Film::read(Pass pass, float exposure) const {
  const PassInfo& p = info(pass);
  if (!passes_[size_t(pass)])
    fail("pass '{}' was not rendered: enable it in the view layer and render again", p.name);
  if (p.kind == PassKind::kFirst) return layer(layers_[size_t(pass)], p.channels);
  if (p.kind == PassKind::kNoisy) return read(Pass::kCombined, exposure);
  if (p.kind == PassKind::kSamples)
    return sample_shares(counts(), size_t(width_) * size_t(height_));
  std::vector<float> divisor;
  if (p.divisor != pass) divisor = total(p.divisor);
  return average(pass, total(pass), divisor, counts(), exposure);
}

std::optional<double> Film::estimated_error() const {
  if (!options_.moments || counts_.all < 2) return std::nullopt;
  return relative_error(moments(), counts());
}

std::vector<float> Film::variance(float exposure) const {
  if (!options_.moments || counts_.all < 2) return {};
  return variances(moments(), counts(), exposure);
}

uint32_t Film::spoiled_samples() const {
  uint32_t count = 0;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  spoiled_.read(0, sizeof count, &count);
  return count;
}

Pieces Film::take_pieces(float exposure) {
  if (block_samples_ > 0) finish_block();
  Pieces pieces{width_, height_, exposure, passes_, std::exchange(blocks_, {}), {}};
  for (int i = 0; i < kPassCount; ++i)
    if (passes_[size_t(i)] && kPasses[size_t(i)].kind == PassKind::kFirst)
      pieces.firsts[Pass(i)] = read(Pass(i), exposure);
  counts_ = {};
  return pieces;
}

}  // namespace panoptes::film
