#include "gl/program.h"

#include "base/error.h"
#include "gl/counters.h"

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

namespace panoptes::gl {

namespace {

// Mesa forgets a file's number in the messages of its semantic analysis, never the line's: so the
// line says which file it is in as well.
constexpr size_t kLinesPerFile = 100000;

class Expander {
 public:
  explicit Expander(const ProgramSource& source) : source_(source) {}

  ExpandedSource run(const Stage& stage) {
    result_.text = "#version 450 core\n";
    for (const std::string& define : source_.defines) result_.text += "#define " + define + "\n";
    append(stage.file, stage.file);
    return std::move(result_);
  }

 private:
  void append(const std::string& file, const std::string& includer) {
    if (!seen_.insert(file).second) return;
    const auto snippet = source_.snippets.find(file);
    const std::string_view text =
        snippet != source_.snippets.end() ? snippet->second : embedded_shader(file);
    // Includes are resolved before conditions are: a permutation without generated code has none.
    if (text.data() == nullptr && file.starts_with("generated/")) return;
    if (text.data() == nullptr)
      fail("shader '{}' includes '{}', which does not exist: reinstall Panoptes", includer, file);

    const size_t index = result_.files.size();
    result_.files.push_back(file);
    const auto line_directive = [&](size_t line) {
      return fmt::format("#line {} {}\n", index * kLinesPerFile + line, index);
    };
    result_.text += line_directive(1);
    std::istringstream lines{std::string(text)};
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
      static const std::regex include(R"(^\s*#\s*include\s*"([^"]+)\"\s*$)");
      static const std::regex pragma_once(R"(^\s*#\s*pragma\s+once\s*$)");
      std::smatch match;
      if (line.find('#') != std::string::npos && std::regex_match(line, match, include)) {
        append(match[1], file);
        result_.text += line_directive(size_t(number) + 1);
      } else if (line.find('#') != std::string::npos && std::regex_match(line, pragma_once)) {
        result_.text += "\n";
      } else {
        result_.text += line + "\n";
      }
    }
  }

  const ProgramSource& source_;
  ExpandedSource result_;
  std::set<std::string> seen_;
};

std::string first_lines(const std::string& text, int count) {
  std::istringstream lines(text);
  std::string line, result;
  while (count-- > 0 && std::getline(lines, line))
    if (!line.empty()) result += (result.empty() ? "" : "; ") + line;
  return result;
}

GLuint compile(const ProgramSource& source, const Stage& stage) {
  const ExpandedSource expanded = expand(source, stage);
  const GLuint shader = glCreateShader(stage.type);
  const char* text = expanded.text.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled) return shader;

  std::string log(8192, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader, GLsizei(log.size()), &length, log.data());
  log.resize(size_t(length));
  glDeleteShader(shader);
  fail("shader program '{}' does not compile, please report it: {}", source.name,
       first_lines(translate_log(log, expanded.files), 3));
}

}  // namespace

std::string ProgramSource::key() const {
  std::string result;
  for (const Stage& stage : stages) result += stage.file + '\n';
  for (const std::string& define : defines) result += define + '\n';
  for (const auto& [file, text] : snippets) result += file + '\n' + text + '\n';
  return result;
}

ExpandedSource expand(const ProgramSource& source, const Stage& stage) {
  return Expander(source).run(stage);
}

std::string translate_log(std::string_view log, const std::vector<std::string>& files) {
  // Mesa writes "1:23(7): error: …", NVIDIA "1(23) : error …", glslang "ERROR: 1:23: …".
  static const std::regex position(
      R"((\d{1,8})(?::(\d{1,8})(?:\(\d+\))?|\((\d{1,8})\))\s*:)");
  std::string result;
  std::istringstream lines{std::string(log)};
  std::string line;
  while (std::getline(lines, line)) {
    std::smatch match;
    if (std::regex_search(line, match, position)) {
      const size_t number = std::stoul(match[2].matched ? match[2].str() : match[3].str());
      const size_t named = number >= kLinesPerFile ? number / kLinesPerFile : std::stoul(match[1]);
      line = fmt::format("{}{}:{}:{}", match.prefix().str(),
                         files[std::min(named, files.size() - 1)], number % kLinesPerFile,
                         match.suffix().str());
    }
    result += line + '\n';
  }
  return result;
}

Program::Program(const ProgramSource& source) {
  std::vector<GLuint> shaders;
  const auto release = [&] {
    for (GLuint shader : shaders) glDeleteShader(shader);
  };
  try {
    for (const Stage& stage : source.stages) shaders.push_back(compile(source, stage));
  } catch (...) {
    release();
    throw;
  }
  id_ = glCreateProgram();
  for (GLuint shader : shaders) glAttachShader(id_, shader);
  glLinkProgram(id_);
  release();

  GLint linked = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &linked);
  if (!linked) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(id_, GLsizei(log.size()), &length, log.data());
    log.resize(size_t(length));
    glDeleteProgram(id_);
    fail("shader program '{}' does not link, please report it: {}", source.name,
         first_lines(log, 3));
  }
  ++counters().programs;
}

Program::~Program() {
  if (id_) glDeleteProgram(id_);
}

const Program& ProgramCache::get(const ProgramSource& source) {
  std::string key = source.key();
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  return programs_.emplace(std::move(key), Program(source)).first->second;
}

}  // namespace panoptes::gl
