// Shader programs from the embedded sources under shaders/.
//
// A source file may `#include "folder/file.glsl"`, each file at most once. A permutation is a list
// of defines put in front of it; generated code (materials, worlds) enters as a named snippet that
// the sources include like a file. Compiler messages are translated back to file and line.
#pragma once

#include "gl/handles.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace panoptes::gl {

struct Stage {
  GLenum type;       // GL_COMPUTE_SHADER, ...
  std::string file;  // "realtime/direct_light.comp"
};

struct ProgramSource {
  std::string name;  // for messages and for files of the shader validation
  std::vector<Stage> stages;
  std::vector<std::string> defines;              // "HAS_SUN 1"
  std::map<std::string, std::string> snippets;   // "generated/material.glsl" -> text

  // Equal keys mean equal programs.
  std::string key() const;
};

// A stage's text with all includes resolved, and the names that its #line numbers refer to.
struct ExpandedSource {
  std::string text;
  std::vector<std::string> files;
};

// Throws Error when an included file does not exist.
ExpandedSource expand(const ProgramSource& source, const Stage& stage);

// "realtime/direct_light.comp:12: 'foo' : undeclared identifier" from a driver's message that names
// files by number.
std::string translate_log(std::string_view log, const std::vector<std::string>& files);

class Program : public Handle {
 public:
  Program() = default;
  // Compiles and links; throws Error with the first messages, naming file and line.
  explicit Program(const ProgramSource& source);
  Program(Program&&) noexcept = default;
  Program& operator=(Program&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Program();

  void use() const { glUseProgram(id_); }
};

// Programs by key, compiled at first use.
class ProgramCache {
 public:
  const Program& get(const ProgramSource& source);
  void clear() { programs_.clear(); }

 private:
  std::map<std::string, Program> programs_;
};

// The text of a file under shaders/, embedded at build time; empty view when there is none.
std::string_view embedded_shader(std::string_view file);

}  // namespace panoptes::gl
